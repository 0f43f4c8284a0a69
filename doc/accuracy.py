#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every figure and table of doc/accuracy.md, from its text in doc/accuracy.in.md:  doc/accuracy.py [BUILD]

Solves all packings with a reference by every law (some 200 runs of `pfv solve`, some 15 seconds), then with
each sphere of some of them moving alone (some 2800 runs, a minute or two), and writes doc/accuracy.md and
doc/figures/accuracy_*.png.
"""
import concurrent.futures
import csv
import dataclasses
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1]
DATA = ROOT / "tests/data"
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
LAWS = ("hydraulic_radius", "effective_radius", "open_throat")
COLOURS = dict(zip(LAWS, ("tab:blue", "tab:grey", "tab:red")))
LATTICES = {  # centres, touching radius, K of F = 6 pi mu a K U by radius scale
    "SC": ([(.5, .5, .5)], .5, {1: 42.1, .95: 27.9, .9: 19.18, .8: 10.06, .5: 2.84202, .1: 1.16461}),
    "BCC": ([(.25, .25, .25), (.75, .75, .75)], 3 ** .5 / 4,
            {1: 162.9, .95: 78.6, .9: 42.82, .8: 16.86, .7: 8.57}),
    "FCC": ([(.25, .25, .25), (.75, .75, .25), (.75, .25, .75), (.25, .75, .75)], 2 ** .5 / 4,
            {1: 435, .95: 147.9, .9: 65.2, .8: 20.90, .7: 9.72})}
OVERLAPPING = {("SC", 1.03): 1.87691e-3, ("SC", 1.06): 1.37346e-3, ("BCC", 1.03): 2.19335e-4}
DENSITIES = (30, 40, 50, 55, 60, 63, 64)
THROUGH = ("--face", "zlo:pressure=1", "--face", "zhi:pressure=0")
PERIODIC = ("--periodic", "x,y,z", "--gradient", "0", "0", "-1")


@dataclasses.dataclass
class Case:
    group: str
    name: str
    spheres: list                  # (x, y, z, radius) in the unit cube
    exact: float                   # permeability, m2; nan where none is known
    wall: str = ""                 # "" in a periodic cell
    forces: dict = None            # exact force (3) by number of the sphere
    calibrates: bool = True        # the error estimate saw it
    found: dict = dataclasses.field(default_factory=dict)  # law: (report, forces)

    def ratio(self, law):
        return permeability(self.found[law][0]) / self.exact

    def force_errors(self, law):
        found = self.found[law][1]
        return [math.dist(found[k], exact) / math.hypot(*exact) for k, exact in self.forces.items()]


def permeability(report):
    tensor = report["permeability_tensor"]
    return sum(tensor[i][i] for i in range(3)) / 3 if tensor else report["permeability"]


def rows_of(name):
    with open(DATA / name, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


def bed(name):
    return [tuple(float(r[k]) for k in ("x", "y", "z", "radius")) for r in rows_of(name + ".csv")]


def solve(case, folder, arguments):
    packing, report, forces = (folder / name for name in ("p.csv", "r.json", "f.csv"))
    packing.write_text("id,x,y,z,radius\n" + "".join(
        f"{i},{x!r},{y!r},{z!r},{r!r}\n" for i, (x, y, z, r) in enumerate(case.spheres, 1)))
    where = [*THROUGH, "--wall", case.wall] if case.wall else PERIODIC
    subprocess.run([BUILD / "bin/pfv", "solve", "--packing", packing, "--box", "0", "1", "0", "1",
                    "0", "1", "--viscosity", "1", "--report", report, "--forces", forces, *where,
                    *arguments], check=True, capture_output=True)
    with open(forces, newline="", encoding="ascii") as file:
        rows = {int(r["id"]): tuple(float(r[k]) for k in ("fx", "fy", "fz", "fpz", "fvz"))
                for r in csv.DictReader(file)}
    return json.loads(report.read_text()), {k: r[:3] for k, r in rows.items()}, rows


def lattice(name, scale):
    centres, touching, drags = LATTICES[name]
    radius = touching * scale
    exact = OVERLAPPING.get((name, scale))
    if exact is None:
        exact = 1 / (6 * math.pi * radius * drags[scale] * len(centres))
    return [(*c, radius) for c in centres], exact


def nine_spheres(size):
    spheres = [(x, y, z, .25) for x in (.25, .75) for y in (.25, .75) for z in (.25, .75)]
    return spheres + ([(.5, .5, .5, .25 * size)] if size else [])


def cases():
    for name, (_, _, drags) in LATTICES.items():
        for scale in drags:
            yield Case("lattices", f"{name} x {scale}", *lattice(name, scale))
    for name, scale in OVERLAPPING:
        yield Case("overlapping lattices", f"{name} x {scale}", *lattice(name, scale))
    for row in rows_of("stokes_nine_spheres.csv"):
        size = float(row["d_over_D"])
        forces = {k: (0, 0, float(row["big_total"])) for k in range(1, 9)}
        if size:
            forces[9] = (0, 0, float(row["small_total"]))
        yield Case("nine spheres", f"nine spheres, d/D {size:g}", nine_spheres(size),
                   float(row["permeability"]), row["wall"], forces, size != .1)
    for row in rows_of("stokes_36_permeability.csv"):
        name, wall = row["packing"].removesuffix(".csv"), row["wall"]
        forces = {int(r["id"]): tuple(float(r[f"{wall}_f{k}"]) for k in "xyz")
                  for r in rows_of(name.replace("packing", "stokes") + "_forces.csv")}
        yield Case("random beds", name.replace("packing_36", "36 spheres,").replace("_", " "),
                   bed(name), float(row["permeability"]), wall, forces)
    exact_forces = {}
    for r in rows_of("stokes_beds_forces.csv"):
        exact_forces.setdefault((r["bed"], r["wall"]), {})[int(r["id"])] = tuple(
            float(r[k]) for k in ("fx", "fy", "fz"))
    for row in rows_of("stokes_beds_permeability.csv"):
        name, wall = row["bed"], row["wall"]
        yield Case("random beds", BEDS[name], bed(name), float(row["permeability"]), wall,
                   exact_forces.get((name, wall)), name.startswith(("bed_24", "packing")))
    for percent in DENSITIES:
        spheres = bed(f"bed_periodic_{percent}")
        solid = sum(4 / 3 * math.pi * s[3] ** 3 for s in spheres)
        drag = 10 * solid / (1 - solid) ** 2 + (1 - solid) ** 2 * (1 + 1.5 * solid ** .5)
        yield Case("periodic beds", f"random, solid fraction 0.{percent}", spheres,
                   (2 * spheres[0][3]) ** 2 * (1 - solid) / (18 * solid * drag), "", None, False)


BEDS = {"bed_24_x1": "24 spheres, gaps 1 %", "bed_24_x0.95": "24 spheres, radii x 0.95",
        "bed_24_x0.7": "24 spheres, radii x 0.7", "bed_24_x1.03": "24 spheres, overlaps 2 %",
        "bed_24_half": "24 spheres, lower half loosened",
        "bed_24_small": "24 spheres and 16 in their pores, sizes 3 to 8",
        "bed_25": "25 spheres", "bed_54": "54 spheres", "bed_200": "200 spheres",
        "bed_two_sizes": "6 and 70 spheres, size ratio 4",
        "bed_cavity": "48 spheres around one large pore",
        "packing_100": "100 spheres of a DEM run"}


def table(header, rows):
    return "\n".join(["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
                     + ["| " + " | ".join(row) + " |" for row in rows])


def named(law):
    return law.replace("_", " ")


def permeability_table(group, solved):
    rows = [[c.name, c.wall.replace("_", "-") or "periodic", f"{c.exact:.4e}"]
            + [f"{c.ratio(law):.3f}" for law in LAWS] for c in solved if c.group == group]
    return table(["packing", "side walls", "exact K, m²", *map(named, LAWS)], rows)


def worst_table(solved):
    rows = []
    for group in dict.fromkeys(c.group for c in solved):
        for wall in ("", "symmetry", "no_slip"):
            here = [c for c in solved if c.group == group and c.wall == wall]
            if here:
                rows.append([group, wall.replace("_", "-") or "periodic", str(len(here))]
                            + [f"{min(c.ratio(law) for c in here):.2f} - "
                               f"{max(c.ratio(law) for c in here):.2f}" for law in LAWS])
    return table(["references", "side walls", "cases", *map(named, LAWS)], rows)


def force_table(solved):
    rows, medians = [], {law: [] for law in LAWS}
    for c in solved:
        if c.forces is None or c.group == "nine spheres":
            continue
        row = [c.name, c.wall.replace("_", "-")]
        for law in LAWS:
            errors = c.force_errors(law)
            medians[law].append(statistics.median(errors))
            row.append(f"{100 * statistics.median(errors):.1f} / {100 * max(errors):.0f}")
        rows.append(row)
    return table(["packing", "side walls", *map(named, LAWS)], rows)


def nine_force_table(solved):
    rows = []
    for c in solved:
        if c.group == "nine spheres":
            rows.append([c.name.split("d/D ")[1], c.wall.replace("_", "-")]
                        + [f"{c.found[law][1][1][2] / c.forces[1][2]:.3f}" for law in LAWS]
                        + [f"{c.found[law][1][9][2] / c.forces[9][2]:.3f}" if 9 in c.forces else "-"
                           for law in LAWS])
    return table(["d/D", "side walls", *(f"big, {named(law)}" for law in LAWS),
                  *(f"small, {named(law)}" for law in LAWS)], rows)


def paper_table(solved, folder):
    """The paper's ratios over its packings of 8, 9, 25, 54 and 200 spheres."""
    sizes = {"nine spheres, d/D 0": "8", "nine spheres, d/D 0.72": "9", "25 spheres": "25",
             "54 spheres": "54"}
    paper = {("hydraulic_radius", "symmetry"): "1.01 on average, at most +13 %",
             ("hydraulic_radius", "no_slip"): "0.78 on average, at most -40 %",
             ("effective_radius", "no_slip"): "0.39 on average"}
    largest = {wall: {law: permeability(solve(Case("", "", bed("bed_200"), math.nan, wall), folder,
                                              ["--conductance", law])[0]) for law in LAWS}
               for wall in ("symmetry", "no_slip")}
    rows = []
    for law in LAWS:
        for wall in ("symmetry", "no_slip"):
            ratios = {sizes[c.name]: c.ratio(law) for c in solved
                      if c.name in sizes and c.wall == wall}
            rows.append([named(law), wall.replace("_", "-")]
                        + [f"{ratios[n]:.2f}" for n in sizes.values()]
                        + [f"({largest[wall][law] / largest[wall]['open_throat']:.2f})",
                           f"{statistics.mean(ratios.values()):.2f}", paper.get((law, wall), "-")])
    return table(["law", "side walls", *sizes.values(), "(200)", "mean", "paper"], rows)


def scatter(solved):
    """Root mean square of ln(K / exact) with the open-throat law."""
    return f"{100 * math.sqrt(statistics.mean(math.log(c.ratio('open_throat')) ** 2 for c in solved)):.1f} %"


def largest_excess(solved):
    """By how much the open-throat law is worse than the papers' where it is at its worst."""
    def excess(case):
        return (abs(case.ratio("open_throat") - 1) - abs(case.ratio("hydraulic_radius") - 1))
    worst = max(solved, key=excess)
    return (f"{100 * excess(worst):.1f} % ({worst.name}, "
            f"{worst.wall.replace('_', '-') or 'periodic'})")


RESPONDING = ("36 spheres, loose", "36 spheres, near touching", "25 spheres",
              "6 and 70 spheres, size ratio 4", "24 spheres and 16 in their pores, sizes 3 to 8",
              "nine spheres, d/D 0.2", "nine spheres, d/D 0.72")


def response(case, sphere, axis, options, folder):
    """Flux into the box through zlo when one sphere moves alone with 1 m/s, all pressures 0; m3/s."""
    name = "_".join((str(sphere), "xyz"[axis], *options)).replace("-", "")
    packing, report = folder / f"{name}.csv", folder / f"{name}.json"
    velocity = [",0,0,0"] * len(case.spheres)
    velocity[sphere - 1] = "," + ",".join("01"[k == axis] for k in range(3))
    packing.write_text("id,x,y,z,radius,vx,vy,vz\n" + "".join(
        f"{i},{x!r},{y!r},{z!r},{r!r}{v}\n"
        for i, ((x, y, z, r), v) in enumerate(zip(case.spheres, velocity), 1)))
    subprocess.run([BUILD / "bin/pfv", "solve", "--packing", packing, "--box", "0", "1", "0", "1", "0", "1",
                    "--face", "zlo:pressure=0", "--face", "zhi:pressure=0", "--wall", case.wall,
                    "--viscosity", "1", "--report", report, *options], check=True, capture_output=True)
    flux = json.loads(report.read_text())["faces"]["zlo"]["flux"]
    packing.unlink()
    report.unlink()
    return flux


def responses(case, options, folder):
    """By sphere; in the nine-sphere cell, whose reference has the forces along z alone, along z."""
    axes = (2,) if case.group == "nine spheres" else (0, 1, 2)
    spheres = (1, 9) if case.group == "nine spheres" else case.forces
    found = {k: [0.0, 0.0, 0.0] for k in spheres}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for (k, axis), flux in zip([(k, axis) for k in spheres for axis in axes],
                                   pool.map(lambda one: response(case, *one, options, folder),
                                            [(k, axis) for k in spheres for axis in axes])):
            found[k][axis] = flux
    return found


def error_words(found, exact):
    """Median, worst and root of the mean square of the errors of vectors, the last over that of the exact ones."""
    differences = {k: math.dist(vector, exact[k]) for k, vector in found.items()}
    relative = [difference / math.hypot(*exact[k]) for k, difference in differences.items()]
    rms = math.sqrt(sum(d * d for d in differences.values())
                    / sum(math.hypot(*exact[k]) ** 2 for k in found))
    return f"{100 * statistics.median(relative):.1f} / {100 * max(relative):.0f} / {100 * rms:.1f}"


def bed_row(case, forces, geometric):
    sums = (sum(found[k][2] for k in case.forces) for found in (forces, geometric, case.forces))
    return [error_words({k: forces[k] for k in case.forces}, case.forces),
            error_words(geometric, case.forces), *(f"{one:.3f}" for one in sums)]


def nine_row(case, forces, geometric):
    return [f"{100 * (found[k][2] / case.forces[k][2] - 1):+.0f}"
            for k in geometric for found in (forces, geometric)]


def response_tables(solved, folder):
    """Forces at rest and fluxes of single moving spheres against the exact forces. The flux by S^T is the force:
    the largest difference, over the largest force, is returned, too (open-throat law)."""
    beds, nine, difference = [], [], 0.0
    for c in (c for c in solved if c.name in RESPONDING):
        axes = (2,) if c.group == "nine spheres" else (0, 1, 2)
        for law in ("open_throat", "hydraulic_radius"):
            forces = c.found[law][1]
            options = ("--conductance", law, "--volume-rates")
            if law == "open_throat":
                largest = max(math.hypot(*f) for f in forces.values())
                fluxes = responses(c, (*options, "reciprocal"), folder)
                difference = max(difference, *(abs(flux[a] - forces[k][a]) / largest
                                               for k, flux in fluxes.items() for a in axes))
            geometric = responses(c, (*options, "geometric"), folder)
            rows, row = (nine, nine_row) if c.group == "nine spheres" else (beds, bed_row)
            rows.append([c.name.removeprefix("nine spheres, d/D "), c.wall.replace("_", "-"), named(law),
                         *row(c, forces, geometric)])
    return (table(["packing", "side walls", "law", "S, S^T", "papers' E", "sum: S^T", "E", "exact"], beds),
            table(["d/D", "side walls", "law", "big: S^T", "E", "small: S^T", "E"], nine),
            f"{difference:.0e}")


def table_2(folder):
    """The paper's table 2: d/D = 0.72, no-slip walls."""
    exact = next(r for r in rows_of("stokes_nine_spheres.csv")
                 if r["d_over_D"] == "0.72" and r["wall"] == "no_slip")
    case = Case("", "", nine_spheres(.72), math.nan, "no_slip")
    columns = []
    for law in ("hydraulic_radius", "open_throat"):
        report, _, rows = solve(case, folder, ["--conductance", law])
        big, small, wall = rows[1], rows[9], report["faces"]["xlo"]
        columns.append([big[4], big[3], big[2], small[4], small[3], small[2],
                        wall["force_viscous"][2], abs(wall["force_pressure"][0])])
    names = ["big sphere, viscous", "big sphere, pressure", "big sphere, total",
             "small sphere, viscous", "small sphere, pressure", "small sphere, total",
             "side wall, viscous", "side wall, pressure"]
    paper_fem = [1.51e-2, 9.09e-2, 1.06e-1, 9.38e-3, 5.17e-2, 6.04e-2, 2.27e-2, 4.98e-1]
    paper_pfv = [1.06e-2, 9.64e-2, 1.07e-1, 5.83e-3, 5.72e-2, 6.30e-2, 2.03e-2, 5.00e-1]
    own_fem = [float(exact[k]) for k in (
        "big_viscous", "big_pressure", "big_total", "small_viscous", "small_pressure",
        "small_total", "side_wall_viscous")] + [math.nan]
    rows = [[name, f"{a:.3g}", "-" if math.isnan(b) else f"{b:.3g}", f"{c:.3g}", f"{d:.3g}",
             f"{e:.3g}"]
            for name, a, b, c, d, e in zip(names, paper_fem, own_fem, paper_pfv, *columns)]
    return table(["force / (Δp S)", "paper's FEM", "our FEM", "paper's PFV",
                  *(named(law) for law in ("hydraulic_radius", "open_throat"))], rows)


def dense_table(folder):
    """Beds of discrete-element runs: the two laws, and YADE, beside each other."""
    rows = []
    for name in ("packing_100", "packing_500"):
        for wall in ("symmetry", "no_slip"):
            case = Case("", name, bed(name), math.nan, wall)
            k = {law: permeability(solve(case, folder, ["--conductance", law])[0])
                 for law in ("hydraulic_radius", "open_throat")}
            rules = ["--conductance", "hydraulic_radius", "--partition", "yade"]
            k["rules"] = permeability(solve(case, folder, rules)[0])
            yade = json.loads((DATA / f"yade_{name[8:]}_{wall}_flow.json").read_text())
            rows.append([name, wall.replace("_", "-"),
                         f"{k['open_throat'] / k['hydraulic_radius']:.3f}",
                         f"{k['hydraulic_radius'] / yade['permeability']:.3f}",
                         f"{k['rules'] / yade['permeability'] - 1:+.1e}"])
    return table(["packing", "side walls", "open throat / hydraulic radius",
                  "hydraulic radius / YADE", "with YADE's rules / YADE - 1"], rows)


def estimate_table(solved):
    rows = []
    for law in LAWS:
        for seen, what in (((True, False), "all"), ((False,), "seen late")):
            here = [c for c in solved if c.calibrates in seen]
            actual = [abs(math.log(c.ratio(law))) for c in here]
            predicted = [math.log1p(c.found[law][0]["permeability_error"]) for c in here]
            covered = sum(a <= p for a, p in zip(actual, predicted))
            rows.append([named(law), what, str(len(here)), f"{100 * covered / len(here):.0f} %",
                         f"{statistics.mean(predicted) / statistics.mean(actual):.2f}",
                         ", ".join(f"{c.name} {c.wall.replace('_', '-')}".strip() for c, a, p in
                                   zip(here, actual, predicted) if a > p) or "-"])
    return table(["law", "cases", "number", "covered", "mean predicted / mean actual",
                  "not covered"], rows)


def save(figure, path):
    figure.savefig(path, dpi=100, metadata={"Software": None})  # without the version of matplotlib
    plt.close(figure)


def plot_permeability(solved, path):
    groups = list(dict.fromkeys((c.group, c.wall) for c in solved))
    figure, axes = plt.subplots(figsize=(9, 5), constrained_layout=True)
    for law in LAWS:
        places, ratios = [], []
        for g, key in enumerate(groups):
            here = [c for c in solved if (c.group, c.wall) == key]
            for i, c in enumerate(here):
                places.append(g + .7 * (i / max(1, len(here) - 1) - .5) if len(here) > 1 else g)
                ratios.append(c.ratio(law))
        axes.plot(places, ratios, "o", ms=4, color=COLOURS[law], label=named(law))
    axes.axhspan(.9, 1.1, color="tab:green", alpha=.15, label="within 10 %")
    axes.set_yscale("log")
    axes.set_yticks([.2, .5, 1, 2, 5, 10], ["0.2", "0.5", "1", "2", "5", "10"])
    axes.set_xticks(range(len(groups)), [f"{g}\n{w.replace('_', '-') or 'periodic'}"
                                         for g, w in groups], fontsize=8)
    axes.set_ylim(.1, 12)
    axes.set_ylabel("permeability / Stokes flow")
    axes.legend(fontsize=8)
    save(figure, path)


def plot_estimate(solved, path):
    figure, axes = plt.subplots(figsize=(6, 5), constrained_layout=True)
    for law in LAWS:
        for calibrates, marker in ((True, "o"), (False, "s")):
            here = [c for c in solved if c.calibrates == calibrates]
            axes.plot([max(1e-3, abs(math.log(c.ratio(law)))) for c in here],
                      [math.log1p(c.found[law][0]["permeability_error"]) for c in here], marker,
                      ms=4, mfc=COLOURS[law] if calibrates else "none", mec=COLOURS[law],
                      label=named(law) + ("" if calibrates else ", seen late"), ls="none")
    axes.plot([1e-3, 10], [1e-3, 10], "k-", lw=.8, label="predicted = actual")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1e-3, 10)
    axes.set_ylim(.05, 10)
    axes.set_xlabel("actual |ln(K / K of Stokes flow)|")
    axes.set_ylabel("predicted")
    axes.legend(fontsize=7)
    save(figure, path)


def plot_forces(solved, path):
    figure, axes = plt.subplots(figsize=(9, 4.5), constrained_layout=True)
    here = [c for c in solved if c.forces is not None and c.group != "nine spheres"]
    for law in LAWS:
        errors = [c.force_errors(law) for c in here]
        axes.plot(range(len(here)), [100 * statistics.median(e) for e in errors], "o",
                  color=COLOURS[law], label=f"{named(law)}, median")
        axes.plot(range(len(here)), [100 * max(e) for e in errors], "^", ms=4, mfc="none",
                  color=COLOURS[law], label=f"{named(law)}, worst")
    axes.axhline(8, color="k", lw=.6)
    axes.axhline(25, color="k", lw=.6, ls="--")
    axes.set_xticks(range(len(here)), [f"{c.name}, {c.wall.replace('_', '-')}" for c in here],
                    rotation=60, ha="right", fontsize=7)
    axes.set_ylabel("error of the force on a sphere, %")
    axes.legend(fontsize=7)
    save(figure, path)


def main():
    figures = ROOT / "doc/figures"
    figures.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        solved = list(cases())
        for case in solved:
            for law in LAWS:
                case.found[law] = solve(case, folder, ["--conductance", law])[:2]
        parts = {"worst": worst_table(solved), "paper": paper_table(solved, folder),
                 "excess": largest_excess(solved), "scatter": scatter(solved),
                 "table_2": table_2(folder), "dense": dense_table(folder),
                 "forces": force_table(solved), "nine_forces": nine_force_table(solved),
                 "estimate": estimate_table(solved)}
        parts["responses"], parts["nine_responses"], parts["difference"] = response_tables(solved, folder)
    for group in dict.fromkeys(c.group for c in solved):
        parts[group.replace(" ", "_")] = permeability_table(group, solved)
    plot_permeability(solved, figures / "accuracy_permeability.png")
    plot_estimate(solved, figures / "accuracy_estimate.png")
    plot_forces(solved, figures / "accuracy_forces.png")
    page = (ROOT / "doc/accuracy.in.md").read_text(encoding="utf-8")
    for key, text in parts.items():
        page = page.replace("{{" + key + "}}", text)
    (ROOT / "doc/accuracy.md").write_text(page, encoding="utf-8")
    print(page)


if __name__ == "__main__":
    main()

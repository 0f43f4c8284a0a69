#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of doc/container.md:  doc/containers.py [BUILD]

Permeability and forces beside finite elements, one sphere in a tube, loose beds beside a lattice-Boltzmann method, and
dense beds in cylinders beside correlations that know of the wall. Ends with status 1 where a bound does not hold. Some twelve
minutes of CPU, most of it lattice-Boltzmann.
"""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build"
os.environ["PFV_BIN"] = str(BUILD / "bin")
sys.path[:0] = [str(ROOT / "inputs/common"), str(ROOT / "doc")]
import lattice_boltzmann
import numpy as np
import scene

DATA = ROOT / "tests/data"
BEDS = ROOT / "inputs/boiling"  # its script pours the beds
FINITE_ELEMENTS_OVER = 1.055  # a lattice-Boltzmann run of 40 to 80 nodes, of a dense bed
COVERED = 0.8  # of what the estimated error should
WITHIN = {"permeability": 0.05, "median force": 0.08, "worst force": 0.25, "correlation": 0.15}
failed = []


def held(what, value, bound):
    if not abs(value) <= bound:
        failed.append(f"{what}: {value:.3g}, wanted within {bound:g}")


def rows_of(name):
    with open(DATA / name, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


def solve(folder, spheres, container, wall, *words):
    """Report and forces of `pfv solve`, pressure 1 at the bottom and 0 at the top; spheres: x, y, z, radius."""
    text = "".join(f"{k},{x!r},{y!r},{z!r},{r!r}\n" for k, (x, y, z, r) in enumerate(spheres, 1))
    (folder / "packing.csv").write_text("id,x,y,z,radius\n" + text)
    (folder / "room.json").write_text(json.dumps(container))
    report = scene.pfv_solve(folder, "packing.csv", "room.json", 1.0, "report.json", "--wall", wall, "--face",
                             "bottom:pressure=1", "--face", "top:pressure=0", "--forces", "forces.csv", *words)
    with open(folder / "forces.csv", newline="", encoding="ascii") as file:
        forces = np.array([[float(row[k]) for k in ("fx", "fy", "fz")] for row in csv.DictReader(file)])
    return report, forces


def between(bottom, top):
    return [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": bottom},
            {"name": "top", "inward_normal": [0, 0, -1], "offset": -top}]


def cylinder(radius, bottom, top, **more):
    return {"planes": between(bottom, top),
            "cylinders": [{"name": "shell", "axis": [0, 0, 1], "point": [0, 0, 0], "radius": radius, **more}]}


def prism(sides, apothem, height):
    planes = between(0.0, height)
    for i in range(sides):
        angle = 2.0 * math.pi * (i + 0.5) / sides
        planes.append({"name": f"side{i}", "inward_normal": [-math.cos(angle), -math.sin(angle), 0.0],
                       "offset": -apothem})
    return {"planes": planes}


def wedge():
    tilt = math.radians(25.0)
    return {"planes": between(0.0, 1.0) + [
        {"name": "x0", "inward_normal": [1, 0, 0], "offset": 0.0},
        {"name": "y0", "inward_normal": [0, 1, 0], "offset": 0.0},
        {"name": "y1", "inward_normal": [0, -1, 0], "offset": -0.8},
        {"name": "tilted", "inward_normal": [-math.cos(tilt), 0.0, -math.sin(tilt)], "offset": -math.cos(tilt)}]}


def room(case):
    if case in ("cylinder", "wedge"):
        return cylinder(0.5, 0.0, 0.75) if case == "cylinder" else wedge()
    sides = int(case.split()[0])
    of_area = math.sqrt(math.pi / (sides * math.tan(math.pi / sides)))
    return prism(sides, 0.5 * (of_area if case.endswith("equal area") else 1.0), 0.75)


def finite_elements(folder):
    print("| container | walls | K over finite elements | force, median | worst |\n|---|---|---|---|---|")
    for row in rows_of("containers_permeability.csv"):
        beads = [tuple(float(b[k]) for k in ("x", "y", "z", "radius")) for b in rows_of(row["packing"])]
        exact = np.array([[float(f[k]) for k in ("fx", "fy", "fz")] for f in rows_of(row["forces"])])
        report, forces = solve(folder, beads, room(row["case"]), row["wall"])
        ratio = report["permeability"] / float(row["permeability"])
        errors = np.sort(np.linalg.norm(forces - exact, axis=1) / np.linalg.norm(exact, axis=1))
        median, worst = errors[len(errors) // 2], errors[-1]
        print(f"| {row['case']} | {row['wall']} | {ratio:.3f} | {100 * median:.1f} % | {100 * worst:.1f} % |")
        for what, value in (("permeability", ratio - 1), ("median force", median), ("worst force", worst)):
            held(f"{row['case']}, {row['wall']}, {what}", value, WITHIN[what])


def sphere_in_tube(folder):
    """F / (6 pi mu a u_max), u_max = 2 Q / (pi R2): the cylinder as 32 flats, as one sphere is refused in a round one."""
    print("\n| r/R | length/R | walls | finite elements | 32 flats | over |\n|---|---|---|---|---|---|")
    for row in rows_of("stokes_tube_sphere.csv"):
        radius, length, exact = (float(row[k]) for k in ("radius", "length", "factor"))
        report, forces = solve(folder, [(0.0, 0.0, 0.0, radius)],
                               cylinder(1.0, -0.5 * length, 0.5 * length, flats=32), row["wall"])
        found = forces[0, 2] / (12.0 * radius * report["outflow"])
        print(f"| {radius:g} | {length:g} | {row['wall']} | {exact:.4g} | {found:.4g} | {found / exact:.2f} |")
    try:
        solve(folder, [(0.0, 0.0, 0.0, 0.2)], cylinder(1.0, -5.0, 5.0), "no_slip")
        failed.append("one sphere in a round tube is not refused")
    except scene.Failure as error:
        print(f"\nround: {error}")


# Stokes drag as ΔP/L = A (1-e)² mu U / (e³ d²) with the mean porosity e, as reviews quote them. N = D/d.
def wall_and_beads(porosity, ratio):
    """Surface of beads and tube over that of the beads."""
    return 1.0 + 2.0 / (3.0 * (1.0 - porosity) * ratio)


CORRELATIONS = {
    # Carman (1937), Transactions of the Institution of Chemical Engineers 15, 150: no wall
    "Carman": lambda e, n: 180.0,
    # Ergun (1952), Chemical Engineering Progress 48, 89; Mehta & Hawley (1969), I&EC Process Des. Dev. 8, 280
    "Ergun, Mehta & Hawley": lambda e, n: 150.0 * wall_and_beads(e, n)**2,
    # Eisfeld & Schnitzlein (2001), Chemical Engineering Science 56, 4321: spheres
    "Eisfeld & Schnitzlein": lambda e, n: 154.0 * wall_and_beads(e, n)**2,
    # Cheng (2011), Powder Technology 210, 261
    "Cheng": lambda e, n: 185.0 + 17.0 * e / (1.0 - e) * (n / (n - 1.0))**2,
}


SMALLEST_WITH_CORE = 5.0  # D/d


def core_speed(ratio):
    """Di Felice & Gibilaro (2004), Chemical Engineering Science 59, 3037: mean velocity over that of the core."""
    return 2.06 - 1.06 * ((ratio - 1.0) / ratio)**2


def porosity_of_core(spheres, tube, low, high):
    """Of what is further than a diameter from the wall, by the porosity of 20000 places."""
    random, reach = np.random.default_rng(1), tube - 2.0 * spheres[:, 3].mean()
    radius, angle = reach * np.sqrt(random.uniform(size=20000)), random.uniform(0.0, 2.0 * math.pi, 20000)
    places = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), random.uniform(low, high, 20000)])
    solid = np.zeros(len(places), bool)
    for x, y, z, r in spheres:
        solid |= ((places - (x, y, z))**2).sum(axis=1) < r * r
    return 1.0 - solid.mean()


def beside_correlations(name, spheres, tube, low, high, permeability):
    """Spheres whose centres lie between low and high."""
    sauter = 2.0 * (spheres[:, 3]**3).sum() / (spheres[:, 3]**2).sum()
    porosity = 1.0 - 4.0 / 3.0 * (spheres[:, 3]**3).sum() / (tube**2 * (high - low))
    ratio = 2.0 * tube / sauter
    core = porosity_of_core(spheres, tube, low, high) if ratio > SMALLEST_WITH_CORE else None
    over = [permeability * law(porosity, ratio) * (1.0 - porosity)**2 / porosity**3 / sauter**2
            for law in CORRELATIONS.values()]
    words = [f"{value:.2f}" for value in over]
    if core:
        words.append(f"{permeability * 150.0 * (1.0 - core)**2 / core**3 / sauter**2 / core_speed(ratio):.2f}")
    print(f"| {name} | {ratio:.1f} | {len(spheres)} | {porosity:.3f} | " + (f"{core:.3f}" if core else "-") + " | " +
          " | ".join(words + ([] if core else ["-"])) + " |", flush=True)
    return dict(zip(CORRELATIONS, over))


def pour(folder, ratio, friction, beads):
    """Beads of 0.9, 1 and 1.1 mm poured into a cylinder: x, y, z, radius, and its radius, m."""
    radius, seeds = 0.5e-3, scene.primes(1)
    tube = ratio * radius
    height = beads * 4.0 / 3.0 * math.pi * radius**3 / (math.pi * tube**2) / 0.15
    scene.liggghts(BEDS, "in.prepare", {
        "shape": "cylinder", "N": beads, "r": radius, "kn": 1e3, "mu": friction, "R": tube, "W": tube,
        "height": height + 0.1, "fill": height, "out": str(folder / "bed"),
        **{f"s{k + 1}": prime for k, prime in enumerate(seeds)}}, str(folder / "bed"))
    return np.loadtxt(folder / "bed_bed.dump", skiprows=9)[:, 2:6], tube


def resistance(folder, spheres, tube, low, high):
    """Of the spheres whose centres lie between two planes, Pa s/m³."""
    inside = spheres[(spheres[:, 2] > low) & (spheres[:, 2] < high)]
    report, _ = solve(folder, [tuple(map(float, s)) for s in inside], cylinder(tube, low, high), "no_slip")
    return 1.0 / report["outflow"]


def permeability_of_middle(folder, spheres, tube, low, high):
    """Where planes cut a bed, spheres are missing behind them: halves and whole tell what two such ends do."""
    middle = 0.5 * (low + high)
    whole = resistance(folder, spheres, tube, low, high)
    halves = resistance(folder, spheres, tube, low, middle) + resistance(folder, spheres, tube, middle, high)
    return (high - low) / (math.pi * tube**2 * (2.0 * whole - halves))


def dense_beds(folder):
    print("\n| K of | D/d | beads | porosity | of the core | over " + " | ".join(CORRELATIONS) +
          " | Di Felice & Gibilaro |\n" + "|---" * (6 + len(CORRELATIONS)) + "|")
    beads = np.array([[float(b[k]) for k in ("x", "y", "z", "radius")] for b in rows_of("cyl_equal_packing.csv")])
    exact = float(rows_of("containers_permeability.csv")[0]["permeability"])
    beside_correlations("finite elements", beads, 0.5, 0.0, 0.75, exact)
    for ratio, friction in ((6, 0.0), (8, 0.0), (10, 0.0), (14, 0.0), (10, 0.4)):
        spheres, tube = pour(folder, ratio, friction, round(12 * ratio**2))
        low, high = 2e-3, spheres[:, 2].max() - 2e-3
        found = permeability_of_middle(folder, spheres, tube, low, high)
        inside = spheres[(spheres[:, 2] > low) & (spheres[:, 2] < high)]
        over = beside_correlations("this" if friction == 0 else f"this, friction {friction:g}", inside, tube, low, high,
                                   found)
        held(f"D/d {ratio}, friction {friction:g}, K over Cheng's - 1", over["Cheng"] - 1, WITHIN["correlation"])
        if ratio >= 8:
            held(f"D/d {ratio}, friction {friction:g}, K over Eisfeld's and Schnitzlein's - 1",
                 over["Eisfeld & Schnitzlein"] - 1, WITHIN["correlation"])


def loose_beds(folder):
    """Few beads with wide ways between them and the wall, no slip."""
    print("\n| beads | nodes across | lattice-Boltzmann, m² | finite elements over it | round cylinder | 32 flats | square box |\n"
          "|---|---|---|---|---|---|---|")
    exact = float(rows_of("containers_permeability.csv")[0]["permeability"])
    for name, file, height, known in (("30 equal ones, dense", "cyl_equal_packing.csv", 0.75, exact),
                                      ("20, radii to 1 : 1.5", "cylinder_loose_20_near.csv", 1.0, None),
                                      ("20, radii to 1 : 3", "cylinder_loose_20.csv", 1.0, None)):
        beads = [tuple(float(b[k]) for k in ("x", "y", "z", "radius")) for b in rows_of(file)]
        rooms = (cylinder(0.5, 0.0, height), cylinder(0.5, 0.0, height, flats=32), prism(4, 0.5, height))
        found = [solve(folder, beads, one, "no_slip")[0]["permeability"] for one in rooms]
        turned = [(math.cos(-math.pi / 4) * x - math.sin(-math.pi / 4) * y, math.sin(-math.pi / 4) * x +
                   math.cos(-math.pi / 4) * y, z, r) for x, y, z, r in beads]  # the prism's sides look along the diagonals
        for nodes in (48, 80):
            round_one = lattice_boltzmann.permeability(beads, 0.5, height, nodes)
            square_one = lattice_boltzmann.permeability(turned, 0.5, height, nodes, square=True)
            words = [f"{value / round_one:.2f}" for value in found[:2]] + [f"{found[2] / square_one:.2f}"]
            print(f"| {name} | {nodes} | {round_one:.4g} | {known / round_one if known else math.nan:.3f} | ".replace("nan", "-") +
                  " | ".join(words) + " |", flush=True)


def bed_at_random(count, solid, ratio, seed, square):
    """Beads pushed apart until none overlap, in a unit height of the cylinder or square of width 1; sizes to 1 : ratio."""
    random = np.random.default_rng(seed)
    radii = ratio**random.uniform(0.0, 1.0, count)
    radii *= (solid * (1.0 if square else math.pi / 4.0) / (4.0 / 3.0 * math.pi * (radii**3).sum()))**(1.0 / 3.0)
    places = np.column_stack([random.uniform(-0.5, 0.5, (count, 2)), random.uniform(0.0, 1.0, count)])
    room = 0.5 - radii[:, None]
    for _ in range(20000):
        if square:
            places[:, :2] = np.clip(places[:, :2], -room, room)
        else:
            away = np.linalg.norm(places[:, :2], axis=1, keepdims=True)
            places[:, :2] *= np.minimum(1.0, room / np.maximum(away, 1e-12))
        places[:, 2] = np.clip(places[:, 2], radii, 1.0 - radii)
        between = places[:, None] - places[None]
        apart = np.linalg.norm(between, axis=2) + 10.0 * np.eye(count)
        overlap = np.maximum(1.005 * (radii[:, None] + radii[None]) - apart, 0.0) * (1.0 - np.eye(count))
        if overlap.max() < 2e-3 * radii.mean():
            return [tuple(float(v) for v in bead) for bead in np.column_stack([places, 0.9995 * radii])]
        places += 0.45 * (overlap[:, :, None] * between / apart[:, :, None]).sum(axis=1)
    return None


def rooms_around(beads, square):
    if not square:
        return {"round cylinder": (cylinder(0.5, 0.0, 1.0), beads), "32 flats": (cylinder(0.5, 0.0, 1.0, flats=32), beads)}
    turn = math.sqrt(0.5)  # the prism's sides look along the diagonals
    return {"square box": (prism(4, 0.5, 1.0), [(turn * (x - y), turn * (x + y), z, r) for x, y, z, r in beads])}


def few_beads(folder, seeds=40, nodes=40):
    """Beds at random beside a lattice-Boltzmann method: the factor between them, and how often the estimated error covers it."""
    found = []
    for seed in range(seeds):
        random = np.random.default_rng(1000 + seed)
        count, solid, ratio = (int(random.choice([8, 15, 25, 45])), float(random.choice([0.15, 0.3, 0.42])),
                               float(random.choice([1.0, 1.5, 3.0])))
        for square in (False, True):
            beads = bed_at_random(count, solid, ratio, seed, square)
            if beads is None:
                continue
            exact = FINITE_ELEMENTS_OVER * lattice_boltzmann.permeability(beads, 0.5, 1.0, nodes, square=square)
            for name, (container, of_room) in rooms_around(beads, square).items():
                try:
                    report = solve(folder, of_room, container, "no_slip")[0]
                except scene.Failure:  # too few beads for a round wall
                    continue
                found.append((name, count, solid, math.log(report["permeability"] / exact),
                              math.log1p(report["permeability_error"])))
    table_of_beds(found)


def table_of_beds(found):
    print("\n| no-slip walls, solid fraction, beads | beds | K over the reference, mean | scatter | estimated error, mean | covers |\n"
          "|---|---|---|---|---|---|")
    groups = [("all", found)]
    for name in ("square box", "round cylinder", "32 flats"):
        for low, high in ((0.15, 0.15), (0.3, 0.42)):
            for few, many in ((8, 15), (25, 45)):
                beds = [f for f in found if f[0] == name and low <= f[2] <= high and few <= f[1] <= many]
                groups.insert(-1, (f"{name}, {low:g}{'' if low == high else f' and {high:g}'}, {few} and {many}", beds))
    for name, beds in groups:
        if not beds:
            continue
        off, estimate = np.array([[f[3], f[4]] for f in beds]).T
        print(f"| {name} | {len(beds)} | {math.exp(off.mean()):.2f} | {100 * off.std():.0f} % | "
              f"{100 * math.expm1(estimate.mean()):.0f} % | {100 * np.mean(abs(off) <= estimate):.0f} % |")
    covered = float(np.mean([abs(f[3]) <= f[4] for f in found]))
    held("few beads, part that the estimated error does not cover", 1.0 - covered, 1.0 - COVERED)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        finite_elements(folder)
        loose_beds(folder)
        few_beads(folder)
        sphere_in_tube(folder)
        dense_beds(folder)
    print(*(f"FAILED {what}" for what in failed), sep="\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

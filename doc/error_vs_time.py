#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against run time: measures, and writes doc/error_vs_time.md and its figures.

    doc/error_vs_time.py [PART...]     some forty minutes for `all` parts
    doc/error_vs_time.py check         whether the sources are those that the page's figures follow from
    doc/error_vs_time.py again         three cheap figures once more, against the page's

Parts: scenes solvers thresholds coupling coupling_5000 sizes models scaling. The figures of a part that is
not named are those of doc/error_vs_time.json, where each keeps what it measured. Times are CPU
seconds on one thread of this machine: compare them within a table. The scenes' rows are kept one by one
(scene_errors.py), so that a command that was interrupted goes on.
"""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "inputs/common"))
import plotting
import scene_errors
import scene_page
from plotting import plt

BIN = pathlib.Path(os.environ.get("PFV_BIN", ROOT / "build/bin"))
KEPT = ROOT / "build" / "error_vs_time"  # runs
MEASURED = pathlib.Path(__file__).with_suffix(".json")  # what the page shows
FIGURES = ROOT / "doc" / "figures"
DATA = ROOT / "tests" / "data"
UNIT_BOX = ["--box", "0", "1", "0", "1", "0", "1"]
THROUGH = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=1", "--viscosity", "1"]

# Catalano 2012, table 5.1: seconds for one solution, by number of spheres
THESIS_SECONDS = {2000: (0.08, 0.12, 0.12), 4000: (0.25, 0.32, 0.33), 8000: (0.98, 0.93, 0.83),
                  16000: (4.23, 2.84, 2.51)}
# tables 5.3 and 5.4: one more right-hand side on the kept factor
THESIS_KEPT = {2000: (0.003, 0.005), 4000: (0.007, 0.007), 8000: (0.019, 0.028),
               16000: (0.047, 0.070)}


def pfv(*words):
    done = subprocess.run([BIN / "pfv", *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"error_vs_time: pfv {words[0]}: {done.stderr.strip()}")
    return done.stdout


def dense_packing(folder, spheres, seed=1):
    path = pathlib.Path(folder) / f"{spheres}_{seed}.csv"
    if not path.exists():
        with open(path, "w", encoding="ascii") as file:
            subprocess.run([BIN / "pfv_dense_packing", str(spheres), str(seed)], check=True,
                           stdout=file)
    return path


def solve(folder, packing, *words, wall="symmetry", forces=False):
    """Report of one `pfv solve`, and the forces as rows of numbers where asked for."""
    report = pathlib.Path(folder) / "report.json"
    command = ["solve", "--packing", packing, *UNIT_BOX, *THROUGH, "--wall", wall,
               "--report", report, *words]
    if forces:
        command += ["--forces", pathlib.Path(folder) / "forces.csv"]
    pfv(*command)
    result = json.loads(report.read_text())
    if not forces:
        return result
    with open(pathlib.Path(folder) / "forces.csv", encoding="ascii") as file:
        rows = [[float(row[key]) for key in ("fx", "fy", "fz")] for row in csv.DictReader(file)]
    return result, np.array(rows)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


# ------------------------------------------------------------------------------------- solvers

SOLVERS = [("supernodal", []), ("cg", ["--tolerance", "1e-10"]), ("cg", ["--tolerance", "1e-6"]),
           ("cg", ["--tolerance", "1e-3"]), ("amg", ["--tolerance", "1e-10"]), ("amg", ["--tolerance", "1e-7"]),
           ("amg", ["--tolerance", "1e-4"]), ("gauss_seidel", ["--tolerance", "1e-6"]),
           ("gauss_seidel", ["--tolerance", "1e-3"])]


REPEATS = 5  # of the same solve, on the kept network


def exact_forces(spheres):
    """Rows of forces, solved in extended precision."""
    done = subprocess.run([BIN / "pfv_exact_forces", str(spheres)], check=True, capture_output=True, text=True)
    return np.array([[float(row[key]) for key in ("fx", "fy", "fz")] for row in csv.DictReader(done.stdout.splitlines())])


def measure_solvers():
    """Linear solvers at several tolerances, all against a solution in extended precision."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for size in THESIS_SECONDS:
            packing = dense_packing(folder, size)
            exact = exact_forces(size)
            for solver, words in SOLVERS:
                repeat = REPEATS if solver != "amg" else 0
                again = ["--repeat", repeat] if repeat else []
                result, forces = solve(folder, packing, "--solver", solver, *words, *again, forces=True)
                seconds = result["seconds"]
                mean_flow = 0.5 * (result["inflow"] + result["outflow"])
                rows.append({
                    "spheres": size, "solver": solver,
                    "tolerance": float(words[1]) if words else None,
                    "first": seconds["order"] + seconds["factor"] + seconds["solve"] / (1 + repeat),
                    # amg would begin the same solve at its solution
                    "step": seconds["step"] if repeat else seconds["solve"],
                    "flow_error": abs(result["inflow"] - result["outflow"]) / mean_flow,
                    "force_error": rms(forces - exact) / rms(exact)})
    return rows


def write_solvers(rows):
    figure, axes = plt.subplots(figsize=(6, 4))
    styles = {"supernodal": "ko", "cg": "b^", "amg": "gD", "gauss_seidel": "rs"}
    largest = max(row["spheres"] for row in rows)
    shown, named = set(), []
    for row in rows:
        if row["spheres"] != largest:
            continue
        label = row["solver"] if row["solver"] not in shown else None
        shown.add(row["solver"])
        axes.loglog(row["step"], max(row["force_error"], 1e-15), styles[row["solver"]], label=label)
        if row["tolerance"]:
            named.append(((row["step"], row["force_error"]), f"{row['tolerance']:.0e}"))
    axes.set(xlabel="CPU s a step on the kept network",
             ylabel="error of the forces (rms, relative)", title=f"{largest} spheres")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.tight_layout()
    plotting.name_points(axes, *zip(*named))
    save(figure, "solvers")
    lines = ["| spheres | solver | tolerance | first solution, s | a further step, s | "
             "flow error (5.6) | force error | thesis: Gauss-Seidel 1e-6 / PARDISO / TAUCS, s | "
             "thesis: further solve, s |", "|--|--|--|--|--|--|--|--|--|"]
    for row in rows:
        first = row["solver"] == "supernodal"
        thesis = " / ".join(f"{s:g}" for s in THESIS_SECONDS[row["spheres"]]) if first else ""
        kept = " / ".join(f"{s:g}" for s in THESIS_KEPT[row["spheres"]]) if first else ""
        tolerance = f"{row['tolerance']:.0e}" if row["tolerance"] else "direct"
        lines.append(f"| {row['spheres']} | {row['solver']} | {tolerance} | {row['first']:.3g} | "
                     f"{row['step']:.3g} | {row['flow_error']:.1e} | {row['force_error']:.1e} | "
                     f"{thesis} | {kept} |")
    return "\n".join(lines)


# ------------------------------------------------------------------- consolidation: the oedometer

def consolidation(name, *words):
    """p(H/2)/load and U over T_v of a coupled oedometer run, and its CPU seconds."""
    sys.path.insert(0, str(ROOT / "inputs" / "oedometer"))
    import analyse
    import oedometer
    out = KEPT / "oedometer" / name
    out.parent.mkdir(parents=True, exist_ok=True)
    oedometer.run(oedometer.parse([*words, f"OUT={out}"]))
    records = analyse.Run(out)
    times = np.linspace(0.02, 2.0, 400)
    return {"cpu": records.figures["cpu_coupled"], "retriangulations": records.retriangulations,
            "dry": records.figures["cpu_dry_step"] * records.figures["cpu_coupled"] /
            records.figures["cpu_coupled_step"],
            "p": np.interp(times, records.T, records.middle()).tolist(),
            "U": np.interp(times, records.T_lid, records.settlement()).tolist()}


def same_sample(name, source):
    """Gives the run `name` the sample, dry test and permeability of the run `source`."""
    folder = KEPT / "oedometer"
    for ending in (".dump", ".restart", "_loaded.dump", "_steady.csv", "_measured.json"):
        shutil.copy(folder / (source + ending), folder / (name + ending))


def against_first(rows):
    for row in rows:
        if "unstable" in row:
            continue
        for curve in ("p", "U"):
            difference = np.array(row[curve]) - np.array(rows[0][curve])
            row[curve + "_rms"], row[curve + "_max"] = rms(difference), float(abs(difference).max())
    return [{key: value for key, value in row.items() if key not in ("p", "U")} for row in rows]


# the sum of the largest strains (thesis), a lag of the new network, the mean strain
THRESHOLDS = [(f"{100 * s:g} %", f"retriangulate {s:g}") for s in (1e-4, 1e-3, 5e-3, 1e-2, 2e-2, 5e-2)]
THRESHOLDS += [("never", "retriangulate 1e9")]
THRESHOLDS += [(f"1 %, `rebuild_lag` {k}", f"retriangulate 0.01 rebuild_lag {k}") for k in (10, 40)]
THRESHOLDS += [(f"mean {100 * s:g} %", f"retriangulate mean {s:g}")
               for s in (2e-4, 5e-4, 1e-3, 2e-3, 5e-3)]


def measure_thresholds():
    """Retriangulation thresholds on the consolidation under 200 kPa, all against the finest."""
    rows = []
    for name, words_of_fix in THRESHOLDS:
        run = f"threshold_{len(rows)}"
        words = ["N=300", "LOAD=200000", f"FIX={words_of_fix}"]
        if rows:
            same_sample(run, "threshold_0")
            words.append("KEEP=1")
        rows.append({"threshold": name, **consolidation(run, *words)})
    return against_first(rows)


def write_thresholds(rows):
    lines = ["| threshold | retriangulations | p(H/2): rms, largest difference / load | "
             "U: rms, largest difference | CPU, s | CPU / dry |", "|--|--|--|--|--|--|"]
    for row in rows:
        lines.append(f"| {row['threshold']} | {row['retriangulations']} | {100 * row['p_rms']:.3f}, "
                     f"{100 * row['p_max']:.3f} % | {100 * row['U_rms']:.3f}, "
                     f"{100 * row['U_max']:.3f} % | {row['cpu']:.1f} | "
                     f"{row['cpu'] / row['dry']:.2f} |")
    draw_runs(rows, "thresholds", lambda r: str(r["threshold"]).replace("`", ""))
    return "\n".join(lines)


EACH_STEP = "FIX=couple_every 1"
COUPLINGS = [("every 2nd", "couple_every 2"), ("every 4th", "couple_every 4"),
             ("every 8th", "couple_every 8"), ("mixed precision", "couple_every 1 precision mixed")]


def couplings(part, grains, steps, words_of_fix):
    """Rows of the consolidation under 5 kPa on one sample: at parts of the time step, then at the
    step itself, then with words of fix pfv."""
    first = consolidation(f"{part}_0", f"N={grains}", EACH_STEP)
    import scene  # the oedometer's, found now
    step = json.loads((KEPT / "oedometer" / f"{part}_0_run.json").read_text())["time_step"]
    rows = []

    def add(name, *words):
        run = f"{part}_{len(rows) + 1}"
        same_sample(run, f"{part}_0")
        try:
            result = consolidation(run, f"N={grains}", "KEEP=1", *words)
        except scene.Failure as failure:  # the fluid throws the grains about
            print(f"{name}: {failure}", flush=True)
            result = {"unstable": True}
        rows.append({"setting": name, **result})

    for divisor in steps:
        add(f"time step / {divisor}", f"TIME_STEP={step / divisor:.17g}", EACH_STEP)
    rows.append({"setting": "every step", **first})
    for name, words in words_of_fix:
        add(name, f"FIX={words}")
    return against_first(rows)


def measure_coupling():
    """couple_every and the time step with 300 grains, against a quarter step."""
    return couplings("coupling", 300, [4, 2], COUPLINGS)


def measure_coupling_5000():
    """couple_every with 5000 grains, against the coupling at every step."""
    return couplings("coupling_5000", 5000, [], COUPLINGS[:2])


def write_coupling(rows, name="coupling"):
    lines = ["| | p(H/2): rms, largest difference / load | U: rms, largest difference | CPU, s | "
             "CPU / dry |", "|--|--|--|--|--|"]
    for row in rows:
        if "unstable" in row:
            lines.append(f"| {row['setting']} | unstable: ends with an error | | | |")
            continue
        lines.append(f"| {row['setting']} | {100 * row['p_rms']:.3f}, {100 * row['p_max']:.3f} % | "
                     f"{100 * row['U_rms']:.3f}, {100 * row['U_max']:.3f} % | {row['cpu']:.1f} | "
                     f"{row['cpu'] / row['dry']:.2f} |")
    draw_runs(rows, name, lambda r: r["setting"])
    return "\n".join(lines)


def write_coupling_5000(rows):
    return write_coupling(rows, "coupling_5000")


def draw_runs(rows, name, label):
    figure, axes = plt.subplots(figsize=(6, 4))
    shown = [row for row in rows[1:] if "unstable" not in row]
    points = [(row["cpu"], 100 * max(row["p_max"], 1e-7)) for row in shown]
    axes.loglog(*zip(*points), "ko")
    axes.margins(x=0.15)
    axes.set(xlabel="CPU s of the coupled run", ylabel="largest error of p(H/2), % of the load")
    axes.grid(alpha=0.3, which="both")
    figure.tight_layout()
    plotting.name_points(axes, points, [label(row) for row in shown])
    save(figure, name)


# ---------------------------------------------------------------------------- packing size, models

def measure_sizes():
    """Scatter of the permeability over ten packings a size."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for size in (100, 250, 500, 1000, 2500, 5000):
            values, times = [], []
            for seed in range(1, 11):
                result = solve(folder, dense_packing(folder, size, seed))
                radius = np.cbrt(0.6 / (4 / 3 * np.pi * size))  # of the mean volume
                values.append(result["permeability"] / (2 * radius) ** 2)
                times.append(result["seconds"]["total"])
            rows.append({"spheres": size, "mean": float(np.mean(values)),
                         "scatter": float(np.std(values, ddof=1) / np.mean(values)),
                         "cpu": float(np.median(times))})
    return rows


def write_sizes(rows):
    figure, axes = plt.subplots(figsize=(6, 4))
    axes.loglog([r["cpu"] for r in rows], [100 * r["scatter"] for r in rows], "ko-")
    for row in rows:
        axes.annotate(f"  {row['spheres']}", (row["cpu"], 100 * row["scatter"]))
    axes.set(xlabel="CPU s of one solution", ylabel="scatter of K (one sample), %")
    axes.grid(alpha=0.3, which="both")
    save(figure, "sizes")
    lines = ["| spheres | K / d² (mean of ten) | scatter of one sample | mean / that of the largest "
             "- 1 | CPU, s |", "|--|--|--|--|--|"]
    for row in rows:
        lines.append(f"| {row['spheres']} | {row['mean']:.3e} | {100 * row['scatter']:.1f} % | "
                     f"{100 * (row['mean'] / rows[-1]['mean'] - 1):+.1f} % | {row['cpu']:.3g} |")
    return "\n".join(lines)


LAWS = ["hydraulic_radius", "effective_radius", "open_throat"]
# minutes that the finite elements took (P2-P1, MINRES; the file says how many unknowns)
FINITE_ELEMENT_SECONDS = (360, 900)


def measure_models():
    """Each law against the finite elements on the packings of 36 spheres."""
    with open(DATA / "stokes_36_permeability.csv", encoding="ascii") as file:
        references = list(csv.DictReader(file))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for reference in references:
            for law in LAWS:
                result = solve(folder, DATA / reference["packing"], "--conductance", law,
                               wall=reference["wall"])
                rows.append({"packing": reference["packing"], "wall": reference["wall"],
                             "law": law, "unknowns": result["unknowns"],
                             "fe_unknowns": int(reference["unknowns"]),
                             "ratio": result["permeability"] / float(reference["permeability"]),
                             "cpu": result["seconds"]["total"]})
    return rows


def write_models(rows):
    figure, axes = plt.subplots(figsize=(6, 4))
    for law, style in zip(LAWS, ("rs", "gv", "bo")):
        chosen = [r for r in rows if r["law"] == law]
        axes.loglog([r["cpu"] for r in chosen], [100 * abs(r["ratio"] - 1) for r in chosen], style,
                    label=law)
    axes.axvspan(*FINITE_ELEMENT_SECONDS, color="0.8", label="finite elements (the reference)")
    axes.set(xlabel="CPU s", ylabel="|error| of K, %")
    axes.legend()
    axes.grid(alpha=0.3, which="both")
    save(figure, "models")
    lines = ["| packing | walls | law | K / finite elements | unknowns | CPU, s | "
             "finite elements: unknowns |", "|--|--|--|--|--|--|--|"]
    for r in rows:
        lines.append(f"| {r['packing'][:-4]} | {r['wall']} | {r['law']} | {r['ratio']:.3f} | "
                     f"{r['unknowns']} | {r['cpu']:.2g} | {r['fe_unknowns']} |")
    return "\n".join(lines)


# ------------------------------------------------------------------------------------ scaling, page

THESIS_EXPONENTS = {"triangulate": "N log²N", "assemble": "1", "factor": "2", "step": "1.36 (solve)",
                    "forces": "1"}


def measure_scaling():
    report = KEPT / "bench.json"
    pfv("bench", "--spheres", "1000,2000,5000,10000,20000", "--repeat", 3, "--report", report)
    return json.loads(report.read_text())


def write_scaling(report):
    rows = report["rows"]
    fits = report["fits"][rows[0]["solver"]]
    lines = ["| phase | " + " | ".join(str(row["spheres"]) for row in rows)
             + " | fitted | thesis (5.19) |", "|--|" + "--|" * (len(rows) + 2)]
    figure, axes = plt.subplots(figsize=(6, 4))
    for phase in rows[0]["cpu_seconds"]:
        medians = [row["cpu_seconds"][phase]["median"] for row in rows]
        law = fits[phase]
        lines.append(f"| {phase} | " + " | ".join(f"{1e3 * m:.3g}" for m in medians)
                     + f" | {law['factor']:.2e} N^{law['exponent']:.2f} | "
                     f"{THESIS_EXPONENTS.get(phase, '')} |")
        axes.loglog([row["spheres"] for row in rows], medians, "o-", label=phase)
    axes.set(xlabel="spheres", ylabel="CPU s")
    axes.legend(fontsize=7)
    axes.grid(alpha=0.3, which="both")
    save(figure, "scaling")
    return "\n".join(lines)


def write_scenes(results):
    scene_page.draw(results, FIGURES / "error_vs_time_scenes.png")
    return scene_page.all_rows(results)


def save(figure, name):
    FIGURES.mkdir(parents=True, exist_ok=True)
    figure.tight_layout()
    figure.savefig(FIGURES / f"error_vs_time_{name}.png", dpi=100)
    plt.close(figure)


PARTS = {"scenes": (scene_errors.measure_scenes, write_scenes),
         "solvers": (measure_solvers, write_solvers),
         "thresholds": (measure_thresholds, write_thresholds),
         "coupling": (measure_coupling, write_coupling),
         "coupling_5000": (measure_coupling_5000, write_coupling_5000),
         "sizes": (measure_sizes, write_sizes),
         "models": (measure_models, write_models), "scaling": (measure_scaling, write_scaling)}


def measured(wanted):
    """All results: those wanted measured now, the others as the last measurement left them."""
    results = json.loads(MEASURED.read_text()) if MEASURED.exists() else {}
    for name in PARTS:
        if name in wanted or name not in results:
            print(f"measuring: {name}", flush=True)
            results[name] = PARTS[name][0]()
            results.setdefault("sources", {})[name] = scene_errors.hash_of_part(name)
            MEASURED.write_text(json.dumps(results, indent=1) + "\n")
    return results


def cheapest(rows, error, limit):
    """The cheapest row whose error is within the limit, or None."""
    good = [row for row in rows if row.get(error, limit + 1) <= limit]
    return min(good, key=lambda row: row["cpu"]) if good else None


def settings_for_one_percent(results):
    lines = ["| what | take | error | CPU |", "|--|--|--|--|"]
    row = cheapest(results["thresholds"], "p_max", 0.01)
    if row:
        lines.append(f"| `retriangulate` (200 kPa, 300 grains) | {row['threshold']} | "
                     f"{100 * row['p_max']:.2f} % of the load | {row['cpu']:.0f} s |")
    row = cheapest(results["coupling"], "p_max", 0.01)
    if row:
        lines.append(f"| `couple_every` and time step (5 kPa, 300 grains) | {row['setting']} | "
                     f"{100 * row['p_max']:.2f} % of the load | {row['cpu']:.0f} s |")
    row = cheapest(results["sizes"], "scatter", 0.01)
    if row:
        lines.append(f"| grains of a permeability sample | {row['spheres']} | "
                     f"{100 * row['scatter']:.1f} % scatter | {row['cpu']:.2g} s |")
    solvers = [dict(r, cpu=r["step"]) for r in results["solvers"] if r["spheres"] == 16000]
    row = cheapest(solvers, "force_error", 0.01)
    lines.append(f"| solver (16 000 grains, kept network) | {row['solver']} | "
                 f"{row['force_error']:.0e} of the forces | {row['step']:.2g} s a step |")
    return "\n".join(lines)


def check():
    """Says which parts were measured with other sources than these; exit status."""
    known = json.loads(MEASURED.read_text())["sources"]
    old = [name for name in PARTS if known.get(name) != scene_errors.hash_of_part(name)]
    if old:
        print(f"doc/error_vs_time.md is of other sources: {', '.join(old)}; doc/error_vs_time.py all makes it again")
    return 1 if old else 0


def main(words):
    if words == ["check"]:
        sys.exit(check())
    if words == ["again"]:
        sys.exit(scene_errors.again(json.loads(MEASURED.read_text())["scenes"]))
    words = list(PARTS) if words == ["all"] else words
    unknown = set(words) - set(PARTS)
    if unknown:
        sys.exit(f"error_vs_time: no part {sorted(unknown)}; there are: {' '.join(PARTS)}")
    KEPT.mkdir(parents=True, exist_ok=True)
    results = measured(words)
    text = {name: write(results[name]) for name, (_, write) in PARTS.items()}
    page = (pathlib.Path(__file__).with_name("error_vs_time.in.md")).read_text(encoding="utf-8")
    for name in PARTS:
        page = page.replace(f"@{name}@", text[name])
    page = page.replace("@settings@", settings_for_one_percent(results))
    page = page.replace("@scenes_settings@", scene_page.for_one_percent(results["scenes"]))
    page = page.replace("@scenes_interval@", scene_page.of_interval())
    sources = [f"{name} {results['sources'].get(name, '(measured before this was kept)')}" for name in PARTS]
    page = page.replace("@sources@", ", ".join(sources))
    pathlib.Path(__file__).with_name("error_vs_time.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

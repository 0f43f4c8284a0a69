#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triaxial tests of a dense and a loose cube of grains: drained, undrained at several rates, and dry at constant volume.

    run.py [KEY=VALUE...]      called by ./run.sh triaxial [KEY=VALUE...]
"""
import itertools
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import bed
import meshes
import scene
from element_tests import BULK_MODULUS, FRICTION, NUDGES, RAMP, ROWS, compared, draw_drained, draw_undrained
from element_tests import drained_measures, record, time_step

KEYS = {
    "N": (int, 1000, "grains"),
    "SEED": scene.SEED,
    "STRESS": (float, 50e3, "isotropic stress before the test and total stress of the sides in it, Pa"),
    "RATES": (str, "0.1,0.3", "rates of the undrained tests, 1/s; the slowest is that of the drained one"),
    "STRAIN": (float, 0.12, "axial strain of the undrained tests"),
    "DRAINED": (float, 0.2, "axial strain of the drained tests"),
    "VISCOSITY": (float, 2.0, "Pa s"),
    "TESTS": (str, "all", "all, or paths: of the dense sample alone, undrained beside dry"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS = 0.03  # m
PISTON_MASS = 0.3  # kg for each grain: as much as the sample
STEP = time_step(RADIUS)  # s
SPEED = 0.2  # m/s, of the plates while they compress
ENOUGH = 1000  # grains from which on a loose sample is even enough for both sides to have one stress
# a drained test is far below its explicit limit; a compressible fluid is solved at each step
COUPLE_EVERY = {"drained": 5, "undrained": 1, "dry": 1}
GRAIN = 4 / 3 * math.pi * RADIUS**3 * bed.MEAN_CUBE  # m3, the mean


def write_plates(out, edge):
    for axis in range(3):
        corners = [(a, b) for a, b in ((-edge, -edge), (edge, -edge), (edge, edge), (-edge, edge))]
        write = [tuple(np.insert(corner, axis, 0.0)) for corner in corners]
        meshes.write_mesh(SCENE / f"{out}_{'xyz'[axis]}.stl", meshes.quad(*write))


def prepare(settings, kind):
    """The sample under the isotropic stress: its file, last step, plates and porosities."""
    out = f"{settings['OUT']}_{kind}"
    half = 0.5 * (settings["N"] * GRAIN / 0.3)**(1 / 3)
    write_plates(settings["OUT"], 1.2 * half)
    press, rest = round(0.5 * half / SPEED / STEP), 4000
    said, cpu = scene.liggghts(
        SCENE, "in.prepare",
        {"N": settings["N"], "r2": RADIUS, "mu": FRICTION[kind], "half": half, "S": settings["STRESS"], "speed": SPEED,
         "piston_mass": PISTON_MASS * settings["N"], "press": press, "rest": rest, "plates": settings["OUT"], "out": out,
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        f"{out}_prepare", scene.Progress(f"{kind} sample", 0, press + rest, STEP))
    places = [float(word) for word in said["plates"]]
    low, sides = np.array(places[::2]), np.diff(np.reshape(places, (3, 2)))[:, 0]
    grains = bed.read_dump(SCENE / f"{out}.dump")
    grains[:, 2:5] -= low
    solid = 4 / 3 * math.pi * (grains[:, 5]**3).sum()
    print(f"{kind} sample of {settings['N']} grains: porosity {1 - solid / sides.prod():.3f}, away from the plates "
          f"{bed.core_porosity(grains, sides):.3f}; CPU {cpu:.0f} s", flush=True)
    return {"name": out, "last": int(said["sample"][0]), "plates": places, "volume": float(sides.prod()),
            "porosity": 1 - solid / float(sides.prod()), "core_porosity": bed.core_porosity(grains, sides), "cpu": cpu}


def test(settings, sample, fluid, rate, nudge=0.0):
    """One test; its record with mean stress, deviator and volumetric strain."""
    out = f"{sample['name']}_{fluid}_{rate:g}{f'_nudge_{nudge:g}' if nudge else ''}"
    ramp = RAMP / rate
    strain = settings["DRAINED" if fluid == "drained" else "STRAIN"]
    every = max(1, round((strain / rate + ramp / 2) / STEP / ROWS))
    _, cpu = scene.liggghts(
        SCENE, "in.triaxial",
        {"fluid": fluid, "sides": "constant_volume" if fluid == "dry" else "pistons",
         "words": scene.fix_words(f"couple_every {COUPLE_EVERY[fluid]}", settings["FIX"]),
         "sample": sample["name"], "plates": settings["OUT"], "out": out, "r2": RADIUS, "S": settings["STRESS"],
         **dict(zip(("x0", "x1", "y0", "y1", "z0", "z1"), sample["plates"])), "last": sample["last"], "rate": rate,
         "ramp": ramp, "steps": every * ROWS, "every": every, "piston_mass": PISTON_MASS * settings["N"],
         "viscosity": settings["VISCOSITY"], "bulk_modulus": BULK_MODULUS, "nudge": nudge},
        out, scene.Progress(f"{fluid} {rate:g}/s", sample["last"], sample["last"] + every * ROWS, STEP))
    print(f"  {fluid} at {rate:g}/s: {every * ROWS} steps, CPU {cpu:.0f} s", flush=True)
    return {**record(SCENE / f"{out}.csv", sample["volume"]), "cpu": cpu}


def tests_of(settings, kind, rates):
    sample = prepare(settings, kind)
    runs = {("drained", rates[0]): test(settings, sample, "drained", rates[0])} if settings["TESTS"] == "all" else {}
    for rate in rates:
        runs["undrained", rate] = test(settings, sample, "undrained", rate)
        runs["dry", rate] = test(settings, sample, "dry", rate)
    alike = [runs["dry", rates[0]]]
    alike += [test(settings, sample, "dry", rates[0], nudge) for nudge in NUDGES[:3 if settings["N"] >= ENOUGH else 1]]
    pairs = list(itertools.combinations(alike, 2))
    drained = {"drained": drained_measures(run, sample["volume"]) for (fluid, _), run in runs.items() if fluid == "drained"}
    return {"sample": sample, "runs": runs, **drained,
            "scatter": compared(pairs), "cpu": sample["cpu"] + sum(run["cpu"] for run in [*runs.values(), *alike[1:]]),
            "paths": {rate: compared([(runs["undrained", rate], runs["dry", rate])]) for rate in rates}}


def checks_of_paths(settings, kind, one, rates):
    rows, scatter = [], one["scatter"]
    for rate in rates:
        wet = one["runs"]["undrained", rate]["rows"]
        if kind == "dense" or settings["N"] >= ENOUGH:
            rms = one["paths"][rate]["rms"]
            rows.append((f"{kind}, {rate:g}/s: from the dry path, rms / p'", rms,
                         f"<= 0.03 (two dry runs: {scatter['rms']:.2g})", rms <= max(0.03, scatter["rms"])))
        total = float(np.sqrt(((wet["total"] / settings["STRESS"] - 1)**2).mean()))
        rows.append((f"{kind}, {rate:g}/s: total stress of the sides / given - 1, rms", total, "<= 0.02", total <= 0.02))
    return rows


def checks(settings, found, rates):
    rows, stress = [], settings["STRESS"]
    for kind, one in found.items():
        drained = one["drained"]
        rows += checks_of_paths(settings, kind, one, rates)
        slow = one["runs"]["undrained", rates[0]]["rows"]["p"] / stress
        if kind == "loose":
            rows.append(("loose: pore pressure at the end / stress", slow[-10:].mean(), ">= 0.2", slow[-10:].mean() >= 0.2))
        else:
            fall = slow[-10:].mean() - slow.max()
            rows += [("dense: pore pressure, first rise / stress", slow.max(), ">= 0.1", slow.max() >= 0.1),
                     ("dense: its fall after that / stress", fall, "<= -0.3", fall <= -0.3)]
        rows.append((f"{kind}: drained, what has left - what the volume lost, / volume", drained["left"], "<= 2e-4",
                     drained["left"] <= 2e-4))
        rows.append((f"{kind}: drained, largest mean excess pressure / stress", drained["excess"] / stress, "<= 0.05",
                     drained["excess"] <= 0.05 * stress))
        wet = [run["rows"] for (fluid, _), run in one["runs"].items() if fluid != "dry"]
        for name in ("mass_error", "force_error"):
            error = max(float(abs(run[name]).max()) for run in wet)
            rows.append((f"{kind}: {name.replace('_', ' ')}, largest", error, "<= 1e-9", error <= 1e-9))
    peak = found["dense"]["drained"]["peak"] / found["loose"]["drained"]["peak"]
    dilation = found["dense"]["drained"]["volume_at_end"]
    loose = found["loose"]["drained"]["volume_at_end"]
    return rows + [("drained: peak of the dense over that of the loose sample", peak, ">= 1.2", peak >= 1.2),
                   ("drained: volumetric strain at the end, dense (dilates)", dilation, "< 0", dilation < 0),
                   ("drained: volumetric strain at the end, loose (contracts)", loose, "> 0", loose > 0)]


def say_paths(one, rates):
    for name, d in [("two dry runs", one["scatter"]), *((f"undrained and dry, {r:g}/s", one["paths"][r]) for r in rates)]:
        print(f"  {name + ', stress paths':<36s} {100 * d['rms']:6.2f} % of p' apart (rms), {100 * d['largest']:.1f} % at most; "
              f"p' at equal strain {100 * d['at_equal_strain']:.2f} %")


def only_paths(settings, rates):
    one = tests_of(settings, "dense", rates)
    print(f"\ndense, {settings['N']} grains, CPU {one['cpu']:.0f} s")
    say_paths(one, rates)
    return scene.summary(SCENE, settings["OUT"], {**settings, "scatter": one["scatter"], "paths": {
        f"{rate:g}": pair for rate, pair in one["paths"].items()}}, checks_of_paths(settings, "dense", one, rates))


def work(words):
    settings = scene.parse(words, KEYS)
    rates = scene.numbers(settings, "RATES")
    if settings["N"] < 150 or min(settings[k] for k in ("STRESS", "VISCOSITY")) <= 0:
        raise scene.BadSetting("N must be at least 150; STRESS and VISCOSITY above 0")
    if not all(0.02 <= settings[k] <= 0.4 for k in ("STRAIN", "DRAINED")):
        raise scene.BadSetting("STRAIN and DRAINED must be between 0.02 and 0.4")
    if settings["TESTS"] not in ("all", "paths"):
        raise scene.BadSetting("TESTS must be all or paths")
    if settings["TESTS"] == "paths":
        return only_paths(settings, rates)
    found = {kind: tests_of(settings, kind, rates) for kind in FRICTION}
    print()
    for kind, one in found.items():
        m, slow = one["drained"], one["runs"]["undrained", rates[0]]
        p = slow["rows"]["p"] / 1e3
        print(f"{kind}: drained, deviator {m['peak'] / 1e3:.1f} kPa at its peak ({m['peak_angle']:.1f} degrees), "
              f"{m['end'] / 1e3:.1f} at the end ({m['end_angle']:.1f}); volumetric strain {100 * m['contraction']:.2f} % at "
              f"most, {100 * m['volume_at_end']:.2f} % at the end\n  undrained at {rates[0]:g}/s: pore pressure between "
              f"{p.min():.1f} and {p.max():.1f} kPa, {p[-10:].mean():.1f} at the end; CPU {one['cpu']:.0f} s")
        say_paths(one, rates)
    draw_drained(found, rates[0], SCENE / settings["OUT"])
    draw_undrained(found, rates, SCENE / settings["OUT"])
    measures = {kind: {key: one[key] for key in ("sample", "drained", "scatter", "cpu")} | {
        "paths": {f"{rate:g}": pair for rate, pair in one["paths"].items()}} for kind, one in found.items()}
    return scene.summary(SCENE, settings["OUT"], {**settings, **measures}, checks(settings, found, rates))


if __name__ == "__main__":
    scene.main("triaxial", work)

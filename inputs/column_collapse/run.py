#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A column of beads collapses, dry and in a viscous fluid with several tops of the flow box.

    run.py [KEY=VALUE...]      called by ./run.sh column_collapse [KEY=VALUE...]
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import scene
from plotting import plt, save_figure

KEYS = {
    "N": (int, 150, "beads"),
    "VISCOSITY": (float, 0.1, "Pa s"),
    "MU": (float, 0.4, "friction of beads and walls"),
    "WIDTH": (float, 8.0, "period along y, in radii"),
    "RISE": (float, 1.5, "height of the column over its foot, about"),
    "END": (float, 0.3, "duration of the runs in the fluid, s"),
    "TOPS": (str, "low,high,closed", "what is above, of low, high, closed, no_slip, extent"),
    "SHEAR": (str, "yes", "shear_viscous: yes or no"),
    "SAMPLES": (int, 3, "columns whose means are compared, from SEED on"),
    "SEED": scene.SEED,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS = 1e-3, 200.0  # m, N/m
DENSITY, GRAVITY = 2500.0, 9.81
STEP = 0.2 * math.sqrt(DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3 / STIFFNESS)  # of in.beads
# what is above, the words behind `face zhi`: open planes at 1.3 and 3 heights of the column, closed ones, and one that
# follows the highest bead
TOPS = {"low": "plane {low:.17g} symmetry pressure 0", "high": "plane {high:.17g} symmetry pressure 0",
        "closed": "plane {high:.17g} symmetry point 0 0 0 pressure 0",
        "no_slip": "plane {high:.17g} point 0 0 0 pressure 0", "extent": "extent pressure 0"}


def geometry_of(settings):
    """Foot, width and height of the column, length of the floor, heights of the planes above (m)."""
    width = settings["WIDTH"] * RADIUS
    section = settings["N"] * 4.0 / 3.0 * math.pi * RADIUS**3 / 0.57 / width  # m2, of the column
    a = math.sqrt(section / settings["RISE"])
    height = settings["RISE"] * a
    return {"a": a, "W": width, "L": 6.0 * a, "height": height, "low": 1.3 * height, "high": 3.0 * height}


def run(name, settings, geometry, top):
    """Means over the samples; the curves are those of the first."""
    samples = [sample(name, {**settings, "SEED": settings["SEED"] + k,
                             "OUT": settings["OUT"] + (f"_{k + 1}" if k else "")}, geometry, top)
               for k in range(settings["SAMPLES"])]
    means = {key: float(np.mean([found[key] for found in samples])) for key in ("run_out", "moved", "half")}
    worst = {key: max(found[key] for found in samples) for key in ("mass", "force")}
    sums = {key: sum(found[key] for found in samples) for key in ("cpu", "networks")}
    return {"name": name, **means, **worst, **sums, "samples": samples}


def sample(name, settings, geometry, top):
    out = f"{settings['OUT']}_{name}"
    wet = top is not None
    end = settings["END"] if wet else 0.25 * settings["END"]
    steps = math.ceil(end / STEP)
    said, cpu = scene.liggghts(
        SCENE, "in.column_collapse",
        {"N": settings["N"], "r": RADIUS, "kn": STIFFNESS, "mu": settings["MU"], "viscosity": settings["VISCOSITY"],
         "wet": int(wet), "top": top or "none", "words": scene.fix_words(f"shear_viscous {settings['SHEAR']}", settings["FIX"]),
         "settle": 20000, "steps": steps, "every": max(1, steps // 200), "out": out,
         "a": geometry["a"], "W": geometry["W"], "L": geometry["L"], "H": geometry["high"],
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        out + "_run", scene.Progress(name, 0, steps, STEP))
    record = np.genfromtxt(SCENE / f"{out}_record.csv", delimiter=",", names=True)
    start, end = record["x"][0], record["x"][-1]
    half = float(np.interp(0.5 * (start + end), record["x"], record["time"]))
    return {"name": name, "run_out": float((record["front"][-1] - geometry["a"]) / geometry["a"]),
            "moved": float((end - start) / geometry["a"]), "half": half, "cpu": cpu, "networks": int(float(said["end"][0])),
            "mass": float(abs(record["mass_error"]).max()), "force": float(abs(record["force_error"]).max())}


def draw(runs, settings):
    figure, axes = plt.subplots(figsize=(6, 4))
    for found in runs:
        record = np.genfromtxt(SCENE / f"{settings['OUT']}_{found['name']}_record.csv", delimiter=",", names=True)
        axes.plot(record["time"], 1e3 * record["x"], lw=1, label=found["name"])
    axes.set(xlabel="time, s", ylabel="mean place of the beads, mm")
    axes.legend()
    save_figure(figure, SCENE / f"{settings['OUT']}_collapse.png")


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 100 or min(settings["VISCOSITY"], settings["END"], settings["RISE"]) <= 0 or settings["WIDTH"] < 6 or settings["SAMPLES"] < 1:
        raise scene.BadSetting("N must be at least 100, WIDTH 6, SAMPLES 1; VISCOSITY, END and RISE above 0")
    tops = settings["TOPS"].split(",")
    if not set(tops) <= set(TOPS) or settings["SHEAR"] not in ("yes", "no"):
        raise scene.BadSetting(f"TOPS are {', '.join(TOPS)}, with commas between them; SHEAR is yes or no")
    geometry = geometry_of(settings)
    runs = [run("dry", settings, geometry, None)]
    runs += [run(name, settings, geometry, TOPS[name].format(**geometry)) for name in tops]
    print(f"\nColumn collapse: {settings['N']} beads, foot {1e3 * geometry['a']:.3g} mm, height {1e3 * geometry['height']:.3g} mm")
    for found in runs:
        print(f"  {found['name']:<8s} run-out {found['run_out']:.3f}, mean way {found['moved']:.4f} of the foot, half of it after "
              f"{found['half']:.4f} s; networks {found['networks']}, CPU {found['cpu']:.0f} s")
    rows, first = [], runs[1]
    for found in runs[2:]:
        for what, key in (("run-out", "run_out"), ("mean way", "moved"), ("time of half of it", "half")):
            beside = [one[key] / other[key] - 1.0 for one, other in zip(found["samples"], first["samples"])]
            error = float(np.std(beside, ddof=1) / math.sqrt(len(beside))) if len(beside) > 1 else 0.0
            mean = float(np.mean(beside))
            rows.append((f"{what}, top {found['name']} / {first['name']} - 1", mean, f"0, +- 0.05 + 2 x {error:.3f}",
                         abs(mean) <= 0.05 + 2.0 * error))
    draw(runs, settings)
    return scene.summary(SCENE, settings["OUT"], {**settings, **geometry, "runs": runs}, rows)


if __name__ == "__main__":
    scene.main("column_collapse", work)

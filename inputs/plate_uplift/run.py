#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A plate is pulled up through a saturated bed, slowly and fast: drained, and held by the suction under it.

    run.py [KEY=VALUE...]      called by ./run.sh plate_uplift [KEY=VALUE...]
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import meshes
import scene
from plotting import plt, save_figure

KEYS = {
    "N": (int, 900, "beads"),
    "SEED": scene.SEED,
    "MU": (float, 0.5, "friction between beads; walls and plate have none"),
    "VISCOSITY": (float, 0.06, "Pa s"),
    "SPEED": (float, 0.02, "of the fastest pull, m/s; the others are a half and a fifth of it"),
    "TRAVEL": (float, 6e-4, "how far the plate is pulled, m"),
    "STRAIN": (str, "mean 0.03", "pore strain at which the network is built anew"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS, DENSITY, WATER, GRAVITY = 2.5e-3, 2e3, 2500.0, 1000.0, 9.81
LENGTH, WIDTH = 0.06, 0.025            # m, of the bed
PLATE, THICKNESS, DEEP = 0.024, 4e-3, 0.012  # m: width of the plate, its lower side above the floor
DT = 0.2 * math.sqrt(DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3 / STIFFNESS)
BEYOND = 1e-3                          # m that the plate reaches through the side walls
WINDOW = 0.2                           # of the travel: forces are compared from there on


ALONG, UP = (0.5 * (LENGTH - PLATE), 0.5 * (LENGTH + PLATE)), (DEEP, DEEP + THICKNESS)  # m: x and z of the plate


def plate():
    """A closed block through both side walls."""
    x, y, z = ALONG, (-BEYOND, WIDTH + BEYOND), UP
    ring = [[(x[i], y[j], height) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))] for height in z]
    return meshes.funnel(*ring) + meshes.lid(ring[0][::-1]) + meshes.lid(ring[1])


def pull(name, settings, speed, viscosity=0.0):
    """One run; dry, under the gravity of the buoyant weight, without a viscosity."""
    out = f"{settings['OUT']}_{name}"
    meshes.write_mesh(SCENE / f"{out}_plate.stl", plate())
    settle, rest, steps = math.ceil(0.35 / DT), math.ceil(0.05 / DT), math.ceil(settings["TRAVEL"] / speed / DT)
    solid = settings["N"] * 4.0 / 3.0 * math.pi * RADIUS**3
    print(f"{name}: {speed:g} m/s, {viscosity:g} Pa s, {steps} steps of {DT:.3g} s", flush=True)
    said, cpu = scene.liggghts(
        SCENE, "in.plate_uplift",
        {"N": settings["N"], "r": RADIUS, "kn": STIFFNESS, "mu": settings["MU"], "L": LENGTH, "W": WIDTH,
         "H": solid / (LENGTH * WIDTH) / 0.2 + 0.02, "settle": settle, "rest": rest, "steps": steps,
         "every": max(1, steps // 200), "report": max(1, steps // 10), "speed": speed, "wet": int(viscosity > 0.0),
         "viscosity": viscosity,
         "px0": ALONG[0], "px1": ALONG[1], "pz0": UP[0], "pz1": UP[1],
         "gravity": GRAVITY * (1.0 if viscosity > 0.0 else 1.0 - WATER / DENSITY), 
         "words": scene.fix_words(f"retriangulate {settings['STRAIN']}", settings["FIX"]),
         "out": out, **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        out + "_run", scene.Progress(name, settle + rest, settle + rest + steps, DT))
    rows = np.genfromtxt(SCENE / f"{out}_record.csv", delimiter=",", names=True)
    return {"name": name, "speed": speed, "viscosity": viscosity, "cpu": cpu, "rows": rows,
            "beads": int(said["end"][0]), "lift": float(said["lift"][0]) if viscosity > 0.0 else 0.0}


def forces(run):
    """Mean over the window, N, downward, the fluid's lift at rest left out: all on the plate, and the fluid alone."""
    rows = run["rows"]
    chosen = rows["u"] >= WINDOW * rows["u"][-1]
    found = {"all": run["lift"] - float(rows["all"][chosen].mean())}
    if run["viscosity"] > 0:
        found["fluid"] = run["lift"] - float(rows["fluid"][chosen].mean())
    return found


def draw(runs, found, base):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    for run in runs:
        curve, = left.plot(1e3 * run["rows"]["u"], run["lift"] - run["rows"]["all"], lw=1, label=run["label"])
        rate, parts = 1e3 * run["speed"] * run["viscosity"], found[run["name"]]
        right.plot(rate, parts["all"], "o", color=curve.get_color())
        if "fluid" in parts:
            right.plot(rate, parts["fluid"], "^", color=curve.get_color())
    left.set(xlabel="way of the plate, mm", ylabel="resistance to uplift, N", ylim=(0, None))
    left.legend(fontsize="small")
    right.set(xlabel="speed x viscosity, mPa m", ylabel="N: dots all, triangles the fluid on the plate", ylim=(0, None))
    save_figure(figure, f"{base}_resistance.png")


def checks(f, wet):
    drained = f["slow"]["all"] - 2.0 / 3.0 * (f["middle"]["all"] - f["slow"]["all"])  # 0.2 and 0.5 of the top speed
    found = [("resistance, line through the two slowest at rest / dry", drained / f["dry"]["all"], (0.85, 1.3)),
             ("resistance, fast / slow", f["fast"]["all"] / f["slow"]["all"], (1.5, 3.0)),
             ("fluid's part, fast / half as fast", f["fast"]["fluid"] / f["middle"]["fluid"], (1.5, 2.7)),
             ("fluid's part, fast / a fifth as fast", f["fast"]["fluid"] / f["slow"]["fluid"], (3.3, 7.0)),
             ("resistance, half as fast in twice the viscosity / fast - 1", f["thick"]["all"] / f["fast"]["all"] - 1,
              (-0.2, 0.2))]
    rows = [(what, value, f"{low:g} to {high:g}", low <= value <= high) for what, value, (low, high) in found]
    for what, name in (("mass error, largest", "mass_error"), ("force-balance error, largest", "force_error")):
        worst = max(float(abs(run["rows"][name]).max()) for run in wet)
        rows.append((what, worst, "<= 1e-10", worst <= 1e-10))
    return rows


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 300 or min(settings["SPEED"], settings["TRAVEL"], settings["VISCOSITY"]) <= 0:
        raise scene.BadSetting("N must be at least 300, SPEED, TRAVEL and VISCOSITY above 0")
    top, mu = settings["SPEED"], settings["VISCOSITY"]
    runs = [pull("dry", settings, top / 2)]
    for name, part, factor in (("slow", 0.2, 1), ("middle", 0.5, 1), ("fast", 1.0, 1), ("thick", 0.5, 2)):
        runs.append(pull(name, settings, top * part, mu * factor))
    for run in runs:
        words = f"{run['speed']:g} m/s, {run['viscosity']:g} Pa s"
        run["label"] = words if run["name"] != "dry" else "dry, buoyant weight"
    found = {run["name"]: forces(run) for run in runs}
    print(f"\nPlate in {runs[0]['beads']} beads, {1e3 * settings['TRAVEL']:g} mm up; CPU "
          + " + ".join(f"{run['cpu']:.0f}" for run in runs) + " s")
    for run in runs:
        parts = found[run["name"]]
        print(f"  {run['label']:<24s} resistance {parts['all']:.3f} N"
              + (f", of the fluid {parts['fluid']:.3f} N" if "fluid" in parts else ""))
    draw(runs, found, SCENE / settings["OUT"])
    return scene.summary(SCENE, settings["OUT"], {**settings, "forces": found}, checks(found, runs[1:]))


if __name__ == "__main__":
    scene.main("plate_uplift", work)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A drum, more than half full of beads, turns about its axis: dry, and filled up with fluid.

    run.py [KEY=VALUE...]      called by ./run.sh drum_underwater [KEY=VALUE...]
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
    "N": (int, 420, "beads; as many as find room"),
    "SEED": scene.SEED,
    "MU": (float, 0.5, "friction between beads and with the drum"),
    "VISCOSITY": (float, 0.01, "Pa s"),
    "PERIOD": (float, 4.0, "of the drum, s"),
    "TURN": (float, 0.35, "how far it turns, in turns"),
    "STRAIN": (str, "mean 0.03", "pore strain at which the network is built anew"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS, DENSITY = 2.5e-3, 1e3, 2500.0  # m, N/m, kg/m3
ROOM, LENGTH, SIDES = 0.03, 0.025, 32  # m; flats of the drum
DT = 0.2 * math.sqrt(DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3 / STIFFNESS)
TOGETHER, FLOWS = (0.01, 0.05), 0.15  # turns: the bed still goes with the drum; it flows since long


def turn(name, settings, viscosity=0.0):
    """One run; dry without a viscosity."""
    out = f"{settings['OUT']}_{name}"
    ends = [meshes.ring(SIDES, ROOM, y) for y in (0.0, LENGTH)]
    meshes.write_mesh(SCENE / f"{out}_drum.stl", meshes.lying(
        meshes.funnel(*ends) + meshes.lid(ends[0]) + meshes.lid(ends[1])))
    settle, steps = math.ceil(0.25 / DT), math.ceil(settings["TURN"] * settings["PERIOD"] / DT)
    print(f"{name}: {steps} steps of {DT:.3g} s", flush=True)
    said, cpu = scene.liggghts(
        SCENE, "in.drum_underwater",
        {"N": settings["N"], "r": RADIUS, "kn": STIFFNESS, "mu": settings["MU"], "R": ROOM, "length": LENGTH,
         "settle": settle, "steps": steps, "every": max(1, steps // 300), "report": max(1, steps // 20),
         "period": settings["PERIOD"], "wet": int(viscosity > 0.0), "viscosity": viscosity,
         "words": scene.fix_words(f"retriangulate {settings['STRAIN']} coupling auto", settings["FIX"]), "out": out,
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"], 6))}},
        out + "_run", scene.Progress(name, 3 * settle, 3 * settle + steps, DT))
    rows = np.genfromtxt(SCENE / f"{out}_record.csv", delimiter=",", names=True)
    angle = np.degrees(np.arctan2(-rows["x"], -rows["z"]))  # of the bed's middle from the vertical
    return {"name": name, "cpu": cpu, "rows": rows, "angle": angle, "turns": rows["time"] / settings["PERIOD"],
            "begun": int(said["end"][0]), "left": int(said["end"][1])}


def measures(run):
    turns, angle = run["turns"], run["angle"]
    first, late = (turns > TOGETHER[0]) & (turns < TOGETHER[1]), turns > FLOWS
    return {"together": float(np.polyfit(turns[first], angle[first], 1)[0] / 360.0), "angle": float(angle[late].mean()),
            "scatter": float(angle[late].std()), "lost": run["begun"] - run["left"]}


def fluid(run, settings):
    """Exact balances of the fluid."""
    rows = run["rows"]
    swept = 2.0 * math.pi / settings["PERIOD"] * ROOM * 2.0 * math.pi * ROOM * LENGTH  # m3/s, wall's speed times area
    return {"flow": float(max(abs(rows["inflow"]).max(), abs(rows["outflow"]).max()) / swept),
            "power": float(rows["power"].max() / -rows["power"].mean()), "fed": float(rows["power"].mean()),
            "outside": int(rows["outside"].max()), "mass": float(abs(rows["mass_error"]).max()),
            "force": float(abs(rows["force_error"]).max()), "networks": int(rows["networks"][-1])}


def draw(runs, base):
    figure, axes = plt.subplots(figsize=(7, 4))
    for run in runs:
        axes.plot(run["turns"], run["angle"], label=run["name"])
    axes.plot([0, 0.12], [0, 43.2], "k--", lw=1, label="the drum")
    axes.set(xlabel="turns of the drum", ylabel="angle of the bed's middle, degrees")
    axes.legend()
    save_figure(figure, f"{base}_angle.png")


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 300 or settings["TURN"] <= FLOWS or min(settings["PERIOD"], settings["VISCOSITY"]) <= 0:
        raise scene.BadSetting(f"N must be at least 300, TURN above {FLOWS}, PERIOD and VISCOSITY above 0")
    dry, wet = turn("dry", settings), turn("wet", settings, settings["VISCOSITY"])
    a, b, f = measures(dry), measures(wet), fluid(wet, settings)
    print(f"\nDrum with {wet['left']} beads, {settings['PERIOD']:g} s a turn: the bed's angle is {a['angle']:.1f} +- "
          f"{a['scatter']:.1f} degrees dry, {b['angle']:.1f} +- {b['scatter']:.1f} in the fluid; networks {f['networks']}, "
          f"CPU {dry['cpu']:.0f} + {wet['cpu']:.0f} s")
    draw((dry, wet), SCENE / settings["OUT"])
    rows = [
        ("flow through the opening / what the wall sweeps, largest", f["flow"], "<= 1e-12", f["flow"] <= 1e-12),
        ("bed / drum before it flows, dry, angular velocities - 1", a["together"] - 1, "within 0.03",
         abs(a["together"] - 1) <= 0.03),
        ("bed / drum before it flows, wet, angular velocities - 1", b["together"] - 1, "within 0.03",
         abs(b["together"] - 1) <= 0.03),
        ("power of the fluid on beads against the drum, mean, W", f["fed"], "< 0", f["fed"] < 0),
        ("the same, largest / mean loss", f["power"], "<= 0.01", f["power"] <= 0.01),
        ("angle in the fluid / dry", b["angle"] / a["angle"], "> 1", b["angle"] > a["angle"]),
        ("beads lost or outside", a["lost"] + b["lost"] + f["outside"], "0", a["lost"] + b["lost"] + f["outside"] == 0),
        ("mass error, largest", f["mass"], "<= 1e-10", f["mass"] <= 1e-10),
        ("force-balance error, largest", f["force"], "<= 1e-10", f["force"] <= 1e-10)]
    return scene.summary(SCENE, settings["OUT"], {**settings, "dry": a, "wet": {**b, **f}}, rows)


if __name__ == "__main__":
    scene.main("drum_underwater", work)

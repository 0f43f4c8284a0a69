#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Water rises through a bed with a free surface: Darcy's law until the bed boils, then the buoyant weight.

    run.py [KEY=VALUE...]      called by ./run.sh boiling [KEY=VALUE...]
"""
import json
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import scene
from plotting import plt, save_figure

KEYS = {
    "SHAPE": (str, "both", "cylinder, box or both"),
    "N": (int, 800, "beads"),
    "SEED": scene.SEED,
    "VISCOSITY": (float, 0.1, "Pa s"),
    "MU": (float, 0.3, "friction between beads; walls have none"),
    "END": (float, 1.5, "duration, s"),
    "MOST": (float, 1.5, "discharge at the end, over that at which the bed should boil"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS = 2.5e-3, 2e4  # m, N/m
ROOM = 0.02  # m, radius of the cylinder; the box has its section
DENSITY, WATER, GRAVITY = 2500.0, 1000.0, 9.81
AREA = math.pi * ROOM**2
BEAD = 4.0 / 3.0 * math.pi * RADIUS**3 * (0.9**3 + 1.0 + 1.1**3) / 3.0  # m3, of a mean bead
LINEAR, BOILS = 0.5, 1.2  # of the discharge at which the bed should boil: below, Darcy; above, it boils
RECORDS, MEAN = 400, 20  # rows of a record; those in the mean of which the plateau is the largest


def container(shape, top):
    """For `pfv solve`: the bed's room from the floor to the top of the highest bead."""
    planes = [{"name": "floor", "inward_normal": [0, 0, 1], "offset": 0.0},
              {"name": "top", "inward_normal": [0, 0, -1], "offset": -top}]
    if shape == "cylinder":
        return {"planes": planes, "cylinders": [{"name": "shell", "axis": [0, 0, 1], "point": [0, 0, 0],
                                                 "radius": ROOM}]}
    half = 0.5 * math.sqrt(AREA)
    for axis in (0, 1):
        for way in (1, -1):
            normal = [0, 0, 0]
            normal[axis] = way
            planes.append({"name": f"side{axis}{way}", "inward_normal": normal, "offset": -half})
    return {"planes": planes}


def prepare(shape, settings, variables):
    said, _ = scene.liggghts(SCENE, "in.prepare", variables, variables["out"] + "_bed",
                             scene.Progress("bed", 0, 30000, 0.0))
    count, start, dt = map(float, said["bed"])
    beads = np.loadtxt(SCENE / f"{variables['out']}_bed.dump", skiprows=9)
    solid = float((4.0 / 3.0 * math.pi * beads[:, 5]**3).sum())
    top = float((beads[:, 4] + beads[:, 5]).max())
    name = f"{variables['out']}_room.json"
    (SCENE / name).write_text(json.dumps(container(shape, top)))
    report = scene.pfv_solve(SCENE, f"{variables['out']}_bed.dump", name, settings["VISCOSITY"],
                             f"{variables['out']}_report.json", "--wall", "symmetry",
                             "--face", "floor:pressure=1", "--face", "top:pressure=0")
    weight = solid * (DENSITY - WATER) * GRAVITY
    resistance = 1.0 / abs(report["faces"]["floor"]["flux"])
    return {"count": int(count), "dt": dt, "start": int(start), "solid": solid, "top": top, "weight": weight,
            "resistance": resistance, "permeability": report["permeability"],
            "Q_critical": weight / AREA / resistance}


def room(shape, settings):
    """Variables of both scripts."""
    out = f"{settings['OUT']}_{shape}"
    height = 0.1 + settings["N"] * BEAD / AREA / 0.15
    return {"shape": shape, "N": settings["N"], "r": RADIUS, "kn": STIFFNESS, "mu": settings["MU"], "R": ROOM,
            "W": math.sqrt(AREA), "height": height, "fill": height - 0.1, "out": out,
            **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}}


def couple(shape, settings, variables, bed):
    out = variables["out"]
    steps = math.ceil(settings["END"] / bed["dt"])
    every = max(1, steps // RECORDS)
    print(f"{shape}: {bed['count']} beads, {steps} steps of {bed['dt']:.3g} s", flush=True)
    said, cpu = scene.liggghts(
        SCENE, "in.boiling",
        {**variables, "viscosity": settings["VISCOSITY"], "Q_end": settings["MOST"] * bed["Q_critical"],
         "start": bed["start"], "words": scene.fix_words("", settings["FIX"]), "steps": steps, "every": every, "report": max(1, steps // 50)}, out + "_run",
        scene.Progress(shape, bed["start"], bed["start"] + steps, bed["dt"]))
    return {**bed, "shape": shape, "out": out, "cpu": cpu, "every": every, "limit": float(said["end"][0])}


class Record:
    """Of one run: discharge and pressure drop, each over those at which the bed should boil."""

    def __init__(self, run):
        rows = np.genfromtxt(SCENE / f"{run['out']}_record.csv", delimiter=",", names=True)
        bottom = np.genfromtxt(SCENE / f"{run['out']}_bottom.csv", delimiter=",", skip_header=1)
        self.rows, at = rows[1:], np.searchsorted(bottom[:, 0], rows["time"][1:] - 1e-9)
        self.Q = self.rows["Q"] / run["Q_critical"]
        self.p = bottom[np.minimum(at, len(bottom) - 1), 1] * AREA / run["weight"]


def measures(run):
    record = Record(run)
    low, high = record.Q < LINEAR, record.Q > BOILS
    slope = float((record.Q[low] @ record.p[low]) / (record.Q[low] @ record.Q[low]))
    stray = float(np.sqrt(((record.p[low] - slope * record.Q[low])**2).mean()) / LINEAR)
    rows, smooth = record.rows, np.convolve(record.p, np.ones(MEAN) / MEAN, mode="valid")
    flows = abs(rows["inflow"] - rows["Q"]).max() / rows["Q"].max()
    return {"slope": slope, "stray": stray, "plateau": float(smooth.max()),
            "last": float(smooth[-1]), "floor": float(rows["floor"][high].mean() / run["weight"]),
            "rest": float((record.p[high] + rows["floor"][high] / run["weight"]).mean()),
            "side": float(abs(rows["side"]).max() / run["weight"]), "inflow": float(flows),
            "mass": float(abs(rows["mass_error"]).max()), "force": float(abs(rows["force_error"]).max()),
            "networks": int(rows["networks"][-1]),
            "rise": float((rows["mean_z"][-1] - rows["mean_z"][0]) / rows["mean_z"][0])}


def checks(run, m):
    name = run["shape"]
    return [(f"{name}: pressure drop / Darcy's before it boils - 1", m["slope"] - 1, "within 0.03",
             abs(m["slope"] - 1) <= 0.03),
            (f"{name}: strays from the line (rms)", m["stray"], "<= 0.01", m["stray"] <= 0.01),
            (f"{name}: plateau / (buoyant weight / area) - 1", m["plateau"] - 1, "within 0.03",
             abs(m["plateau"] - 1) <= 0.03),
            (f"{name}: (drop x area + floor's force) / weight - 1, boiling", m["rest"] - 1, "within 0.005",
             abs(m["rest"] - 1) <= 0.005),
            (f"{name}: side walls' vertical force / weight, largest", m["side"], "0", m["side"] == 0.0),
            (f"{name}: inflow / discharge - 1, largest", m["inflow"], "<= 1e-3", m["inflow"] <= 1e-3),
            (f"{name}: mass error, largest", m["mass"], "<= 1e-10", m["mass"] <= 1e-10),
            (f"{name}: force-balance error, largest", m["force"], "<= 1e-10", m["force"] <= 1e-10)]


def draw(runs, base):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharex=True)
    for run in runs:
        record = Record(run)
        axes[0].plot(record.Q, record.p, lw=1, label=run["shape"])
        axes[1].plot(record.Q, 1e3 * record.rows["mean_z"], lw=1)
    axes[0].plot([0, 1, max(record.Q)], [0, 1, 1], "k--", lw=1, label="Darcy, buoyant weight")
    axes[0].set(xlabel="discharge / (weight / Darcy's resistance)", ylabel="Δp A / buoyant weight")
    axes[0].legend()
    axes[1].set(xlabel="discharge / (weight / Darcy's resistance)", ylabel="mean height of beads, mm")
    save_figure(figure, f"{base}_curve.png")


def work(words):
    settings = scene.parse(words, KEYS)
    shapes = ("cylinder", "box") if settings["SHAPE"] == "both" else (settings["SHAPE"],)
    if not set(shapes) <= {"cylinder", "box"}:
        raise scene.BadSetting("SHAPE must be cylinder, box or both")
    if settings["N"] < 150 or settings["MOST"] <= BOILS or settings["END"] <= 0 or settings["VISCOSITY"] <= 0:
        raise scene.BadSetting(f"N must be at least 150, MOST above {BOILS}, END and VISCOSITY above 0")
    runs = []
    for shape in shapes:
        variables = room(shape, settings)
        runs.append(couple(shape, settings, variables, prepare(shape, settings, variables)))
    found = [measures(run) for run in runs]
    print(f"\nBoiling: {settings['N']} beads, {settings['END']:g} s")
    rows = []
    for run, m in zip(runs, found):
        print(f"  {run['shape']:<9s} K {run['permeability']:.3e} m2, boils at {1e6 * run['Q_critical']:.3g} cm3/s; plateau "
              f"{m['plateau']:.4f}, at the end {m['last']:.4f} of the weight, floor {m['floor']:.4f}; beads rise "
              f"{100 * m['rise']:.1f} %; networks {m['networks']}, CPU {run['cpu']:.0f} s")
        rows += checks(run, m)
    draw(runs, SCENE / settings["OUT"])
    return scene.summary(SCENE, settings["OUT"], {**settings, "runs": [{**r, **m} for r, m in zip(runs, found)]}, rows)


if __name__ == "__main__":
    scene.main("boiling", work)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drained compression of beads in a cylindrical cell between two plates: what leaves is what the volume loses, the
fluid's pressure is that of slow drainage, grains and fluid together carry the load.

    run.py [KEY=VALUE...]      called by ./run.sh triaxial_cylinder [KEY=VALUE...]
"""
import json
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
    "CELL": (str, "tube", "tube (32 flats of an STL file) or cylinder (primitive)"),
    "N": (int, 600, "beads"),
    "SEED": scene.SEED,
    "MU": (float, 0.3, "friction between beads; cell and plates have none"),
    "VISCOSITY": (float, 0.4, "Pa s"),
    "STRESS": (float, 16e3, "axial stress at the end, Pa; it begins with a quarter"),
    "TIME": (float, 0.4, "in which the load grows, s"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS, DENSITY = 2.5e-3, 1e4, 2500.0  # m, N/m, kg/m3
ROOM, SIDES = 0.02, 32  # m; flats of the tube
BEAD = 4.0 / 3.0 * math.pi * RADIUS**3 * (0.9**3 + 1.0 + 1.1**3) / 3.0  # m3, of a mean bead
SETTLE, PRESS, REST = 14000, 8000, 8000  # steps
PLANES = 40  # of the pressure profile


def area(cell):
    return math.pi * ROOM**2 if cell == "cylinder" else meshes.polygon_area(SIDES, ROOM)


def write_meshes(settings, height):
    out, edge = settings["OUT"], 1.6 * ROOM
    meshes.write_mesh(SCENE / f"{out}_plate.stl", meshes.quad(*[(x, y, 0.0) for x, y in (
        (-edge, -edge), (edge, -edge), (edge, edge), (-edge, edge))]))
    meshes.write_mesh(SCENE / f"{out}_tube.stl", meshes.funnel(
        meshes.ring(SIDES, ROOM, -0.004), meshes.ring(SIDES, ROOM, height - 0.001)))


def couple(settings):
    solid, section = settings["N"] * BEAD, area(settings["CELL"])
    filled = solid / section / 0.2
    write_meshes(settings, filled + 0.02)
    dt = 0.2 * math.sqrt(DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3 / STIFFNESS)
    growth = math.ceil(settings["TIME"] / dt)
    every = max(1, growth // 100)
    begin, hold = SETTLE + PRESS + REST, 20 * every
    force = settings["STRESS"] * section
    print(f"{settings['CELL']}: {settings['N']} beads, {growth + hold} steps of {dt:.3g} s", flush=True)
    said, cpu = scene.liggghts(
        SCENE, "in.triaxial_cylinder",
        {"cell": settings["CELL"], "N": settings["N"], "r": RADIUS, "kn": STIFFNESS, "mu": settings["MU"], "R": ROOM,
         "height": filled + 0.02, "H0": filled, "F0": force / 4, "F1": force, "piston_mass": 0.05, "vel_max": 5.0,
         "viscosity": settings["VISCOSITY"], "words": scene.fix_words("", settings["FIX"]), "settle": SETTLE, "press": PRESS, "rest": REST,
         "growth": every * 100 if every > 1 else growth, "hold": hold, "every": every, "report": max(1, growth // 50),
         "planes": PLANES, "out": settings["OUT"],
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        settings["OUT"] + "_run", scene.Progress("compression", 0, begin + growth + hold, dt))
    return {"area": section, "dt": dt, "force": force, "cpu": cpu, "H_before": float(said["rest"][0]),
            "H_after": float(said["end"][0]), "limit": float(said["end"][1])}


def permeability(settings, run, when):
    """m2, of the beads before or after the load has grown."""
    height = run[f"H_{when}"]
    name = f"{settings['OUT']}_{when}.json"
    (SCENE / name).write_text(json.dumps({
        "planes": [{"name": "base", "inward_normal": [0, 0, 1], "offset": 0.0},
                   {"name": "lid", "inward_normal": [0, 0, -1], "offset": -height}],
        "cylinders": [{"name": "shell", "axis": [0, 0, 1], "point": [0, 0, 0],
                       "radius": math.sqrt(run["area"] / math.pi)}]}))
    return scene.pfv_solve(SCENE, f"{settings['OUT']}_{when}.dump", name, settings["VISCOSITY"],
                           f"{settings['OUT']}_{when}_report.json", "--wall", "symmetry",
                           "--face", "base:pressure=1", "--face", "lid:pressure=0")["permeability"]


def record(settings):
    """Rows of means; the first interval is not whole."""
    return np.genfromtxt(SCENE / f"{settings['OUT']}_record.csv", delimiter=",", names=True)


def while_growing(time, settings):
    return (time > 0.25 * settings["TIME"]) & (time < 0.95 * settings["TIME"])


def curvature(settings, height):
    """Of the mean pressure in the middle of the sample, 1/m2 Pa: where the walls' pores do not count."""
    rows = np.loadtxt(SCENE / f"{settings['OUT']}_profile.csv", delimiter=",", skiprows=1)
    pressure = rows[while_growing(rows[:, 0], settings), 1:].mean(axis=0)
    place = (np.arange(PLANES) + 0.5) / PLANES
    inner = (place > 0.2) & (place < 0.8)
    return -2.0 * float(np.polyfit(place[inner] * height, pressure[inner], 2)[0])


def measures(settings, run):
    rows = record(settings)
    left = float(rows["net"][1:] @ np.diff(rows["time"]))  # m3, from the first record to the last
    lost = run["area"] * float(rows["H"][0] - rows["H"][-1])
    K = [permeability(settings, run, when) for when in ("before", "after")]
    growing = while_growing(rows["time"], settings)
    # uniform strain between drained plates: K p'' = -mu v/H
    speed, height = rows["net"][growing].mean() / run["area"], rows["H"][growing].mean()
    slow = settings["VISCOSITY"] * speed / height / np.mean(K)
    lid, base, load = (rows[name][1:] for name in ("lid", "base", "load"))
    return {"K": K, "left": left, "lost": lost, "volume": left / lost - 1.0,
            "pressure": curvature(settings, height) / slow - 1.0,
            "excess": float(rows["mean_p"][growing].mean() * run["area"] / run["force"]),
            "largest": float(abs(rows["mean_p"]).max() * run["area"] / run["force"]),
            "remaining": float(abs(rows["mean_p"][-5:]).max() * run["area"] / run["force"]),
            "lid": float((lid - load).mean() / load.mean()),
            "lid_rms": float(np.sqrt(((lid / load - 1.0)**2).mean())),
            "plates": float(abs((lid + base) / load).max()),
            "strain": float(1.0 - run["H_after"] / run["H_before"]),
            "mass": float(abs(rows["mass_error"]).max()), "force_error": float(abs(rows["force_error"]).max()),
            "networks": int(rows["networks"][-1])}


def draw(settings, run, base):
    rows = record(settings)[1:]
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.8))
    axes[0].plot(100 * (1 - rows["H"] / run["H_before"]), rows["lid"] / run["area"] / 1e3)
    axes[0].set(xlabel="axial strain, %", ylabel="axial stress, kPa")
    axes[1].plot(rows["time"], rows["mean_p"])
    axes[1].set(xlabel="t, s", ylabel="mean excess pressure, Pa")
    axes[2].plot(rows["time"], 1e9 * np.cumsum(rows["net"]) * (rows["time"][1] - rows["time"][0]), label="has left")
    axes[2].plot(rows["time"], 1e9 * run["area"] * (rows["H"][0] - rows["H"]), "k--", lw=1, label="lost volume")
    axes[2].set(xlabel="t, s", ylabel="mm³")
    axes[2].legend()
    save_figure(figure, f"{base}_curves.png")


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["CELL"] not in ("tube", "cylinder"):
        raise scene.BadSetting("CELL must be tube or cylinder")
    if settings["N"] < 150 or min(settings[k] for k in ("VISCOSITY", "STRESS", "TIME")) <= 0:
        raise scene.BadSetting("N must be at least 150; VISCOSITY, STRESS and TIME above 0")
    run = couple(settings)
    m = measures(settings, run)
    print(f"\nCompression of {settings['N']} beads in a {settings['CELL']} to {settings['STRESS'] / 1e3:g} kPa: strain "
          f"{100 * m['strain']:.2f} %, K {m['K'][0]:.3e} to {m['K'][1]:.3e} m2\n  largest excess pressure "
          f"{100 * m['largest']:.2f} % of the load, {100 * m['remaining']:.4f} % at the end; time step "
          f"{run['dt']:.3g} s, explicit limit {run['limit']:.3g} s; networks {m['networks']}, CPU {run['cpu']:.0f} s")
    draw(settings, run, SCENE / settings["OUT"])
    rows = [
        ("what has left / what the volume lost - 1", m["volume"], "within 0.002", abs(m["volume"]) <= 0.002),
        ("curvature of p / that of slow drainage - 1", m["pressure"], "within 0.2", abs(m["pressure"]) <= 0.2),
        ("mean excess pressure while it grows / load", m["excess"], "<= 0.01", m["excess"] <= 0.01),
        ("pressure left at the end / load", m["remaining"], "<= 1e-3", m["remaining"] <= 1e-3),
        ("grains + fluid on the lid / load - 1, mean", m["lid"], "within 1e-3", abs(m["lid"]) <= 1e-3),
        ("grains + fluid on the lid / load - 1, rms", m["lid_rms"], "<= 0.01", m["lid_rms"] <= 0.01),
        ("(lid + base) / load, largest", m["plates"], "<= 0.01", m["plates"] <= 0.01),
        ("mass error, largest", m["mass"], "<= 1e-10", m["mass"] <= 1e-10),
        ("force-balance error, largest", m["force_error"], "<= 1e-10", m["force_error"] <= 1e-10)]
    return scene.summary(SCENE, settings["OUT"], {**settings, **run, **m}, rows)


if __name__ == "__main__":
    scene.main("triaxial_cylinder", work)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed of rigid clumps settles in a viscous fluid beside one of spheres of the same volume.

    run.py [KEY=VALUE...]      called by ./run.sh clumps [KEY=VALUE...]
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
    "N": (int, 40, "grains of each kind"),
    "SEED": scene.SEED,
    "MU": (float, 0.4, "friction between grains and with the walls"),
    "VISCOSITY": (float, 1.0, "Pa s"),
    "COUPLING": (str, "implicit", "explicit, staged, implicit or auto"),
    "TIME": (float, 0.5, "s"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS, DENSITY = 1.5e-3, 20.0, 2500.0  # m, N/m, kg/m3
VOLUME = 4.0 / 3.0 * math.pi * RADIUS**3
LOOSE = 0.2  # solid fraction at the start
DT = 0.2 * math.sqrt(DENSITY * VOLUME / STIFFNESS)
RECORDS = 200


def lens(r, d):
    return 2.0 * math.pi * (r - d / 2.0) ** 2 * (2.0 * r + d / 2.0) / 3.0


def pair():
    """Two spheres whose centres are one radius apart, of the volume of a single grain."""
    r = (VOLUME / (8.0 / 3.0 * math.pi - lens(1.0, 1.0))) ** (1.0 / 3.0)
    return [(-r / 2.0, 0.0, 0.0, r), (r / 2.0, 0.0, 0.0, r)]


def four():
    """Four in a tetrahedron, the void between them open; overlaps of three do not meet."""
    edge = 1.8
    r = (VOLUME / (16.0 / 3.0 * math.pi - 6.0 * lens(1.0, edge))) ** (1.0 / 3.0)
    s = edge * r / math.sqrt(8.0)
    return [(x * s, y * s, z * s, r) for x, y, z in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))]


def settle(name, settings, body=None):
    out = f"{settings['OUT']}_{name}"
    spheres = body or []
    (SCENE / f"{out}_body.txt").write_text("".join("%.17g %.17g %.17g %.17g\n" % s for s in spheres))
    edge = 8.5 * RADIUS
    fill = settings["N"] * VOLUME / (LOOSE * edge**2)
    steps = math.ceil(settings["TIME"] / DT)
    print(f"{name}: {steps} steps of {DT:.3g} s", flush=True)
    said, cpu = scene.liggghts(
        SCENE, "in.clumps",
        {"bodies": int(bool(body)), "orientation": "orientation random" if body else "",
         "N": settings["N"], "nspheres": max(1, len(spheres)), "body": f"{out}_body.txt", "r": RADIUS, "kn": STIFFNESS,
         "mu": settings["MU"], "L": edge, "H": fill + 3.0 * RADIUS, "fill": fill, "viscosity": settings["VISCOSITY"],
         "words": scene.fix_words(f"coupling {settings['COUPLING']} retriangulate mean 0.03", settings["FIX"]), "steps": steps, "every": max(1, steps // RECORDS),
         "report": max(1, steps // 20), "out": out,
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        out + "_run", scene.Progress(name, 1, 1 + steps, DT))
    rows = np.genfromtxt(SCENE / f"{out}_record.csv", delimiter=",", names=True)
    return {"name": name, "cpu": cpu, "rows": rows, "limit": float(said["end"][1])}


def solid_fraction(run, settings):
    """Of the whole bed at the end: grains lie as deep below their mean height as above the floor."""
    return settings["N"] * VOLUME / ((8.5 * RADIUS) ** 2 * 2.0 * run["rows"]["height"][-1])


def speed(run):
    """m/s at which the grains sink at first, over the first tenth of the way that they go."""
    time, height = run["rows"]["time"], run["rows"]["height"]
    gone = np.argmax(height < height[0] - 0.1 * (height[0] - height[-1]))
    return (height[0] - height[gone]) / (time[gone] - time[0])


def stretched(run, body, settings):
    """Largest change of a distance between two spheres of one body, over it."""
    lines = (SCENE / f"{settings['OUT']}_{run['name']}_last.dump").read_text().splitlines()[9:]
    places = np.array([line.split() for line in lines], dtype=float)[:, 2:5].reshape(-1, len(body), 3)
    shape = np.array(body)[:, :3]
    found, wanted = (np.sort(np.linalg.norm(x[..., :, None, :] - x[..., None, :, :], axis=-1).reshape(len(x), -1))
                     for x in (places, shape[None]))
    return float((abs(found - wanted) / wanted.max()).max())


def draw(runs, base):
    figure, axes = plt.subplots(figsize=(7, 4))
    for run in runs:
        axes.plot(run["rows"]["time"], 1e3 * run["rows"]["height"], label=run["name"])
    axes.set(xlabel="t, s", ylabel="mean height of the grains, mm")
    axes.legend()
    save_figure(figure, f"{base}_heights.png")


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 20 or settings["VISCOSITY"] <= 0 or settings["TIME"] <= 0:
        raise scene.BadSetting("N must be at least 20, VISCOSITY and TIME above 0")
    shapes = {"spheres": None, "pairs": pair(), "fours": four()}
    runs = [settle(name, settings, body) for name, body in shapes.items()]
    print(f"\nSettling: {settings['N']} grains, {settings['COUPLING']} coupling")
    for run in runs:
        print(f"  {run['name']:<8s} sink at {1e3 * speed(run):.2f} mm/s, solid fraction {solid_fraction(run, settings):.3f}, "
              f"R {DT / run['limit']:.2g}, CPU {run['cpu']:.0f} s")
    mass, force = (max(float(abs(run["rows"][name]).max()) for run in runs) for name in ("mass_error", "force_error"))
    bent = max(stretched(run, shapes[run["name"]], settings) for run in runs[1:])
    rows = [("distances within a body, largest change", bent, "<= 1e-9", bent <= 1e-9),
            ("mass error, largest", mass, "<= 1e-10", mass <= 1e-10),
            ("force-balance error, largest", force, "<= 1e-10", force <= 1e-10)]
    for run in runs[1:]:
        ratio = speed(run) / speed(runs[0])
        rows.append((f"{run['name']} / spheres, speed at first", ratio, "0.5 to 2", 0.5 <= ratio <= 2.0))
    draw(runs, SCENE / settings["OUT"])
    figures = {run["name"]: {"speed": speed(run), "solid_fraction": solid_fraction(run, settings),
                             "ratio": DT / run["limit"], "cpu": run["cpu"]} for run in runs}
    return scene.summary(SCENE, settings["OUT"], {**settings, **figures}, rows)


if __name__ == "__main__":
    scene.main("clumps", work)

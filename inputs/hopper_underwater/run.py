#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Beads leave a hopper: dry, under water with an open surface, and under a closed cover, where water has to rise
past them as they sink.

    run.py [KEY=VALUE...]      called by ./run.sh hopper_underwater [KEY=VALUE...]
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
    "N": (int, 600, "beads"),
    "SEED": scene.SEED,
    "MU": (float, 0.3, "friction between beads and with the hopper"),
    "VISCOSITY": (float, 0.25, "Pa s"),
    "TIME": (float, 0.8, "under the closed cover, s; twice that at twice the viscosity"),
    "STRAIN": (str, "mean 0.01", "pore strain at which the network is built anew"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS, DENSITY, GRAVITY = 2.5e-3, 1e3, 2500.0, 9.81  # m, N/m, kg/m3, m/s2
HEIGHT, OUTLET, TOP = 0.1, 0.015, 0.055  # m; half of the outlet's and of the top's side
BEAD = 4.0 / 3.0 * math.pi * RADIUS**3 * (0.9**3 + 1.0 + 1.1**3) / 3.0  # m3, of a mean bead
DT = 0.2 * math.sqrt(DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3 / STIFFNESS)
DRY, OPEN = 0.4, 0.1  # s
RECORDS = 200


def beverloo():
    """Beads a second through a square outlet (Beverloo et al. 1961, C = 0.58, k = 1.4), times Rose and Tanaka's
    factor for a steep hopper with beads that slip at 45 degrees in it."""
    side = 2.0 * OUTLET - 1.4 * 2.0 * RADIUS
    flat = 0.58 * 4.0 / math.pi * DENSITY * 0.58 * math.sqrt(GRAVITY) * side**2.5  # kg/s
    return flat * ((TOP - OUTLET) / HEIGHT) ** -0.35 / (DENSITY * BEAD)


def write_meshes(out):
    corner, edge = math.sqrt(2.0), OUTLET + 2.0 * RADIUS
    meshes.write_mesh(SCENE / f"{out}_hopper.stl", meshes.funnel(
        meshes.ring(4, OUTLET * corner, 0.0, start=0.5), meshes.ring(4, TOP * corner, HEIGHT, start=0.5)))
    meshes.write_mesh(SCENE / f"{out}_slide.stl", meshes.quad(
        (-edge, -edge, 0.0), (edge, -edge, 0.0), (edge, edge, 0.0), (-edge, edge, 0.0)))


def discharge(name, settings, seconds, viscosity=0.0, top="sealed"):
    """One run; dry without a viscosity."""
    out = f"{settings['OUT']}_{name}"
    write_meshes(out)
    steps = math.ceil(seconds / DT)
    print(f"{name}: {steps} steps of {DT:.3g} s", flush=True)
    settle = math.ceil(0.4 / DT)
    _, cpu = scene.liggghts(
        SCENE, "in.hopper_underwater",
        {"N": settings["N"], "r": RADIUS, "kn": STIFFNESS, "mu": settings["MU"], "H": HEIGHT + 0.001,
         "cover": HEIGHT - 1e-4, "half": TOP, "fill": OUTLET + 0.4 * (TOP - OUTLET), "wet": int(viscosity > 0.0),
         "top": top, "viscosity": viscosity,
         "words": scene.fix_words(f"retriangulate {settings['STRAIN']}", settings["FIX"]), "settle": settle, "steps": steps,
         "every": max(1, steps // RECORDS),
         "report": max(1, steps // 20), "out": out,
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        out + "_run", scene.Progress(name, settle, settle + steps, DT))
    rows = np.genfromtxt(SCENE / f"{out}_record.csv", delimiter=",", names=True)
    return {"name": name, "out": out, "cpu": cpu, "rows": rows, "begun": settings["N"], "beyond": beyond(out)}


def beyond(out):
    """Beads in the hopper whose centre is on the other side of one of its flats: none, if they hold."""
    lines = (SCENE / f"{out}_last.dump").read_text().splitlines()[9:]
    beads = np.array([line.split() for line in lines], dtype=float).reshape(-1, 6)
    inside = beads[beads[:, 4] > 0.0]
    side = OUTLET + (TOP - OUTLET) * inside[:, 4] / HEIGHT
    return int((abs(inside[:, 2:4]).max(axis=1, initial=0.0) > side).sum())


def times(run):
    """When the n-th bead left, n = 0, 1, ...: from the counts of the record, between its rows."""
    gone = run["begun"] - run["rows"]["count"]
    n = np.arange(int(gone.max()) + 1)
    last = len(gone) - 1 - np.argmax(gone[::-1] <= n[:, None], axis=1)  # the last row with no more than n gone
    return run["rows"]["time"][last]


def rate(run, low=5, part=0.6):
    """Beads a second, from the `low`-th to this part of those that left."""
    when = times(run)
    if len(when) <= 2 * low:
        raise scene.Failure(f"{run['name']}: {len(when) - 1} beads have left; raise TIME until {2 * low} have")
    high = int(part * (len(when) - 1))
    return (high - low) / (when[high] - when[low])


def slowing(thin, thick):
    """Ratio of the times at which as many beads have left, in the mean over the n-th beads from the fifth on."""
    a, b = times(thin), times(thick)
    n = slice(5, min(len(a), len(b)))
    return float((b[n] / a[n]).mean())


def draw(runs, base):
    figure, axes = plt.subplots(figsize=(7, 4))
    for run in runs:
        axes.plot(run["rows"]["time"], run["begun"] - run["rows"]["count"], label=run["name"].replace("_", " "))
    axes.set(xlabel="t, s", ylabel="beads that have left")
    axes.legend()
    save_figure(figure, f"{base}_beads.png")


def checks(dry, open_top, thin, thick):
    rates = {run["name"]: rate(run) for run in (dry, open_top, thin, thick)}
    wet = [run["rows"] for run in (open_top, thin, thick)]
    mass, force = (max(float(abs(rows[name]).max()) for rows in wet) for name in ("mass_error", "force_error"))
    outside = sum(run["beyond"] for run in (dry, open_top, thin, thick))
    to_theory, slower = rates["dry"] / beverloo(), slowing(thin, thick)
    rows = [
        ("dry / Beverloo's law in a steep hopper - 1", to_theory - 1, "within 0.3", abs(to_theory - 1) <= 0.3),
        ("open surface / dry, beads a second", rates["open"] / rates["dry"], "< 1", rates["open"] < rates["dry"]),
        ("closed cover / open surface, beads a second", rates["closed"] / rates["open"], "< 1",
         rates["closed"] < rates["open"]),
        ("times at twice the viscosity / at once", slower, "1 to 2.1", 1.0 < slower <= 2.1),
        ("beads beyond a flat of the hopper", outside, "0", outside == 0),
        ("mass error, largest", mass, "<= 1e-10", mass <= 1e-10),
        ("force-balance error, largest", force, "<= 1e-10", force <= 1e-10)]
    return rates, rows


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 200 or settings["VISCOSITY"] <= 0 or settings["TIME"] <= 0:
        raise scene.BadSetting("N must be at least 200, VISCOSITY and TIME above 0")
    viscosity, seconds = settings["VISCOSITY"], settings["TIME"]
    runs = [discharge("dry", settings, DRY), discharge("open", settings, OPEN, viscosity, "pressure 0"),
            discharge("closed", settings, seconds, viscosity),
            discharge("closed_thick", settings, 2.0 * seconds, 2.0 * viscosity)]
    rates, rows = checks(*runs)
    print(f"\nHopper: {settings['N']} beads, outlet {2e3 * OUTLET:g} mm wide; Beverloo {beverloo():.0f} beads/s")
    for run in runs:
        print(f"  {run['name']:<14s} {rates[run['name']]:7.0f} beads/s, {run['begun'] - run['rows']['count'][-1]:.0f} have left, "
              f"CPU {run['cpu']:.0f} s")
    draw(runs, SCENE / settings["OUT"])
    return scene.summary(SCENE, settings["OUT"], {**settings, "rates": rates}, rows)


if __name__ == "__main__":
    scene.main("hopper_underwater", work)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A sinusoidal pressure on a fixed bed against the harmonic solution (thesis eqs. 6.24-6.26).

    run.py [KEY=VALUE...]      called by ./run.sh wave_still [KEY=VALUE...]
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import bed
import fields
import scene
from plotting import plt, save_figure

KEYS = {
    "N": (str, "312,1250,5000", "grains, or a list of sizes"),
    "WIDTH": (float, 3.0, "of the bed across the wave, mean diameters"),
    "SEED": scene.SEED,
    "LAW": scene.LAW,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
LENGTH, DEPTH, AMPLITUDE = 2.0, 1.0, 1000.0  # m, m, Pa
WAVE = math.pi / LENGTH
LARGEST_RMS = 0.02  # of the amplitude at 5000 grains; README.md has what was measured


def size(grains, width):
    """Mean radius and width (m) of the bed: fills 0.64 of what the layers of grains along walls
    leave, which each lose a quarter of a radius."""
    radius = 0.05
    for _ in range(50):
        across = 2.0 * width * radius
        solid = 0.64 * (1.0 - 0.5 * radius * (1.0 / DEPTH + 1.0 / LENGTH + 1.0 / across))
        radius = (solid * LENGTH * DEPTH * across /
                  (grains * 4.0 / 3.0 * math.pi * bed.MEAN_CUBE)) ** (1.0 / 3.0)
    return radius, 2.0 * width * radius


def pressure(x, z):
    """z from the bottom up."""
    return AMPLITUDE * (1.0 + np.cosh(WAVE * z) / np.cosh(WAVE * DEPTH) * np.cos(WAVE * x))


def velocity(x, z, conductivity):
    """Darcy velocity for a conductivity K/mu."""
    scale = conductivity * WAVE * AMPLITUDE / np.cosh(WAVE * DEPTH)
    return (scale * np.cosh(WAVE * z) * np.sin(WAVE * x),
            -scale * np.sinh(WAVE * z) * np.cos(WAVE * x))


def one_size(grains, settings):
    radius, across = size(grains, settings["WIDTH"])
    out = f"{settings['OUT']}_{grains}"
    fields.clear(SCENE / f"{out}.pvd")
    print(f"bed of {grains} grains, mean diameter {2 * radius:.4f} m", flush=True)
    seeds = {f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}
    _, cpu = scene.liggghts(SCENE, "in.wave_still", {
        "N": grains, "r2": radius, "LY": across, "amplitude": AMPLITUDE,
        "words": scene.fix_words(f"conductance {settings['LAW']}", settings["FIX"]), "out": out, **seeds},
        out, scene.Progress("bed", 0, 12001, 0.0))
    box = (0.0, LENGTH, 0.0, across, 0.0, DEPTH)
    permeability = [scene.pfv_solve(
        SCENE, f"{out}.dump", box, 1.0, f"{out}_K.json", "--wall", "symmetry",
        "--conductance", settings["LAW"], "--face", f"{axis}lo:pressure=1",
        "--face", f"{axis}hi:pressure=0")["permeability"] for axis in "xz"]
    (_, pores, _), = fields.collection(SCENE / f"{out}.pvd")
    flow = fields.Fields(pores)
    return {"N": grains, "radius": radius, "width": across, "cpu": cpu,
            "permeability": permeability, "flow": flow, **errors(flow, permeability, across)}


def errors(flow, permeability, across):
    x, z = flow.points[:, 0], flow.points[:, 2]
    error = (flow["pressure"] - pressure(x, z)) / AMPLITUDE
    # Through vertical planes. Between two pores on the face, whose pressures are both imposed, the
    # flow is one along the face, not through the bed.
    inside = ~flow.imposed()[flow.ends].all(axis=1)
    places = np.linspace(0.1, 0.9, 17) * LENGTH
    exact = (permeability[0] * AMPLITUDE * across * np.tanh(WAVE * DEPTH) * np.sin(WAVE * places))
    measured = np.array([flow.plane_flux(0, place, inside) for place in places])
    return {"rms": float(np.sqrt(np.mean(error**2))), "largest": float(abs(error).max()),
            "flux_rms": float(np.sqrt(np.mean((measured - exact)**2)) / exact.max())}


def draw_fields(result, base):
    flow, across = result["flow"], result["width"]
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.6), sharey=True)
    x, z = np.meshgrid(np.linspace(0, LENGTH, 201), np.linspace(0, DEPTH, 101))
    levels = np.linspace(0.1, 1.9, 10)
    left.tricontour(flow.points[:, 0], flow.points[:, 2], flow["pressure"] / AMPLITUDE, levels,
                    colors="C0", linewidths=0.8)
    left.contour(x, z, pressure(x, z) / AMPLITUDE, levels, colors="k", linestyles="dashed",
                 linewidths=1.0)
    left.set(xlabel="x, m", ylabel="z, m", xlim=(0, LENGTH), ylim=(0, DEPTH),
             title="p / A: pores (blue), harmonic (dashed)")
    edges = [np.linspace(0, LENGTH, 17), np.array([-1.0, across + 1.0]), np.linspace(0, DEPTH, 9)]
    block = LENGTH / 16 * across * DEPTH / 8
    blocks = flow.darcy_velocity(edges, block)[:, 0]
    middle = np.meshgrid((edges[0][1:] + edges[0][:-1]) / 2, (edges[2][1:] + edges[2][:-1]) / 2,
                         indexing="ij")
    exact = velocity(*middle, result["permeability"][0])
    unit = dict(angles="xy", scale_units="xy", scale=np.hypot(*exact).max() * 8, width=0.004)
    right.quiver(*middle, *exact, color="0.6", **unit)
    right.quiver(*middle, blocks[..., 0], blocks[..., 2], color="C0", **unit)
    right.set(xlabel="x, m", title="Darcy velocity: throats (blue), eqs. 6.25-6.26 (grey)")
    figure.suptitle(f"{result['N']} grains")
    save_figure(figure, f"{base}_fields.png", dpi=100)


def draw_errors(results, base):
    figure, axes = plt.subplots(figsize=(5, 3.6))
    sizes = [result["N"] for result in results]
    for name, label in (("rms", "pressure, rms"), ("flux_rms", "flow through planes, rms")):
        axes.loglog(sizes, [100 * result[name] for result in results], "o-", label=label)
    axes.loglog(sizes, [100 * results[-1]["rms"] * (sizes[-1] / n)**0.5 for n in sizes], "k:",
                label="N^(-1/2), as the diameter")
    axes.set(xlabel="grains", ylabel="error, %")
    axes.legend()
    save_figure(figure, f"{base}_errors.png", dpi=100)


def work(words):
    settings = scene.parse(words, KEYS)
    sizes = scene.numbers(settings, "N", int)
    if min(sizes) < 100 or settings["WIDTH"] < 1.5:
        raise scene.BadSetting("N must be at least 100 and WIDTH 1.5")
    results = [one_size(grains, settings) for grains in sizes]
    base = SCENE / settings["OUT"]
    print(f"\nWave on a fixed bed {settings['WIDTH']:g} diameters wide")
    print("      N   rms of p / A   largest   flow through planes, rms   CPU, s")
    for r in results:
        print(f"  {r['N']:5d} {100 * r['rms']:11.2f} % {100 * r['largest']:8.1f} % "
              f"{100 * r['flux_rms']:18.1f} % {r['cpu']:16.1f}")
    last = results[-1]
    # in a bed of a given number of diameters across, the diameter goes with N^(-1/2), and so does
    # the depth at which the pores on the face end
    bound = LARGEST_RMS * (5000 / last["N"]) ** 0.5
    rows = [("pressure: rms difference from harmonic / amplitude", last["rms"],
             f"<= {bound:.3g} at {last['N']}", last["rms"] <= bound)]
    if len(results) > 1:
        rows.append(("the same, over that of the smallest sample", last["rms"] / results[0]["rms"],
                     "< 1", last["rms"] < results[0]["rms"]))
        draw_errors(results, base)
    draw_fields(last, base)
    for r in results:
        del r["flow"]
    return scene.summary(SCENE, settings["OUT"], {"sizes": results}, rows)


if __name__ == "__main__":
    scene.main("wave_still", work)

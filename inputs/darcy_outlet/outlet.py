# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures and promises of the runs through the hole."""
import re

import numpy as np

import scene
from fields import Fields
from plotting import plt, save_figure

BOX = np.array([0.1, 0.2, 0.1])  # m
BINS = (10, 20, 10)


def record(folder, run):
    return np.genfromtxt(folder / f"{run['out']}_record.csv", delimiter=",", names=True)


def snapshots(folder, run, kind):
    """Files of a kind with their steps, in order of time."""
    name = (folder / run["out"]).name
    found = []
    for path in (folder / run["out"]).parent.iterdir():
        match = re.fullmatch(rf"{name}_{kind}[._](\d+)\.(?:txt|vtu)", path.name)
        if match:
            found.append((int(match[1]), path))
    return sorted(found)


def grains(path):
    """Columns id, x, y, z, radius, vx, vy, vz."""
    return np.loadtxt(path, skiprows=9, ndmin=2)


def displacements(folder, run):
    """Places at the end and displacement of the grains that are still there."""
    (_, first), *_, (_, last) = [(s, p) for s, p in snapshots(folder, run, "grains")
                                 if p.suffix == ".txt"]
    before, after = grains(first), grains(last)
    _, i, j = np.intersect1d(before[:, 0], after[:, 0], return_indices=True)
    return after[j, 1:4], np.linalg.norm(after[j, 1:4] - before[i, 1:4], axis=1)


def shares(places):
    """Cells of the coarse grid around each place with their shares: a place between two cells
    belongs to both."""
    low, weight = [], []
    for k in range(3):
        at = np.clip(places[:, k] / BOX[k] * BINS[k] - 0.5, 0, BINS[k] - 1)
        low.append(np.minimum(at.astype(int), BINS[k] - 2))
        weight.append(at - low[-1])
    for corner in np.ndindex(2, 2, 2):
        share = np.ones(len(places))
        for k in range(3):
            share = share * (weight[k] if corner[k] else 1 - weight[k])
        yield tuple(low[k] + corner[k] for k in range(3)), share


def nearest(points, values, places):
    return np.array([values[np.argmin(((points - place)**2).sum(axis=1))] for place in places])


def coarse_fields(folder, run, row):
    """In the middle plane z = 0.05: the pressure, and the velocity (flow rate over total area) as
    components along y and x. Those of the cells; or the pressure of the nearest pore, and the sum
    over the throats in a cell of flow rate times length, over the cell's volume."""
    middle = slice(BINS[2] // 2 - 1, BINS[2] // 2 + 1)
    if run["model"] == "darcy_grid":
        data = Fields(snapshots(folder, run, "cells")[row][1]).cells
        velocity = data["velocity"].reshape(*BINS[::-1], 3).transpose(2, 1, 0, 3)
        pressure = data["pressure"].reshape(BINS[::-1]).T[:, :, middle].mean(axis=2)
    else:
        pores = Fields(snapshots(folder, run, "pores")[row][1])
        rows, columns = np.indices((4 * BINS[0], 4 * BINS[1]))
        places = np.stack([(rows.ravel() + 0.5) * BOX[0] / rows.shape[0],
                           (columns.ravel() + 0.5) * BOX[1] / rows.shape[1],
                           np.full(rows.size, 0.05)], axis=1)
        near = abs(pores.points[:, 2] - 0.05) < 2.5 * run["radius"]
        pressure = nearest(pores.points[near], pores["pressure"][near], places).reshape(rows.shape)
        start = pores.points[pores.ends[:, 0]]
        way = pores.points[pores.ends[:, 1]] - start
        velocity = np.zeros((*BINS, 3))
        for part in (np.arange(4) + 0.5) / 4:
            for cell, share in shares(start + part * way):
                np.add.at(velocity, cell, (0.25 * share * pores.flux)[:, None] * way)
        velocity /= BOX.prod() / np.prod(BINS)
    return pressure, velocity[:, :, middle, 1].mean(axis=2), velocity[:, :, middle, 0].mean(axis=2)


def draw(folder, settings, runs):
    figure, axes = plt.subplots(3, len(runs), figsize=(5.6 * len(runs), 8.5), squeeze=False)
    x = (np.arange(BINS[0]) + 0.5) * BOX[0] / BINS[0]
    y = (np.arange(BINS[1]) + 0.5) * BOX[1] / BINS[1]
    for column, run in enumerate(runs):
        (top, middle, bottom) = axes[:, column]
        places, moved = displacements(folder, run)
        cut = abs(places[:, 2] - 0.05) < 1.2 * run["radius"]
        order = np.argsort(moved[cut])
        shown = top.scatter(places[cut, 1][order], places[cut, 0][order],
                            c=1e3 * moved[cut][order], s=(1.1e4 * run["radius"])**2 / 35,
                            cmap="viridis")
        top.set_title(f"{run['model']}: {run['left']} of {run['grains']} grains out "
                      f"after {run['steps'] * run['time_step']:.2f} s")
        figure.colorbar(shown, ax=top, label="displacement, mm")
        pressure, u, v = coarse_fields(folder, run, 0)
        arrows = middle.quiver(*np.meshgrid(y, x), u, v, 1e3 * np.hypot(u, v), cmap="plasma",
                               scale=0.2)
        figure.colorbar(arrows, ax=middle, label="discharge at t = 0, mm/s")
        picture = bottom.imshow(pressure, origin="lower", extent=(0, 0.2, 0, 0.1), cmap="coolwarm")
        figure.colorbar(picture, ax=bottom, label="pressure at t = 0, Pa")
        for part in axes[:, column]:
            part.set(xlabel="y, m", ylabel="x, m", aspect="equal", xlim=(0, 0.21))
    save(figure, folder, settings, "fields")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    for run in runs:
        rows = record(folder, run)
        left.plot(rows["time"], run["grains"] - rows["grains"], label=run["model"])
        right.semilogy(rows["time"], np.maximum(abs(rows["mass_error"]), 1e-18), label=run["model"])
    left.set(xlabel="t, s", ylabel="grains out")
    right.set(xlabel="t, s", ylabel="|inflow - outflow| / inflow")
    for part in (left, right):
        part.grid(alpha=0.3)
        part.legend()
    save(figure, folder, settings, "out")


def save(figure, folder, settings, name):
    save_figure(figure, folder / f"{settings['OUT']}_{name}.png", dpi=110)


def measure(folder, run):
    rows = record(folder, run)
    run.update(mass_error_max=float(abs(rows["mass_error"]).max()),
               inflow_error_max=float(abs(rows["inflow"] / run["flux"] - 1).max()),
               force_balance_error_first=float(rows["force_balance_error"][0]),
               force_balance_error_max=float(rows["force_balance_error"].max()),
               mean_pressure_first=float(rows["mean_pressure"][0]),
               mean_pressure_last=float(rows["mean_pressure"][-1]),
               rebuilt=int(rows["rebuilt"][-1]),
               first_out=None)
    gone = rows["time"][rows["grains"] < run["grains"]]
    if len(gone):
        run["first_out"] = float(gone[0])


def judge(run):
    name = run["model"]
    rows = [(f"{name}: |inflow - outflow| / inflow, largest", run["mass_error_max"], "< 1e-10",
             run["mass_error_max"] < 1e-10),
            (f"{name}: |inflow / given - 1|, largest", run["inflow_error_max"], "< 1e-10",
             run["inflow_error_max"] < 1e-10)]
    return rows


def analyse(folder, settings, runs):
    checks = []
    for run in runs:
        run["flux"] = settings["FLUX"]
        measure(folder, run)
        checks += judge(run)
    out = sum(run["left"] for run in runs)
    checks.append(("grains out and counted, all runs", out, ">= 1", out >= 1))
    draw(folder, settings, runs)
    print(f"\nDarcy outlet, {runs[0]['grains']} grains, "
          f"{runs[0]['steps'] * runs[0]['time_step']:.2f} s")
    lines = [("grains out", "left", "{:d}"), ("mean pressure at first, Pa", "mean_pressure_first",
             "{:.4g}"), ("at the end, Pa", "mean_pressure_last", "{:.4g}"),
             ("first grain out after, s", "first_out", "{:.3g}"),
             ("balance of forces, at first", "force_balance_error_first", "{:.1e}"),
             ("largest", "force_balance_error_max", "{:.1e}"),
             ("networks or renewals of the porosity", "rebuilt", "{:d}"), ("CPU seconds", "cpu",
             "{:.1f}")]
    print(f"  {'':36s}" + "".join(f"{run['model']:>14s}" for run in runs))
    for title, key, form in lines:
        print(f"  {title:36s}" + "".join(
            f"{'-' if run[key] is None else form.format(run[key]):>14s}" for run in runs))
    return scene.summary(folder, settings["OUT"], {"settings": settings, "runs": runs}, checks)

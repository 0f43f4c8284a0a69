# SPDX-License-Identifier: GPL-3.0-or-later
"""Consolidation of a layer as uneven as the sample, to tell the sample's unevenness from an error.

Terzaghi's sample is uniform. Ours is ten to sixteen grains high, its permeability and stiffness
change with height, and the pores that touch a drained plate have the plate's pressure, so that the
first layer of grains gives off its water at once. Two measurements at rest hold all of that: the
pressures of the steady flow give the share R(z) of the resistance below z, the displacements of the
dry test the share C(z) of the settlement below z. The one-dimensional equation
    dC/dR dp/dT_v = 1/4 d2p/dR2,   p = 0 at R = 0 and 1,   p = load at T_v = 0,
then has no parameter left; for R = C = z/H it is Terzaghi's."""
import numpy as np


def columns(path):
    """Rows of a dump with one snapshot, sorted by id."""
    rows = np.loadtxt(path, skiprows=9)
    return rows[np.argsort(rows[:, 0])]


def resistance(base):
    """z/H of the planes and the share of the flow's resistance below each."""
    with open(base.parent / f"{base.name}_steady.csv") as file:
        heights = np.array([float(word) for word in file.readline().split(",")[1:]])
        p = np.array([float(word) for word in file.readline().split(",")[1:]]) / 1.0e6
    return heights, np.maximum.accumulate(np.clip(1.0 - p, 0.0, 1.0))


def compliance(base, figures, heights):
    """Share of the dry settlement below each relative height: displacement of the grains that the
    plane cuts, weighted by the area of the cut. Grains that nothing holds are left out."""
    before = columns(base.parent / f"{base.name}.dump")
    after = columns(base.parent / f"{base.name}_loaded.dump")
    z, radius = before[:, 4], before[:, 5]
    settlement = figures["dry_strain"] * figures["height"]
    moved = (before[:, 4] - after[:, 4] + figures["loaded_bottom"]) / settlement
    distance = abs(moved - z / figures["height"])
    held = distance < 6 * np.median(distance)
    share = []
    for plane in heights * figures["height"]:
        area = np.maximum(radius[held]**2 - (z[held] - plane)**2, 0.0)
        share.append(area @ moved[held] / area.sum())
    return np.maximum.accumulate(np.clip(share, 0.0, 1.0))


def consolidate(R, C, times):
    """p/load at the planes (rows: times) and U, by backward Euler on slabs around the planes."""
    edges = np.concatenate([[0.0], (C[1:] + C[:-1]) / 2, [1.0]])
    storage = np.diff(edges)
    conductance = 1 / np.maximum(np.diff(np.concatenate([[0.0], R, [1.0]])), 1e-9)
    matrix = (np.diag(conductance[:-1] + conductance[1:]) - np.diag(conductance[1:-1], 1)
              - np.diag(conductance[1:-1], -1)) / 4
    p, rows = np.ones(len(R)), []
    for step in np.diff(np.concatenate([[0.0], times])):
        for _ in range(4):
            p = np.linalg.solve(np.diag(storage) + step / 4 * matrix, storage * p)
        rows.append(p)
    rows = np.array(rows)
    return rows, 1 - rows @ storage


def predict(base, figures):
    """z/H of the planes, T_v, p/load (rows: times) and U of the uneven layer."""
    heights, R = resistance(base)
    times = np.concatenate([np.logspace(-5, -2, 60), np.linspace(0.01, 3.0, 600)[1:]])
    p, U = consolidate(R, compliance(base, figures, heights), times)
    return heights, times, p, U

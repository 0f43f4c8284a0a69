# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertical effective stress from the contact forces of LIGGGHTS' dumps."""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))
import contact_stress


def read(path):
    """Columns of a dump with one snapshot."""
    return np.loadtxt(path, skiprows=9)


def vertical_moments(base, step):
    """z, radius and V sigma_zz of each grain: sum of -x_z F_z over its contacts and walls (thesis
    eq. 2.18), compression positive."""
    grains = read(base.parent / f"{base.name}_grains.{step}.txt")
    grains = grains[np.argsort(grains[:, 0])]
    contacts = read(base.parent / f"{base.name}_contacts.{step}.txt")
    moments = contact_stress.vertical_moments(grains[:, 0], grains[:, 1], grains[:, 2], contacts,
                                              grains[:, 3])
    return grains[:, 1], grains[:, 2], moments


def increments(base, steps, edges, area):
    """Change of sigma_zz between two steps, averaged over horizontal slices; each grain shares
    itself among them by its volume at the first step. The mean over the grains times (1 - n) is the
    sum of V sigma over the slice's volume."""
    z, radius, before = vertical_moments(base, steps[0])
    _, _, after = vertical_moments(base, steps[1])
    below = np.array([contact_stress.share_below(z, radius, height) for height in edges])
    below[0], below[-1] = 0.0, 1.0
    return (np.diff(below, axis=0) @ (after - before)) / (np.diff(edges) * area)


def profile(run, T_v, area=0.01):
    """Relative heights, effective and total stress increments at about T_v, divided by the load."""
    f = run.figures
    slices = round(run.rest_height / (1.1e-2 * (1000 / f["N"]) ** (1 / 3)))  # one grain high
    edges = np.linspace(0.0, run.rest_height, slices + 1)
    steps = max(1, round(T_v * f["unit"] / f["time_step"] / f["stride"])) * f["stride"]
    effective = increments(run.base, (f["rest_to"], f["rest_to"] + steps), edges, area) / run.load
    heights = (edges[1:] + edges[:-1]) / 2 / run.rest_height
    p, _ = run.at(steps * f["time_step"] / f["unit"])
    return heights, effective, effective + np.interp(heights, run.heights, p)

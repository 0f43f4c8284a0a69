# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertical effective stress from contact forces (thesis eqs. 2.18, 2.19)."""
import numpy as np


def vertical_moments(ids, z, radius, contacts, wall_force):
    """V sigma_zz of each grain: the sum of -x_z F_z over its contacts and walls, compression
    positive. contacts: rows id, id, ..., vertical force on the first; wall_force: vertical force of
    horizontal walls on each grain."""
    order = np.argsort(ids)
    moment = radius * abs(wall_force)
    if len(contacts) == 0:
        return moment
    first = order[np.searchsorted(ids[order], contacts[:, 0])]
    second = order[np.searchsorted(ids[order], contacts[:, 1])]
    # The contact lies on the line of centres, so that arms are in proportion to the radii.
    arm = (z[second] - z[first]) / (radius[first] + radius[second])
    force = contacts[:, -1]
    np.add.at(moment, first, -arm * radius[first] * force)
    np.add.at(moment, second, -arm * radius[second] * force)
    return moment


def share_below(z, radius, height):
    """Part of each sphere's volume below a height."""
    depth = np.clip((height - z + radius) / radius, 0.0, 2.0)
    return depth**2 * (3 - depth) / 4


def slices(z, radius, moments, edges, area):
    """sigma_zz averaged over horizontal slices; each grain shares itself among them by its volume.
    The mean over the grains times (1 - n) is the sum of V sigma over the slice's volume."""
    below = np.array([share_below(z, radius, height) for height in edges])
    return np.diff(below, axis=0) @ moments / (np.diff(edges) * area)

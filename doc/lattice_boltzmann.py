# SPDX-License-Identifier: GPL-3.0-or-later
"""Stokes flow through spheres in a cylinder or a square duct by a lattice-Boltzmann method, for doc/containers.py.

D3Q19 with two relaxation times and walls half-way between nodes (Ginzburg, Verhaeghe & d'Humieres 2008, Communications in
Computational Physics 3, 427): independent of the pores, and of any mesh.
"""
import numpy as np

AXES = [sign * np.eye(3, dtype=int)[axis] for axis in range(3) for sign in (1, -1)]
EDGES = [a + b for a in AXES for b in AXES if a @ b == 0 and tuple(np.nonzero(a)[0]) < tuple(np.nonzero(b)[0])]
LINKS = np.array([np.zeros(3, dtype=int), *AXES, *EDGES])
WEIGHTS = np.array([1 / 3] + [1 / 18] * 6 + [1 / 36] * 12)
BACK = np.array([int(np.nonzero((LINKS == -link).all(axis=1))[0][0]) for link in LINKS])
PAIRS = [(i, BACK[i]) for i in range(1, 19) if i < BACK[i]]
VISCOSITY, PUSH = 1 / 6, 1e-6  # relaxation time 1; body force, small enough for no inertia to be seen
ODD_RATE = 1.0 / (0.5 + 3.0 / 16.0 / 0.5)  # walls half-way whatever the viscosity
GAP = 0.1  # of open tube before and behind the bed, over the diameter
STEADY = 2e-4  # change of K in 200 steps


def fluid_nodes(spheres, radius, height, nodes, square):
    """Where there is fluid, x by y by z, and the spacing, m."""
    spacing = 2.0 * radius / nodes
    gap = GAP * 2.0 * radius
    across = (np.arange(nodes + 2) - nodes / 2 - 0.5) * spacing
    along = (np.arange(round((height + 2.0 * gap) / spacing)) + 0.5) * spacing - gap
    x, y, z = np.meshgrid(across, across, along, indexing="ij")
    fluid = np.maximum(abs(x), abs(y)) < radius if square else np.hypot(x, y) < radius
    for a, b, c, r in spheres:
        fluid &= (x - a)**2 + (y - b)**2 + (z - c)**2 > r * r
    return fluid, spacing


def sources(fluid):
    """Of each link and node: the place in the array of populations that streams there; at a wall its own, turned back."""
    count = int(fluid.sum())
    number = -np.ones(fluid.shape, dtype=int)
    number[fluid] = np.arange(count)
    places, own = np.argwhere(fluid), np.arange(count)
    found = np.empty((19, count), dtype=np.int64)
    for i, link in enumerate(LINKS):
        from_place = places - link
        from_place[:, 2] %= fluid.shape[2]
        neighbour = number[tuple(from_place.T)]
        found[i] = np.where(neighbour >= 0, i * count + neighbour, BACK[i] * count + own)
    return found


def collide(populations):
    """One step of relaxation under PUSH along z, and the momenta along z."""
    density = populations.sum(axis=0)
    momenta = LINKS.T.astype(float) @ populations
    momenta[2] += 0.5 * PUSH
    after = np.empty_like(populations)
    after[0] = WEIGHTS[0] * density
    for i, back in PAIRS:
        odd = 0.5 * (populations[i] - populations[back])
        even = WEIGHTS[i] * density
        turn = odd - ODD_RATE * (odd - 3.0 * WEIGHTS[i] * (LINKS[i] @ momenta))
        turn += 3.0 * WEIGHTS[i] * LINKS[i, 2] * PUSH * (1.0 - 0.5 * ODD_RATE)
        after[i], after[back] = even + turn, even - turn
    return after, momenta[2]


def permeability(spheres, radius, height, nodes=48, square=False):
    """Of spheres (x, y, z, radius) between z = 0 and `height` in a no-slip cylinder about z, or in the square duct around
    it, m²; `nodes` across."""
    fluid, spacing = fluid_nodes(spheres, radius, height, nodes, square)
    streams = sources(fluid)
    populations = np.repeat(WEIGHTS[:, None], fluid.sum(), axis=1)
    section = (4.0 if square else np.pi) * radius**2
    last = found = 0.0
    while not last or abs(found - last) > STEADY * found:
        last = found
        for _ in range(200):
            populations, speed = collide(populations)
            populations = populations.ravel()[streams]
        # the flux through each section, and all of the push on the bed
        flux = speed.sum() / fluid.shape[2] * spacing**2
        found = VISCOSITY * flux / section / (PUSH * fluid.shape[2] * spacing / height) * spacing**2
    return found

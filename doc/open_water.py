#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of doc/open_water.md:  doc/open_water.py [BUILD]

The drag of one sphere at random places in tanks of many sizes, and how fast spheres of periodic clouds move under a force
on each alone. A few seconds; needs the Python module.
"""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
sys.path.insert(0, str(BUILD / "python"))
import numpy as np
import pfv

PLACES, SPHERES = 250, 60
OPENINGS = (("zhi",), ("xlo", "xhi"), ("xhi", "zhi"), ("ylo",))
FRACTIONS = (0.01, 0.05, 0.1, 0.2, 0.3)
VARIANTS = ({"open_water": False}, {}, {"shear_viscous": True})


def drags(box, places, radius, movers, **options):
    """Forces on all spheres, over Stokes' drag, as each of the movers goes along x, y and z: 3 N x 3 movers."""
    flow = pfv.Flow(box, pfv.Fluid(viscosity=1.0), **options)
    columns = []
    for mover in movers:
        for axis in range(3):
            velocities = np.zeros_like(places)
            velocities[mover, axis] = 1.0
            columns.append(-np.array(flow.evaluate(places, np.full(len(places), radius), velocities=velocities,
                                                   dt=1e-6)).reshape(-1))
    found = np.array(columns).T / (6.0 * np.pi * radius)
    return 0.5 * (found + found.T) if len(movers) == len(places) else found


def alone(wall, **options):
    random, found = np.random.default_rng(7), []
    for place in range(PLACES):
        edges = 350.0 + 150.0 * random.uniform(-1.0, 1.0, 3)
        box = pfv.Box([[0.0, edge] for edge in edges], wall=wall)
        for face in OPENINGS[place % len(OPENINGS)]:
            box.face(face, pressure=0.0)
        drag = drags(box, (edges * random.uniform(0.1, 0.9, 3))[None, :], 1.0, [0], **options)
        found += list(np.linalg.eigvalsh(0.5 * (drag + drag.T)))
    return min(found), max(found)


def cloud(fraction, seed=1):
    random, radius, places = np.random.default_rng(seed), (fraction / (4.0 / 3.0 * np.pi * SPHERES))**(1.0 / 3.0), []
    while len(places) < SPHERES:
        place = random.uniform(0.0, 1.0, 3)
        apart = np.array(places).reshape(-1, 3) - place
        apart -= np.round(apart)
        if not len(places) or (apart**2).sum(axis=1).min() > 4.0 * radius**2:
            places.append(place)
    return np.array(places), radius


def mobility(fraction, **options):
    """Mean over the spheres; what all do together, which nothing resists, is left out."""
    places, radius = cloud(fraction)
    values = np.linalg.eigvalsh(drags(pfv.Box([[0, 1]] * 3, periodic="xyz"), places, radius, range(SPHERES), **options))
    return (1.0 / values[values > 1e-8]).sum() / len(values)


def main():
    print("drag of one sphere over Stokes', smallest and largest")
    for wall in ("symmetry", "no_slip"):
        for options in VARIANTS[:2]:
            print(f"  {wall:<9s} {str(options):<24s} {'%.3f %.3f' % alone(wall, **options)}")
    print("mobility over Stokes'", *VARIANTS)
    for fraction in FRACTIONS:
        print(f"  {fraction:<5g}", *(f"{mobility(fraction, **options):8.2f}" for options in VARIANTS))


main()

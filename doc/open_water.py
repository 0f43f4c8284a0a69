#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of doc/open_water.md:  doc/open_water.py [BUILD]

The drag of one sphere at random places in tanks of many sizes, that off the axis of a tube of flats, and how fast spheres of
periodic clouds move under a force on each alone. Half a minute; needs the Python module.
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
OFF_AXIS, SIDES, SMALL = (0.0, 0.4, 0.6, 0.8), (8, 16, 32, 62), 0.02
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


# The regular part of a Stokeslet's flow in a no-slip tube (R = 1, mu = 1): transforms along the axis and around it.
STEPS = np.arange(0.0, 14.0, 0.06)


def k_bessel(order, x):
    weights = np.full(STEPS.size, 0.06)
    weights[0] *= 0.5
    return (np.exp(-x[:, None] * np.cosh(STEPS)) * np.cosh(order * STEPS) * weights).sum(axis=1)


def log_i_bessel(x, most):
    """Of exp(-x) I_n(x), n = 0 ... most, from their ratios by downward recurrence."""
    ratios = np.zeros(int(most + 30 + 10 * x**0.5 + x) + 2)
    for n in range(len(ratios) - 2, -1, -1):
        ratios[n] = 1.0 / (2.0 * (n + 1) / x + ratios[n + 1])
    turn = (np.arange(4000) + 0.5) * np.pi / 4000
    first = np.log(np.exp(x * (np.cos(turn) - 1.0)).mean())
    return first + np.concatenate([[0.0], np.cumsum(np.log(ratios[:most]))])


def modes_at(r, k, n, inside, wall):
    """Velocities (r, theta, z) at r of three solutions of Stokes' equations ~ exp(i (n theta + k z)) (Happel & Brenner 1983,
    section 3-3), over I_n(k)."""
    value, up, down = (np.exp(inside[m] - wall[abs(n)] + k * (r - 1.0)) for m in (abs(n), abs(n) + 1, abs(abs(n) - 1)))
    slope = 0.5 * (up + down)
    second = (1.0 + (n / (k * r))**2) * value - slope / (k * r)
    return np.array([[k * slope, 1j * n / r * value, r * k * k * second],
                     [1j * n / r * value, -k * slope, 1j * n * (k * slope - value / r)],
                     [1j * k * value, 0.0, 1j * k * (r * k * slope + value)]])


def stokeslet_on_tube(k, x, y):
    """Transforms along z of a Stokeslet's flow, times 8 pi: for forces along x, y, z a column each."""
    s = np.hypot(x, y)
    k0, k1 = k_bessel(0, k * s), k_bessel(1, k * s)
    return [(2 * k0 + 2 * k * x * x * k1 / s, 2 * k * x * y * k1 / s, -2j * k * x * k0),
            (2 * k * x * y * k1 / s, 2 * k0 + 2 * k * y * y * k1 / s, -2j * k * y * k0),
            (-2j * k * x * k0, -2j * k * y * k0, 4 * k0 - 2 * k * s * k1)]


def slopes_in_tube(off):
    """c of the mobility 1 - c r/R towards the wall, around and along a tube, `off` R off its axis, to first order in r/R."""
    place, most = max(off, 1e-3), int(8 + 9 / (1 - off))
    theta = 2.0 * np.pi * np.arange(1024) / 1024
    nodes, weights = np.polynomial.legendre.leggauss(160)
    scale, t = 1.5 / (1.0 - off), 0.5 * (nodes + 1.0)
    waves, widths = scale * t**2 / (1 - t), scale * (2 * t * (1 - t) + t**2) / (1 - t)**2 * 0.5 * weights
    sums = np.zeros(3)
    for k, width in zip(waves, widths):
        if k * (1 - off) > 40.0:
            continue
        inside, wall = log_i_bessel(k * place, most + 2), log_i_bessel(k, most + 2)
        for axis, (ux, uy, uz) in enumerate(stokeslet_on_tube(k, np.cos(theta) - off, np.sin(theta))):
            around = [np.fft.fft(u) / theta.size for u in (ux * np.cos(theta) + uy * np.sin(theta),
                                                         uy * np.cos(theta) - ux * np.sin(theta), uz + 0j)]
            for n in range(-most, most + 1):
                on_wall = np.linalg.lstsq(modes_at(1.0, k, n, wall, wall), -np.array([u[n] for u in around]), rcond=None)[0]
                sums[axis] += width * (modes_at(place, k, n, inside, wall) @ on_wall)[axis].real / np.pi
    return -0.75 * sums


def slopes_in_prism(off, sides):
    """The same as this program has them, for a small grain in front of the middle of a side."""
    planes = [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": 0}, {"name": "top", "inward_normal": [0, 0, -1], "offset": -20}]
    planes += [{"name": f"side{i}", "inward_normal": [-np.cos(a), -np.sin(a), 0.0], "offset": -1.0}
               for i, a in enumerate(2.0 * np.pi * np.arange(sides) / sides)]
    box = pfv.Container({"planes": planes}).face("top", pressure=0.0)
    drag = drags(box, np.array([[off, 0.0, 10.0]]), SMALL, [0])
    return (1.0 - 1.0 / np.diag(drag)) / SMALL


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
    print("1 - c r/R in a tube, towards the wall, around, along; of flats over it")
    for off in OFF_AXIS:
        exact = slopes_in_tube(off)
        print(f"  {off:<4g}", *(f"{c:7.4f}" for c in exact), *(
            f"  {sides}: " + " ".join(f"{c:.2f}" for c in slopes_in_prism(off, sides) / exact) for sides in SIDES))
    print("mobility over Stokes'", *VARIANTS)
    for fraction in FRACTIONS:
        print(f"  {fraction:<5g}", *(f"{mobility(fraction, **options):8.2f}" for options in VARIANTS))


main()

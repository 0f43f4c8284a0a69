# SPDX-License-Identifier: GPL-3.0-or-later
"""Data files of the five samples, each made once, and the same grains with other numbers."""
import functools
import math
import random
import re
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
sys.path.insert(0, str(SCENE.parent / "oedometer"))
import oedometer  # noqa: E402
import scene  # noqa: E402

DENSITY = 2600.0


def write_data(name, grains, box, types=1, renumbered=None):
    """post/NAME.data of rows type, x, y, z, radius; `renumbered`: seed of a permutation of numbers and rows."""
    order = list(range(len(grains)))
    if renumbered is not None:
        random.Random(renumbered).shuffle(order)
    lines = ["grains", "", f"{len(grains)} atoms", f"{types} atom types", ""]
    lines += [f"{low!r} {high!r} {axis}lo {axis}hi" for axis, (low, high) in zip("xyz", box)] + ["", "Atoms", ""]
    for number, k in enumerate(order, 1):
        kind, x, y, z, r = grains[k]
        lines.append(f"{number} {int(kind)} {2 * r!r} {DENSITY} {x!r} {y!r} {z!r}")
    path = SCENE / "post" / f"{name}{'' if renumbered is None else '_renumbered'}.data"
    path.write_text("\n".join(lines) + "\n")
    return f"post/{path.name}"


def read_rest(path):
    """Rows type, x, y, z, radius of a dump, by number."""
    return [[float(word) for word in row.split()[1:6]] for row in sorted(
        path.read_text().splitlines()[9:], key=lambda row: int(row.split()[0]))]


def cloud(across, up, step, size, rng):
    """A jittered grid: `size` of the step is the mean diameter."""
    return [[1] + [(n + 0.5 + rng.uniform(-0.05, 0.05)) * step for n in place] +
            [0.5 * size * step * rng.uniform(0.9, 1.1)]
            for place in ((i, j, k) for i in range(across) for j in range(across) for k in range(up))]


@functools.cache
def outlet():
    """The lattice of darcy_outlet with 8 grains across."""
    return [[1, *(0.0125 * (n + 0.5) for n in (i, j, k)), 0.00625]
            for k in range(8) for j in range(16) for i in range(8)], [(-0.01, 0.11), (-0.01, 0.23), (-0.01, 0.11)], 1


@functools.cache
def settling():
    return cloud(6, 6, 0.0146, 0.88, random.Random(3)), [(-0.02, 0.12)] * 3, 1


@functools.cache
def two_sizes(ratio=5.0):
    """Large grains on a jittered grid, small ones wherever a finer grid leaves them room."""
    rng = random.Random(9)
    large = cloud(3, 3, 0.031, 0.8, rng)
    radius = large[0][4] / ratio
    small = [row for row in cloud(12, 12, 0.0078, 2 * radius / 0.0078, rng)
             if all(math.dist(row[1:4], other[1:4]) > row[4] + other[4] for other in large)]
    return large + small, [(-0.02, 0.12)] * 3, 1


@functools.cache
def bed():
    grains, box = cloud(7, 6, 0.0142, 0.88, random.Random(5)), [(-0.02, 0.12)] * 3
    data = write_data("bed", grains, box)
    scene.liggghts(SCENE, "in.rest", {"data": data, "steps": 10000, "mass": 2.6e-3, "dt": 5e-5, "out": "post/bed.rest"}, "post/bed")
    return read_rest(SCENE / "post" / "bed.rest"), box, 1


@functools.cache
def oedometer_sample(count=300):
    """(grains, box, types) and what the oedometer measured of them."""
    settings = oedometer.parse([f"N={count}", "LAW=hydraulic_radius", "OUT=../solve_interval/post/oedometer"])
    measured = oedometer.prepare(settings)
    planned = oedometer.plan(settings, measured)
    grains = read_rest(SCENE / "post" / "oedometer.dump")
    return (grains, [(-0.01, 0.11), (-0.01, 0.11), (-0.01, 0.12)], 4), settings, measured, planned


def write_plates(half=0.018):
    for axis, name in enumerate("xyz"):
        corners = [[a, b] for a, b in ((-half, -half), (half, -half), (half, half), (-half, half))]
        for corner in corners:
            corner.insert(axis, 0.0)
        text = "solid p\n"
        for triangle in ((0, 1, 2), (0, 2, 3)):
            text += "facet normal 0 0 0\n outer loop\n" + "".join(
                "  vertex " + " ".join(map(str, corners[k])) + "\n" for k in triangle) + " endloop\nendfacet\n"
        (SCENE / "post" / f"plate_{name}.stl").write_text(text + "endsolid p\n")


@functools.cache
def compressed():
    write_plates()
    said, _ = scene.liggghts(SCENE, "in.compression_dry", {}, "post/compression_dry")
    places = dict(zip(("xa", "xb", "ya", "yb", "za", "zb"), said["plates"]))
    return (read_rest(SCENE / "post" / "compression.rest"), [(-0.022, 0.022)] * 3, 2), places

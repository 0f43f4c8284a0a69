# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangulated plates, tubes, funnels and boxes, and the STL files of them."""
import math


def write_mesh(path, triangles):
    """An STL file."""
    lines = ["solid mesh"]
    for triangle in triangles:
        lines += ["facet normal 0 0 1", " outer loop"]
        lines += ["  vertex " + " ".join(repr(float(v)) for v in corner) for corner in triangle]
        lines += [" endloop", "endfacet"]
    path.write_text("\n".join(lines + ["endsolid mesh"]) + "\n")


def quad(a, b, c, d):
    """Two triangles; corners in order around the plate."""
    return [(a, b, c), (a, c, d)]


def ring(sides, radius, height, middle=0.0, start=0.0):
    """Corners of a regular polygon normal to z."""
    angles = [2 * math.pi * (i + start) / sides for i in range(sides)]
    return [(middle + radius * math.cos(a), middle + radius * math.sin(a), height) for a in angles]


def funnel(below, above):
    """The flats between two rings of as many corners."""
    after = range(1, len(below) + 1)
    return [t for i, j in zip(range(len(below)), after)
            for t in quad(below[i], below[j % len(below)], above[j % len(above)], above[i])]


def lid(ring_of_corners):
    """The polygon that a ring bounds."""
    a = ring_of_corners[0]
    return [(a, b, c) for b, c in zip(ring_of_corners[1:], ring_of_corners[2:])]


def lying(triangles):
    """The axis z becomes y."""
    return [tuple((x, z, -y) for x, y, z in triangle) for triangle in triangles]


def square(edge, height=0.0, tilt=0.0):
    """The corners of a square normal to z; `tilt` lifts the side at large x."""
    lifted = height + tilt
    return [(0, 0, height), (edge, 0, lifted), (edge, edge, lifted), (0, edge, height)]


def polygon_area(sides, radius):
    """Of a regular polygon with its corners on a circle."""
    return 0.5 * sides * radius**2 * math.sin(2 * math.pi / sides)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangulated plates for mesh walls."""


def write_plate(path, corners):
    """An STL file of two triangles; corners in order around the plate."""
    a, b, c, d = corners
    lines = ["solid plate"]
    for triangle in ((a, b, c), (a, c, d)):
        lines += ["facet normal 0 0 1", " outer loop"]
        lines += ["  vertex " + " ".join(repr(float(v)) for v in corner) for corner in triangle]
        lines += [" endloop", "endfacet"]
    path.write_text("\n".join(lines + ["endsolid plate"]) + "\n")


def square(edge, height=0.0, tilt=0.0):
    """The corners of a square normal to z; `tilt` lifts the side at large x."""
    lifted = height + tilt
    return [(0, 0, height), (edge, 0, lifted), (edge, edge, lifted), (0, edge, height)]

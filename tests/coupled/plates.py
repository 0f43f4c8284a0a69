# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of the scenes in inputs/, for the tests."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "inputs" / "common"))
from meshes import funnel, lid, lying, polygon_area, quad, ring, square, write_mesh  # noqa: E402,F401


def write_plate(path, corners):
    write_mesh(path, quad(*corners))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Containers from outside: the walls that --vtk draws, and cylinders as flats."""
import json
import math
import unittest

import numpy
from vtk import VTK_POLYGON
from vtk.util.numpy_support import vtk_to_numpy

from command import DATA, DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest
from test_fields import grid_of

ENDS = [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": 0},
        {"name": "top", "inward_normal": [0, 0, -1], "offset": -0.75}]
SHELL = {"name": "shell", "axis": [0, 0, 1], "point": [0, 0, 0], "radius": 0.5}
TILT = math.radians(25.0)
WEDGE = [ENDS[0], {"name": "top", "inward_normal": [0, 0, -1], "offset": -1},
         {"name": "x0", "inward_normal": [1, 0, 0], "offset": 0},
         {"name": "y0", "inward_normal": [0, 1, 0], "offset": 0},
         {"name": "y1", "inward_normal": [0, -1, 0], "offset": -0.8},
         {"name": "tilted", "inward_normal": [-math.cos(TILT), 0, -math.sin(TILT)], "offset": -math.cos(TILT)}]
STRIPS = 96
THROUGH = ["--viscosity", "1", "--face", "bottom:pressure=1", "--face", "top:pressure=0"]
BEADS = DATA / "cyl_equal_packing.csv"


def texts(cells, name):
    array = cells.GetAbstractArray(name)
    return [array.GetValue(k) for k in range(array.GetNumberOfValues())]


class Walls(CommandTest):
    def drawn(self, container, packing, *words):
        """{face: its name}, {face: [area vector of each polygon]}, numbers and all data of the cells, volume within; checks
        that the polygons close, and the loads against the report."""
        box = UNIT_BOX
        if container:
            self.write("room.json", json.dumps(container))
            box = ["--container", "room.json"]
        report = self.report("--vtk", "n.vtu", *words, packing=packing, box=box)
        grid = grid_of(self.folder / "n_walls.vtu")
        cells = grid.GetCellData()
        numbers = {cells.GetArrayName(k) for k in range(cells.GetNumberOfArrays())} - {"name", "wall", "boundary"}
        data = {name: vtk_to_numpy(cells.GetArray(name)) for name in numbers}
        areas, volume = {}, 0.0
        for k in range(grid.GetNumberOfCells()):
            self.assertEqual(grid.GetCellType(k), VTK_POLYGON)
            corners = numpy.array([grid.GetCell(k).GetPoints().GetPoint(i)
                                   for i in range(grid.GetCell(k).GetNumberOfPoints())])
            vectors = 0.5 * numpy.cross(corners[1:-1] - corners[0], corners[2:] - corners[0])
            areas.setdefault(int(data["face"][k]), []).append(vectors.sum(axis=0))
            volume += corners[0] @ vectors.sum(axis=0) / 3.0
        self.assertLess(numpy.abs(sum(sum(parts) for parts in areas.values())).max(), 1e-14)
        names = {int(f): name for f, name in zip(data["face"], texts(cells, "name"))}
        self.assertEqual([names[f] for f in sorted(names)], list(report["faces"]))
        for k, f in enumerate(data["face"]):
            result = report["faces"][names[int(f)]]
            self.assertEqual(data["flux"][k], result["flux"])
            numpy.testing.assert_array_equal(data["force_pressure"][k], result["force_pressure"])
            numpy.testing.assert_array_equal(data["force_viscous"][k], result["force_viscous"])
            numpy.testing.assert_array_equal(data["force"][k], data["force_pressure"][k] + data["force_viscous"][k])
        return names, areas, data, volume, cells

    def test_a_box_has_its_six_faces(self):
        names, areas, data, volume, cells = self.drawn(None, DENSE, *THROUGH_FLOW, "--face", "xlo:velocity=0.25,wall=symmetry")
        self.assertEqual([names[f] for f in range(6)], ["xlo", "xhi", "ylo", "yhi", "zlo", "zhi"])
        self.assertEqual(texts(cells, "wall"), ["symmetry", "no_slip", "no_slip", "no_slip", "open", "open"])
        self.assertEqual(texts(cells, "boundary"), ["sealed"] * 4 + ["pressure"] * 2)
        self.assertEqual(volume, 1.0)
        for f in range(6):
            outward = numpy.zeros(3)
            outward[f // 2] = 2 * (f % 2) - 1
            numpy.testing.assert_array_equal(areas[f], [outward])
        numpy.testing.assert_array_equal(data["velocity"][0], [0.25, 0, 0])

    def test_a_periodic_axis_has_no_walls(self):
        self.solve("--vtk", "n.vtu", *THROUGH_FLOW, "--periodic", "x,y")
        self.assertEqual(texts(grid_of(self.folder / "n_walls.vtu").GetCellData(), "name"), ["zlo", "zhi"])
        self.write("all_walls.vtu", "of a run with walls")
        self.solve("--vtk", "all.vtu", "--periodic", "x,y,z", "--gradient", "0", "0", "1", "--viscosity", "1")
        self.assertFalse((self.folder / "all_walls.vtu").exists())

    def test_planes_are_clipped_to_the_container(self):
        names, areas, data, volume, _ = self.drawn({"planes": WEDGE}, DATA / "wedge_packing.csv", *THROUGH)
        slope = math.tan(TILT)
        expected = {"bottom": 0.8, "top": 0.8 * (1 - slope), "x0": 0.8, "y0": 1 - slope / 2, "y1": 1 - slope / 2,
                    "tilted": 0.8 / math.cos(TILT)}
        self.assertEqual(set(names.values()), set(expected))
        for f, parts in areas.items():
            self.assertEqual(len(parts), 1)
            self.assertAlmostEqual(numpy.linalg.norm(parts[0]), expected[names[f]], delta=1e-12)
        for f, area in zip(data["face"], data["area"]):
            self.assertAlmostEqual(area, expected[names[int(f)]], delta=1e-12)
        self.assertAlmostEqual(volume, 0.8 * (1 - slope / 2), delta=1e-12)

    def test_a_cylinder_is_strips_and_two_polygons(self):
        names, areas, data, volume, cells = self.drawn({"planes": ENDS, "cylinders": [SHELL]}, BEADS, *THROUGH)
        section = STRIPS / 2 * math.sin(2 * math.pi / STRIPS) * 0.25
        by_name = {names[f]: parts for f, parts in areas.items()}
        self.assertEqual(len(by_name["shell"]), STRIPS)
        strip = 2 * 0.5 * math.sin(math.pi / STRIPS) * 0.75
        for vector in by_name["shell"]:
            self.assertAlmostEqual(numpy.linalg.norm(vector), strip, delta=1e-14)
        for end, sign in (("bottom", -1), ("top", 1)):
            numpy.testing.assert_allclose(by_name[end], [[0, 0, sign * section]], atol=1e-14)
        self.assertAlmostEqual(volume, section * 0.75, delta=1e-13)
        self.assertAlmostEqual(volume / (math.pi * 0.25 * 0.75), 1.0, delta=1e-3)
        self.assertEqual(set(texts(cells, "wall")), {"open", "no_slip"})
        for f, area in zip(data["face"], data["area"]):
            whole = math.pi * 0.75 if names[int(f)] == "shell" else math.pi * 0.25
            self.assertAlmostEqual(area, whole, delta=1e-14)

    def test_a_cylinder_as_flats(self):
        names, areas, _, volume, _ = self.drawn(
            {"planes": ENDS, "cylinders": [{**SHELL, "axis": [0, 0, 2], "flats": 16}]}, BEADS, *THROUGH)
        self.assertEqual(sorted(names.values()),
                         sorted(["bottom", "top"] + [f"shell_{i}" for i in range(1, 17)]))
        self.assertAlmostEqual(volume, math.pi * 0.25 * 0.75, delta=1e-13)
        for flats in (2, 2.5, 63, "32", 2**32 + 8, 2**63 + 8):
            self.write("room.json", json.dumps({"planes": ENDS, "cylinders": [{**SHELL, "flats": flats}]}))
            refused = self.run_pfv("solve", "--packing", BEADS, "--container", "room.json", *THROUGH)
            self.assert_refused(refused, "room.json, cylinders 1", '"flats" is no whole number from 3 to 62')

    def test_one_sphere_in_a_cylinder_is_refused_with_the_remedy(self):
        self.write("one.csv", "id,x,y,z,radius\n7,0,0,0.4,0.1\n")
        self.write("room.json", json.dumps({"planes": ENDS, "cylinders": [SHELL]}))
        refused = self.run_pfv("solve", "--packing", "one.csv", "--container", "room.json", *THROUGH)
        self.assert_refused(refused, "sphere 7", "around the axis", '"flats": 32', "container flats")
        self.write("room.json", json.dumps({"planes": ENDS, "cylinders": [{**SHELL, "flats": 32}]}))
        self.solve(*THROUGH, packing="one.csv", box=["--container", "room.json"])


if __name__ == "__main__":
    unittest.main()

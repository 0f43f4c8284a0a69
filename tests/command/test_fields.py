# SPDX-License-Identifier: GPL-3.0-or-later
"""Pores, throats and grains as VTK's own readers see them."""
import os
import subprocess
import unittest
import xml.etree.ElementTree

import numpy
from vtk import VTK_LINE, VTK_VERTEX
from vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest, dense_rows


def grid_of(path):
    reader = vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors and reader.GetErrorCode() == 0
    return reader.GetOutput()


def arrays_of(attributes):
    return {attributes.GetArrayName(k): vtk_to_numpy(attributes.GetArray(k))
            for k in range(attributes.GetNumberOfArrays())}


class Network(CommandTest):
    def setUp(self):
        super().setUp()
        self.summary = self.report("--vtk", "network.vtu", *THROUGH_FLOW)
        self.grid = grid_of(self.folder / "network.vtu")
        self.pores = self.grid.GetNumberOfPoints()
        self.throats = self.grid.GetNumberOfCells() - self.pores
        self.cell_data = arrays_of(self.grid.GetCellData())
        self.point_data = arrays_of(self.grid.GetPointData())

    def ends(self):
        return numpy.array([[self.grid.GetCell(self.pores + t).GetPointId(k) for k in (0, 1)]
                            for t in range(self.throats)])

    def test_each_pore_is_a_vertex_and_each_throat_a_line(self):
        self.assertEqual(self.pores, self.summary["pores"])
        self.assertGreater(self.throats, self.pores)
        kinds = [self.grid.GetCellType(k) for k in range(self.grid.GetNumberOfCells())]
        self.assertEqual(set(kinds[:self.pores]), {VTK_VERTEX})
        self.assertEqual(set(kinds[self.pores:]), {VTK_LINE})
        for k in range(self.pores):
            self.assertEqual(self.grid.GetCell(k).GetPointId(0), k)

    def test_arrays_are_as_long_as_what_they_belong_to(self):
        self.assertEqual(set(self.point_data), {"pressure", "volume", "velocity"})
        self.assertEqual(set(self.cell_data), {"pressure", "volume", "conductance", "flux"})
        for name, values in self.point_data.items():
            self.assertEqual(values.shape,
                             (self.pores, 3) if name == "velocity" else (self.pores,))
        for values in self.cell_data.values():
            self.assertEqual(values.shape, (self.pores + self.throats,))
            self.assertTrue(numpy.isfinite(values).all())
        for name in ("pressure", "volume"):
            numpy.testing.assert_array_equal(self.cell_data[name][:self.pores],
                                             self.point_data[name])

    def test_pressures_reach_from_one_imposed_value_to_the_other(self):
        pressure = self.point_data["pressure"]
        self.assertEqual((pressure.min(), pressure.max()), (0, 1))

    def test_flux_is_conductance_times_pressure_difference_along_the_line(self):
        pressure = self.point_data["pressure"]
        ends = self.ends()
        conductance = self.cell_data["conductance"][self.pores:]
        flux = self.cell_data["flux"][self.pores:]
        expected = conductance * (pressure[ends[:, 0]] - pressure[ends[:, 1]])
        self.assertGreater(conductance.min(), -1e-300)
        numpy.testing.assert_allclose(flux, expected, atol=1e-12 * abs(flux).max(), rtol=0)
        numpy.testing.assert_allclose(self.cell_data["pressure"][self.pores:],
                                      pressure[ends].mean(axis=1), rtol=1e-15, atol=1e-16)

    def test_no_pore_without_an_imposed_pressure_gains_or_loses_fluid(self):
        ends, flux = self.ends(), self.cell_data["flux"][self.pores:]
        balance = numpy.zeros(self.pores)
        numpy.add.at(balance, ends[:, 0], -flux)
        numpy.add.at(balance, ends[:, 1], flux)
        pressure = self.point_data["pressure"]
        free = (pressure > 0) & (pressure < 1)
        self.assertGreater(free.sum(), 0.5 * self.pores)
        self.assertLess(abs(balance[free]).max(), 1e-10 * abs(flux).max())
        self.assertAlmostEqual(-balance[pressure == 1].sum() / self.summary["inflow"], 1,
                               delta=1e-9)


OVERLAPPING = """id,x,y,z,radius
1,0.358579,0.358579,0.358579,0.232
2,0.641421,0.641421,0.358579,0.232
3,0.641421,0.358579,0.641421,0.232
4,0.358579,0.641421,0.641421,0.232
5,0.5,0.5,0.1,0.15
"""


class FluidVolume(CommandTest):
    """The volumes of the pores add up to that of the report, where spheres overlap each other and walls, too."""

    def volumes(self, packing, *options):
        summary = self.report("--vtk", "pores.vtu", *THROUGH_FLOW, *options, packing=packing)
        volume = arrays_of(grid_of(self.folder / "pores.vtu").GetPointData())["volume"]
        self.assertAlmostEqual(volume.sum() / summary["pore_volume"], 1, delta=1e-12)
        return volume

    def scaled(self, factor):
        header, rows = dense_rows()
        lines = [",".join([*row[:4], repr(factor * float(row[4]))]) for row in rows]
        return self.write("scaled.csv", "\n".join([",".join(header), *lines]) + "\n")

    def test_of_a_dense_packing(self):
        for factor in (0.7, 1.0, 1.3):
            self.volumes(self.scaled(factor))

    def test_of_four_spheres_around_a_pore_and_one_through_a_wall(self):
        self.assertGreaterEqual(self.volumes(self.write("overlap.csv", OVERLAPPING)).min(), 0.0)


class Grains(CommandTest):
    def setUp(self):
        super().setUp()
        subprocess.run([os.environ["PFV_WRITE_GRAINS"], str(DENSE), str(self.folder)], check=True)

    def test_grains_come_back_with_id_radius_velocity_force_and_pressure(self):
        grid = grid_of(self.folder / "grains.vtu")
        rows = numpy.array([[float(value) for value in row] for row in dense_rows()[1]])
        values = arrays_of(grid.GetPointData())
        places = vtk_to_numpy(grid.GetPoints().GetData())
        self.assertEqual(grid.GetNumberOfCells(), len(rows))
        self.assertEqual({grid.GetCellType(k) for k in range(len(rows))}, {VTK_VERTEX})
        numpy.testing.assert_array_equal(places, rows[:, 1:4])
        numpy.testing.assert_array_equal(values["id"], rows[:, 0].astype(int))
        numpy.testing.assert_array_equal(values["radius"], rows[:, 4])
        numpy.testing.assert_array_equal(values["velocity"], numpy.zeros((len(rows), 3)))
        numpy.testing.assert_array_equal(values["force"], 2 * rows[:, 1:4])
        numpy.testing.assert_array_equal(values["pressure"], 3 * rows[:, 4])

    def test_a_collection_names_a_file_beside_it_with_its_time(self):
        root = xml.etree.ElementTree.parse(self.folder / "grains.pvd").getroot()
        self.assertEqual(root.get("type"), "Collection")
        entry, = root.iter("DataSet")
        self.assertEqual(float(entry.get("timestep")), 0.25)
        self.assertEqual(entry.get("part"), "1")
        self.assertTrue((self.folder / entry.get("file")).exists())



class Culprits(CommandTest):
    """Four spheres that close the pore between them while they approach each other."""

    def setUp(self):
        super().setUp()
        rows = ["id,x,y,z,radius,vx,vy,vz"]
        ways = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
        for number, way in enumerate(ways, 11):
            place = [0.5 + 0.103 * step for step in way]
            rows.append(",".join(map(str, (number, *place, 0.18, *(-0.01 * step for step in way)))))
        rows.append("20,0.9,0.1,0.5,0.05,0,0,0")
        self.packing = self.write("closing.csv", "\n".join(rows) + "\n")

    def test_are_drawn_where_the_packing_cannot_be_solved(self):
        result = self.run_pfv("solve", "--packing", self.packing, *UNIT_BOX, *THROUGH_FLOW,
                              "--culprits", "culprits.vtu", "--vtk", "network.vtu")
        self.assert_refused(result, "spheres 11, 12, 13, 14", "cut off")
        grid = grid_of(self.folder / "culprits.vtu")
        data = arrays_of(grid.GetPointData())
        self.assertEqual(list(data["id"]), [11, 12, 13, 14, -1])
        self.assertEqual(list(data["radius"]), [0.18] * 4 + [0.0])
        for x in grid.GetPoint(4):
            self.assertAlmostEqual(x, 0.5, delta=1e-9)
        self.assertFalse((self.folder / "network.vtu").exists())

    def test_are_not_written_where_it_can(self):
        self.solve(*THROUGH_FLOW, "--bulk-modulus", "1e6", "--time-step", "1e-3", "--culprits",
                   "culprits.vtu", packing=self.packing)
        self.assertFalse((self.folder / "culprits.vtu").exists())


if __name__ == "__main__":
    unittest.main()

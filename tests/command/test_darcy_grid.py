# SPDX-License-Identifier: GPL-3.0-or-later
"""`pfv solve --model darcy_grid`: report, fields, refusals."""
import unittest

import numpy
from vtk import VTK_VOXEL

from command import THROUGH_FLOW, CommandTest
from test_fields import arrays_of, grid_of

GRID = ("--model", "darcy_grid", "--cells", "3", "4", "5")


class DarcyGrid(CommandTest):
    def test_report_and_fields_agree(self):
        report = self.report(*GRID, *THROUGH_FLOW, "--vtk", "cells.vtu")
        self.assertEqual(report["model"], "darcy_grid")
        self.assertEqual(report["pores"], 60)
        self.assertEqual(report["conductance"], "kozeny_carman")
        self.assertLess(abs(report["mass_error"]), 1e-12)
        self.assertEqual(report["counts"]["order"], 1)
        grid = grid_of(self.folder / "cells.vtu")
        self.assertEqual(grid.GetNumberOfCells(), 60)
        self.assertTrue(all(grid.GetCellType(c) == VTK_VOXEL for c in range(60)))
        self.assertEqual(grid.GetBounds(), (0, 1, 0, 1, 0, 1))
        data = arrays_of(grid.GetCellData())
        self.assertAlmostEqual(data["porosity"].mean(), report["porosity"], delta=1e-14)
        # cell c stands where its number says: the pressure falls towards zlo
        heights = numpy.array([grid.GetCell(c).GetBounds()[4] for c in range(60)])
        self.assertEqual(list(numpy.argsort(heights, kind="stable")), list(range(60)))
        layers = data["pressure"].reshape(5, 12).mean(axis=1)
        self.assertTrue((numpy.diff(layers) > 0).all())
        through = data["velocity"][:, 2].reshape(5, 12).mean(axis=1)
        self.assertTrue((abs(through - report["faces"]["zlo"]["flux"]) <
                         1e-12 * abs(through)).all())

    def test_total_porosity_is_that_of_the_pore_network(self):
        """Two balls apart, one of them across a face: both count the parts in the box exactly."""
        packing = self.write("p.csv", "id,x,y,z,radius\n1,.3,.4,.5,.25\n2,.8,.7,.6,.3\n")
        cells = self.report(*GRID, *THROUGH_FLOW, packing=packing)
        pores = self.report(*THROUGH_FLOW, packing=packing)
        self.assertEqual(pores["model"], "pfv")
        self.assertAlmostEqual(cells["porosity"], pores["porosity"], delta=1e-13)
        self.assertAlmostEqual(cells["solid_area"] / pores["solid_area"], 1, delta=1e-12)

    def test_drag_and_gradient_are_written_apart(self):
        self.solve(*GRID, *THROUGH_FLOW, "--drag", "kozeny_carman", "--forces", "forces.csv")
        rows = numpy.array(list(self.forces("forces.csv").values()))
        self.assertTrue(numpy.allclose(rows[:, :3], rows[:, 3:6] + rows[:, 6:]))
        self.assertAlmostEqual(rows[:, 2].sum(), -1.0, delta=1e-12)  # dp S, downwards

    def test_what_it_refuses(self):
        for words, part in ((("--model", "darcy_grid"), "--cells NX NY NZ"),
                            (("--cells", "1", "1", "1"), "use the model darcy_grid"),
                            (("--model", "grid"), "unknown model"),
                            (("--model", "darcy_grid", "--cells", "1", "x", "1"), "whole number"),
                            ((*GRID, "--drag", "stokes"), "unknown drag law"),
                            ((*GRID, "--periodic", "x"), "no periodic axes"),
                            ((*GRID, "--partition", "yade"), "no partition")):
            with self.subTest(words=words):
                packing = self.write("p.csv", "id,x,y,z,radius\n1,.5,.5,.5,.4\n")
                self.assert_refused(self.run_pfv("solve", "--packing", packing, "--box", *"010101",
                                                 *words), part)


if __name__ == "__main__":
    unittest.main()

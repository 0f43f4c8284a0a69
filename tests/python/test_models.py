# SPDX-License-Identifier: GPL-3.0-or-later
"""The coarse grid behind the same class."""
import unittest

import numpy as np
import pfv
from case import grains, through_flow


class DarcyGrid(unittest.TestCase):
    def setUp(self):
        self.bed = grains("packing_500.csv")
        self.flow = pfv.Flow(through_flow(), model="darcy_grid", cells=(2, 2, 4), drag="kozeny_carman")
        self.flow.evaluate(self.bed.positions, self.bed.radii)

    def test_it_has_a_row_for_each_cell(self):
        flow = self.flow
        for array in (flow.pressures, flow.cell_porosities(), flow.cell_permeabilities()):
            self.assertEqual(array.shape, (16,))
        self.assertEqual(flow.cell_velocities().shape, (16, 3))
        self.assertTrue((np.diff(flow.pressures.reshape(4, 4).mean(axis=1)) < 0).all())
        self.assertEqual(flow.report()["model"], "darcy_grid")

    def test_what_pores_alone_have_is_refused_by_name(self):
        for ask in (self.flow.network, self.flow.throat_fluxes, self.flow.sphere_stresses):
            with self.assertRaisesRegex(pfv.InputError, "darcy_grid has no such result"):
                ask()

    def test_forces_balance_what_drives_the_flow(self):
        total = self.flow.forces.sum(axis=0) + sum(self.flow.face_forces().values())
        np.testing.assert_allclose(total, 0, atol=1e-12)


if __name__ == "__main__":
    unittest.main()

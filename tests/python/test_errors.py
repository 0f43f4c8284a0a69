# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors are exceptions of Python's kinds that say what is wrong, and which spheres."""
import unittest

import numpy as np
import pfv
from case import DATA, UNIT, grains, through_flow


class Errors(unittest.TestCase):
    def setUp(self):
        bed = grains()
        self.positions, self.radii = np.array(bed.positions), np.array(bed.radii)
        self.flow = pfv.Flow(through_flow())

    def refused(self, *words, error=pfv.InputError, call=None, **arguments):
        """Evaluates and expects an error that says these words."""
        given = {"positions": self.positions, "radii": self.radii, **arguments}
        with self.assertRaises(error) as caught:
            (call or self.flow.evaluate)(**given)
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        return caught.exception

    def test_they_are_of_pythons_kinds(self):
        self.assertTrue(issubclass(pfv.InputError, ValueError))
        self.assertTrue(issubclass(pfv.SolverError, RuntimeError))
        self.assertTrue(issubclass(pfv.FileError, OSError))
        for error in (pfv.InputError, pfv.SolverError, pfv.FileError):
            self.assertTrue(issubclass(error, pfv.Error))
            self.assertEqual(error.__module__, "pfv")

    def test_a_wrong_shape_is_named(self):
        self.refused("positions", "(3, 100)", "N x 3", positions=self.positions.T)
        self.refused("radii", "(99,)", "100 spheres", radii=self.radii[1:])
        self.refused("radii", "(100, 1)", radii=self.radii[:, None])
        self.refused("velocities", "(3,)", velocities=[0, 0, 1])
        self.refused("velocities", "(99, 3)", velocities=self.positions[1:])
        self.refused("ids", "(1,)", ids=[1])

    def test_a_wrong_type_is_named(self):
        for positions in (self.positions.astype(complex), self.positions.astype(str), self.positions > 0,
                          self.positions.astype(object), [[1, 2], [3]], None, "abc"):
            self.refused("positions", error=TypeError, positions=positions)
        self.refused("ids", "float64", error=TypeError, ids=np.arange(100.0))

    def test_bad_numbers_are_named_with_their_sphere(self):
        self.positions[7, 1] = np.nan
        self.refused("sphere 7", "not finite")
        self.assertIn("sphere 107", str(self.refused(ids=np.arange(100, 200))))
        self.positions[7, 1] = 0.5
        self.radii[3] = -1
        self.assertEqual(self.refused("sphere 3", "radius").spheres, (3,))

    def test_what_is_masked_is_no_number(self):
        masked = np.ma.masked_array(self.positions, mask=np.zeros_like(self.positions))
        self.flow.evaluate(masked, self.radii)
        masked[3, 1] = np.ma.masked
        self.refused("positions", "masked", positions=masked)

    def test_bad_numbers_are_named_on_a_network_that_is_kept(self):
        flow = pfv.Flow(pfv.Box([[0, 1]] * 3).face("zhi", pressure=0.0))
        flow.evaluate(self.positions, self.radii)
        self.assertEqual(self.refused("sphere 6", "velocity", call=flow.evaluate,
                                      velocities=np.where(np.arange(100)[:, None] == 6, np.nan, self.positions)).spheres, (6,))

    def test_a_lattice_that_is_off_by_a_millionth_is_no_slender_cell(self):
        lattice = (np.indices((5, 5, 5)).reshape(3, -1).T + 0.5) / 5
        for seed in range(4):
            positions = lattice + np.random.default_rng(seed).normal(size=lattice.shape) * 2e-7
            try:
                pfv.permeability(positions, np.full(125, 0.095), UNIT, periodic="xyz")
            except pfv.InputError as error:
                self.assertIn("cubic lattice", str(error))

    def test_culprits_are_ids(self):
        self.positions[5] = [2, 0.5, 0.5]
        self.assertEqual(self.refused("sphere 5", "not inside the box").spheres, (5,))
        self.assertEqual(self.refused("sphere 42", ids=np.arange(100) + 37).spheres, (42,))
        ids = np.arange(100)
        ids[9] = 8
        self.positions[5] = [0.5] * 3
        self.assertEqual(self.refused("occurs twice", ids=ids).spheres, (8,))
        self.assertEqual(self.refused(ids=ids).places, ())

    def test_no_pressure_for_moving_grains(self):
        flow = pfv.Flow(UNIT)
        self.refused(call=flow.evaluate, velocities=self.positions)

    def test_without_a_result_there_is_no_answer(self):
        for ask in (lambda: self.flow.forces, lambda: self.flow.pressures, self.flow.report, self.flow.network):
            with self.assertRaisesRegex(pfv.InputError, "no result"):
                ask()
        self.flow.evaluate(self.positions, self.radii)
        forces = self.flow.forces
        before = forces.copy()
        self.refused("time step", call=self.flow.advance, dt=-1.0)
        with self.assertRaisesRegex(pfv.InputError, "no result"):
            self.flow.report()
        np.testing.assert_array_equal(forces, before)
        np.testing.assert_array_equal(self.flow.evaluate(self.positions, self.radii), before)

    def test_what_was_not_asked_for_says_how_to_ask(self):
        self.flow.evaluate(self.positions, self.radii)
        for name, setting in (("torques", "torques"), ("viscous_forces", "split_forces"),
                              ("sphere_pressures", "sphere_pressure")):
            with self.assertRaisesRegex(pfv.InputError, f"{setting}=True"):
                getattr(self.flow, name)

    def test_a_folder_that_is_not_there(self):
        self.flow.evaluate(self.positions, self.radii)
        with self.assertRaises(pfv.FileError):
            self.flow.write_fields("/there/is/none.vtu")
        with self.assertRaises(pfv.InputError):
            pfv.read_packing("/there/is/none.csv")

    def test_a_snapshot_of_a_table_and_a_unit(self):
        with self.assertRaisesRegex(pfv.InputError, "is no dump"):
            pfv.read_packing(DATA / "packing_100.csv", snapshot=3)
        small = pfv.read_packing(DATA / "packing_100.csv", length_unit=1e-3)
        np.testing.assert_array_equal(small.radii, 1e-3 * pfv.read_packing(DATA / "packing_100.csv").radii)
        np.testing.assert_array_equal(small.radii, pfv.read_packing(DATA / "packing_100.csv", length_unit="mm").radii)
        with self.assertRaisesRegex(pfv.InputError, "unit of length is 'ell': give m, cm"):
            pfv.read_packing(DATA / "packing_100.csv", length_unit="ell")

    def test_a_place_without_pressure_is_named(self):
        self.flow.evaluate(self.positions, self.radii)
        with self.assertRaisesRegex(pfv.InputError, r"no pressure at \(2, 0.5, -1\)"):
            self.flow.pressure_at([2, 0.5, -1])

    def test_queries_refuse_bad_places_and_axes(self):
        self.flow.evaluate(self.positions, self.radii)
        for ask in (lambda: self.flow.pressure_at([2, 2, 2]), lambda: self.flow.plane_pressure("w", 0),
                    lambda: self.flow.plane_pressure(3, 0.5), lambda: self.flow.plane_flux(-1, 0.5),
                    lambda: self.flow.viscosity_matrices([100]), lambda: self.flow.pressure_at([0, 1]),
                    self.flow.cell_porosities):
            with self.assertRaises(pfv.InputError):
                ask()


if __name__ == "__main__":
    unittest.main()

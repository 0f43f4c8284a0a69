# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays go in and out without copies where their layout allows, and live as long as somebody looks at them."""
import gc
import tracemalloc
import unittest

import numpy as np
import pfv
from case import UNIT, grains, rotation, through_flow


def address(array):
    return array.__array_interface__["data"][0]


class Copies(unittest.TestCase):
    def setUp(self):
        self.bed = grains("packing_500.csv")
        self.flow = pfv.Flow(through_flow())
        self.flow.evaluate(self.bed.positions, self.bed.radii, ids=self.bed.ids)

    def allocated(self, positions, velocities):
        """Bytes that Python and NumPy take at most during a step."""
        tracemalloc.start()
        self.flow.advance(positions, self.bed.radii, velocities, 1e-6, ids=self.bed.ids)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return peak

    def test_rows_of_float64_are_read_where_they_stand(self):
        positions, velocities = np.array(self.bed.positions), rotation(self.bed.positions)
        self.assertLess(self.allocated(positions, velocities), positions.nbytes / 2)
        self.assertGreater(self.allocated(np.asfortranarray(positions), velocities), positions.nbytes)

    def test_forces_are_the_librarys_own(self):
        forces = self.flow.forces
        self.assertEqual(address(forces), address(self.flow.forces))
        place = address(forces)
        del forces
        # nobody looks at them: the next step writes to the same place
        self.assertEqual(address(self.flow.advance(self.bed.positions, self.bed.radii, dt=1e-6)), place)

    def test_other_layouts_and_types_give_the_same_forces(self):
        expected = np.array(self.flow.forces)
        wide = np.zeros((500, 6))
        wide[:, ::2] = self.bed.positions
        for positions in (wide[:, ::2], np.asfortranarray(self.bed.positions), self.bed.positions.tolist(),
                          self.bed.positions.astype(">f8"), misaligned(self.bed.positions)):
            forces = self.flow.evaluate(positions, self.bed.radii, ids=self.bed.ids)
            np.testing.assert_array_equal(forces, expected)

    def test_forces_cannot_be_written_to(self):
        with self.assertRaises(ValueError):
            self.flow.forces[0] = 0


class Lifetime(unittest.TestCase):
    def test_forces_outlive_further_steps_and_the_flow(self):
        bed = grains("packing_500.csv")
        flow = pfv.Flow(through_flow(), torques=True)
        forces = flow.evaluate(bed.positions, bed.radii)
        torques, copies = flow.torques, (forces.copy(), flow.torques.copy())
        places = address(forces), address(torques)
        second = flow.advance(bed.positions, bed.radii, rotation(bed.positions), 1e-3)
        kept = second.copy()
        flow.advance(bed.positions[:300].copy(), bed.radii[:300].copy(), dt=1e-3)
        del flow
        gc.collect()
        disturbance = [np.ones(1500) for _ in range(1000)]
        np.testing.assert_array_equal(forces, copies[0])
        np.testing.assert_array_equal(torques, copies[1])
        np.testing.assert_array_equal(second, kept)
        self.assertEqual((address(forces), address(torques)), places)
        self.assertEqual(len(disturbance), 1000)

    def test_networks_and_packings_are_kept_by_their_arrays(self):
        bed = grains()
        flow = pfv.Flow(through_flow())
        flow.evaluate(bed.positions, bed.radii)
        centres, positions = flow.network().pore_centres, bed.positions
        copies = centres.copy(), positions.copy()
        del flow, bed
        gc.collect()
        disturbance = [np.ones(centres.size) for _ in range(100)]
        np.testing.assert_array_equal(centres, copies[0])
        np.testing.assert_array_equal(positions, copies[1])
        self.assertEqual(len(disturbance), 100)

    def test_many_flows_leave_no_memory_behind(self):
        bed = pfv.dense_packing(50)
        def run():
            flow = pfv.Flow(through_flow())
            return flow.evaluate(bed.positions, bed.radii)
        run()
        tracemalloc.start()
        for _ in range(20):
            run()
        gc.collect()
        self.assertLess(tracemalloc.get_traced_memory()[0], 20000)
        tracemalloc.stop()


def misaligned(rows):
    """The same numbers one byte off."""
    memory = np.zeros(rows.nbytes + 1, dtype=np.uint8)
    copy = memory[1:].view(np.float64).reshape(rows.shape)
    copy[...] = rows
    return copy


if __name__ == "__main__":
    unittest.main()

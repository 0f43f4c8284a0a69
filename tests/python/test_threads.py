# SPDX-License-Identifier: GPL-3.0-or-later
"""Flows in threads go on side by side; one flow serves one thread at a time."""
import threading
import unittest
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pfv
from case import UNIT, rotation, through_flow


def run(seed, solver="auto"):
    """Some steps of a packing; the forces of each."""
    bed = pfv.dense_packing(200, seed=seed)
    positions, velocities = np.array(bed.positions), rotation(bed.positions)
    flow = pfv.Flow(through_flow(), retriangulate=1e-3, solver=solver)
    forces = []
    for _ in range(5):
        positions = positions + 1e-3 * velocities
        forces.append(flow.advance(positions, bed.radii, velocities, 1e-3))
    return forces


class Threads(unittest.TestCase):
    def test_flows_in_threads_give_the_bytes_of_one_after_the_other(self):
        for solver in ("auto", "cholmod", "klu2"):
            with ThreadPoolExecutor(4) as pool:
                side_by_side = list(pool.map(lambda seed: run(seed, solver), range(1, 5)))
            for seed, forces in enumerate(side_by_side, 1):
                np.testing.assert_array_equal(forces, run(seed, solver))

    def test_other_threads_run_while_one_solves(self):
        """A function that imposes a pressure waits in the middle of a solve for another thread of Python."""
        entered, left = threading.Event(), threading.Event()
        def pressure(place, time):
            entered.set()
            self.assertTrue(left.wait(60))
            return 1.0
        bed = pfv.dense_packing(50)
        flow = pfv.Flow(pfv.Box(UNIT).face("zhi", pressure=pressure))
        with ThreadPoolExecutor(1) as pool:
            forces = pool.submit(flow.evaluate, bed.positions, bed.radii)
            self.assertTrue(entered.wait(60))
            other = pfv.Flow(through_flow()).evaluate(bed.positions, bed.radii)
            for busy in (lambda: flow.evaluate(bed.positions, bed.radii), lambda: flow.time, lambda: flow.box,
                         lambda: flow.set_box(UNIT)):
                with self.assertRaisesRegex(pfv.InputError, "another thread works on this flow"):
                    busy()
            left.set()
            self.assertEqual(forces.result().shape, other.shape)
        self.assertEqual(flow.time, 0)


if __name__ == "__main__":
    unittest.main()

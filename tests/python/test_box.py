# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv.Box: conditions by the names of the faces."""
import copy
import unittest

import numpy as np
import pfv
from case import UNIT, grains


class Box(unittest.TestCase):
    def test_a_face_keeps_what_is_not_named(self):
        box = pfv.Box([[0, 1], [0, 2], [0, 3]], wall="symmetry")
        self.assertIs(box.face("zhi", pressure=5, velocity=-0.1), box)
        box.face("zhi", velocity=0.2).face("xlo", wall="no_slip", sliding=(0, 1, 0), spin=2, pivot=[0, 1, 1])
        faces = box.faces
        self.assertEqual((faces["zhi"]["pressure"], faces["zhi"]["velocity"]), (5, 0.2))
        self.assertEqual((faces["xlo"]["sealed"], faces["xlo"]["wall"], faces["xlo"]["spin"]), (True, "no_slip", 2))
        self.assertEqual(faces["yhi"]["wall"], "symmetry")
        box.face("zhi", sealed=True)
        self.assertTrue(box.faces["zhi"]["sealed"])
        box.face("zhi", flux=1e-3, sealed=False)
        self.assertEqual(box.faces["zhi"]["flux"], 1e-3)

    def test_its_measures(self):
        box = pfv.Box([[0, 1], [0, 2], [0, 3]])
        self.assertEqual((box.volume, box.area("yhi"), box.position("yhi")), (6, 3, 2))
        box.upper = [1, 2, 2.5]
        self.assertEqual(box.position("zhi"), 2.5)
        other = copy.deepcopy(box)
        other.lower = (-1, 0, 0)
        self.assertEqual((box.lower[0], other.lower[0]), (0, -1))
        self.assertEqual(repr(box), "pfv.Box([[0, 1], [0, 2], [0, 2.5]])")

    def test_periodic_axes_are_spelled_as_one_likes(self):
        for spelled in ("xy", "x,y", "y, x", ("x", "y"), ["y", "x"]):
            self.assertEqual(pfv.Box(UNIT, periodic=spelled).periodic, "xy")
        np.testing.assert_array_equal(pfv.Box(UNIT, periodic="z", gradient=(0, 0, -1)).gradient, [0, 0, -1])

    def test_a_tilted_cell(self):
        """One that leans by half an edge, and two of them in a straight cell; by a whole edge: the same lattice."""
        bed = grains()
        places, radii = np.array(bed.positions), np.array(bed.radii)

        def tensor(edges, tilt, places, radii):
            box = pfv.Box([[0, edge] for edge in edges], periodic="xyz", gradient=(0, 0, -1), tilt=tilt)
            np.testing.assert_array_equal(box.tilt, tilt)
            flow = pfv.Flow(box, viscosity=1.0)
            flow.evaluate(places, radii)
            return np.array(flow.report()["permeability_tensor"])

        straight = tensor((1, 1, 1), (0, 0, 0), places, radii)
        np.testing.assert_allclose(tensor((1, 1, 1), (1, 0, -1), places, radii), straight, atol=1e-10 * straight.max())
        leaning = tensor((1, 1, 1), (0.5, 0, 0), places, radii)
        twice = np.vstack([places, places + (0.5, 1, 0)])
        both = tensor((1, 2, 1), (0, 0, 0), twice, np.tile(radii, 2))
        np.testing.assert_allclose(both, leaning, atol=1e-10 * straight.max())
        self.assertGreater(abs(leaning - straight).max(), 1e-3 * straight.max())
        self.assertIn("tilt=(0.5, 0, 0)", repr(pfv.Box(UNIT, periodic="xy", tilt=(0.5, 0, 0))))
        box = pfv.Box(UNIT, periodic="xy")
        box.tilt = (0, 0, 0.25)
        with self.assertRaisesRegex(pfv.InputError, "tilt"):
            pfv.Flow(box, viscosity=1.0)

    def test_what_makes_no_sense_is_refused(self):
        box = pfv.Box(UNIT)
        for refused in (lambda: pfv.Box([[0, 1], [0, 0], [0, 1]]), lambda: pfv.Box([0, 1, 0, 1, 0, 1]),
                        lambda: pfv.Box(UNIT, periodic="w"), lambda: pfv.Box(UNIT, periodic="xyx"), lambda: pfv.Box(UNIT, tilt=(0.5, 0, 0)),
                        lambda: pfv.Box(UNIT, periodic="xyz", tilt=0.5), lambda: pfv.Box(UNIT, wall="smooth"),
                        lambda: box.face("top", pressure=1), lambda: box.face("zhi", pressure=1, flux=2),
                        lambda: box.face("zhi", wall="smooth"), lambda: box.face("zhi", sliding=(1, 2)),
                        lambda: box.patch("zhi", [0, 1, 0, 1], pressure=1), lambda: box.patch("zhi", [[0, 1], [0, 1]]),
                        lambda: box.region([0, 0, 0], [1, 1], pressure=1),
                        lambda: pfv.Flow(pfv.Box(UNIT).patch("zhi", [[0.5, 2], [0.3, 0.1]], pressure=1))):
            with self.assertRaises(pfv.InputError):
                refused()
        for refused in (lambda: box.face("zhi", pressure="high"), lambda: box.face("zhi", velocity=[1, 2, "a"]),
                        lambda: box.face("zhi", flux=lambda place, time: 1)):
            with self.assertRaises(TypeError):
                refused()
        self.assertTrue(box.faces["zhi"]["sealed"])


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv.Packing, read_packing and write_packing: what a file holds is what comes back."""
import os
import pathlib
import subprocess
import unittest
import warnings

import numpy as np
import pfv
from case import DATA, UNIT, CommandCase, grains

TILT = (0.25, 0.0, -0.125)


class Packings(CommandCase):
    def assert_same_spheres(self, one, other):
        for name in ("ids", "positions", "radii", "velocities", "angular_velocities"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)

    def moving(self):
        bed = grains()
        spins = np.arange(3.0 * len(bed)).reshape(-1, 3) / 7
        return pfv.Packing(bed.positions, bed.radii, 1e-3 * bed.positions, angular_velocities=spins,
                           ids=bed.ids[::-1] * 3, bounds=pfv.Box(UNIT, periodic="xyz", tilt=TILT), step=1200)

    def test_a_dump_holds_all(self):
        written = self.moving()
        path = self.folder / "bed.dump"
        self.assertEqual(pfv.write_packing(path, written), [])
        read = pfv.read_packing(path)
        self.assert_same_spheres(read, written)
        self.assertEqual((read.periodic, read.step, read.remarks), ("xyz", 1200, []))
        self.assertEqual(repr(read), "<pfv.Packing of 100 spheres, step 1200>")
        np.testing.assert_allclose(read.bounds, UNIT, atol=1e-15)
        np.testing.assert_array_equal(read.tilt, TILT)

    def test_other_formats_say_what_they_lose(self):
        lost = {"csv": 2, "data": 3, "vtu": 2, "yade": 4}  # step, bounds (data: sides, and a density assumed), ...
        for name, sentences in lost.items():
            with self.subTest(format=name), warnings.catch_warnings():
                warnings.simplefilter("ignore", pfv.PackingWarning)
                bed = self.moving()
                upright = pfv.Packing(bed.positions, bed.radii, bed.velocities, ids=bed.ids, bounds=UNIT, periodic="x",
                                      step=7)
                path = self.folder / ("bed." + name)
                self.assertEqual(len(pfv.write_packing(path, upright, format=name)), sentences)
                np.testing.assert_array_equal(pfv.read_packing(path).positions, upright.positions)

    def test_it_writes_what_the_command_converts(self):
        pfv.write_packing(self.folder / "module.data", grains(), density=2600.0)
        subprocess.run([os.environ["PFV_COMMAND"], "convert", str(DATA / "packing_100.csv"), "command.data",
                        "--density", "2600"], cwd=self.folder, check=True, capture_output=True)
        self.assertEqual((self.folder / "module.data").read_bytes(), (self.folder / "command.data").read_bytes())

    def test_rows_without_ids_count_from_1_and_the_extent_is_that_of_the_spheres(self):
        bed = pfv.Packing([[0, 0, 0], [1, 2, 3]], [0.5, 0.25])
        np.testing.assert_array_equal(bed.ids, [1, 2])
        self.assertEqual((len(bed), bed.bounds, bed.periodic, bed.velocities), (2, None, "", None))
        np.testing.assert_array_equal(bed.extent, [[-0.5, 1.25], [-0.5, 2.25], [-0.5, 3.25]])

    def test_what_was_assumed_in_reading_is_a_warning(self):
        path = pathlib.Path(self.folder, "cut.csv")
        path.write_text("x,y,z,radius\n0.5,0.5,0.5,0.1\n0.25,0.25,0.25,0.1")
        with self.assertWarnsRegex(pfv.PackingWarning, "its last number may be cut off"):
            read = pfv.read_packing(path)
        self.assertEqual(len(read.remarks), 2)
        with self.assertNoLogs(), warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(grains().remarks, [])

    def test_what_is_no_packing_is_refused(self):
        good = pfv.Packing([[0, 0, 0]], [1.0])
        refused = [lambda: pfv.Packing([[0, 0]], [1.0]), lambda: pfv.Packing([[0, 0, 0]], [1.0, 2.0]),
                   lambda: pfv.Packing([[0, 0, 0]], [1.0], bounds=[[0, 0], [0, 1], [0, 1]]),
                   lambda: pfv.Packing([], []).extent,
                   lambda: pfv.write_packing(self.folder / "a.xlsx", good),
                   lambda: pfv.write_packing(self.folder / "none/a.csv", good),
                   lambda: pfv.write_packing(self.folder / "a.csv", good, density=1.0),
                   lambda: pfv.write_packing(self.folder / "a.data", good, density=float("nan"))]
        refused += [lambda bad=bad: pfv.write_packing(self.folder / "a.csv", bad) for bad in (
            pfv.Packing([[0, 0, float("nan")]], [1.0]), pfv.Packing([[0, 0, 0]], [-1.0]),
            pfv.Packing([[0, 0, 0], [1, 1, 1]], [0.1, 0.1], ids=[4, 4]))]
        for number, case in enumerate(refused):
            with self.subTest(number), self.assertRaises(pfv.InputError):
                case()
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv.permeability is what the command reports, to the last digit."""
import unittest
import warnings

import numpy as np
import pfv
from case import DATA, UNIT, VISCOSITY, CommandCase, grains


class Permeability(CommandCase):
    def of_command(self, name, *words):
        return self.solve(DATA / name, *words)[0]["permeability"]

    def test_it_is_the_commands(self):
        for name in ("packing_100.csv", "packing_500.csv", "bed_200.csv"):
            with self.subTest(packing=name), warnings.catch_warnings():
                warnings.simplefilter("ignore", pfv.AccuracyWarning)
                bed = grains(name)
                box = UNIT if name.startswith("packing") else bounds_of(bed)
                for words, keywords in (([], {}), (["--wall", "symmetry"], {"wall": "symmetry"})):
                    report, _ = self.solve(DATA / name, *words, "--face", "zlo:pressure=1", "--face", "zhi:pressure=0",
                                           box=box)
                    found = pfv.permeability(bed.positions, bed.radii, box, viscosity=VISCOSITY, **keywords)
                    self.assertEqual(found, report["permeability"])

    def test_it_takes_settings_axes_and_periods(self):
        bed = grains()
        along_x = self.of_command("packing_100.csv", "--face", "xlo:pressure=1", "--face",
                                  "xhi:pressure=0", "--conductance", "hydraulic_radius")
        self.assertEqual(pfv.permeability(bed.positions, bed.radii, UNIT, axis="x", viscosity=VISCOSITY,
                                          conductance="hydraulic_radius"), along_x)
        periodic = self.of_command("bed_periodic_60.csv", "--periodic", "x,y,z", "--gradient", "0", "0", "-1")
        bed = grains("bed_periodic_60.csv")
        self.assertEqual(pfv.permeability(bed.positions, bed.radii, UNIT, periodic="xyz", viscosity=VISCOSITY),
                         periodic)

    def test_axes_have_names_and_numbers(self):
        bed = grains()
        for number, name in enumerate("xyz"):
            self.assertEqual(pfv.permeability(bed.positions, bed.radii, UNIT, axis=number),
                             pfv.permeability(bed.positions, bed.radii, UNIT, axis=name))
        for wrong in ("w", 3, None):
            with self.assertRaisesRegex(pfv.InputError, "there is no axis"):
                pfv.permeability(bed.positions, bed.radii, UNIT, axis=wrong)

    def test_lengths_in_mm_are_asked_about(self):
        bed = grains()
        with self.assertWarnsRegex(pfv.PackingWarning, "lengths are in m: are these in mm"):
            pfv.permeability(1e3 * bed.positions, 1e3 * bed.radii, 1e3 * np.array(UNIT))

    def test_lists_are_taken_too(self):
        bed = grains()
        self.assertEqual(pfv.permeability(bed.positions.tolist(), bed.radii.tolist(), UNIT),
                         pfv.permeability(bed.positions, bed.radii, np.array(UNIT)))

    def test_it_warns_where_its_error_may_not_hold(self):
        bed = grains("bed_cavity.csv")
        report, _ = self.solve(DATA / "bed_cavity.csv", "--face", "zlo:pressure=1", "--face", "zhi:pressure=0",
                               box=bounds_of(bed))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pfv.permeability(bed.positions, bed.radii, bounds_of(bed), viscosity=VISCOSITY)
        self.assertEqual(len(caught), len(report["outside_range"]))
        for warning, reason in zip(caught, report["outside_range"]):
            self.assertIs(warning.category, pfv.AccuracyWarning)
            self.assertIn(reason, str(warning.message))

    def test_a_compressible_fluid_has_none(self):
        bed = grains()
        with self.assertRaises(pfv.InputError):
            pfv.permeability(bed.positions, bed.radii, UNIT, bulk_modulus=1e9)


def bounds_of(bed):
    """A box around all centres."""
    lower, upper = bed.positions.min(axis=0) - 0.01, bed.positions.max(axis=0) + 0.01
    return np.round(np.column_stack([lower, upper]), 3).tolist()


if __name__ == "__main__":
    unittest.main()

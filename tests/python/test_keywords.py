# SPDX-License-Identifier: GPL-3.0-or-later
"""Keywords are the settings of the library's table."""
import os
import re
import subprocess
import unittest

import numpy as np
import pfv
from case import UNIT, grains, through_flow


class Keywords(unittest.TestCase):
    def test_they_are_those_of_the_commands_page(self):
        page = subprocess.run([os.environ["PFV_COMMAND"], "settings"], check=True, stdout=subprocess.PIPE,
                              text=True).stdout
        rows = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
                for line in page.splitlines() if line.startswith("| ") and not line.startswith("| setting ")]
        of_page = {row[0]: (row[2], row[3], row[8].replace("\\|", "|")) for row in rows if row[6]}
        self.assertEqual(of_page, {row["name"]: (row["unit"], row["default"], row["help"]) for row in pfv.settings()})
        self.assertNotIn("couple_every", of_page)

    def test_the_help_has_each_with_its_default(self):
        for text in (pfv.Flow.__doc__, pfv.permeability.__doc__):
            for row in pfv.settings():
                self.assertRegex(text, rf"\n    {row['name']} = .*\(default {re.escape(row['default'])}\)")

    def test_each_takes_its_default(self):
        for row in pfv.settings():
            if row["default"] == "none" or row["models"] != ["pfv", "darcy_grid"]:
                continue
            reader = {"solver": "cg"} if row["name"] == "tolerance" else {}
            pfv.Flow(UNIT, **{row["name"]: row["default"]}, **reader)

    def test_an_unknown_one_is_answered_with_those_that_are_like_it(self):
        for make in (pfv.Flow, lambda box, **settings: pfv.permeability([[0.5] * 3], [0.1], box, **settings)):
            with self.assertRaisesRegex(TypeError, "'conductanc'; is conductance meant"):
                make(UNIT, conductanc="open_throat")
            with self.assertRaisesRegex(TypeError, "it has viscosity, density, .*outside"):
                make(UNIT, xyz=1)
        with self.assertRaisesRegex(TypeError, "'viscocity'; is viscosity meant"):
            pfv.Fluid(viscocity=1)
        with self.assertRaisesRegex(TypeError, "'presure'; is pressure"):
            pfv.Box(UNIT).face("zlo", presure=1)

    def test_values_are_pythons(self):
        pfv.Flow(UNIT, torques=True, threads=2, retriangulate="largest 0.02", buoyancy=np.bool_(False))
        pfv.Flow(UNIT, threads=np.int64(2), viscosity=np.float32(0.5), gravity=np.array([0, 0, -9.81]),
                 density=np.array(900.0))
        pfv.Flow(UNIT, model="darcy_grid", cells=np.array([2, 2, 2]), bulk_modulus=None)
        self.assertEqual(pfv.Fluid(viscosity=0.1).viscosity, 0.1)
        self.assertEqual(pfv.Fluid(viscosity=1 / 3).viscosity, 1 / 3)

    def test_bad_values_are_refused_with_the_table_s_words(self):
        for keywords, words in (({"viscosity": -1}, "viscosity.*> 0"), ({"solver": "pardiso"}, "auto, supernodal"),
                                ({"threads": 1.5}, "threads"), ({"gravity": [0, 0]}, "gravity along z is missing"),
                                ({"gravity": [0, 0, 1, 2]}, "too many values"), ({"torques": "maybe"}, "yes or no"),
                                ({"tolerance": 1e-8}, "supernodal"), ({"cells": (2, 2, 2)}, "takes no cells"),
                                ({"model": "darcy_grid"}, "needs the numbers of its cells"),
                                ({"viscosity": float("nan")}, "viscosity"), ({"threads": True}, "threads"),
                                ({"shear_viscous": True, "coupling": "implicit", "solver": "cholmod"},
                                 "solves no implicit steps")):
            with self.subTest(keywords=keywords), self.assertRaisesRegex(pfv.InputError, words):
                pfv.Flow(UNIT, **keywords)
        for keywords in ({"viscosity": None}, {"solver": object()}, {"viscosity": 1j}):
            with self.subTest(keywords=keywords), self.assertRaises(TypeError):
                pfv.Flow(UNIT, **keywords)

    def test_a_fluid_is_said_once(self):
        with self.assertRaisesRegex(TypeError, "viscosity is the fluid's"):
            pfv.Flow(UNIT, pfv.Fluid(), viscosity=1.0)
        self.assertEqual(pfv.Flow(UNIT, viscosity=3.0).fluid.viscosity, 3.0)

    def test_settings_reach_the_work(self):
        bed = grains()
        for solver in ("cholmod", "klu2", "cg"):
            flow = pfv.Flow(through_flow(), solver=solver)
            flow.evaluate(bed.positions, bed.radii)
            self.assertEqual(flow.report()["solver"], solver)


class Fluid(unittest.TestCase):
    def test_its_defaults_are_the_tables(self):
        fluid, table = pfv.Fluid(), {row["name"]: row["default"] for row in pfv.settings()}
        self.assertEqual((fluid.viscosity, fluid.density), (float(table["viscosity"]), float(table["density"])))
        self.assertEqual((fluid.gravity.tolist(), fluid.bulk_modulus), ([0, 0, 0], None))

    def test_it_does_not_change(self):
        fluid = pfv.Fluid(gravity=(0, 0, -9.81))
        with self.assertRaises(AttributeError):
            fluid.viscosity = 2.0
        fluid.gravity[2] = 0
        self.assertEqual(fluid.gravity[2], -9.81)
        self.assertIn("gravity=0 0 -9.81", repr(fluid))


if __name__ == "__main__":
    unittest.main()

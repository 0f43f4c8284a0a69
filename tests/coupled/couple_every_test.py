# SPDX-License-Identifier: GPL-3.0-or-later
"""couple_every auto: fewer solves, the same run; and a sealed fluid whose box changes at constant volume."""
import re
import unittest

from coupled import EDGE, CoupledTest, faces, packing, read_thermo, write_data
from plates import write_plate
from settled import STEP, SettledTest

AUTO = "couple_every auto"


class CoupleEvery(SettledTest):
    def run_with(self, words, ratio=0.05, steps=400):
        """(rows of each tenth step, solves, steps)"""
        fix = self.fix(ratio * SettledTest.limit / STEP, words)
        screen = self.liggghts(self.script(fix, f"thermo 10\nrun {steps}\n"))
        said = re.search(r"solved at (\d+) of (\d+) steps, estimated error (\S+) %", screen)
        solves = int(said.group(1)) if said else steps
        return read_thermo((self.folder / "log.liggghts").read_text()), solves

    def test_auto_does_as_each_step_with_few_solves(self):
        each, _ = self.run_with("couple_every 1")
        auto, solves = self.run_with(AUTO)
        self.assertLess(solves, 200)  # of 400
        settled = abs(each[-1]["height"] - each[0]["height"])
        for row, other in zip(auto, each):
            self.assertLess(abs(row["height"] - other["height"]), 2e-3 * settled)

    def test_a_smaller_error_costs_more_solves(self):
        _, coarse = self.run_with(AUTO + " error 1")
        _, fine = self.run_with(AUTO + " error 0.01")
        self.assertLess(coarse, fine)

    def test_near_the_limit_each_step_is_solved(self):
        _, solves = self.run_with(AUTO, ratio=0.5, steps=50)
        self.assertEqual(solves, 50)

    def test_where_each_step_is_solved_no_load_was_held_that_could_err(self):
        fix = self.fix(0.5 * SettledTest.limit / STEP, AUTO)
        self.assertRegex(self.liggghts(self.script(fix, "run 20\n")), r"solved at 20 of 20 steps\n")

    def test_a_compressible_fluid_is_solved_at_each_step(self):
        _, solves = self.run_with(AUTO + " bulk_modulus 1e7", steps=50)
        self.assertEqual(solves, 50)

    def test_restart_continues_with_the_same_bytes(self):
        self.restarts_with_the_same_bytes(self.fix(0.05 * SettledTest.limit / STEP, AUTO))

    def test_a_pressure_that_jumps_is_solved_for_at_once(self):
        flow = self.fix(0.05 * SettledTest.limit / STEP, AUTO).replace("pressure 0", "pressure v_p", 1)
        self.liggghts("variable p equal 100*(step>150)\n" +
                      self.script(flow, "thermo 1\nrun 160\n"))
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertLess(abs(rows[150]["flow[7]"]), 30.0)
        self.assertGreater(rows[151]["flow[7]"], 30.0)

    def test_fix_modify_to_each_nth_step_ends_it(self):
        flow = self.fix(0.05 * SettledTest.limit / STEP, AUTO)
        self.liggghts(self.script(flow, "") +
                      "thermo_style custom step f_flow[10]\nthermo_modify norm no\nthermo 1\nrun 5\n"
                      "fix_modify flow couple_every 4\nrun 0\nrun 12\n")
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        since = [row["flow[10]"] for row in rows[-12:]]
        self.assertEqual(sum(steps == 0 for steps in since), 3)
        self.assertEqual(max(since), 3)

    def test_refuses_an_error_that_is_none(self):
        for words in ("couple_every auto error 0", "couple_every auto error 200"):
            self.refused(self.script(self.fix(1.0, words), "run 0\n"), "couple_every", "error")


class ConstantVolume(CoupledTest):
    def test_one_lid_out_and_one_in(self):
        """The box loses a² EDGE of its volume: pressures on networks of up to 1 % of strain."""
        grains = packing(3)
        write_data(self.folder, grains)
        for name, axis in (("xhi", 0), ("zhi", 2)):
            corners = [[a, b] for a, b in ((-0.05, -0.05), (0.15, -0.05), (0.15, 0.15), (-0.05, 0.15))]
            for corner in corners:
                corner.insert(axis, EDGE)
            write_plate(self.folder / f"{name}.stl", corners)
        modulus = 1e6
        self.liggghts(
            "include in.packing\nunfix integr\n"
            "fix xhi all mesh/surface/stress file xhi.stl type 1\n"
            "fix zhi all mesh/surface/stress file zhi.stl type 1\n"
            "fix out all move/mesh mesh xhi linear 0.1 0 0\n"
            "fix in all move/mesh mesh zhi linear 0 0 -0.1\n"
            f"fix flow all pfv viscosity 0.01 bulk_modulus {modulus} "
            f"{faces(xhi='mesh xhi', zhi='mesh zhi')}\n"
            "thermo_style custom step f_flow[5] f_flow[7]\n"
            "thermo_modify norm no format float %.15g\nthermo 250\nrun 1000\n")
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertGreater(rows[-1]["flow[5]"], 2)
        fluid = EDGE**3 - sum(4 / 3 * 3.141592653589793 * grain[4]**3 for grain in grains)
        for row in rows[1:]:
            moved = 0.1 * row["Step"] * 1e-5
            exact = modulus * moved**2 * EDGE / fluid
            self.assertAlmostEqual(row["flow[7]"] / exact, 1.0, delta=1e-3)


if __name__ == "__main__":
    unittest.main()

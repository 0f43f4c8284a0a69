# SPDX-License-Identifier: GPL-3.0-or-later
"""The forces that grains receive in a run are those of the library on the same grains."""
import math
import unittest

from coupled import EDGE, FLOW, WATER, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, write_data

# dumps carry 17 digits, so both programs see the same numbers; LIGGGHTS parses and prints them once
SAME = 1e-10
PRESSURES = ("--face", "zlo:pressure=10", "--face", "zhi:pressure=0")


class Forces(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing())

    def move_grains(self):
        write_data(self.folder, packing(), random_velocities(packing()))

    def test_still_grains_get_the_forces_of_pfv_solve(self):
        self.liggghts(f"include in.packing\nfix flow all pfv {FLOW}\n{dump('d.dump')}run 0\n")
        rows = read_dump(self.folder / "d.dump")[0]
        expected = self.pfv_forces("d.dump", *PRESSURES)
        self.assertLess(largest_difference(forces(rows), expected), SAME)

    def test_moving_grains_get_the_forces_of_pfv_solve(self):
        self.move_grains()
        self.liggghts(f"include in.packing\nfix flow all pfv {FLOW}\n{dump('d.dump')}run 0\n")
        rows = read_dump(self.folder / "d.dump")[0]
        expected = self.pfv_forces("d.dump", *PRESSURES)
        still = self.pfv_forces(self.without_velocities(rows), *PRESSURES)
        self.assertGreater(largest_difference(still, expected), 1e-3)  # the velocities matter
        self.assertLess(largest_difference(forces(rows), expected), SAME)

    def without_velocities(self, rows):
        lines = ["id,x,y,z,radius"]
        lines += [",".join([str(n)] + [repr(v) for v in row[:4]]) for n, row in rows.items()]
        (self.folder / "still.csv").write_text("\n".join(lines) + "\n")
        return "still.csv"

    def test_forces_sum_to_pressure_drop_times_section(self):
        """With symmetry at the side walls the grains carry all of dP S (Chareyre 2012, sec. 3)."""
        flow = FLOW.replace("plane 0.0 sealed", "plane 0.0 symmetry sealed")
        flow = flow.replace(f"plane {EDGE} sealed", f"plane {EDGE} symmetry sealed")
        self.liggghts(f"include in.packing\nfix flow all pfv {flow}\n{dump('d.dump')}run 0\n")
        total = [sum(f[k] for f in forces(read_dump(self.folder / "d.dump")[0]).values())
                 for k in range(3)]
        self.assertAlmostEqual(total[2] / (10 * EDGE**2), 1.0, delta=1e-12)

    def test_forces_move_the_grains(self):
        """After one step from rest, v = f dt/m for half a step and then another half."""
        grains = packing()
        self.liggghts(f"include in.packing\nfix flow all pfv {FLOW}\n{dump('d.dump')}run 1\n")
        steps = read_dump(self.folder / "d.dump")
        for n, *_, radius in grains:
            mass = 2600 * 4 / 3 * math.pi * radius**3
            for k in range(3):
                expected = 0.5e-5 / mass * (steps[0][n][7 + k] + steps[1][n][7 + k])
                self.assertAlmostEqual(steps[1][n][4 + k], expected, delta=1e-10 * abs(expected))

    def test_flow_is_advanced_once_every_n_steps_and_held_between(self):
        self.move_grains()
        self.liggghts("include in.packing\n"
                      f"fix flow all pfv {WATER} couple_every 5\n{dump('d.dump')}run 12\n")
        steps = read_dump(self.folder / "d.dump")
        changes = [step for step in range(1, 13) if forces(steps[step]) != forces(steps[step - 1])]
        self.assertEqual(changes, [5, 10])

    def test_flow_every_n_steps_takes_mean_velocities(self):
        self.move_grains()
        self.liggghts("include in.packing\n"
                      f"fix flow all pfv {WATER} couple_every 5 volume_rates geometric\n"
                      f"{dump('d.dump')}run 10\n")
        steps = read_dump(self.folder / "d.dump")
        lines = ["id,x,y,z,radius,vx,vy,vz"]
        for n, row in steps[10].items():
            mean = [(row[k] - steps[5][n][k]) / 5e-5 for k in range(3)]
            lines.append(",".join([str(n)] + [repr(v) for v in steps[0][n][:4] + mean]))
        (self.folder / "mean.csv").write_text("\n".join(lines) + "\n")
        # the network is still that of step 0: the strain of 10 steps is far below 1 %
        expected = self.pfv_forces("mean.csv", *PRESSURES, "--volume-rates", "geometric")
        self.assertLess(largest_difference(forces(steps[10]), expected), SAME)

    def test_pressures_follow_their_variables(self):
        """p at zlo doubles with its variable: so do the forces of grains at rest."""
        flow = FLOW.replace("pressure 10", "pressure v_p")
        self.liggghts("include in.packing\nunfix integr\nvariable p equal 10*(1+step)\n"
                      f"fix flow all pfv {flow}\n{dump('d.dump')}run 1\n")
        steps = read_dump(self.folder / "d.dump")
        doubled = {n: [2 * v for v in f] for n, f in forces(steps[0]).items()}
        self.assertLess(largest_difference(forces(steps[1]), doubled), 1e-13)

    def test_variables_may_ask_computes(self):
        """Energies are tallied only in steps that were announced: each flow step has to be."""
        flow = WATER.replace("pressure 10", "pressure v_p")
        self.liggghts("include in.packing\ncompute e all pe\nvariable p equal 10+0*c_e\n"
                      f"fix flow all pfv {flow} couple_every 3\n" + dump("d.dump") + "run 7\n")
        variable = (self.folder / "d.dump").read_bytes()
        self.liggghts(f"include in.packing\nfix flow all pfv {WATER} couple_every 3\n" +
                      dump("d.dump") + "run 7\n")
        self.assertEqual((self.folder / "d.dump").read_bytes(), variable)

    def test_grains_outside_the_group_are_invisible(self):
        self.liggghts("include in.packing\nregion half block -1 1 -1 1 -1 0.05 units box\n"
                      f"group wet region half\nfix flow wet pfv {FLOW}\n{dump('d.dump')}run 0\n")
        rows = read_dump(self.folder / "d.dump")[0]
        dry = [row for row in rows.values() if row[2] > 0.05]
        self.assertGreater(len(dry), 0)
        self.assertEqual({tuple(row[7:11]) for row in dry}, {(0.0, 0.0, 0.0, 0.0)})
        wet = {n: row for n, row in rows.items() if row[2] <= 0.05}
        self.without_velocities(wet)
        expected = self.pfv_forces("still.csv", *PRESSURES)
        self.assertLess(largest_difference(forces(wet), expected), SAME)

    def test_buoyancy_once_where_there_is_gravity(self):
        """Still fluid, sealed box: each grain gets rho V g upwards; nothing with buoyancy no."""
        sealed = "viscosity 0.01 density 1000 " + FLOW.split(" ", 2)[2].replace(
            "pressure 10", "sealed").replace("pressure 0", "sealed")
        for words, factor in ((sealed, 1.0), (sealed + " buoyancy no", 0.0)):
            self.liggghts("include in.packing\nfix g all gravity 9.81 vector 0 0 -1\n"
                          f"fix flow all pfv {words}\n{dump('d.dump')}run 0\n")
            for row in read_dump(self.folder / "d.dump")[0].values():
                lift = 1000 * 4 / 3 * math.pi * row[3]**3 * 9.81
                self.assertAlmostEqual(row[9], factor * lift, delta=1e-12 * lift)

    def test_gravity_is_that_of_a_grain_however_many_fixes_give_it(self):
        """A fix for each group is no more gravity than one for all; fixes that add up in each grain are."""
        groups = "group a id <= 40\ngroup b subtract all a\n"
        flow = f"fix flow all pfv {FLOW} density 1000\n{dump('d.dump')}run 0\n"
        found = []
        for gravity in ("fix g all gravity 9 vector 0 0 -1\n",
                        "fix ga a gravity 9 vector 0 0 -1\nfix gb b gravity 9 vector 0 0 -1\n",
                        "fix ga a gravity 9 vector 0 0 -1\n",  # the others have none of their own, and the same lift
                        "fix g1 all gravity 4 vector 0 0 -1\nfix g2 all gravity 5 vector 0 0 -1\n"):
            self.liggghts("include in.packing\n" + groups + gravity + flow)
            found.append(forces(read_dump(self.folder / "d.dump")[0]))
        for other in found[1:]:
            self.assertEqual(other, found[0])
        self.refused("include in.packing\n" + groups + "fix ga a gravity 9 vector 0 0 -1\n"
                     "fix gb b gravity 8 vector 0 0 -1\n" + flow, "fix gravity 'ga'", "fix gravity 'gb'", "the fluid has one")

    def test_thermo_output(self):
        self.liggghts("include in.packing\n"
                      f"fix flow all pfv {FLOW}\n"
                      "thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[4] "
                      "f_flow[5] f_flow[6] f_flow[7] f_flow[8]\n"
                      "thermo_modify format float %.15g\nthermo 1\nrun 2\n")
        first, _, last = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual(first["flow"], 0.0)
        self.assertGreater(last["flow"], 0.0)
        self.assertGreater(first["flow[1]"], 0.0)
        self.assertAlmostEqual(first["flow[2]"] / first["flow[1]"], 1.0, delta=1e-10)
        self.assertLess(abs(first["flow[3]"]), 1e-10)
        self.assertLess(abs(last["flow[3]"]), 1e-10)
        self.assertLess(first["flow[4]"], 1e-12)
        self.assertEqual(first["flow[5]"], 0.0)
        self.assertTrue(0.0 < first["flow[6]"] < 1.0)
        self.assertTrue(3.0 < first["flow[7]"] < 7.0)  # between 0 and 10 Pa, near the middle
        self.assertEqual(first["flow[8]"], 0.0)


if __name__ == "__main__":
    unittest.main()

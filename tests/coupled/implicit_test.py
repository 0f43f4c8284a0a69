# SPDX-License-Identifier: GPL-3.0-or-later
"""Implicit coupling, and pistons in all couplings, on the sample of settled.py."""
import math
import unittest

from coupled import EDGE, dump, forces, largest_difference
from coupled import read_dump, read_thermo, restarted_head
from plates import square, write_plate
from settled import GRAVITY, STEP, THERMO, WALLS, SettledTest

LOAD, VEL_MAX = 20.0, 5.0  # N; m/s, never reached


def lid(mass, load=LOAD):
    """A servo whose integral gain alone makes the lid a piston of this mass (kg) under the load."""
    return (f"fix lid all mesh/surface/stress/servo file lid.stl type 1 move 0 0 {EDGE} "
            f"com {EDGE / 2} {EDGE / 2} {EDGE} ctrlPV force axis 0 0 -1 target_val {load!r} "
            f"vel_max {VEL_MAX} kp 0 ki {load / (VEL_MAX * mass)!r}\n"
            "fix plates all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 "
            "meshes lid\n")


class Implicit(SettledTest):
    # stability and accuracy

    def test_stable_to_ten_thousand_limits(self):
        """Consolidation with retriangulations; the explicit coupling explodes at R = 20. At R = 1e4
        water leaves so slowly that there is less to decay."""
        for ratio in (10, 100, 1000, 10000):
            rows = self.thermo(self.script(self.at_ratio(ratio, "coupling implicit"),
                                           "thermo 10\nrun 600\n"))
            energy = [row["KinEng"] for row in rows]
            self.assertLess(energy[-1], 0.1 * max(energy), ratio)
            self.assertLess(max(energy), 0.1, ratio)
            self.assertEqual({row["flow[9]"] for row in rows}, {1.0})

    def test_settlement_and_pressure_are_those_of_the_explicit_run_at_its_own_limit(self):
        """Of first order in the time step: 0.8 % of the settlement and 1.7 % of the peak pressure were
        measured, half of it at half of the step; most of it are the dashpots, which act with v(n-1/2)."""
        kept = "retriangulate 1000"  # or the pressures differ by the jumps of new networks
        implicit = self.thermo(self.script(self.at_ratio(20, "coupling implicit " + kept),
                                           "thermo 1\nrun 120\n"))
        fine = self.thermo(self.script(self.at_ratio(20, kept), "thermo 25\nrun 3000\n",
                                       step=STEP / 25))
        settled = abs(fine[-1]["height"] - fine[0]["height"])
        peak = max(row["flow[7]"] for row in fine[20:])
        for at in range(20, 121):
            row, other = implicit[at], fine[at]
            self.assertLess(abs(row["height"] - other["height"]), 0.01 * settled)
            self.assertLess(abs(row["flow[7]"] - other["flow[7]"]), 0.02 * peak)

    def test_shear_viscous_forces_as_by_explicit_steps_and_to_ten_thousand_limits(self):
        """They settle less far with them; 0.9 % of the settlement were measured beside explicit steps, and no
        energy grows."""
        kept = "retriangulate 1000 shear_viscous yes"
        implicit = self.thermo(self.script(self.at_ratio(20, "coupling implicit " + kept), "thermo 1\nrun 120\n"))
        fine = self.thermo(self.script(self.at_ratio(20, kept), "thermo 25\nrun 3000\n", step=STEP / 25))
        settled = abs(fine[-1]["height"] - fine[0]["height"])
        for at in range(20, 121):
            self.assertLess(abs(implicit[at]["height"] - fine[at]["height"]), 0.015 * settled)
        for ratio in (100, 10000):
            energy = [row["KinEng"] for row in self.thermo(self.script(
                self.at_ratio(ratio, "coupling implicit shear_viscous yes"), "thermo 10\nrun 600\n"))]
            self.assertLess(energy[-1], 0.1 * max(energy), ratio)
            self.assertLess(max(energy), 0.1, ratio)

    # pistons

    def piston_script(self, viscosity, mass, words, run, step=STEP):
        write_plate(self.folder / "lid.stl", square(EDGE, 0.0))
        fix = self.fix(viscosity, words).replace(
            f"face zhi plane {EDGE} pressure 0", "face zhi mesh lid sealed")
        walls = "".join(line + "\n" for line in WALLS.splitlines() if "wzhi" not in line)
        thermo = THERMO.replace("f_flow[9]", "f_flow[9] f_flow[1] f_flow[2] f_lid[3] f_lid[12]")
        return ("include in.packing\n" + walls + GRAVITY.format(30) + lid(mass) + fix +
                f"timestep {step!r}\n" + thermo + run)

    def test_a_piston_counts_in_the_limit_and_the_limit_is_that_of_liggghts(self):
        """A light lid on the water, over four decades of viscosity: explicit runs 5 % below the printed
        limit come to rest on the load, those 5 % above throw the lid (3 % were measured)."""
        mass = 0.01
        limit = self.thermo(self.piston_script(1.0, mass, "", "run 0\n"))[0]["flow[6]"]
        self.assertLess(limit, 0.3 * self.limit)
        for viscosity in (1e2, 1e4, 1e6):  # contacts have no say at steps this short
            bearing = {}
            for factor in (0.95, 1.05):
                rows = self.thermo(self.piston_script(
                    viscosity, mass, "time_step_check no retriangulate 1000", "run 600\n",
                    step=factor * limit / viscosity))
                bearing[factor] = rows[-1]["lid[3]"]
            self.assertAlmostEqual(bearing[0.95] / LOAD, 1.0, delta=0.05)
            self.assertGreater(abs(bearing[1.05]), 100 * LOAD)

    def test_staged_and_implicit_bear_the_load_where_the_explicit_coupling_throws_the_lid(self):
        mass = 0.01
        limit = self.thermo(self.piston_script(1.0, mass, "", "run 0\n"))[0]["flow[6]"]
        for words, ratio in (("coupling staged", 100), ("coupling staged", 1000),
                             ("coupling implicit", 100), ("coupling implicit", 10000)):
            screen = self.liggghts(self.piston_script(ratio * limit / STEP, mass, words,
                                                      "thermo 1\nrun 200\n"))
            self.assertIn("pistons 1", screen)
            rows = read_thermo((self.folder / "log.liggghts").read_text())
            self.assertAlmostEqual(rows[-1]["lid[3]"] / LOAD, 1.0, delta=0.02)
            self.assertLess(max(row["KinEng"] for row in rows), 0.05)
        thrown = self.thermo(self.piston_script(100 * limit / STEP, mass, "time_step_check no",
                                                "run 3\n"))[-1]["lid[3]"]
        self.assertGreater(abs(thrown), 100 * LOAD)

    def test_water_leaves_as_fast_as_the_lid_comes_down(self):
        """The outflow of an implicit step is that of velocities between those of the last step and those
        which LIGGGHTS finds from its forces: nothing but the lid changes the volume of the box."""
        limit = self.thermo(self.piston_script(1.0, 0.05, "", "run 0\n"))[0]["flow[6]"]
        script = self.piston_script(100 * limit / STEP, 0.05, "coupling implicit",
                                    "thermo 1\nrun 40\nrun 40\n")
        rows = self.thermo(script.replace("float %.15g", "float %.17g"))
        setups = 0, 41  # of the two runs: LIGGGHTS kicks half a step
        for at in set(range(1, len(rows) - 1)) - {one + by for one in setups for by in (-1, 0)}:
            before, row, after = rows[at - 1:at + 2]
            lost = ((before["lid[12]"] - row["lid[12]"]) / 3 +
                    (row["lid[12]"] - after["lid[12]"]) * 2 / 3) * EDGE**2 / STEP
            self.assertAlmostEqual((row["flow[2]"] - row["flow[1]"]) / lost, 1.0, delta=1e-6)

    # cost

    def test_solves_and_factors_of_a_step(self):
        def counts(steps):
            screen = self.liggghts(self.script(self.at_ratio(100, "coupling implicit "
                                                             "retriangulate 10"),
                                               f"run {steps}\n"))
            return [next(int(line.split()[2]) for line in screen.splitlines()
                         if line.startswith(name)) for name in ("solve ", "factor ")]
        two, six = counts(2), counts(6)
        self.assertEqual(six[0] - two[0], 4)
        self.assertEqual(six[1], 2)  # G for the limit, and A

    def test_auto_is_implicit_where_that_is_cheaper(self):
        """Many steps between two networks and a large R; staged where R is small, and where the solver does not
        factor the matrix of implicit steps with shear viscous forces."""
        for ratio, words, wanted in ((1000, "retriangulate 10", "coupling implicit"),
                                     (1000, "retriangulate 10 shear_viscous yes", "coupling implicit"),
                                     (1000, "retriangulate 10 shear_viscous yes solver cholmod", "coupling staged"),
                                     (4, "retriangulate 10", "coupling staged")):
            dumps = []
            for coupling in (wanted, "coupling auto"):
                self.liggghts(self.script(self.at_ratio(ratio, f"{coupling} {words}"),
                                          dump("d.dump") + "run 20\n"))
                dumps.append((self.folder / "d.dump").read_bytes())
            self.assertEqual(dumps[0], dumps[1], ratio)

    # grains that the fluid does not move

    def test_frozen_grains_stay_and_feel_the_same_force_however_they_are_held(self):
        group = "group some id 1 20 40 60 80 100\ngroup others subtract all some\n"
        held = {"freeze": "fix hold some freeze\n", "setforce": "fix hold some setforce 0 0 0\n",
                "no integrator": "unfix integr\nfix integr others nve/sphere\n"}
        seen = {}
        for name, words in held.items():
            self.thermo(self.script(self.at_ratio(100, "coupling implicit"),
                                    dump("d.dump") + "run 50\n",
                                    before=group).replace(THERMO, words + THERMO))
            steps = read_dump(self.folder / "d.dump")
            seen[name] = steps[0]
            for grain in (1, 20, 40, 60, 80, 100):
                self.assertEqual(steps[50][grain][:6], steps[0][grain][:6])
        for name in held:
            self.assertEqual(seen[name], seen["freeze"])

    # what the script's author is told

    def refuse(self, words, *parts, fix="coupling implicit", before=""):
        self.refused(self.script(self.at_ratio(20, fix), words + "run 1\n", before=before), *parts)

    def test_refusals(self):
        self.refuse("", "couple_every 1", fix="coupling implicit couple_every 2")
        self.refuse("fix late all gravity 1 vector 1 0 0\n", "gravity 'late'", "after this fix")
        self.refuse("", "freeze 'early'", "define it after",
                    before="group one id 1\nfix early one freeze\n")

    def test_change_of_the_time_step_and_of_radii_between_runs(self):
        """Smaller grains no longer touch: they fall, in step with the water."""
        rows = self.thermo(self.script(
            self.at_ratio(100, "coupling implicit"),
            f"run 20\ntimestep {STEP / 2!r}\nrun 20\ntimestep {2 * STEP!r}\nrun 20\n"
            "set group all diameter 0.016\nrun 20\n"))
        self.assertTrue(all(math.isfinite(row["KinEng"]) for row in rows))
        self.assertLess(max(row["KinEng"] for row in rows), 0.01)

    # restart, ranks

    def test_continued_and_restarted_run_write_the_same_bytes(self):
        for words in ("coupling implicit", "coupling implicit shear_viscous yes", "coupling auto"):
            self.restarts_with_the_same_bytes(self.at_ratio(100, words))

    def test_two_ranks_give_the_forces_of_one_and_bear_the_piston(self):
        fix = self.at_ratio(100, "coupling implicit")
        self.liggghts(self.script(fix, "run 20\nwrite_restart file.restart\n"))
        steps = {}
        for ranks in (1, 2):
            self.liggghts(restarted_head() + WALLS + GRAVITY.format(40) + fix +
                          f"timestep {STEP}\n" + dump(f"{ranks}.dump") + "run 1\n", ranks=ranks)
            steps[ranks] = read_dump(self.folder / f"{ranks}.dump")
        for step in (20, 21):
            self.assertLess(largest_difference(forces(steps[2][step]), forces(steps[1][step])), 1e-8)
        limit = self.thermo(self.piston_script(1.0, 0.01, "", "run 0\n"))[0]["flow[6]"]
        rows = self.thermo(self.piston_script(100 * limit / STEP, 0.01, "coupling implicit",
                                              "run 200\n"), ranks=2)
        self.assertAlmostEqual(rows[-1]["lid[3]"] / LOAD, 1.0, delta=0.02)


if __name__ == "__main__":
    unittest.main()

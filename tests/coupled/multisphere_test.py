# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies of several spheres (fix multisphere): lift, time-step limit. Their couplings: bodies_test.py."""
import math
import unittest

from coupled import CONTACT, CoupledTest, read_dump, read_thermo

HEAD = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
region all block -0.05 0.15 -0.05 0.15 -0.05 0.15 units box
create_box 1 all
neighbor 0.002 bin
neigh_modify delay 0
""" + CONTACT + """region place block 0.03 0.07 0.03 0.07 0.03 0.07 units box
fix shape all particletemplate/multisphere 15485863 atom_type 1 density constant 1000 &
    nspheres {count} ntry 1000000 spheres file body.txt scale 1.0 type 1
fix sizes all particledistribution/discrete 15485867 1 shape 1.0
fix drop all insert/pack seed 32452843 distributiontemplate sizes maxattempt 100 &
    insert_every once overlapcheck yes vel constant 0. 0. {speed} region place &
    particles_in_region 1 ntry_mc 10000
fix move all multisphere
timestep {step}
run 1
"""
CLOSE = ("face xlo plane 0.03 face xhi plane 0.09 face ylo plane 0.04 face yhi plane 0.09 "
         "face zlo plane 0.04 face zhi plane 0.09 pressure 0")
WIDE = ("face xlo plane 0 symmetry face xhi plane 0.1 symmetry face ylo plane 0 symmetry "
        "face yhi plane 0.1 symmetry face zlo plane 0 symmetry face zhi plane 0.1 pressure 0")
VISCOUS = f"fix flow all pfv viscosity 2000 {CLOSE}\n"
GRAVITY = "fix weight all gravity 10.0 vector 0 0 -1\n"
PAIR = [(-0.005, 0, 0, 0.01), (0.005, 0, 0, 0.01)]
R = 0.01
UNION_OF_PAIR = 2 * 4 / 3 * math.pi * R**3 - 2 * math.pi * (R / 2)**2 * (3 * R - R / 2) / 3  # m3
DUMP = ("dump d all custom 1 d.dump id x y z radius vx vy vz f_flow[1] f_flow[2] f_flow[3] "
        "f_flow[4]\ndump_modify d sort id format \"%d" + " %.17g" * 11 + "\"\n")
THERMO = ("variable vz atom vz\ncompute speed all reduce ave v_vz\n"
          "variable fast atom sqrt(vx*vx+vy*vy+vz*vz)\ncompute fastest all reduce max v_fast\n"
          "compute lift all reduce sum f_flow[3]\n"
          "thermo_style custom step c_lift c_speed f_flow[6] c_fastest\nthermo_modify format float %.15g\n"
          "thermo 1000\n")


class Multisphere(CoupledTest):
    def head(self, spheres=PAIR, speed=0.0, step=1e-5):
        (self.folder / "body.txt").write_text(
            "".join(" ".join(map(repr, sphere)) + "\n" for sphere in spheres))
        return HEAD.format(count=len(spheres), speed=speed, step=step)

    # lift

    def test_lift_is_that_of_the_union(self):
        """Weight and lift then differ by the noise of LIGGGHTS' own volume (a million points)."""
        script = self.head() + GRAVITY + f"fix flow all pfv viscosity 1e-3 {WIDE}\n" + THERMO
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                rows = read_thermo(self.liggghts(script + "run 200\n", ranks=ranks))
                self.assertAlmostEqual(rows[-2]["lift"] / (1e4 * UNION_OF_PAIR), 1, delta=1e-6)
                # 0.04 m/s2, the noise; 1.8 m/s2 where the overlap counts twice
                self.assertLess(abs(rows[-1]["speed"]) / 2e-3, 0.1)

    def test_lift_acts_at_the_centre_of_mass(self):
        """A homogeneous body of unlike spheres, as dense as the fluid, does not turn."""
        spheres = [(0, 0, 0, 0.01), (0.011, 0, 0, 0.006), (0.013, 0.006, 0, 0.004),
                   (0.002, 0.004, 0.008, 0.005)]
        script = self.head(spheres) + GRAVITY + f"fix flow all pfv viscosity 1e-5 {WIDE}\n"
        self.liggghts(script + DUMP + "run 200\n")
        rows = list(read_dump(self.folder / "d.dump").values())[-1]
        speeds = [row[4:7] for row in rows.values()]
        turning = max(math.dist(a, b) for a in speeds for b in speeds)
        # 1.2e-11; 4.4e-5 with the parts of the union as they are, 2.3e-3 with whole spheres
        self.assertLess(turning, 1e-10)

    def test_behind_the_flow_the_body_gets_its_lift_from_the_first_half_step_on(self):
        """Before it, each run begins with half a step of weight alone: g dt/2 = 5e-5 m/s."""
        flow = f"fix flow all pfv viscosity 1e-3 {WIDE}\n"
        script = self.head().replace("fix move", GRAVITY + flow + "fix move") + THERMO + "run 0\nrun 1\n"
        self.assertLess(abs(read_thermo(self.liggghts(script))[-1]["speed"]), 1e-6)

    def test_a_body_that_lies_across_a_periodic_side_keeps_its_lift(self):
        """It falls through the cell's floor, 1 mm a step, and runs begin with one sphere on either side."""
        upright = [(0, 0, -0.005, 0.01), (0, 0, 0.005, 0.01)]
        head = self.head(upright, speed=-100.0).replace("boundary f f f", "boundary f f p")
        head = head.replace("-0.05 0.15 units box\ncreate_box", "0.0 0.1 units box\ncreate_box")
        sides = WIDE[:WIDE.index("face zlo")]
        script = head + GRAVITY + (f"fix flow all pfv viscosity 1e-9 {sides} point 0.02 0.02 0.02 pressure 0 "
                                   "couple_every 1\n") + THERMO.replace("thermo 1000", "thermo 1") + DUMP
        rows = [row for row in read_thermo(self.liggghts(script + 60 * "run 1\n")) if "lift" in row]
        apart = [abs(steps[0][2] - steps[1][2]) for steps in
                 (list(rows.values()) for rows in read_dump(self.folder / "d.dump").values())]
        self.assertGreater(max(apart), 0.05)
        for row in rows:
            self.assertAlmostEqual(row["lift"] / (1e4 * UNION_OF_PAIR), 1, delta=1e-12)

    def test_without_gravity_there_is_no_lift(self):
        script = self.head() + f"fix flow all pfv viscosity 1e-3 {WIDE}\n" + THERMO + "run 0\n"
        self.assertEqual(read_thermo(self.liggghts(script))[-1]["lift"], 0.0)

    # time step

    def test_limit_is_that_of_the_body(self):
        """Twice the mass over the drag of the body's translation bounds it from above; that of a rotation, or of
        both together, may be the larger one. LIGGGHTS finds the mass by a million random points: to some 0.1 %."""
        around = CLOSE.replace("0.04", "0.02")  # the body lies elsewhere on two ranks
        for ranks, faces in ((1, CLOSE), (1, around), (2, around)):
            with self.subTest(ranks=ranks, faces=faces):
                script = self.head(speed=1e-3) + f"fix flow all pfv viscosity 20000 {faces}\n"
                screen = self.liggghts(script + DUMP + THERMO + "run 0\n", ranks=ranks)
                limit = read_thermo(screen)[-1]["flow[6]"]
                rows = list(read_dump(self.folder / "d.dump").values())[-1]
                force = abs(sum(row[9] for row in rows.values()))
                upper = 2 * 1000 * UNION_OF_PAIR * 1e-3 / force
                self.assertLess(limit, 1.004 * upper)
                self.assertGreater(limit, upper / 2)
                self.assertIn("times the limit of the explicit coupling", screen)
                self.assertIn("`coupling staged`", screen)

    def test_runs_rest_below_the_limit_and_shake_above(self):
        def speed_after(step):
            script = self.head(speed=1e-3, step=step) + VISCOUS + THERMO + "run 400\n"
            return read_thermo(self.liggghts(script))[-1]["fastest"]
        rows = read_thermo(self.liggghts(self.head(speed=1e-3, step=1e-6) + VISCOUS + THERMO + "run 0\n"))
        limit = rows[-1]["flow[6]"]
        self.assertLess(speed_after(0.98 * limit), 1e-5)
        # no grain is left where it was thrown out: LIGGGHTS' largest of none is -1e20
        self.assertGreater(abs(speed_after(1.1 * limit)), 1e-2)

    def test_a_body_that_is_held_has_no_limit(self):
        script = self.head() + VISCOUS + "fix hold all freeze\n" + THERMO + "run 0\n"
        self.assertEqual(read_thermo(self.liggghts(script))[-1]["flow[6]"], math.inf)

    def test_a_run_that_goes_on_keeps_its_network(self):
        script = self.head() + GRAVITY + f"fix flow all pfv viscosity 1e-3 {WIDE}\n"
        screen = self.liggghts(script + "thermo_style custom step f_flow[5]\nrun 5\nrun 0\nrun 5\n")
        self.assertEqual([row["flow[5]"] for row in read_thermo(screen) if "flow[5]" in row], [0] * 5)


if __name__ == "__main__":
    unittest.main()

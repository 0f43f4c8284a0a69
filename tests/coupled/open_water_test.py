# SPDX-License-Identifier: GPL-3.0-or-later
"""Grains that have left the bed under a plane with a pressure: the drag of one alone, on its way and slowing down."""
import math
import unittest

from coupled import CoupledTest, read_thermo

RADIUS, VISCOSITY, SPEED = 1e-3, 0.2, 0.3
STOKES = 6 * math.pi * VISCOSITY * RADIUS * SPEED
ANSWERS = 2 / 9 * 2600 * RADIUS**2 / VISCOSITY  # s
STEP = 1e-5
SLIDE = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
region box block -2e-3 0.15 -2e-3 0.11 -2e-3 0.11 units box
create_box 1 box
neighbor 4e-4 bin
neigh_modify delay 0
timestep {step}
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.25
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.0
pair_style gran model hertz tangential history
pair_coeff * *
create_atoms 1 single 0.03 {y} {z} units box
set group all density 2600 diameter 2e-3
velocity all set {speed} 0. 0. units box
fix flow all pfv viscosity 0.2 density 1000 {options} face xlo plane 0 face xhi plane 0.14 face ylo plane 0 {side} &
    face yhi plane {wide} {side} face zlo plane 0 {floor} face zhi plane {top}
fix move all nve/sphere
compute v all reduce max vx
compute f1 all reduce min f_flow[1]
thermo_style custom step c_v c_f1 f_flow[3] f_flow[4]
thermo {every}
thermo_modify norm no lost error format float %.15g
run {steps}
"""
TOPS = ("pressure 0", "symmetry pressure 0", "no_slip pressure 0")


class OpenWater(CoupledTest):
    def rows(self, **words):
        words = {"step": STEP, "y": 0.05, "z": 0.05, "wide": 0.1, "side": "symmetry", "floor": "no_slip", "options": "",
                 "top": "0.1 pressure 0", "speed": SPEED, "every": 1, "steps": 0, **words}
        return read_thermo(self.liggghts(SLIDE.format(**words)))

    def drag(self, **words):
        return -self.rows(**words)[0]["f1"] / STOKES

    def test_the_drag_in_the_middle_is_that_of_stokes_under_any_top(self):
        for top in TOPS:
            for side in ("symmetry", "no_slip"):
                self.assertTrue(0.9 < self.drag(top="0.1 " + top, side=side) < 1.1, (top, side))

    def test_the_kind_and_height_of_the_top_do_not_change_it(self):
        low, high = self.drag(z=0.01, top="0.04 pressure 0"), self.drag(z=0.01, top="0.1 symmetry pressure 0")
        self.assertAlmostEqual(low / high, 1.0, delta=0.05)

    def test_beside_the_floor_it_is_larger_and_bounded(self):
        for z, least, most in ((0.00101, 1.3, 1.8), (0.003, 1.1, 1.35)):
            self.assertTrue(least < self.drag(z=z) < most, z)

    def test_a_grain_slows_down_as_stokes_drag_has_it(self):
        steps = round(ANSWERS / STEP)
        last = self.rows(steps=steps, every=steps)[-1]
        self.assertAlmostEqual(last["v"] / (SPEED * math.exp(-1)), 1.0, delta=0.06)
        self.assertLess(abs(last["flow[4]"]), 1e-12)

    def test_staged_and_implicit_steps_slow_it_down_as_much(self):
        steps = round(ANSWERS / STEP / 10)
        ends = {coupling: self.rows(step=10 * STEP, steps=steps, every=steps, options=f"coupling {coupling}")[-1]["v"]
                for coupling in ("explicit couple_every 1", "staged", "implicit")}
        for end in ends.values():
            self.assertAlmostEqual(end / ends["explicit couple_every 1"], 1.0, delta=0.03, msg=ends)

    def test_without_it_most_of_the_drag_is_lost(self):
        self.assertLess(self.drag(options="open_water no"), 0.5)


if __name__ == "__main__":
    unittest.main()

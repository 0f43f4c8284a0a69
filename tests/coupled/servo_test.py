# SPDX-License-Identifier: GPL-3.0-or-later
"""Proportional servos: the setup says which swing against the fluid, and runs show that it is right."""
import re
import unittest

from coupled import EDGE, CoupledTest, faces, packing, read_thermo, write_data
from plates import square, write_plate

VEL_MAX, TARGET = 0.1, 1.0  # m/s, N
STEPS = 300
HELD = "fix hold all freeze\n"  # no grain touches the plate: only the fluid resists


class Servo(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4))
        write_plate(self.folder / "lid.stl", square(EDGE, EDGE))
        write_plate(self.folder / "base.stl", square(EDGE, 0.0))

    def script(self, kp, words, open_face, held=HELD, two=False, steps=0):
        plates = {"lid": (EDGE, -1.0)}
        if two:
            plates["base"] = (0.0, 1.0)
        lines = ["include in.packing", "velocity all set 0 0 0"]
        for name, (height, axis) in plates.items():
            lines.append(f"fix {name} all mesh/surface/stress/servo file {name}.stl type 1 com 0.05 "
                         f"0.05 {height} ctrlPV force axis 0. 0. {axis} target_val {TARGET} "
                         f"vel_max {VEL_MAX} kp {kp!r} ki 0")
        lines.append("fix wall all wall/gran model hooke/stiffness tangential history mesh n_meshes "
                     f"{len(plates)} meshes {' '.join(plates)}")
        sources = {"zhi": "mesh lid", **({"zlo": "mesh base"} if two else {}), **open_face}
        lines.append(f"fix flow all pfv density 0 retriangulate 1000 {words} {faces(**sources)}")
        lines.append(held + "thermo_style custom step f_lid[3] f_lid[12] f_flow[5]\nthermo 1")
        lines.append("thermo_modify norm no lost ignore format float %.15g")
        return "\n".join(lines) + f"\nrun {steps}\n"

    def said(self, kp, *setting, **more):
        """The line of the servo, if there is one, and whether the run goes on."""
        done = self.launch(self.script(kp, *setting, **more))
        lines = [line for line in done.stdout.splitlines() if "proportional servo" in line]
        self.assertLessEqual(len(lines), 1)
        return (lines[0] if lines else ""), done.returncode == 0

    def critical(self, *setting, **more):
        """The kp at which a velocity meets the force that reverses it."""
        line, _ = self.said(1e6, *setting, **more)
        return 1e6 / float(re.search(r"those of all servos ([0-9.e+-]+);", line).group(1))

    def swing(self, kp, words, *setting, **more):
        """Largest change of the plate's velocity in one of the last steps, as a part of vel_max."""
        screen = self.liggghts(self.script(kp, words + " time_step_check no", *setting, steps=STEPS,
                                           **more))
        heights = [row["lid[12]"] for row in read_thermo(screen)]
        velocities = [(b - a) / 1e-5 for a, b in zip(heights, heights[1:])]
        changes = [abs(b - a) for a, b in zip(velocities, velocities[1:])]
        return max(changes[-10:]) / VEL_MAX

    def check(self, *setting, **more):
        kp = self.critical(*setting, **more)
        self.assertLess(self.swing(0.9 * kp, *setting, **more), 1e-2)
        self.assertGreater(self.swing(1.1 * kp, *setting, **more), 1.0)  # to and fro
        self.assertEqual(self.said(0.45 * kp, *setting, **more), ("", True))
        line, goes_on = self.said(0.9 * kp, *setting, **more)
        self.assertTrue(goes_on and line.startswith("WARNING") and "may swing" in line, line)
        line, goes_on = self.said(1.1 * kp, *setting, **more)
        self.assertTrue(not goes_on and line.startswith("ERROR") and "swings" in line, line)

    def test_drained(self):
        for viscosity in (0.2, 1.0, 5.0):
            with self.subTest(viscosity):
                self.check(f"viscosity {viscosity}", {"zlo": "pressure 0"})

    def test_grains_that_move(self):
        self.check("viscosity 1", {"zlo": "pressure 0"}, held="")

    def test_two_plates_together(self):
        """Each alone would bear a larger gain."""
        drained = {"xlo": "pressure 0"}
        self.check("viscosity 1", drained, two=True)
        self.assertLess(self.critical("viscosity 1", drained, two=True),
                        self.critical("viscosity 1", drained))

    def test_a_compressible_fluid_drained_and_sealed(self):
        """Its storage answers alternating steps with less than steady ones."""
        self.check("viscosity 1 bulk_modulus 1e8", {"zlo": "pressure 0"})
        self.check("viscosity 0.01 bulk_modulus 3e8", {})

    def test_intervals_of_several_steps(self):
        self.check("viscosity 1 bulk_modulus 1e8 couple_every 2", {"zlo": "pressure 0"})

    def test_the_line_names_face_gain_and_remedy(self):
        kp = 3 * self.critical("viscosity 1", {"zlo": "pressure 0"})
        line, _ = self.said(kp, "viscosity 1", {"zlo": "pressure 0"})
        for part in ("face zhi", "'lid'", f"(kp {kp:.4g})", f"Take kp {kp / 12:.3g}", "piston"):
            self.assertIn(part, line)

    def test_a_target_beyond_reach_is_a_warning(self):
        """In thin fluid such a plate goes with vel_max until it meets the grains."""
        kp = 1.5 * self.critical("viscosity 0.01", {"zlo": "pressure 0"})
        self.assertGreater(kp, 5)
        self.assertLess(self.swing(kp, "viscosity 0.01", {"zlo": "pressure 0"}), 1e-6)
        line, goes_on = self.said(kp, "viscosity 0.01", {"zlo": "pressure 0"})
        self.assertTrue(goes_on and line.startswith("WARNING"), line)

    def test_the_setup_leaves_no_trace(self):
        """The look at the servos changes neither the forces nor the network."""
        setting = "viscosity 1", {"zlo": "pressure 0"}
        kp = 0.3 * self.critical(*setting)
        rows = [read_thermo(self.liggghts(self.script(kp, setting[0] + words, setting[1], steps=20)))
                for words in ("", " time_step_check no")]
        self.assertEqual(rows[0], rows[1])
        self.assertEqual(rows[0][-1]["flow[5]"], 0.0)

    def test_staged_and_implicit_are_warned(self):
        kp = 2 * self.critical("viscosity 1", {"zlo": "pressure 0"})
        for coupling in ("staged", "implicit"):
            line, goes_on = self.said(kp, f"viscosity 1 coupling {coupling}", {"zlo": "pressure 0"})
            self.assertTrue(goes_on and line.startswith("WARNING"), line)


if __name__ == "__main__":
    unittest.main()

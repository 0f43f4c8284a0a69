# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts do with a fix: load, remove, replace, run again, change, clear."""
import math
import os
import shutil
import unittest

from coupled import BIN, EDGE, FLOW, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, write_data

HEAD = "include in.packing\n"
FIX = f"fix flow all pfv {FLOW}\n"
THERMO = ("thermo_style custom step time f_flow f_flow[1] f_flow[5]\n"
          "thermo_modify norm no format float %.15g\n")


class Control(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4), random_velocities(packing(4)))

    def dumped(self, script, name="d.dump", **options):
        screen = self.liggghts(script, **options)
        return screen, (self.folder / name).read_bytes()

    @unittest.skipUnless(shutil.which("liggghts"), "the stock binary is not installed")
    def test_preloaded_into_the_stock_binary_it_gives_the_same_bytes(self):
        script = HEAD + FIX + dump("d.dump") + "run 20\n"
        _, own = self.dumped(script)
        (self.folder / "d.dump").unlink()
        # a sanitizer's runtime has to come before what was compiled for it
        libraries = os.environ.get("PFV_SANITIZER_RUNTIME", "").split()
        libraries.append(str(BIN / "libliggghts_pfv.so"))
        _, preloaded = self.dumped(script, command=shutil.which("liggghts"),
                                   environment={"LD_PRELOAD": " ".join(libraries)})
        self.assertEqual(own, preloaded)

    @unittest.skipUnless(shutil.which("liggghts"), "the stock binary is not installed")
    def test_the_stock_binary_alone_does_not_know_it(self):
        self.refused(HEAD + FIX, "Invalid fix style", command=shutil.which("liggghts"))

    def test_same_script_gives_the_same_bytes(self):
        script = HEAD + FIX + dump("d.dump") + "run 20\n"
        self.assertEqual(self.dumped(script)[1], self.dumped(script)[1])

    def test_clear_forgets_everything(self):
        script = HEAD + FIX + dump("d.dump") + "run 5\n"
        _, once = self.dumped(script)
        _, after_clear = self.dumped(script + "clear\n" + script)
        self.assertEqual(once, after_clear)

    def test_unfix_ends_the_forces_and_fix_begins_anew(self):
        self.liggghts(HEAD + "unfix integr\n" + FIX + dump("a.dump") + "run 0\nundump d\n"
                      "unfix flow\ncompute f all reduce max fz\nthermo_style custom step c_f\n"
                      "thermo_modify format float %.15g\nrun 0\n"
                      "thermo_style custom step\n" + FIX + dump("b.dump") + "run 0\n")
        dry = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual([row["f"] for row in dry if "f" in row], [0.0])
        first, second = (read_dump(self.folder / n)[0] for n in ("a.dump", "b.dump"))
        self.assertEqual(first, second)

    def test_fix_of_the_same_id_replaces_the_first(self):
        doubled = FIX.replace("pressure 10", "pressure 20")
        self.liggghts(HEAD + "unfix integr\nvelocity all set 0 0 0\n" + FIX + "run 0\n" + doubled +
                      dump("d.dump") + "run 0\n")
        again = read_dump(self.folder / "d.dump")[0]
        self.liggghts(HEAD + "unfix integr\nvelocity all set 0 0 0\n" + doubled + dump("d.dump") +
                      "run 0\n")
        self.assertEqual(again, read_dump(self.folder / "d.dump")[0])

    def test_run_0_repeated_changes_nothing(self):
        self.liggghts(HEAD + FIX + THERMO + dump("d.dump") + "run 0\nrun 0\nrun 0\n")
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual(len(rows), 3)
        for row in rows:
            self.assertEqual(row, rows[0])

    def test_two_runs_advance_the_flow_as_long_as_one(self):
        """The strain counts each step once: a run's setup advances nothing."""
        frozen = HEAD + "unfix integr\n" + FIX + THERMO
        self.liggghts(frozen + "run 12\n")
        whole = read_thermo((self.folder / "log.liggghts").read_text())[-1]
        self.liggghts(frozen + "run 5\nrun 0\nrun 7\n")
        parts = read_thermo((self.folder / "log.liggghts").read_text())[-1]
        self.assertEqual(whole, parts)
        self.assertGreater(whole["flow"], 0.0)

    def test_time_step_may_change_between_runs(self):
        """At constant velocities the strain grows with time, not with steps."""
        frozen = HEAD + "unfix integr\n" + FIX + THERMO
        self.liggghts(frozen + "run 4\ntimestep 2.0e-5\nrun 4\n")
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertAlmostEqual(rows[-1]["flow"] / rows[1]["flow"], 3.0, delta=1e-9)

    def test_fix_modify_pressure_and_viscosity(self):
        frozen = HEAD + "unfix integr\nvelocity all set 0 0 0\n" + FIX
        self.liggghts(frozen + dump("d.dump") + "run 0\nundump d\n"
                      "fix_modify flow pressure zlo 30\n" + dump("e.dump") + "run 0\nundump d\n"
                      "fix_modify flow viscosity 0.02\nthermo_style custom step f_flow[1]\n"
                      "thermo_modify format float %.15g\nrun 0\n"
                      "fix_modify flow viscosity 0.01\nrun 0\n")
        one = forces(read_dump(self.folder / "d.dump")[0])
        three = forces(read_dump(self.folder / "e.dump")[0])
        self.assertLess(largest_difference({n: [3 * v for v in f] for n, f in one.items()}, three),
                        1e-13)
        inflow = [row["flow[1]"] for row in read_thermo((self.folder / "log.liggghts").read_text())
                  if "flow[1]" in row]
        self.assertEqual(len(inflow), 2)
        self.assertAlmostEqual(inflow[1] / inflow[0], 2.0, delta=1e-12)

    def test_fix_modify_seals_a_face(self):
        self.liggghts(HEAD + "unfix integr\nvelocity all set 0 0 0\n" + FIX + "run 0\n"
                      "fix_modify flow sealed zlo\n" + dump("d.dump") + "run 0\n")
        for force in forces(read_dump(self.folder / "d.dump")[0]).values():
            self.assertEqual(max(abs(v) for v in force), 0.0)

    def test_a_strain_in_per_cent_is_asked_about(self):
        said = self.liggghts(HEAD + f"fix flow all pfv {FLOW} retriangulate mean 1\nrun 0\n")
        self.assertIn("`retriangulate 1` lets the pores change by 100 % before", said)
        self.assertNotIn("lets the pores change", self.liggghts(HEAD + f"fix flow all pfv {FLOW}\nrun 0\n"))

    def test_a_density_in_grams_is_asked_about(self):
        set_density = "set group all density {}\n"
        said = self.liggghts(HEAD + set_density.format(2.65) + f"fix flow all pfv {FLOW}\nrun 0\n")
        self.assertIn("no free grain is denser than 2.65 kg/m3", said)
        said = self.liggghts(HEAD + set_density.format(11) + f"fix flow all pfv {FLOW}\nrun 0\n")
        self.assertNotIn("no free grain is denser", said)

    def test_fix_modify_retriangulate(self):
        frozen = HEAD + "unfix integr\n" + FIX + THERMO
        self.liggghts(frozen + "run 10\nfix_modify flow retriangulate 1e-9\nrun 10\n")
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual(rows[1]["flow[5]"], 0.0)
        # the largest strain in place of the mean begins with a network, at the setup of the second run
        self.assertEqual(rows[-1]["flow[5]"], 10.0)

    def test_gravity_may_change_between_runs(self):
        sealed = FLOW.replace("pressure 10", "sealed").replace("pressure 0", "sealed")
        self.liggghts(HEAD + "unfix integr\nvelocity all set 0 0 0\n"
                      "fix g all gravity 9.81 vector 0 0 -1\n"
                      f"fix flow all pfv {sealed}\nrun 0\nunfix g\nfix g all gravity 4.0 "
                      "vector 1 0 0\n" + dump("d.dump") + "run 0\n")
        for row in read_dump(self.folder / "d.dump")[0].values():
            lift = 1000 * 4 / 3 * math.pi * row[3]**3 * 4.0
            self.assertAlmostEqual(row[7], -lift, delta=1e-12 * lift)
            self.assertAlmostEqual(row[9], 0.0, delta=1e-12 * lift)

    def test_run_without_its_setup(self):
        frozen = HEAD + "unfix integr\n" + FIX + THERMO
        self.liggghts(frozen + "run 5\nrun 7 pre no\n")
        last = read_thermo((self.folder / "log.liggghts").read_text())[-1]
        self.liggghts(frozen + "run 12\n")
        self.assertEqual(last, read_thermo((self.folder / "log.liggghts").read_text())[-1])

    def test_two_flows_in_groups_without_a_common_grain(self):
        head = (HEAD + "region left block -1 0.05 -1 1 -1 1 units box\ngroup left region left\n"
                "group right subtract all left\n")
        left = FLOW.replace(f"face xhi plane {EDGE}", "face xhi plane 0.05")
        right = FLOW.replace("face xlo plane 0.0", "face xlo plane 0.05").replace(
            "pressure 10", "pressure 20")
        one, other = f"fix one left pfv {left}\n", f"fix flow right pfv {right}\n"
        self.liggghts(head + other + dump("alone.dump") + "run 0\n")
        self.liggghts(head + one + other + dump("both.dump") + "run 0\n")
        self.assertEqual((self.folder / "alone.dump").read_bytes(),
                         (self.folder / "both.dump").read_bytes())
        one, other = one.replace("fix one", "fix flow"), other.replace("fix flow", "fix two")
        self.liggghts(head + one + dump("alone.dump") + "run 0\n")
        self.liggghts(head + one + other + dump("both.dump") + "run 0\n")
        self.assertEqual((self.folder / "alone.dump").read_bytes(),
                         (self.folder / "both.dump").read_bytes())

    def test_end_of_run_prints_phases_and_papers(self):
        screen = self.liggghts(HEAD + FIX + "run 3\n")
        for text in ("triangulate", "factor", "solve", "92:473-493", "38:51-71"):
            self.assertIn(text, screen)

    def test_reset_timestep_goes_on(self):
        self.liggghts(HEAD + FIX + THERMO + "run 3\nreset_timestep 0\nrun 2\n")
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertGreater(rows[-1]["flow"], rows[1]["flow"])

    def test_flow_box_is_that_of_the_faces(self):
        """A face moved inwards leaves the grains behind it without fluid."""
        flow = FLOW.replace(f"plane {EDGE} pressure 0", f"plane {0.5 * EDGE} pressure 0")
        self.liggghts(HEAD + f"fix flow all pfv {flow}\n" + dump("d.dump") +
                      "thermo_style custom step f_flow[8]\nrun 0\n")
        rows = read_dump(self.folder / "d.dump")[0]
        outside = [row for row in rows.values() if row[2] > 0.5 * EDGE]
        self.assertGreater(len(outside), 0)
        self.assertEqual({tuple(row[7:11]) for row in outside}, {(0.0, 0.0, 0.0, 0.0)})
        thermo = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual(thermo[0]["flow[8]"], len(outside))


if __name__ == "__main__":
    unittest.main()

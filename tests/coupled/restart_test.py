# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that is continued from a restart file goes the way of the run that wrote it."""
import unittest

from coupled import FLOW, WATER, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, restarted_head, write_data

THERMO = ("thermo_style custom step f_flow f_flow[5] f_flow[7]\n"
          "thermo_modify norm no format float %.15g\n")


class Restart(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4), random_velocities(packing(4)))

    def restarted(self, fix, run):
        """The script of a continued run: the same settings, the grains from the restart file."""
        return restarted_head() + fix + THERMO + dump("restarted.dump") + run

    def compare(self, fix, first="run 10\n", run="run 10\n", ranks=1, by_hand=""):
        """Runs on and restarts; returns the rows of both runs after the restart file, and what is changed before."""
        head = "include in.packing\n"
        self.liggghts(head + fix + first + "write_restart file.restart\n" + by_hand + THERMO +
                      dump("continued.dump") + run, ranks=ranks)
        continued = read_thermo((self.folder / "log.liggghts").read_text())
        self.liggghts(self.restarted(fix + by_hand, run), ranks=ranks)
        restarted = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual(restarted, [row for row in continued if "flow[7]" in row])
        self.assertEqual((self.folder / "continued.dump").read_bytes(),
                         (self.folder / "restarted.dump").read_bytes())
        return restarted

    def test_continued_and_restarted_run_write_the_same_bytes(self):
        rows = self.compare(f"fix flow all pfv {FLOW}\n")
        self.assertEqual(rows[-1]["Step"], 20)
        self.assertGreater(rows[-1]["flow"], 0.0)

    def test_a_solver_that_sets_out_from_the_last_solutions(self):
        for words in ("", "bulk_modulus 1e4", "coupling staged"):
            self.compare(f"fix flow all pfv {FLOW} solver amg {words}\n")

    def test_auto_goes_by_what_the_network_before_has_served(self):
        """A network a step: amg from the second one on, and so in the run that goes on."""
        write_data(self.folder, packing(13), random_velocities(packing(13)))
        self.compare(f"fix flow all pfv {FLOW} retriangulate 1e-9\n", "run 3\n", "run 2\n")
        log = (self.folder / "log.liggghts").read_text()
        self.assertIn("auto: a factor of 2197 spheres pays from 6 solves a network on", log)

    def test_two_ranks_write_the_same_bytes_too(self):
        for words in ("", "bulk_modulus 1e4", "retriangulate 1e-6"):
            self.compare(f"fix flow all pfv {FLOW} {words}\n", ranks=2)

    def test_compressible_pressures_are_kept(self):
        """Uneven stored pressures: a restart that lost them would begin at another mean."""
        rows = self.compare(f"fix flow all pfv {FLOW} bulk_modulus 1e4\n")
        self.assertGreater(abs(rows[0]["flow[7]"]), 0.0)

    def test_pressure_from_a_variable_that_asks_a_compute(self):
        flow = FLOW.replace("pressure 10", "pressure v_p")
        self.compare(f"compute e all pe\nvariable p equal 10+0*c_e\nfix flow all pfv {flow}\n")

    def test_between_two_flow_steps(self):
        self.compare(f"fix flow all pfv {WATER} couple_every 4\n")

    def test_grains_that_are_moved_before_the_first_run(self):
        """As between two runs: the interval begins anew, and the displacement is no mean velocity. (LIGGGHTS moves no
        grains before a first run while a file's contacts wait for their history.)"""
        forgetful = "pair_style gran model hooke/stiffness tangential no_history\npair_coeff * *\n"
        moved = "displace_atoms all random 1e-4 1e-4 1e-4 10007 units box\n"
        for words in ("couple_every 4", "couple_every 1", "", "couple_every 4 model darcy_grid 3 3 3"):
            with self.subTest(words=words):
                self.compare(f"{forgetful}fix flow all pfv {WATER} {words}\n", by_hand=moved)
        shared = f"{forgetful}fix flow all pfv {WATER} couple_every 4 solver amg ranks all\n"
        self.compare(shared, by_hand=moved, ranks=2)

    def test_a_file_of_grains_that_were_moved_before_the_first_run(self):
        forgetful = "pair_style gran model hooke/stiffness tangential no_history\npair_coeff * *\n"
        moved = "displace_atoms all random 1e-4 1e-4 1e-4 10007 units box\n"
        fix = f"{forgetful}fix flow all pfv {WATER} couple_every 4\n"
        self.compare(fix)
        rows = []
        for script in (self.restarted(fix + moved + "write_restart second.restart\n", "run 10\n"),
                       self.restarted(fix, "run 10\n").replace("file.restart", "second.restart")):
            self.liggghts(script)
            rows.append(read_thermo((self.folder / "log.liggghts").read_text()))
        self.assertEqual(rows[0], rows[1])

    def test_counts_go_on(self):
        rows = self.compare(f"fix flow all pfv {FLOW} retriangulate 1e-6\n")
        # at each step but the first, which has the network of the restart file
        self.assertEqual(rows[-1]["flow[5]"] - rows[0]["flow[5]"], 9)
        self.assertGreater(rows[0]["flow[5]"], 0)

    def test_networks_that_are_built_in_the_background(self):
        """One is on its way when the restart file is written: the network of that file follows."""
        rows = self.compare(f"fix flow all pfv {FLOW} retriangulate 1e-6 rebuild_lag 3\n")
        self.assertEqual(rows[-1]["flow[5]"] - rows[0]["flow[5]"], 2)  # begun in steps 12, 15, 18

    def test_restart_files_in_the_middle_of_a_run(self):
        """LIGGGHTS reckons the forces of the first step with v(n), the run itself with v(n-1/2):
        contact damping differs in the last digits there. Without contacts nothing does but the
        volume rates of that one step (2e-10 of the forces here)."""
        fix = f"fix flow all pfv {FLOW}\n"
        self.liggghts("include in.packing\n" + fix + "restart 10 file.*.restart\n" +
                      dump("continued.dump") + "run 20\n")
        (self.folder / "file.10.restart").rename(self.folder / "file.restart")
        self.liggghts(self.restarted(fix, "run 10\n"))
        continued = read_dump(self.folder / "continued.dump")
        restarted = read_dump(self.folder / "restarted.dump")
        self.assertLess(largest_difference(forces(continued[20]), forces(restarted[20])), 1e-9)

    def test_restart_before_the_first_run(self):
        fix = f"fix flow all pfv {FLOW}\n"
        self.liggghts("include in.packing\n" + fix + "write_restart file.restart\n" +
                      dump("continued.dump") + "run 5\n")
        self.liggghts(self.restarted(fix, "run 5\n"))
        self.assertEqual((self.folder / "continued.dump").read_bytes(),
                         (self.folder / "restarted.dump").read_bytes())


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks that are built in the background while the grains move on."""
import unittest

from coupled import FLOW, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, write_data

THERMO = "thermo_style custom step f_flow f_flow[3] f_flow[5]\nthermo 1\n"
STRAIN = 1.5e-3  # twelve steps


class RebuildLag(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(5), random_velocities(packing(5)))

    def run_with(self, words, name="forces.dump", **options):
        """(forces of each step, rows of thermo output, bytes of the dump, screen)"""
        if "retriangulate" not in words:
            words += f" retriangulate {STRAIN}"
        screen = self.liggghts(
            f"include in.packing\nfix flow all pfv {FLOW} {words}\n" +
            THERMO + dump(name) + "run 60\n", **options)
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        path = self.folder / name
        steps = {step: forces(grains) for step, grains in read_dump(path).items()}
        return steps, rows, path.read_bytes(), screen

    def test_same_bytes_in_every_run_and_for_any_number_of_threads(self):
        _, rows, first, screen = self.run_with("rebuild_lag 4")
        networks = rows[-1]["flow[5]"]
        self.assertGreater(networks, 3)
        self.assertIn(f"built in the background {networks:.0f} ", screen)
        for words in ("rebuild_lag 4", "rebuild_lag 4 threads 2"):
            self.assertEqual(self.run_with(words)[2], first)

    def test_an_old_network_errs_by_what_its_pores_have_strained(self):
        """Beside networks of every step; the lag adds a third to the steps of a network."""
        exact = self.run_with("retriangulate 1e-12")[0]
        prompt = self.run_with("")[0]
        lagging, rows, _, _ = self.run_with("rebuild_lag 4")
        error = {name: max(largest_difference(run[step], exact[step]) for step in exact)
                 for name, run in (("prompt", prompt), ("lagging", lagging))}
        self.assertGreater(error["lagging"], error["prompt"])
        self.assertLess(error["lagging"], (1 + 4 / 12 + 0.15) * error["prompt"])
        self.assertLess(max(row["flow[3]"] for row in rows), 1e-9)  # mass error

    def test_the_mean_strain_leads_to_fewer_networks(self):
        networks = [self.run_with(f"retriangulate {measure}{STRAIN / 25}")[1][-1]["flow[5]"]
                    for measure in ("", "mean ")]
        self.assertGreater(networks[1], 0)
        self.assertGreater(networks[0], 5 * networks[1])

    def test_on_two_ranks(self):
        _, rows, _, screen = self.run_with("rebuild_lag 4", ranks=2)
        self.assertIn(f"built in the background {rows[-1]['flow[5]']:.0f} ", screen)

    def test_on_ranks_that_share_the_flow(self):
        """A second thread of each; networks and forces are those of one rank."""
        words = "rebuild_lag 4 solver amg tolerance 1e-10"
        alone, of_one, _, _ = self.run_with(words)
        shared, rows, first, screen = self.run_with(words, ranks=2)
        for said in ("the flow is shared by 2 ranks", "since it began"):
            self.assertEqual(screen.count(said), 1, said)
        networks = rows[-1]["flow[5]"]
        self.assertGreater(networks, 3)
        self.assertEqual(networks, of_one[-1]["flow[5]"])
        self.assertIn(f"built in the background {networks:.0f} ", screen)
        for step in alone:
            self.assertLess(largest_difference(shared[step], alone[step]), 1e-9, step)
        self.assertEqual(self.run_with(words, ranks=2)[2], first)


if __name__ == "__main__":
    unittest.main()

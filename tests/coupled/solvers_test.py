# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear solvers within LIGGGHTS: the same forces from each, and the end of a run says whose they were."""
import os
import unittest

from coupled import FLOW, CoupledTest, dump, forces, largest_difference, packing, random_velocities
from coupled import read_dump, write_data

HEAD = "include in.packing\n"
# who ordered, factored and solved, as the end of a run says it
MADE_BY = {"auto": ("geometric", "factored by pfv", "solved by pfv"),
           "cholmod": ("geometric", "factored by CHOLMOD", "solved by CHOLMOD"),
           "tacho": ("METIS", "factored by Tacho", "solved by Tacho"),
           "klu2": ("KLU2", "factored by KLU2", "solved by KLU2"),
           "mumps": ("MUMPS", "factored by MUMPS", "solved by MUMPS"),
           "amg tolerance 1e-10": ("preconditioned by hypre's BoomerAMG", "solved by pfv"),
           "cg": ("preconditioned by pfv", "solved by pfv")}
if os.environ.get("PFV_WITH_MUMPS") == "OFF":
    del MADE_BY["mumps"]


class Solvers(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(5), random_velocities(packing(5)))

    def run_with(self, solver, **options):
        """The forces of step 20, and the end of the run's log."""
        log = self.liggghts(HEAD + f"fix flow all pfv {FLOW} solver {solver} retriangulate 0.001\n" +
                            dump("d.dump") + "run 20\n", **options)
        return forces(read_dump(self.folder / "d.dump")[20]), log[log.index("since it began"):]

    def test_each_gives_the_forces_of_the_default_and_says_who_made_them(self):
        expected, _ = self.run_with("auto")
        for solver, words in MADE_BY.items():
            found, end = self.run_with(solver)
            self.assertLess(largest_difference(found, expected), 1e-8, solver)
            for word in words:
                self.assertIn(word, end)

    def test_tacho_mumps_and_amg_stay_on_their_rank(self):
        expected, _ = self.run_with("auto", ranks=2)
        for solver in MADE_BY.keys() & {"tacho", "mumps", "amg tolerance 1e-10"}:
            self.assertLess(largest_difference(self.run_with(solver, ranks=2)[0], expected), 1e-8, solver)


if __name__ == "__main__":
    unittest.main()

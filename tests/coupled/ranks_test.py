# SPDX-License-Identifier: GPL-3.0-or-later
"""Several ranks: the flow is solved on rank 0 and must not depend on how the grains are spread."""
import unittest

from coupled import EDGE, FLOW, CoupledTest, dump, faces, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, restarted_head, write_data
from plates import square, write_plate

THERMO = ("thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[4] f_flow[5] "
          "f_flow[6] f_flow[7] f_flow[8]\nthermo_modify norm no format float %.15g\n")
FIX = f"fix flow all pfv {FLOW}\n"


class Ranks(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(5), random_velocities(packing(5)))

    def log(self):
        return read_thermo((self.folder / "log.liggghts").read_text())

    def test_first_step_after_a_restart_file_is_the_same_on_1_2_and_4_ranks(self):
        self.liggghts("include in.packing\n" + FIX + "run 10\nwrite_restart file.restart\n")
        rows, first, thermo = {}, {}, {}
        for ranks in (1, 2, 4):
            self.liggghts(restarted_head() + FIX + THERMO + dump(f"{ranks}.dump") + "run 1\n",
                          ranks=ranks)
            steps = read_dump(self.folder / f"{ranks}.dump")
            rows[ranks], first[ranks] = forces(steps[10]), forces(steps[11])
            thermo[ranks] = self.log()
        for ranks in (2, 4):
            self.assertEqual(rows[ranks], rows[1])  # the same grains in the same order: same bytes
            self.assertLess(largest_difference(first[ranks], first[1]), 1e-10)
            self.assertEqual(thermo[ranks][0], thermo[1][0])

    def test_mesh_face_of_which_some_ranks_own_nothing(self):
        write_plate(self.folder / "lid.stl", square(EDGE, EDGE))
        script = ("include in.packing\nfix lid all mesh/surface/stress file lid.stl type 1\n"
                  "fix lidw all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 "
                  "meshes lid\nfix down all move/mesh mesh lid linear 0 0 -0.001\n"
                  "fix flow all pfv viscosity 0.01 " +
                  faces(zlo="pressure 0", zhi="mesh lid sealed") + "\n" +
                  "thermo_style custom step f_flow[2] f_lid[3]\n"
                  "thermo_modify norm no format float %.15g\nthermo 1\nrun 2\n")
        self.liggghts(script)
        alone = self.log()
        self.liggghts(script, ranks=4)
        together = self.log()
        for row, other in zip(alone, together):
            self.assertAlmostEqual(row["flow[2]"], other["flow[2]"],
                                   delta=1e-10 * abs(row["flow[2]"]))
        self.assertGreater(alone[-1]["lid[3]"], 0.0)
        self.assertAlmostEqual(alone[-1]["lid[3]"], together[-1]["lid[3]"],
                               delta=1e-8 * alone[-1]["lid[3]"])

    def test_error_on_rank_0_stops_all_ranks_with_its_message(self):
        """Two grains at one place: the library throws on rank 0 while rank 1 waits."""
        grains = packing(5)
        n, x, y, z, radius = grains[7]
        grains.append((999, x, y, z, radius))
        write_data(self.folder, grains)
        script = "include in.packing\n" + FIX + "run 0\n"
        for ranks in (1, 2):
            self.refused(script, "8", "999", ranks=ranks)

    def test_wrong_command_stops_all_ranks(self):
        self.refused("include in.packing\nfix flow all pfv viscosity 1 face zlo extent\n",
                     "xlo, xhi, ylo, yhi, zhi", ranks=2)

    def test_folder_missing_stops_all_ranks(self):
        self.refused(f"include in.packing\nfix flow all pfv {FLOW} output 1 nowhere/a.pvd\n",
                     "nowhere", ranks=2)


if __name__ == "__main__":
    unittest.main()

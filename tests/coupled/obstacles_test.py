# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes among the grains: they displace fluid, are moved as the script moves them, and feel its force."""
import unittest

from coupled import EDGE, FLOW, WATER, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, restarted_head, write_data
from plates import write_mesh
from scene_meshes import can, plate

MIDDLE = EDGE / 2
HEAD = "include in.packing\n"
PADDLE = "fix pad all mesh/surface/stress file paddle.stl type 1\n"
PUSH = "fix push all move/mesh mesh pad linear 0.0 0.05 0.0\n"
TURN = f"fix turn all move/mesh mesh pad rotate origin {MIDDLE} {MIDDLE} {MIDDLE} axis 0. 0. 1. period 0.5\n"
THERMO = ("thermo_style custom step f_flow[3] f_flow[4] f_flow[5] f_flow[8] " +
          " ".join(f"f_flow[{n}]" for n in range(11, 17)) + " " + " ".join(f"f_pad[{n}]" for n in range(1, 10)) +
          "\nthermo_modify norm no format float %.15g\nthermo 5\n")


def write_paddle(folder, half=0.025):
    """paddle.stl in the middle of moving grains, and packing.data."""
    grains = [g for g in packing(6) if not (abs(g[2] - MIDDLE) < g[4] + 1e-3 and abs(g[1] - MIDDLE) < half + 5e-3
                                            and abs(g[3] - MIDDLE) < half + 5e-3)]
    write_data(folder, grains, random_velocities(grains))
    write_mesh(folder / "paddle.stl", plate(1, half, (MIDDLE, MIDDLE, MIDDLE)))


class Obstacles(CoupledTest):
    def setUp(self):
        super().setUp()
        write_paddle(self.folder)

    def rows(self):
        return read_thermo((self.folder / "log.liggghts").read_text())

    def moved(self, motion, words="", run="run 20\n", **options):
        """With gravity off and no contacts with the mesh all that its stress module sees is the fluid."""
        said = self.liggghts(HEAD + PADDLE + motion + f"fix flow all pfv {FLOW} obstacle mesh pad {words}\n" + THERMO +
                             dump("moved.dump") + run, **options)
        return said, self.rows()

    def test_a_paddle_drawn_through_grains(self):
        said, rows = self.moved(PUSH)
        self.assertRegex(said, r"obstacle pad: \d+ spheres in place of its 0 closed and 1 open parts; sheets are")
        self.assertNotIn("in it, the centre", said)
        for row in rows[1:]:
            self.assertLess(abs(row["flow[3]"]), 1e-12)
            self.assertLess(row["flow[4]"], 1e-12)
            self.assertEqual(row["flow[8]"], 0)  # its spheres are no grains
            self.assertLess(row["flow[12]"], 0.0)
            for n in range(3):
                self.assertAlmostEqual(row[f"pad[{n + 1}]"], row[f"flow[{11 + n}]"], delta=1e-12 * abs(row["flow[12]"]))
            # the module's moment is about its own point
            point = [row[f"pad[{n}]"] for n in (7, 8, 9)]
            y = MIDDLE + 0.05 * 1e-5 * row["Step"]
            arm = [c - p for c, p in zip((MIDDLE, y, MIDDLE), point)]
            force = [row[f"flow[{n}]"] for n in (11, 12, 13)]
            about = arm[1] * force[2] - arm[2] * force[1] + row["flow[14]"]
            self.assertAlmostEqual(row["pad[4]"], about, delta=1e-9 * abs(row["flow[12]"]))

    def test_the_history_tells_of_the_grains_as_thermo_does(self):
        self.moved(PUSH, "history 5 h.csv", "run 10\n")
        header, *rows = [line.split(",") for line in (self.folder / "h.csv").read_text().splitlines()]
        last = dict(zip(header, map(lambda text: float(text or "nan"), rows[-1])))
        grains = forces(read_dump(self.folder / "moved.dump")[10]).values()
        self.assertEqual(last["hidden"], self.rows()[-1]["flow[8]"])
        for axis in range(3):
            self.assertAlmostEqual(last["force_" + "xyz"[axis]], sum(force[axis] for force in grains), delta=1e-9)

    def test_a_paddle_that_turns_feels_a_moment(self):
        _, rows = self.moved(TURN, "torques yes")
        self.assertLess(rows[-1]["flow[16]"], 0.0)
        self.assertLess(abs(rows[-1]["flow[3]"]), 1e-10)

    def test_two_ranks_are_one(self):
        one, two = [], []
        for ranks, found in ((1, one), (2, two)):
            load = self.moved(TURN, ranks=ranks)[1][-1]
            found += [forces(read_dump(self.folder / "moved.dump")[20]), [load[f"flow[{n}]"] for n in range(11, 17)]]
        self.assertLess(largest_difference(one[0], two[0]), 1e-9)
        for a, b in zip(one[1], two[1]):
            self.assertAlmostEqual(a, b, delta=1e-9 * abs(one[1][1]))

    def test_at_rest_it_is_that_of_the_command(self):
        write_data(self.folder, packing(5))
        diameter = 0.006
        for name, triangles in (("paddle", plate(2, 0.02, (MIDDLE, MIDDLE, MIDDLE))), ("paddle", can((0.03, 0.04, 0.02)))):
            write_mesh(self.folder / "paddle.stl", triangles)
            said, _ = self.moved("", f"diameter {diameter}", "run 0\n")
            self.assertRegex(said, r"mesh 'pad' is not clear of grains: \d+ grains? sticks? in it, the centre within its body \(\d+")
            static = self.pfv_forces("moved.dump", "--face", "zlo:pressure=10", "--face", "zhi:pressure=0", "--obstacle",
                                     "paddle.stl", "--obstacle-diameter", str(diameter))
            self.assertLess(largest_difference(forces(read_dump(self.folder / "moved.dump")[0]), static), 1e-9)

    def test_every_coupling_knows_it(self):
        for words in ("coupling staged", "coupling implicit", "couple_every 4"):
            _, rows = self.moved(PUSH, words.replace("couple_every 4", ""), "run 20\n")
            self.assertLess(rows[-1]["flow[12]"], 0.0)
            self.assertLess(abs(rows[-1]["flow[3]"]), 1e-9)

    def test_a_restart_goes_on_with_the_same_spheres(self):
        fix = f"fix flow all pfv {WATER} couple_every 2 obstacle mesh pad\n"
        self.liggghts(HEAD + PADDLE + TURN + fix + "run 11\nwrite_restart file.restart\n" + THERMO + dump("on.dump") + "run 10\n")
        on = self.rows()
        self.liggghts(restarted_head() + PADDLE + TURN + fix + THERMO + dump("restarted.dump") + "run 10\n")
        self.assertEqual(self.rows()[-1]["flow[12]"], on[-1]["flow[12]"])
        self.assertEqual((self.folder / "on.dump").read_bytes(), (self.folder / "restarted.dump").read_bytes())

    def test_two_runs_are_one(self):
        once = self.moved(TURN)[1][-1]
        twice = self.moved(TURN, run="run 10\nrun 10\n")[1][-1]
        for n in range(11, 14):  # the second begins with a new network
            self.assertAlmostEqual(once[f"flow[{n}]"], twice[f"flow[{n}]"], delta=1e-3 * abs(once["flow[12]"]))

    def test_what_cannot_be_is_refused(self):
        flow = f"fix flow all pfv {FLOW} "
        self.refused(HEAD + flow + "obstacle mesh nowhere\nrun 0\n", "no fix mesh/surface 'nowhere'")
        self.refused(HEAD + PADDLE + flow + "obstacle mesh pad obstacle mesh pad\nrun 0\n", "given twice")
        self.refused(HEAD + PADDLE + flow + "obstacle mesh pad diameter 0\nrun 0\n", "diameter")
        self.refused(HEAD + PADDLE + flow + "obstacle mesh pad diameter 1e-5\nrun 0\n", "pad", "larger diameter")
        self.refused(HEAD + PADDLE + flow + "obstacle mesh pad model darcy_grid 4 4 4\nrun 0\n", "darcy_grid knows no obstacle")
        self.refused(HEAD + PADDLE + "group none id 9999\n" + f"fix flow none pfv {FLOW} obstacle mesh pad\nrun 0\n",
                     "there are none yet", "diameter D")


if __name__ == "__main__":
    unittest.main()

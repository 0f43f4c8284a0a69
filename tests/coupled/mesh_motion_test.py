# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves as a mesh does: at the setup of each run, after a restart, on a conveyor, beside a restart file."""
import struct
import unittest

from coupled import EDGE, CoupledTest, dump, faces, forces, largest_difference, packing, read_dump, read_thermo
from coupled import random_velocities, restarted_head, write_data
from plates import quad, write_mesh

HEAD = "include in.packing\n"
LID = ("fix lid all mesh/surface/stress file lid.stl type 1 {}\n"
       "fix walls all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes lid\n")
DOWN = "fix move all move/mesh mesh lid linear 0 0 -0.01\n"
BOX = faces(zlo="pressure 0", zhi="mesh lid")
PLANES = {"xlo": "0 0 0 1 0 0", "xhi": f"{EDGE} 0 0 -1 0 0", "ylo": "0 0 0 0 1 0", "yhi": f"0 {EDGE} 0 0 -1 0"}
CONTAINER = ("container " + " ".join(f"face {name} plane {place}" for name, place in PLANES.items()) +
             " face zlo plane 0 0 0 0 0 1 pressure 0 face zhi mesh lid")
THERMO = ("compute m all reduce sum f_flow[3]\n"
          "thermo_style custom step f_flow[2] f_flow[7] f_flow[10] c_m f_lid[3]\nthermo 1\n"
          "thermo_modify norm no format float %.15g\n")


class MeshMotion(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4))
        write_mesh(self.folder / "lid.stl", quad((0, 0, EDGE), (EDGE, 0, EDGE), (EDGE, EDGE, EDGE), (0, EDGE, EDGE)))

    def rows(self, flow, run, before=LID.format("") + DOWN):
        return read_thermo(self.liggghts(HEAD + before + f"fix flow all pfv viscosity 1 {flow}\n" + THERMO + run))

    def test_a_setup_between_runs_knows_that_the_lid_moves(self):
        """Q = v A at each line but those before the first solve; without a step between them two runs set out alike."""
        for words in (BOX, CONTAINER):
            rows = self.rows(f"couple_every 1 {words}", "run 3\nrun 0\nrun 2\nunfix move\nrun 0\n")
            discharges = [row["flow[2]"] for row in rows]
            self.assertEqual(discharges[0], 0.0)  # no step has moved the lid
            for discharge in discharges[1:-1]:
                self.assertAlmostEqual(discharge / (0.01 * EDGE**2), 1.0, places=9)
            self.assertLess(abs(discharges[-1]), 1e-15)
            of_grains = [row["m"] for row in rows[1:-1]]
            self.assertLess(max(of_grains) / min(of_grains), 1.01)

    def test_an_obstacle_goes_on_too(self):
        write_mesh(self.folder / "lid.stl", quad((0.04, 0.04, 0.05), (0.06, 0.04, 0.05), (0.06, 0.06, 0.05), (0.04, 0.06, 0.05)))
        flow = "couple_every 1 obstacle mesh lid " + faces(zlo="pressure 0", zhi="pressure 0")
        rows = self.rows(flow, "thermo_style custom step f_flow[13]\nrun 3\nrun 1\n")
        ends = [row["flow[13]"] for row in rows if row["Step"] == 3]
        self.assertGreater(ends[0], 0.0)
        self.assertAlmostEqual(ends[1] / ends[0], 1.0, delta=0.01)

    def test_a_restart_within_an_interval(self):
        for words in (BOX, CONTAINER):
            fix = LID.format("") + DOWN + f"fix flow all pfv viscosity 1 couple_every 10 {words}\n"
            self.liggghts(HEAD + fix + "run 16\nwrite_restart file.restart\n" + dump("on.dump") + "run 5\n")
            self.liggghts(restarted_head() + fix + dump("again.dump") + "run 5\n")
            self.assertEqual((self.folder / "on.dump").read_bytes(), (self.folder / "again.dump").read_bytes())

    def test_a_restart_file_without_meshes_is_refused(self):
        fix = LID.format("") + DOWN + f"fix flow all pfv viscosity 1 {BOX}\n"
        self.liggghts(HEAD + fix + "run 2\nwrite_restart file.restart\n")
        now, before = (struct.pack("2d", form, 2.0) for form in (11.0, 9.0))
        held = (self.folder / "file.restart").read_bytes()
        self.assertEqual(held.count(now), 1)
        (self.folder / "file.restart").write_bytes(held.replace(now, before))
        self.refused(restarted_head() + fix + "run 1\n", "form before 10", "another ID")

    def test_a_restart_file_within_an_interval_changes_no_load(self):
        """Those on grains, meshes and in the outputs are held until the next solve."""
        write_data(self.folder, packing(4), random_velocities(packing(4)))
        plain, written = (self.rows(f"couple_every 10 {BOX}", words + "run 19\n") for words in ("", "restart 14 a.res b.res\n"))
        self.assertEqual(plain, written)
        self.assertTrue((self.folder / "a.res").exists())

    def test_a_conveyor_takes_the_fluid_along(self):
        """As a mesh that slides or turns does, which stays where it is but for 1e-6 of its size."""
        middle = f"origin {EDGE / 2} {EDGE / 2} 0. axis 0. 0. 1."
        for belt, move in (("surface_vel 0.5 0. 0.", "linear 0.5 0 0"),
                           (f"surface_ang_vel {middle} omega 5.", f"rotate {middle} period 1.2566370614359172")):
            for flow in (f"couple_every 1 {BOX}", f"couple_every 2 {CONTAINER}"):
                for name, before in (("belt", LID.format(belt)),
                                     ("mover", LID.format("") + f"fix move all move/mesh mesh lid {move}\n")):
                    self.rows(flow, dump(f"{name}.dump") + "run 2\n", "unfix integr\n" + before)
                found, wanted = (forces(read_dump(self.folder / f"{name}.dump")[2]) for name in ("belt", "mover"))
                self.assertLess(largest_difference(found, wanted), 1e-3)

    def test_a_belt_that_no_rigid_plane_follows(self):
        screen = self.liggghts(HEAD + LID.format("surface_ang_vel origin 0. 0. 0.05 axis 0. 1. 0. omega 5.") +
                               f"fix flow all pfv viscosity 1 {BOX}\nrun 0\n")
        self.assertEqual(screen.count("face zhi: the surface velocity of mesh 'lid'"), 1)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls as a script has them: cylinders, planes and meshes at any angle, moving and turning ones."""
import math
import unittest

from coupled import EDGE, FLOW, CoupledTest, dump, faces, forces, largest_difference, packing
from coupled import read_dump, read_thermo, restarted_head, write_data
from plates import write_plate

MODEL = "wall/gran model hooke/stiffness tangential history"
HEAD = "include in.packing\n"
FROZEN = HEAD + "unfix integr\n"
RADIUS, MIDDLE = 0.045, EDGE / 2
PIPE = (f"fix shell all {MODEL} primitive type 1 zcylinder {RADIUS} {MIDDLE} {MIDDLE}\n"
        f"fix floor all {MODEL} primitive type 1 zplane 0.0\n"
        f"fix roof all {MODEL} primitive type 1 zplane {EDGE}\n")
IN_PIPE = ("viscosity 0.01 container face side wall shell face bottom wall floor pressure 10 "
           "face top wall roof pressure 0")
THERMO = ("thermo_style custom step f_flow[1] f_flow[2] f_flow[3] f_flow[4]\n"
          "thermo_modify norm no format float %.15g\nthermo 1\n")


def in_pipe(grains):
    return [g for g in grains if math.hypot(g[1] - MIDDLE, g[2] - MIDDLE) + 0.3 * g[4] < RADIUS]


class Containers(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing())

    def test_primitive_cylinder_and_planes_are_the_container_of_the_command(self):
        write_data(self.folder, in_pipe(packing(8)))
        said = self.liggghts(HEAD + PIPE + f"fix flow all pfv {IN_PIPE}\n" + dump("walls.dump") + "run 0\n")
        volume = math.pi * RADIUS**2 * EDGE
        self.assertIn(f"container of {volume:.4g} m3, {len(in_pipe(packing(8)))} grains inside, 0 outside", said)
        container = {"planes": [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": 0.0},
                     {"name": "top", "inward_normal": [0, 0, -1], "offset": -EDGE}],
                     "cylinders": [{"name": "side", "axis": [0, 0, 1], "point": [MIDDLE, MIDDLE, 0.0],
                     "radius": RADIUS}]}
        static = self.pfv_forces("walls.dump", "--face", "bottom:pressure=10", "--face", "top:pressure=0", container=container)
        coupled = forces(read_dump(self.folder / "walls.dump")[0])
        self.assertLess(largest_difference(coupled, static), 1e-12)

    def test_a_patch_on_the_shell_is_that_of_the_command(self):
        write_data(self.folder, in_pipe(packing(8)))
        block = (MIDDLE, EDGE, 0.03, 0.07, 0.02, 0.06)
        flow = f"fix flow all pfv {IN_PIPE.replace('roof pressure 0', 'roof')} patch %s {' '.join(map(str, block))} pressure 0\n"
        self.liggghts(HEAD + PIPE + flow % "side" + dump("walls.dump") + "run 0\n")
        container = {"planes": [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": 0.0},
                     {"name": "top", "inward_normal": [0, 0, -1], "offset": -EDGE}],
                     "cylinders": [{"name": "side", "axis": [0, 0, 1], "point": [MIDDLE, MIDDLE, 0.0],
                     "radius": RADIUS}]}
        static = self.pfv_forces("walls.dump", "--face", "bottom:pressure=10",
                                 "--patch", f"side:{','.join(map(str, block))}:pressure=0", container=container)
        coupled = forces(read_dump(self.folder / "walls.dump")[0])
        self.assertLess(largest_difference(coupled, static), 1e-12)
        self.assertGreater(max(abs(force[0]) for force in coupled.values()), 1e-6)  # it goes out on one side
        self.refused(HEAD + PIPE + flow % "lid" + "run 0\n", "there is no face 'lid'; there are side, bottom, top")

    def test_six_walls_are_the_box(self):
        walls = "".join(f"fix w{a}{k} all {MODEL} primitive type 1 {a}plane {k * EDGE}\n"
                        for a in "xyz" for k in (0, 1))
        named = " ".join(f"face {a}{k} wall w{a}{k}" for a in "xy" for k in (0, 1))
        named += " face z0 wall wz0 pressure 10 face z1 wall wz1 pressure 0"
        self.liggghts(HEAD + f"fix flow all pfv {FLOW}\n" + dump("box.dump") + "run 20\n")
        self.liggghts(HEAD + walls + f"fix flow all pfv viscosity 0.01 container {named}\n" +
                      dump("walls.dump") + "run 0\n")
        box, container = (forces(read_dump(self.folder / f"{n}.dump")[0]) for n in ("box", "walls"))
        self.assertLess(largest_difference(box, container), 1e-13)

    def test_a_leaning_mesh_and_planes_by_point_and_normal(self):
        lean = 0.02
        write_plate(self.folder / "lid.stl", [(-0.1, -0.1, EDGE + lean + 0.1 * lean / EDGE),
                                              (0.2, -0.1, EDGE + lean - 0.2 * lean / EDGE),
                                              (0.2, 0.2, EDGE + lean - 0.2 * lean / EDGE),
                                              (-0.1, 0.2, EDGE + lean + 0.1 * lean / EDGE)])
        lid = "fix lid all mesh/surface file lid.stl type 1\n" + f"fix lw all {MODEL} mesh n_meshes 1 meshes lid\n"
        sides = (f"face x0 plane 0 0 0 1 0 0 face x1 plane {EDGE} 0 0 -1 0 0 face y0 plane 0 0 0 0 1 0 "
                 f"face y1 plane 0 {EDGE} 0 0 -1 0 face floor plane 0 0 0 0 0 1 pressure 10 ")
        self.liggghts(HEAD + lid + f"fix flow all pfv viscosity 0.01 container {sides} face lid mesh lid pressure 0\n" +
                      dump("walls.dump") + "run 0\n")
        slope = lean / EDGE
        container = {"planes": [
                     {"name": "x0", "inward_normal": [1, 0, 0], "offset": 0},
                     {"name": "x1", "inward_normal": [-1, 0, 0], "offset": -EDGE},
                     {"name": "y0", "inward_normal": [0, 1, 0], "offset": 0},
                     {"name": "y1", "inward_normal": [0, -1, 0], "offset": -EDGE},
                     {"name": "floor", "inward_normal": [0, 0, 1], "offset": 0},
                     {"name": "lid", "inward_normal": [-slope, 0, -1], "offset": -(EDGE + lean)}]}
        static = self.pfv_forces("walls.dump", "--face", "floor:pressure=10", "--face", "lid:pressure=0", container=container)
        coupled = forces(read_dump(self.folder / "walls.dump")[0])
        self.assertLess(largest_difference(coupled, static), 1e-9)

    def test_a_plate_that_sinks_and_tilts_expels_what_the_volume_loses(self):
        write_plate(self.folder / "lid.stl", [(-0.05, -0.05, EDGE), (0.15, -0.05, EDGE), (0.15, 0.15, EDGE),
                                              (-0.05, 0.15, EDGE)])
        lid = ("fix lid all mesh/surface file lid.stl type 1\n"
               f"fix lw all {MODEL} mesh n_meshes 1 meshes lid\n"
               "fix down all move/mesh mesh lid linear 0. 0. -0.001\n"
               f"fix turn all move/mesh mesh lid rotate origin {MIDDLE} {MIDDLE} {EDGE} axis 0. 1. 0. period 60.\n")
        sides = (f"face x0 plane 0 0 0 1 0 0 face x1 plane {EDGE} 0 0 -1 0 0 face y0 plane 0 0 0 0 1 0 "
                 f"face y1 plane 0 {EDGE} 0 0 -1 0 face floor plane 0 0 0 0 0 1 pressure 0 ")
        for every in (1, 5):
            self.liggghts(FROZEN + lid + f"fix flow all pfv viscosity 0.01 container {sides} face lid mesh lid "
                          f"couple_every {every}\n" + THERMO + "run 20\n")
            last = read_thermo((self.folder / "log.liggghts").read_text())[-1]
            # turning about its middle it moves as much fluid in as out, but for what it has tilted
            self.assertAlmostEqual(last["flow[2]"] / (0.001 * EDGE**2), 1.0, places=4)
            self.assertLess(abs(last["flow[3]"]), 1e-11)

    def test_runs_on_two_ranks_and_goes_on_after_a_restart(self):
        write_data(self.folder, in_pipe(packing(8)))
        head = HEAD + PIPE + f"fix flow all pfv {IN_PIPE} couple_every 1\n"
        self.liggghts(head + "run 10\nwrite_restart file.restart\n" + dump("whole.dump") + "run 10\n")
        self.liggghts(restarted_head() + PIPE + f"fix flow all pfv {IN_PIPE} couple_every 1\n" +
                      dump("parts.dump") + "run 10\n")
        whole, parts = (read_dump(self.folder / f"{n}.dump")[20] for n in ("whole", "parts"))
        self.assertEqual(whole, parts)
        for ranks in (1, 2):
            self.liggghts(head + dump(f"{ranks}.dump") + "run 20\n", ranks=ranks)
        one, two = (forces(read_dump(self.folder / f"{ranks}.dump")[20]) for ranks in (1, 2))
        self.assertLess(largest_difference(one, two), 1e-9)

    def test_what_is_no_container_is_refused(self):
        bottom = "face bottom wall floor pressure 10"
        pipe = HEAD + PIPE
        self.refused(pipe + f"fix flow all pfv viscosity 0.01 container face side wall shell {bottom}\nrun 0\n",
                     "container", "2 faces")
        self.refused(pipe + f"fix flow all pfv viscosity 0.01 container face side wall shell {bottom} "
                     "face side plane 0 0 0.1 0 0 -1\nrun 0\n", "side", "twice")
        self.refused(pipe + "fix flow all pfv viscosity 0.01 " + faces(xlo="wall shell") + "\nrun 0\n",
                     "cylinder", "container")
        self.refused(HEAD + f"fix flow all pfv viscosity 0.01 {faces()} container\nrun 0\n", "before the faces")
        write_plate(self.folder / "bent.stl", [(0, 0, EDGE), (0.1, 0, EDGE + 0.02), (0.1, 0.1, EDGE), (0, 0.1, EDGE)])
        self.refused(pipe + "fix bent all mesh/surface file bent.stl type 1\n"
                     f"fix flow all pfv viscosity 0.01 container face side wall shell {bottom} face top mesh bent\n"
                     "run 0\n", "container", "it is open")

    def test_a_wall_keeps_its_side_when_the_grains_have_passed_it(self):
        """A gate whose contacts are taken away between runs."""
        write_plate(self.folder / "gate.stl", [(0, 0, 0), (EDGE, 0, 0), (EDGE, EDGE, 0), (0, EDGE, 0)])
        planes = " ".join(f"face {name} plane {place} {normal}" for name, place, normal in (
            ("x0", "0 0 0", "1 0 0"), ("x1", f"{EDGE} 0 0", "-1 0 0"), ("y0", "0 0 0", "0 1 0"),
            ("y1", f"0 {EDGE} 0", "0 -1 0"), ("top", f"0 0 {EDGE}", "0 0 -1 pressure 0")))
        said = self.liggghts(HEAD + "fix gate all mesh/surface file gate.stl type 1\n"
                             f"fix flow all pfv viscosity 0.01 container {planes} face gate mesh gate\nrun 0\n"
                             f"change_box all z final -1.0 1.0\ndisplace_atoms all move 0 0 {-0.9 * EDGE}\nrun 0\n")
        box = f"container of {EDGE**3:.4g} m3"
        self.assertEqual(said.count(box), 2)
        inside = [int(line.split(" grains inside")[0].split()[-1]) for line in said.splitlines() if box in line]
        self.assertEqual(inside[0], 125)
        self.assertLess(inside[1], 63)

    def test_grains_that_have_left_under_an_extent_are_said_to_have(self):
        sides = "face x0 plane 0 0 0 1 0 0 face x1 plane 0.1 0 0 -1 0 0 face y0 plane 0 0 0 0 1 0 face y1 plane 0 0.1 0 0 -1 0"
        for words in (faces(zlo="pressure 1", zhi="extent pressure 0"),
                      f"container {sides} face floor plane 0 0 0 0 0 1 pressure 1 face zhi extent z hi pressure 0"):
            self.refused(HEAD + f"fix flow all pfv viscosity 0.01 {words}\nrun 0\nchange_box all z final -1.0 1.0\n"
                         f"displace_atoms all move 0 0 {-2 * EDGE}\nrun 0\n",
                         "leave no room between them", "face zhi", "where the grains leave")

    def test_a_cylinder_under_a_leaning_roof_is_of_flats(self):
        write_data(self.folder, in_pipe(packing(8)))
        said = self.liggghts(HEAD + PIPE + f"fix flow all pfv viscosity 0.01 container face side wall shell face bottom wall "
                             f"floor pressure 10 face top plane {MIDDLE} {MIDDLE} {EDGE} 0.2 0 -1 pressure 0\n" + THERMO + "run 2\n")
        self.assertIn("held by 34 walls: side_1 (wall 'shell', plane)", said)
        self.assertIn(f"container of {32 * math.tan(math.pi / 32) * RADIUS**2 * EDGE:.4g} m3", said)
        self.assertLess(read_thermo((self.folder / "log.liggghts").read_text())[-1]["flow[4]"], 1e-12)


if __name__ == "__main__":
    unittest.main()

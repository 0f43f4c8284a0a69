# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls found in the script: `container walls`, meshes that are several walls or round, walls that the fluid
does not see."""
import math
import re
import unittest

from coupled import EDGE, FLOW, CoupledTest, dump, forces, largest_difference, packing
from coupled import read_dump, read_thermo, restarted_head, write_data
from plates import funnel, lid, quad, ring, write_mesh

MODEL = "wall/gran model hooke/stiffness tangential history"
HEAD = "include in.packing\n"
FROZEN = HEAD + "unfix integr\n"
RADIUS, MIDDLE = 0.045, EDGE / 2
ENDS = (f"fix floor all {MODEL} primitive type 1 zplane 0.0\n"
        f"fix roof all {MODEL} primitive type 1 zplane {EDGE}\n")
PRESSURES = "face floor pressure 10 face roof pressure 0"
THERMO = ("thermo_style custom step f_flow[1] f_flow[2] f_flow[3] f_flow[4]\n"
          "thermo_modify norm no format float %.15g\nthermo 1\n")


def mesh(*names):
    """Meshes and the wall that they are: LIGGGHTS takes one wall of meshes."""
    return ("".join(f"fix {name} all mesh/surface file {name}.stl type 1\n" for name in names) +
            f"fix meshes all {MODEL} mesh n_meshes {len(names)} meshes {' '.join(names)}\n")


def within(grains, radius):
    return [g for g in grains if math.hypot(g[1] - MIDDLE, g[2] - MIDDLE) + 0.3 * g[4] < radius]


class Walls(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing())

    def flow(self, words="", container="walls"):
        return f"fix flow all pfv viscosity 0.01 container {container} {words} couple_every 1\n"

    def first_forces(self, script, name="walls.dump"):
        said = self.liggghts(script + dump(name) + "run 0\n")
        return forces(read_dump(self.folder / name)[0]), said

    def test_a_tube_of_flats_is_the_cylinder_of_its_cross_section(self):
        write_data(self.folder, within(packing(8), RADIUS))
        write_mesh(self.folder / "tube.stl", funnel(ring(32, RADIUS, -0.01, MIDDLE), ring(32, RADIUS, EDGE + 0.01, MIDDLE)))
        coupled, said = self.first_forces(HEAD + mesh("tube") + ENDS + self.flow(PRESSURES))
        self.assertRegex(said, r"held by 3 walls: floor \(plane\), roof \(plane\), tube \(cylinder of radius 0.04486 m "
                               r"for flats that lie within 0.000\d+ m of it\)")
        section = 16 * RADIUS**2 * math.sin(math.pi / 16)
        container = {"planes": [{"name": "floor", "inward_normal": [0, 0, 1], "offset": 0.0},
                     {"name": "roof", "inward_normal": [0, 0, -1], "offset": -EDGE}],
                     "cylinders": [{"name": "tube", "axis": [0, 0, 1], "point": [MIDDLE, MIDDLE, 0.0],
                     "radius": math.sqrt(section / math.pi)}]}
        static = self.pfv_forces("walls.dump", "--face", "floor:pressure=10", "--face", "roof:pressure=0", container=container)
        self.assertLess(largest_difference(coupled, static), 1e-5)  # LIGGGHTS reads STL files in single precision

    def test_a_funnel_is_its_planes_and_what_lies_under_it_bounds_nothing(self):
        wide, narrow = 0.09, 0.04
        below = ring(4, narrow, 0.0, MIDDLE, 0.5)
        write_mesh(self.folder / "hopper.stl", funnel(below, ring(4, wide, EDGE, MIDDLE, 0.5)))
        grains = [g for g in packing(8) if all(
            abs(g[i] - MIDDLE) + g[4] < math.sqrt(0.5) * (narrow + (wide - narrow) * g[3] / EDGE) for i in (1, 2))]
        write_data(self.folder, grains)
        under = f"fix ground all {MODEL} primitive type 1 zplane -0.01\n"
        words = f"face outlet plane 0 0 0 0 0 1 pressure 0 face top plane 0 0 {EDGE} 0 0 -1 pressure 10"
        for ranks in (1, 2):
            said = self.liggghts(HEAD + mesh("hopper") + under + self.flow(words) + dump("walls.dump") + "run 0\n", ranks=ranks)
            self.assertIn("held by 6 walls: outlet (plane), top (plane), hopper_1 (mesh 'hopper', plane), ", said)
            self.assertIn("left out: wall 'ground' bounds nothing", said)
            slope = math.sqrt(0.5) * (wide - narrow) / EDGE
            planes = [{"name": f"hopper_{k + 1}", "inward_normal": [*n, slope], "offset":
                       -math.sqrt(0.5) * narrow + MIDDLE * sum(n)}
                      for k, n in enumerate([(0, -1), (1, 0), (0, 1), (-1, 0)])]
            container = {"planes": planes + [{"name": "outlet", "inward_normal": [0, 0, 1], "offset": 0},
                         {"name": "top", "inward_normal": [0, 0, -1], "offset": -EDGE}]}
            static = self.pfv_forces("walls.dump", "--face", "top:pressure=10", "--face", "outlet:pressure=0", container=container)
            coupled = forces(read_dump(self.folder / "walls.dump")[0])
            self.assertLess(largest_difference(coupled, static), 1e-5)

    def test_a_closed_mesh_that_moves_in_one_piece_takes_its_fluid_along(self):
        low, high = ([(x, y, z) for x, y in ((0, 0), (EDGE, 0), (EDGE, EDGE), (0, EDGE))] for z in (0.0, EDGE))
        write_mesh(self.folder / "can.stl", funnel(low, high) + lid(low) + lid(high))
        move = "fix move all move/mesh mesh can linear 0.01 0.02 -0.01\n"
        drained = "face can symmetry region 0.04 0.06 0.04 0.06 0.04 0.06 pressure 0"
        self.liggghts(FROZEN + mesh("can") + move + self.flow(drained) + THERMO + "run 5\n")
        last = read_thermo((self.folder / "log.liggghts").read_text())[-1]
        # the grains stay behind: what the faces sweep adds up to nothing, what flows comes back
        self.assertLess(abs(last["flow[1]"]), 1e-9 * EDGE**2)
        self.assertLess(abs(last["flow[2]"]), 1e-9 * EDGE**2)

    def test_a_drum_that_turns_moves_no_fluid_and_goes_on_after_a_restart(self):
        write_data(self.folder, within(packing(8), RADIUS))
        back, front = (ring(24, RADIUS, z, MIDDLE) for z in (0.0, EDGE))
        write_mesh(self.folder / "drum.stl", funnel(back, front) + lid(back) + lid(front))
        turn = f"fix turn all move/mesh mesh drum rotate origin {MIDDLE} {MIDDLE} 0. axis 0. 0. 1. period 2.\n"
        words = "region 0.04 0.06 0.04 0.06 0.04 0.06 pressure 0"
        said = self.liggghts(FROZEN + mesh("drum") + turn + self.flow(words) + THERMO + "run 5\n")
        self.assertIn("held by 3 walls: drum_1 (mesh 'drum', cylinder of radius", said)
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertLess(abs(rows[-1]["flow[2]"]), 1e-9 * EDGE**2)
        write_data(self.folder, [g for g in within(packing(8), 0.95 * RADIUS) if math.hypot(
            g[1] - MIDDLE, g[2] - MIDDLE) + g[4] < 0.98 * RADIUS])
        head = HEAD + mesh("drum") + turn + self.flow(words)
        self.liggghts(head + "run 10\nwrite_restart file.restart\n" + dump("whole.dump") + "run 10\n")
        self.liggghts(restarted_head() + mesh("drum") + turn + self.flow(words) + dump("parts.dump") + "run 10\n")
        whole, parts = (forces(read_dump(self.folder / f"{n}.dump")[20]) for n in ("whole", "parts"))
        self.assertEqual(whole, parts)

    def test_a_silo_of_a_cylinder_and_a_cone_is_of_flats(self):
        shell = [ring(24, RADIUS, z, MIDDLE) for z in (0.03, EDGE)]
        write_mesh(self.folder / "shell.stl", funnel(*shell))
        write_mesh(self.folder / "cone.stl", funnel(ring(24, 0.02, 0.0, MIDDLE), shell[0]))
        grains = [g for g in within(packing(8), 0.99 * RADIUS) if g[3] > 0.04]
        write_data(self.folder, grains)
        said = self.liggghts(HEAD + mesh("shell", "cone") + self.flow(
            f"face outlet plane 0 0 0 0 0 1 pressure 0 face top plane 0 0 {EDGE} 0 0 -1 pressure 10") + "run 0\n")
        self.assertIn("held by 50 walls", said)
        volume = 12 * math.sin(math.pi / 12) * (RADIUS**2 * 0.07 + 0.03 / 3 * (RADIUS**2 + RADIUS * 0.02 + 0.02**2))
        found = float(re.search(r"container of (\S+) m3", said).group(1))
        self.assertAlmostEqual(found / volume, 1.0, places=3)

    def test_what_stands_among_the_grains_is_left_out_and_said(self):
        write_mesh(self.folder / "paddle.stl", quad((0.05, 0.02, 0.02), (0.05, 0.08, 0.02), (0.05, 0.08, 0.08), (0.05, 0.02, 0.08)))
        sides = "".join(f"fix w{a}{k} all {MODEL} primitive type 1 {a}plane {k * EDGE}\n" for a in "xy" for k in (0, 1))
        said = self.liggghts(HEAD + sides + ENDS + mesh("paddle") + self.flow(PRESSURES) + "run 0\n")
        self.assertIn("held by 6 walls", said)
        self.assertRegex(said, r"left out: mesh 'paddle' has \d+ of 125 grains on its other side")
        self.assertRegex(said, r"WARNING.*mesh 'paddle' stands in the fluid, which does not see it: it reaches 0.05 m")
        core = f"fix core all {MODEL} primitive type 1 zcylinder 0.012 {MIDDLE} {MIDDLE}\n"
        said = self.liggghts(HEAD + sides + ENDS + core + self.flow(PRESSURES) + "run 0\n")
        self.assertRegex(said, r"left out: wall 'core' has \d+ of 125 grains on its other side; .*`obstacle mesh ID`")
        self.assertRegex(said, r"WARNING.*wall 'core' .*take a mesh of its shape")
        box, said = self.first_forces(HEAD + mesh("paddle") + f"fix flow all pfv {FLOW}\n", "box.dump")
        self.assertRegex(said, r"WARNING.*mesh 'paddle' stands in the fluid")

    def test_a_box_around_a_cylinder_is_warned_of(self):
        write_data(self.folder, within(packing(8), RADIUS))
        shell = f"fix shell all {MODEL} primitive type 1 zcylinder {RADIUS} {MIDDLE} {MIDDLE}\n"
        said = self.liggghts(HEAD + shell + f"fix flow all pfv {FLOW}\n" + "run 0\n")
        part = float(re.search(r"wall 'shell' cuts off (\S+) %", said).group(1))
        self.assertAlmostEqual(part, 100 * (1 - math.pi * RADIUS**2 / EDGE**2), delta=0.5)
        said = self.liggghts(HEAD + ENDS + f"fix flow all pfv {FLOW}\n" + "run 0\n")
        self.assertNotIn("cuts off", said)

    def test_grains_of_a_metre_are_asked_about(self):
        for name in ("", "x"):
            script = HEAD if not name else HEAD + "set group all diameter 1.2\n"
            said = self.liggghts(script + f"fix flow all pfv {FLOW.replace('plane 0.1', 'plane 100').replace('plane 0.0', 'plane -100')}\n"
                                 "run 0\n")
            self.assertEqual("not mm" in said, bool(name))

    def test_a_place_of_its_own_and_the_group_come_first(self):
        sides = "".join(f"fix w{a}{k} all {MODEL} primitive type 1 {a}plane {k * EDGE}\n" for a in "xy" for k in (0, 1))
        lower = f"face roof plane 0 0 {0.9 * EDGE} 0 0 -1 pressure 0"
        said = self.liggghts(HEAD + sides + ENDS + self.flow(lower) + "run 0\n")
        self.assertIn(f"container of {0.9 * EDGE**3:.4g} m3", said)
        self.assertIn("left out: wall 'roof' is no face, since the face of that name has a place of its own", said)
        wet = (f"region below block INF INF INF INF INF {0.55 * EDGE}\ngroup wet region below\n"
               f"fix middle all {MODEL} primitive type 1 zplane {0.6 * EDGE}\n")
        flow = self.flow("face middle pressure 0").replace("flow all", "flow wet")
        said = self.liggghts(HEAD + sides + wet + ENDS + flow + "run 0\n")
        self.assertIn(f"container of {0.6 * EDGE**3:.4g} m3", said)

    def test_flats_on_request_and_a_gate_that_covers_a_part(self):
        write_data(self.folder, within(packing(8), 0.97 * RADIUS))
        write_mesh(self.folder / "tube.stl", funnel(ring(32, RADIUS, -0.01, MIDDLE), ring(32, RADIUS, EDGE + 0.01, MIDDLE)))
        said = self.liggghts(HEAD + mesh("tube") + ENDS + self.flow(PRESSURES, "walls flats") + "run 0\n")
        self.assertIn("held by 34 walls", said)
        self.assertNotIn("covers", said)
        write_data(self.folder, packing())
        write_mesh(self.folder / "gate.stl", quad((EDGE, 0, 0), (EDGE, EDGE, 0), (EDGE, EDGE, EDGE / 2), (EDGE, 0, EDGE / 2)))
        sides = "".join(f"fix w{a} all {MODEL} primitive type 1 {a[0]}plane {w}\n" for a, w in (("x0", 0), ("y0", 0), ("y1", EDGE)))
        said = self.liggghts(HEAD + sides + ENDS + mesh("gate") + self.flow(PRESSURES) + "run 0\n")
        self.assertRegex(said, r"WARNING.*the mesh of face gate covers 50 % of it")

    def test_what_cannot_be_walls_is_refused(self):
        bent = quad((0, 0, 0), (0.05, 0, 0.02), (0.05, 0.1, 0.02), (0, 0.1, 0)) + quad(
            (0.05, 0, 0.02), (0.1, 0, 0), (0.1, 0.1, 0), (0.05, 0.1, 0.02)) + quad(
            (0.1, 0, 0), (0.15, 0, 0.02), (0.15, 0.1, 0.02), (0.1, 0.1, 0))
        write_mesh(self.folder / "bent.stl", bent)
        self.refused(HEAD + ENDS + mesh("bent") + self.flow("face bent mesh bent") + "run 0\n", "bent", "not convex", "triangle")
        self.refused(HEAD + ENDS + self.flow("face lid pressure 0") + "run 0\n", "face lid", "no fix wall/gran")
        self.refused(HEAD + ENDS + self.flow() + "run 0\n", "2 faces")
        hopper = funnel(ring(4, 0.04, 0.0, MIDDLE), ring(4, 0.09, EDGE, MIDDLE))
        write_mesh(self.folder / "hopper.stl", hopper)
        self.refused(HEAD + ENDS + mesh("hopper") + self.flow("face hopper flux 1e-6") + "run 0\n", "hopper", "4 walls", "flux")
        oval = [[(MIDDLE + 0.7 * (x - MIDDLE), y, z) for x, y, z in ring(80, radius, height, MIDDLE)]
                for radius, height in ((0.04, 0.0), (0.09, EDGE))]  # a round one has fewer flats in its place
        write_mesh(self.folder / "cone.stl", funnel(*oval))
        self.refused(HEAD + ENDS + mesh("cone") + self.flow() + "run 0\n", "2 faces", "left out: mesh 'cone' has")
        self.refused(HEAD + ENDS + mesh("cone") + self.flow("face cone") + "run 0\n", "cone", "80 planes", "fewer flats")


if __name__ == "__main__":
    unittest.main()

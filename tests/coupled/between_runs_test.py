# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves between two runs leads to the network that a new fix would have; what stays keeps its own."""
import unittest

from coupled import EDGE, FLOW, WATER, CoupledTest, dump, faces, packing, read_dump, read_thermo, write_data
from plates import square, write_plate

HEAD = "include in.packing\n"
THERMO = ("thermo_style custom step f_flow[1] f_flow[5]\n"
          "thermo_modify norm no format float %.17g\n")
WALL = ("fix side all wall/gran model hooke/stiffness tangential history primitive type 1 "
        "xplane {}\n")


class BetweenRuns(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4))

    def as_a_new_fix(self, change, flow=FLOW, before="", first="run 0\n", **options):
        """The forces after a change between two runs are, byte for byte, those of a fix that is
        defined anew; the change counts as one retriangulation."""
        fix = f"fix flow all pfv {flow}\n"
        screen = self.liggghts(HEAD + before + fix + THERMO + first + change + dump("kept.dump") +
                               "run 0\nundump d\nthermo_style custom step\nunfix flow\n" + fix +
                               dump("new.dump") + THERMO + "run 0\n", **options)
        rows = [row for row in read_thermo(screen) if "flow[5]" in row]
        self.assertEqual(rows[-2]["flow[5]"] - rows[-3]["flow[5]"], 1)
        self.assertEqual(rows[-2]["flow[1]"], rows[-1]["flow[1]"])
        self.assertNotEqual(rows[-2]["flow[1]"], rows[-3]["flow[1]"])
        kept, new = ((self.folder / name).read_bytes() for name in ("kept.dump", "new.dump"))
        self.assertEqual(kept, new)

    def test_a_viscosity_that_changes_before_a_run_without_a_setup(self):
        """`run ... every` and `pre no` leave the setup out; the next step has the new viscosity all the same."""
        script = (HEAD + f"fix flow all pfv viscosity 0.01 {WATER.split(' ', 2)[2]} {{}}\n" +
                  THERMO + "thermo 1\nrun 2\n")
        for steps in ("couple_every 1", "couple_every 3", "couple_every auto"):
            inflow = {}
            for viscosity in (0.01, 0.5):
                screen = self.liggghts(script.format(steps) + f"fix_modify flow viscosity {viscosity}\nrun 1 pre no\n")
                inflow[viscosity] = read_thermo(screen)[-1]["flow[1]"]
            self.assertAlmostEqual(inflow[0.01] / inflow[0.5] / 50, 1.0, delta=0.02, msg=steps)

    # what moves

    def test_grains_that_are_displaced(self):
        self.as_a_new_fix("displace_atoms all move 0.001 0 0 units box\n")

    def test_one_grain_that_is_displaced_by_a_hair(self):
        self.as_a_new_fix("group one id 20\ndisplace_atoms one move 0 0 1e-9 units box\n")

    def test_grains_that_another_rank_holds(self):
        self.as_a_new_fix("group one id 20\ndisplace_atoms one move 0 0 1e-6 units box\n", ranks=2)

    def test_grains_that_grow_by_less_than_the_strain(self):
        self.as_a_new_fix("set group all diameter 0.0189\n", before="set group all diameter 0.0190\n")

    def test_grains_after_steps_of_their_own(self):
        self.as_a_new_fix("displace_atoms all move 1e-5 0 0 units box\n", first="run 7\n")

    def test_a_wall_that_is_set_up_again_elsewhere(self):
        flow = "viscosity 0.01 " + faces(xlo="wall side", zlo="pressure 10", zhi="pressure 0")
        self.as_a_new_fix("unfix side\n" + WALL.format(-0.005), flow=flow, before=WALL.format(0.0))

    def test_a_mesh_that_is_loaded_again_elsewhere(self):
        write_plate(self.folder / "plate.stl", square(EDGE))
        mesh = "fix plate all mesh/surface file plate.stl type 1 move 0. 0. {}\n"
        flow = "viscosity 0.01 " + faces(zlo="mesh plate pressure 10", zhi="pressure 0")
        self.as_a_new_fix("unfix plate\n" + mesh.format(-0.004), flow=flow,
                          before=mesh.format(-0.002))

    def test_the_extent_of_grains_that_move(self):
        flow = "viscosity 0.01 " + faces(zlo="pressure 10", zhi="extent pressure 0")
        self.as_a_new_fix("displace_atoms all move 0 0 -1e-4 units box\n", flow=flow)

    def test_an_interval_of_couple_every_begins_anew(self):
        """Its mean velocities would otherwise hold the displacement."""
        flow = WATER + " couple_every 5"
        fix = f"fix flow all pfv {flow}\n"
        move = "displace_atoms all move 1e-3 0 0 units box\nvelocity all set 0 0 0\n"
        still = "unfix integr\nvelocity all set 0 0 0\n"
        self.liggghts(HEAD + still + fix + "run 3\n" + move + dump("kept.dump") +
                      "run 5\nundump d\nunfix flow\nreset_timestep 3\n" + fix +
                      dump("new.dump") + "run 5\n")
        self.assertEqual(read_dump(self.folder / "kept.dump"), read_dump(self.folder / "new.dump"))

    # what stays

    def test_what_stays_keeps_its_network(self):
        write_plate(self.folder / "plate.stl", square(EDGE))
        sources = {"planes": FLOW,
                   "extent": "viscosity 0.01 " + faces(zlo="pressure 10", zhi="extent pressure 0"),
                   "mesh": "viscosity 0.01 " + faces(zlo="mesh plate pressure 10",
                                                     zhi="pressure 0")}
        before = ("fix plate all mesh/surface file plate.stl type 1\n"
                  "fix lift all move/mesh mesh plate linear 0. 0. 0.01\n")
        for name, flow in sources.items():
            for ranks in (1, 2):
                with self.subTest(source=name, ranks=ranks):
                    screen = self.liggghts(HEAD + before + f"fix flow all pfv {flow}\n" + THERMO +
                                           "run 5\nrun 5\nrun 5 pre no\nrun 0\n"
                                           "reset_timestep 0\nrun 5\nrun 10 every 5 NULL\n",
                                           ranks=ranks)
                    self.assertEqual({row["flow[5]"] for row in read_thermo(screen)}, {0.0})

    def test_a_restart_file_between_runs_sees_what_moved(self):
        """The run that goes on and the one that starts from the file count the same networks."""
        fix = f"fix flow all pfv {FLOW}\n"
        move = "displace_atoms all move 1e-4 0 0 units box\n"
        screen = self.liggghts(HEAD + fix + THERMO + "run 5\n" + move +
                               "write_restart file.restart\nrun 0\n" + move + "run 0\n")
        counts = [row["flow[5]"] for row in read_thermo(screen)]
        self.assertEqual(counts[0:2], [0.0, 0.0])
        self.assertEqual(counts[-2:], [1.0, 2.0])


class EmptyBox(CoupledTest):
    def test_grains_that_are_all_outside_are_said(self):
        grains = packing(3)
        write_data(self.folder, grains)
        away = FLOW.replace("face zlo plane 0.0", "face zlo plane 1.0").replace(
            "face zhi plane 0.1", "face zhi plane 1.1")
        screen = self.liggghts(HEAD + f"fix flow all pfv {away}\nrun 0\n")
        said = [line for line in screen.splitlines() if "outside the flow box" in line]
        self.assertEqual(len(said), 1)
        lowest = min(grain[3] for grain in grains)
        for part in ("WARNING", "all 27 grains", "z from 1 to 1.1", f"z from {lowest:.6g} to"):
            self.assertIn(part, said[0])

    def test_neither_a_grain_within_nor_a_box_to_be_filled_is(self):
        write_data(self.folder, packing(3))
        some = FLOW.replace("face zlo plane 0.0", "face zlo plane 0.08")
        for script in (HEAD + f"fix flow all pfv {some}\n",
                       HEAD + f"group later id 999\nfix flow later pfv {FLOW}\n"):
            self.assertNotIn("outside the flow box", self.liggghts(script + "run 0\n"))


if __name__ == "__main__":
    unittest.main()

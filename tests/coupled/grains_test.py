# SPDX-License-Identifier: GPL-3.0-or-later
"""Grains that come, go, grow, and leave the flow box."""
import unittest

from coupled import EDGE, FLOW, CoupledTest, dump, faces, forces, largest_difference, packing
from coupled import read_dump, read_thermo, write_data
from plates import square, write_plate

HEAD = "include in.packing\n"
FIX = f"fix flow all pfv {FLOW}\n"
THERMO = ("thermo_style custom step atoms f_flow[5] f_flow[8]\n"
          "thermo_modify lost ignore norm no format float %.15g\nthermo 1\n")
PRESSURES = ("--face", "zlo:pressure=10", "--face", "zhi:pressure=0")


class Grains(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing())

    def log(self):
        return read_thermo((self.folder / "log.liggghts").read_text())

    def check_last_step(self, rows):
        """The forces are those of the library on the grains that are there, and no others."""
        lines = ["id,x,y,z,radius,vx,vy,vz,omegax,omegay,omegaz"]
        lines += [",".join([str(n)] + [repr(v) for v in row[:7] + row[11:14]])
                  for n, row in rows.items()]
        (self.folder / "last.csv").write_text("\n".join(lines) + "\n")
        expected = self.pfv_forces("last.csv", *PRESSURES)
        self.assertLess(largest_difference(forces(rows), expected), 1e-10)

    def test_deleted_between_runs(self):
        self.liggghts(HEAD + FIX + "run 1\nregion hole block 0.04 0.06 0.04 0.06 -1 1 units box\n"
                      "delete_atoms region hole\n" + dump("d.dump") + "run 0\n")
        rows = read_dump(self.folder / "d.dump")[1]
        self.assertEqual(len(rows), 120)
        self.check_last_step(rows)

    def test_deleted_in_a_run_by_an_outlet(self):
        """Grains that cross the plate of a fix massflow/mesh vanish; the flow goes on without."""
        write_plate(self.folder / "outlet.stl", square(EDGE, 0.095))
        # at a constant velocity: that of the step's middle, which the fix takes, is the dumped one
        self.liggghts(HEAD + "unfix integr\nregion top block -1 1 -1 1 0.08 1 units box\n"
                      "group top region top\nfix integr top move linear 0 0 1\n"
                      "fix out all mesh/surface file outlet.stl type 1\n"
                      "fix mf all massflow/mesh mesh out vec_side 0. 0. 1. count once "
                      "delete_atoms yes\n" + FIX + THERMO + dump("d.dump") + "run 700\n")
        steps = read_dump(self.folder / "d.dump")
        self.assertEqual(len(steps[700]), 100)
        changed = [step for step in range(1, 701) if len(steps[step]) != len(steps[step - 1])]
        # a new network is built in the very step in which grains are gone
        self.check_last_step(steps[changed[0]])

    def test_inserted_in_a_run(self):
        grains = [g for g in packing() if g[3] < 0.06]
        write_data(self.folder, grains)
        self.liggghts(HEAD + "fix t all particletemplate/sphere 15485863 atom_type 1 "
                      "density constant 2600 radius constant 0.004\n"
                      "fix d all particledistribution/discrete 32452843 1 t 1.0\n"
                      "region top block 0 0.1 0 0.1 0.07 0.1 units box\n" + FIX +
                      "fix ins all insert/pack seed 32452867 distributiontemplate d insert_every 3 "
                      "overlapcheck yes all_in yes particles_in_region 40 region top\n" +
                      THERMO + dump("d.dump") + "unfix integr\nrun 4\n")
        steps = read_dump(self.folder / "d.dump")
        changed = [step for step in range(1, 5) if len(steps[step]) != len(steps[step - 1])]
        self.assertGreater(len(changed), 0)
        for step in changed:
            self.check_last_step(steps[step])

    def test_diameter_changed_by_fix_adapt(self):
        """A growth of 1 % per step is more than a kept network allows: the forces follow."""
        self.liggghts(HEAD + "unfix integr\n" + FIX + "compute rad all property/atom radius\n"
                      "variable grown atom 2.02*c_rad\n"
                      "fix grow all adapt 1 atom diameter v_grown\n" + dump("d.dump") + "run 2\n")
        steps = read_dump(self.folder / "d.dump")
        self.assertGreater(steps[2][1][3] / steps[0][1][3], 1.005)
        self.check_last_step(steps[2])

    def test_outside_the_box_no_force_until_the_return(self):
        """A grain that leaves through the open top is left out and counted; back inside it gets its
        force again."""
        grains = packing()
        flyer = max(grains, key=lambda g: g[3])[0]
        write_data(self.folder, grains, {flyer: [0.0, 0.0, 20.0]})
        back = f"group flyer id {flyer}\nvelocity flyer set 0 0 -20\n"
        self.liggghts(HEAD + FIX + THERMO + dump("d.dump") + "run 80\n" + back + "run 120\n")
        steps, rows = read_dump(self.folder / "d.dump"), self.log()
        outside = {row["Step"]: row["flow[8]"] for row in rows}
        self.assertEqual((outside[0], outside[80], outside[200]), (0, 1, 0))
        self.assertGreater(steps[80][flyer][2], EDGE)
        self.assertEqual(steps[80][flyer][7:11], [0.0] * 4)
        self.assertNotEqual(steps[200][flyer][7:11], [0.0] * 4)

    def test_lost_from_the_domain(self):
        """LIGGGHTS deletes what leaves its own domain; the flow goes on without it."""
        grains = packing()
        flyer = max(grains, key=lambda g: g[3])[0]
        write_data(self.folder, grains, {flyer: [0.0, 0.0, 40.0]})
        self.liggghts(HEAD + FIX + THERMO + dump("d.dump") + "run 200\n")
        last = read_dump(self.folder / "d.dump")[200]
        self.assertNotIn(flyer, last)
        self.assertEqual(len(last), 124)
        self.assertEqual(self.log()[-1]["flow[8]"], 0)

    def test_no_grains_at_all(self):
        """A group that is empty at first: the box holds fluid alone, which pushes nothing."""
        self.liggghts(HEAD + "group late id 999\n" + FIX.replace("all", "late", 1) + THERMO +
                      "run 3\n")
        self.assertEqual(self.log()[-1]["flow[8]"], 0)

    def test_grains_that_go_along_with_the_fluid(self):
        """Plug flow: no pressure, no force, and nothing to stop the run at a new network."""
        speed = 0.01
        grains = packing(4)
        write_data(self.folder, grains, {grain[0]: [0, 0, speed] for grain in grains})
        sides = {side: "symmetry sealed" for side in ("xlo", "xhi", "ylo", "yhi")}
        flow = faces(zlo=f"flux {speed * EDGE**2!r}", zhi="pressure 0", **sides)
        self.liggghts("include in.packing\nfix flow all pfv viscosity 1 retriangulate 1e-6 " + flow +
                      "\n" + dump("d.dump") + "run 20\n")
        for rows in read_dump(self.folder / "d.dump").values():
            # 12 mu v L = 0.012 N would hold grains at rest
            self.assertLess(max(abs(f) for force in forces(rows).values() for f in force), 1e-12)

    def test_extent_before_there_are_grains_is_the_side_of_the_simulation_box(self):
        """0.1 by 0.1 between the side planes, from -0.02 to 0.15 along z."""
        flow = "viscosity 0.01 " + faces(zlo="extent pressure 1", zhi="extent pressure 0")
        screen = self.liggghts(f"include in.packing\ngroup nobody id 999\nfix flow nobody pfv {flow}\nrun 0\n")
        self.assertIn("flow box of 0.0017 m3, no grains yet", screen)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""couple_every auto: what changes amid an interval is solved for at once, and the intervals grow again after it."""
import unittest

from coupled import EDGE, CoupledTest, faces, packing, read_thermo, write_data
from plates import square, write_plate

JUMP = 150  # the step after which something changes
THERMO = ("thermo_style custom step atoms f_flow[1] f_flow[2] f_flow[7] f_flow[10]\n"
          "thermo_modify norm no format float %.15g\nthermo 1\n")


class SuddenChanges(CoupledTest):
    """Grains that nothing moves, so that intervals are long when the change comes."""

    def setUp(self):
        super().setUp()
        self.grains = [(*grain[:4], 0.012) for grain in packing(3)]
        write_data(self.folder, self.grains)

    def run_with(self, flow, before="", steps=2 * JUMP, integrated="unfix integr\n"):
        self.liggghts(f"include in.packing\n{integrated}{before}fix flow all pfv viscosity 1e-3 {flow}\n{THERMO}run {steps}\n")
        return read_thermo((self.folder / "log.liggghts").read_text())

    def solved_at_once(self, flow, before, name, right=JUMP + 1):
        """Auto is amid an interval before the change, solves right after it, and has the values of each step."""
        auto, each = (self.run_with(flow + words, before) for words in ("", " couple_every 1"))
        self.assertGreater(auto[JUMP]["flow[10]"], 0)
        self.assertEqual(auto[JUMP + 1]["flow[10]"], 0)
        self.assertEqual(auto[right]["flow[10]"], 0)
        self.assertAlmostEqual(auto[right][name] / each[right][name], 1.0, delta=1e-6)
        self.assertGreater(abs(auto[JUMP][name] / auto[right][name] - 1.0), 0.004)
        # the intervals grow anew: 1, 2, 4, 7 ... steps
        self.assertLess(sum(row["flow[10]"] == 0 for row in auto[JUMP + 1:]), 20)

    def test_grains_that_grow_at_rest(self):
        self.solved_at_once(faces(zlo="pressure 10", zhi="pressure 0"),
                            f"variable d equal 0.024+0.0004*(step>{JUMP})\nfix grow all adapt 1 atom diameter v_d\n",
                            "flow[1]")

    def test_a_flux_beside_a_pressure(self):
        self.solved_at_once(faces(zlo="flux v_q", zhi="pressure 1"), f"variable q equal 1e-5+1e-4*(step>{JUMP})\n",
                            "flow[1]")

    def test_a_lid_that_begins_to_move_amid_a_run(self):
        """The solve at the jump has the mean velocity since the last one, the next the lid's own."""
        write_plate(self.folder / "lid.stl", square(EDGE, EDGE))
        lid = ("fix lid all mesh/surface/stress file lid.stl type 1\n"
               f"variable none equal 0\nvariable vz equal -0.01*(step>{JUMP})\n"
               "fix down all move/mesh mesh lid linear/variable v_none v_none v_vz\n")
        self.solved_at_once(faces(zlo="pressure 0", zhi="mesh lid"), lid, "flow[2]", JUMP + 2)

    def test_a_constant_in_all_pressures_changes_no_solve(self):
        solved = {}
        for level in (0, 101325):
            rows = self.run_with(faces(zlo="pressure v_p", zhi=f"pressure {level}"),
                                 before=f"variable p equal {level}+10+20*(step>{JUMP})\n")
            solved[level] = [row["Step"] for row in rows if row["flow[10]"] == 0]
        self.assertIn(JUMP + 1, solved[0])
        self.assertEqual(solved[0], solved[101325])

    def test_grains_that_are_inserted_have_their_loads_at_once(self):
        insertion = ("fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 2600 radius constant 0.002\n"
                     "fix pdd all particledistribution/discrete 32452843 1 pts 1.0\n"
                     "region new block 0.01 0.09 0.01 0.09 0.08 0.099 units box\n"
                     "fix ins all insert/rate/region seed 49979687 distributiontemplate pdd nparticles 6 particlerate 4000 "
                     "insert_every 50 overlapcheck yes vel constant 0. 0. 0. region new\n"
                     "fix gr all gravity 9.81 vector 0 0 -1\n")
        rows = self.run_with(faces(zlo="pressure 10", zhi="pressure 0"), insertion)
        come = [row for before, row in zip(rows, rows[1:]) if row["Atoms"] > before["Atoms"]]
        self.assertGreater(len(come), 1)
        self.assertEqual([row["flow[10]"] for row in come], [0] * len(come))
        self.assertLess(sum(row["flow[10]"] == 0 for row in rows), len(rows) / 2)


if __name__ == "__main__":
    unittest.main()

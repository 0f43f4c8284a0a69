# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies and obstacles with the flow on all ranks: what one rank finds."""
import unittest

from bodies_test import CREATE, GRAVITY, HEAD, INSERT, VOLUME
from coupled import CoupledTest, dump, each_of, forces, in_long, largest_difference, one_after_the_other, read_dump
from coupled import read_thermo, restarted_head
from obstacles_test import FLOW, PADDLE, THERMO, TURN, WATER, write_paddle

SHARED = "solver amg tolerance 1e-11 ranks all"
ALONE = SHARED.replace("all", "one")
WALLS = ("face xlo plane 0.0 face xhi plane 0.1 face ylo plane 0.0 face yhi plane 0.1 "
         "face zlo plane 0.0 face zhi plane 0.1 pressure 0")


def where(ranks):
    return SHARED if ranks > 1 else ALONE


class SharedObstacles(CoupledTest):
    def setUp(self):
        super().setUp()
        write_paddle(self.folder, in_long(0.025, 0.015))

    def fix(self, ranks, words="", fluid=FLOW):
        return f"fix flow all pfv {fluid} obstacle mesh pad {words} {where(ranks)}\n"

    def turned(self, ranks, each):
        """With each of these words: (rows of thermo, {step: forces}) of a paddle that turns among the grains."""
        steps = in_long(20, 5)
        self.liggghts(one_after_the_other(
            "include in.packing\n" + PADDLE + TURN + self.fix(ranks, words) + THERMO + dump(f"{n}.dump") + f"run {steps}\n"
            for n, words in enumerate(each)), ranks=ranks)
        logs = each_of((self.folder / "log.liggghts").read_text())
        for log in logs:
            self.assertEqual("the flow is shared by" in log, ranks > 1)
        return [(read_thermo(log), read_dump(self.folder / f"{n}.dump")) for n, log in enumerate(logs)]

    def test_a_paddle_that_turns_feels_what_it_feels_on_one_rank(self):
        each = "torques yes", "coupling staged"
        alone = self.turned(1, each)
        for ranks in in_long((2, 4), (3,)):
            for (rows, steps), (others, grains) in zip(alone, self.turned(ranks, each), strict=True):
                scale = max(abs(rows[-1][f"flow[{n}]"]) for n in (11, 12, 13))
                for row, other in zip(rows[1:], others[1:], strict=True):
                    for n in range(11, 17):
                        self.assertAlmostEqual(other[f"flow[{n}]"], row[f"flow[{n}]"], delta=1e-8 * scale)
                    for n in range(1, 4):  # the mesh's own account
                        self.assertAlmostEqual(other[f"pad[{n}]"], other[f"flow[{10 + n}]"], delta=1e-12 * scale)
                    self.assertEqual(other["flow[8]"], row["flow[8]"])
                    self.assertLess(abs(other["flow[3]"]), 1e-9)
                    self.assertLess(other["flow[4]"], 1e-12)
                for step, of_step in grains.items():
                    self.assertLess(largest_difference(forces(of_step), forces(steps[step])), 1e-8)

    def test_a_restart_goes_on_with_the_same_spheres(self):
        head = "include in.packing\n" + PADDLE + TURN
        before, after = in_long((11, 10), (5, 4))
        self.liggghts(head + self.fix(3, "couple_every 2", WATER) + f"run {before}\nwrite_restart file.restart\n" +
                      dump("on.dump") + f"run {after}\n", ranks=3)
        start = restarted_head() + PADDLE + TURN
        self.liggghts(start + self.fix(3, "couple_every 2", WATER) + dump("again.dump") + f"run {after}\n", ranks=3)
        self.assertEqual((self.folder / "on.dump").read_bytes(), (self.folder / "again.dump").read_bytes())
        expected = read_dump(self.folder / "on.dump")
        for ranks in in_long((1, 2), (2,)):
            self.liggghts(start + self.fix(ranks, "couple_every 2", WATER) + dump("other.dump") + f"run {after}\n", ranks=ranks)
            for step, rows in read_dump(self.folder / "other.dump").items():
                self.assertLess(largest_difference(forces(rows), forces(expected[step])), 1e-7)


class SharedClumps(CoupledTest):
    """Pairs of fix multisphere, which lie across the parts of ranks and of LIGGGHTS."""

    def setUp(self):
        super().setUp()
        (self.folder / "body.txt").write_text("-0.005 0 0 0.01\n0.005 0 0 0.01\n")
        insert = INSERT.replace("particles_in_region 1", "particles_in_region 24")
        self.liggghts(HEAD.format(start=CREATE, step=1e-5) + insert.format(
            mass=1000 * VOLUME, speed=-0.05, orientation="random", place="0.01 0.09 0.01 0.09 0.01 0.09"))

    def script(self, ranks, words, commands, restart="body.restart", name="d"):
        grid = "processors * 1 1", "processors 1 1 *" if ranks > 2 else "processors * 1 1"
        flow = GRAVITY + f"fix flow all pfv density 500 {WALLS} couple_every 1 {words} {where(ranks)}\n"
        return (HEAD.format(start=f"read_restart {restart}", step=1e-5).replace(*grid) + flow +
                "fix move all multisphere\n" + dump(f"{name}.dump") +
                "thermo_style custom step f_flow[3] f_flow[4] f_flow[6] f_flow[8]\nthermo_modify norm no format float %.15g\n"
                f"thermo 1\n{commands}")

    def run_each(self, ranks, each, steps):
        """With each of these words: (rows of thermo, {step: grains})."""
        self.liggghts(one_after_the_other(self.script(ranks, words, f"run {steps}\n", name=n) for n, words in enumerate(each)),
                      ranks=ranks)
        return [(read_thermo(log), read_dump(self.folder / f"{n}.dump"))
                for n, log in enumerate(each_of((self.folder / "log.liggghts").read_text()))]

    def compare(self, found, expected, within):
        rows, steps = expected
        for row, other in zip(rows, found[0], strict=True):
            self.assertEqual(other["flow[8]"], row["flow[8]"])
            self.assertAlmostEqual(other["flow[6]"] / row["flow[6]"], 1, delta=5e-3)
            self.assertLess(abs(other["flow[3]"]), 1e-9)
            self.assertLess(other["flow[4]"], 1e-12)
        for step, grains in found[1].items():
            self.assertLess(largest_difference(forces(grains), forces(steps[step])), within)

    def test_clumps_move_as_on_one_rank(self):
        each = "viscosity 0.1 torques yes retriangulate 1e-3", "viscosity 2000 coupling staged shear_viscous yes"
        steps = in_long(10, 5)
        alone = self.run_each(1, each, steps)
        for ranks in in_long((2, 4), (3,)):
            for words, expected, found in zip(each, alone, self.run_each(ranks, each, steps), strict=True):
                self.assertEqual(len(expected[1][max(expected[1])]), 48)
                with self.subTest(words=words, ranks=ranks):
                    self.compare(found, expected, 1e-7)

    def test_the_same_bytes_twice_and_a_restart(self):
        words = "viscosity 0.1 bulk_modulus 1e5 coupling auto"
        found = []
        half = in_long(5, 3)
        for _ in range(2):
            self.liggghts(self.script(3, words, f"run {half}\nwrite_restart half.restart\nrun {half}\n"), ranks=3)
            found.append((self.folder / "d.dump").read_bytes())
        self.assertEqual(*found)
        steps = read_dump(self.folder / "d.dump")
        for ranks in in_long((1, 2, 3), (1, 3)):
            self.liggghts(self.script(ranks, words, f"run {half}\n", restart="half.restart"), ranks=ranks)
            again = read_dump(self.folder / "d.dump")
            last = max(again)
            difference = largest_difference(forces(again[last]), forces(steps[last]))
            self.assertLess(difference, 1e-7)
            if ranks == 3:
                self.assertEqual(difference, 0.0)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""A periodic simulation box with the flow on all ranks: what one rank finds, also of grains that cross the sides."""
import math
import re
import unittest

from coupled import EDGE, dump, each_of, forces, in_long, largest_difference, one_after_the_other, packing, random_velocities
from coupled import read_dump, read_thermo
from periodic_test import ALL, BULK, DRIVEN, EACH, THERMO, PeriodicTest

SHARED = "solver amg tolerance 1e-11 ranks "
RESTARTED = ("units", "boundary", "read_data", "atom_style")
OPEN_TOP = f"viscosity 0.01 {EACH} face zlo plane 0 pressure 10 face zhi plane 0.1 pressure 0"
OFTEN = "neigh_modify delay 0 every 1\n"
GRAINS = packing(in_long(5, 4))
SOLID = sum(4 / 3 * math.pi * grain[4]**3 for grain in GRAINS)
FLUID = EDGE**3 - SOLID


class SharedCell(PeriodicTest):
    DRIFT = (40.0, -30.0, 20.0)  # m/s: 4 mm in 10 steps, of a cell of 100

    def moving(self, boundary="p p p", drift=DRIFT, fast=1.0):
        self.write(boundary, {n: [fast * v + d for v, d in zip(of_grain, drift)]
                              for n, of_grain in random_velocities(GRAINS).items()}, GRAINS)

    def runs(self, ranks, flows, run, boundary, before):
        """Of each flow, on these ranks: (rows of thermo, {step: grains}, log)."""
        words = SHARED + ("all" if ranks > 1 else "one")
        self.liggghts(one_after_the_other(
            f"{self.head(boundary)}{commands}fix flow all pfv {flow} {words}\n{THERMO}" + dump(f"{n}.dump") + run
            for n, (flow, commands) in enumerate(zip(flows, before, strict=True))), ranks=ranks)
        return [(read_thermo(log), read_dump(self.folder / f"{n}.dump"), log)
                for n, log in enumerate(each_of((self.folder / "log.liggghts").read_text()))]

    def compare(self, *flows, run="run 8\n", ranks=in_long((2, 4), (3,)), boundary="p p p", before=None):
        """Runs each flow, after what stands before its fix, on one rank and on several; returns what one rank gave and how
        often several have dealt out grains."""
        before = before or [""] * len(flows)
        alone = self.runs(1, flows, run, boundary, before)
        for count in ranks:
            several = self.runs(count, flows, run, boundary, before)
            for one, other, flow, commands in zip(alone, several, flows, before, strict=True):
                with self.subTest(flow=flow, before=commands, ranks=count):
                    self.assertIn(f"shared by {count} ranks", other[2])
                    has_level = any(word in flow for word in ("bulk_modulus", "face", "point"))
                    self.compare_runs(one, other, has_level, has_flow="volume" not in commands)
        return alone, [int(re.search("grains dealt to the ranks (.*) times", log).group(1)) for _, _, log in several]

    def compare_runs(self, one, several, has_level, has_flow):
        for row, other in zip(one[0], several[0], strict=True):
            self.assertEqual(other["flow[5]"], row["flow[5]"])
            for name in ("flow", "flow[1]", "flow[2]") + (("flow[7]",) if has_level else ()):
                self.assertAlmostEqual(other[name], row[name], delta=max(1e-11, 1e-8 * abs(row[name])), msg=name)
            self.assertEqual(other["Step"], row["Step"])
            if has_flow:  # else the mass error is round-off over round-off
                self.assertLess(abs(other["flow[3]"]), 1e-9)
            self.assertLess(other["flow[4]"], 1e-11)
        for step, of_step in several[1].items():
            self.assertLess(largest_difference(forces(of_step), forces(one[1][step])), 1e-8, step)

    def test_a_gradient_through_a_cell_that_is_periodic_all_around(self):
        self.moving(drift=(0.0, 0.0, 0.0))
        self.compare(DRIVEN)

    def test_pressures_across_and_periods_along(self):
        self.moving("p p f", drift=(0.0, 0.0, 0.0))
        self.compare(f"{OPEN_TOP} gradient 12 0 0", boundary="p p f")

    def test_grains_that_cross_sides_and_migrate(self):
        """All drift through the cell: more than one in six is wrapped on the way, and goes from rank to rank. A network a
        step, with what has strayed dealt anew."""
        steps = in_long(10, 7)
        self.moving(drift=[40.0 / steps * v for v in self.DRIFT])
        flows = [f"viscosity 1e-3 {ALL} couple_every {every} {words} retriangulate 1e-9"
                 for words, every in in_long((("", 1), ("", 3), ("bulk_modulus 1e4", 1), ("bulk_modulus 1e4", 3)),
                                             (("", 1), ("bulk_modulus 1e4", 3)))]
        alone, dealt = self.compare(*flows, run=f"run {steps}\n", ranks=in_long((2, 3, 4), (3,)), before=[OFTEN] * len(flows))
        self.assertGreater(min(dealt), 1)
        for rows, grains, _ in alone:
            wrapped = sum(abs(grains[steps][n][0] - grains[0][n][0]) > EDGE / 2 for n in grains[0])
            self.assertGreater(wrapped, len(grains[0]) / 6)
            self.assertGreater(rows[-1]["flow[5]"], 0)

    def test_grains_that_have_strayed_are_dealt_anew_with_the_next_network(self):
        """Of which there are no more than on one rank."""
        steps = in_long(24, 16)
        self.moving(drift=[48.0 / steps * v for v in self.DRIFT])
        flows = [f"viscosity 1e-3 {ALL} {EACH} {words} retriangulate 2e-4" for words in ("", "bulk_modulus 1e4")]
        alone, dealt = self.compare(*flows, run=f"run {steps}\n", ranks=(in_long(4, 3),), before=[OFTEN] * 2)
        self.assertGreater(min(dealt), 1)
        for rows, _, _ in alone:
            self.assertGreater(rows[-1]["flow[5]"], 2)
            self.assertLess(rows[-1]["flow[5]"], 12)

    def test_staged_steps(self):
        self.moving(drift=(0.0, 0.0, 0.0))
        flows = [f"viscosity 5000 {ALL} coupling staged {words}" for words in ("", "bulk_modulus 1e4")]
        self.compare(*flows, run="run 4\n", ranks=(2,))

    def test_a_cell_that_changes(self):
        self.moving(drift=(0.0, 0.0, 0.0))
        cases = [(f"viscosity 0.01 {EACH} {words}", f"fix strain all deform 1 {deform}\n")
                 for deform in ("x erate -5 z erate 2 remap x", "z erate -20 x volume y volume remap x")
                 for words in ("point 0.05 0.05 0.05 pressure 0", f"bulk_modulus {BULK}")]
        self.compare(*(flow for flow, _ in cases), ranks=(in_long(4, 3),), before=[deform for _, deform in cases])

    def test_undrained_pressure_is_the_bulk_modulus_times_the_change_of_the_fluid(self):
        """Over new networks, which count the fluid anew, to second order in that change."""
        self.moving(drift=(0.0, 0.0, 0.0))
        steps = in_long(20, 10)
        cases = ((f"{EACH} retriangulate 0.9", 1e-9), (f"{EACH} retriangulate 1e-4", 1e-3),
                 ("couple_every 5 retriangulate 0.9", 1e-9))
        deform = f"fix strain all deform 1 x erate {-100.0 / steps} z erate {40.0 / steps} remap x\n"
        alone, _ = self.compare(*(f"viscosity 0.01 bulk_modulus {BULK} {words}" for words, _ in cases), run=f"run {steps}\n",
                                ranks=(in_long(4, 2),), before=[deform] * 3)
        self.assertGreater(alone[1][0][-1]["flow[5]"], 2)
        for (words, within), (rows, _, _) in zip(cases, alone, strict=True):
            now = math.prod(rows[-2][hi] - rows[-2][lo] for lo, hi in (("Xlo", "Xhi"), ("Ylo", "Yhi"), ("Zlo", "Zhi"))) - SOLID
            self.assertAlmostEqual(rows[-1]["flow[7]"] / (BULK * (FLUID - now) / FLUID), 1.0, delta=within, msg=words)

    def test_a_restart_on_the_same_ranks_writes_the_same_bytes_and_on_others_the_same_forces(self):
        run, others = f"run {in_long(10, 4)}\n", in_long(4, 3)
        cases = (("p p p", DRIVEN), ("p p p", f"{DRIVEN} bulk_modulus 1e4"), ("p p f", f"{OPEN_TOP} bulk_modulus 1e4"))
        heads, fixes = [], []
        for n, (boundary, words) in enumerate(cases):
            self.moving(boundary, drift=self.DRIFT if boundary == "p p p" else (40.0, -30.0, 0.0))
            (self.folder / "packing.data").rename(self.folder / f"{n}.data")
            heads.append(self.head(boundary).replace("packing.data", f"{n}.data"))
            fixes.append(f"fix flow all pfv {words} {SHARED}all\n")
        self.liggghts(one_after_the_other(head + fix + f"{run}write_restart {n}.restart\n" + dump(f"on{n}.dump") + run
                                          for n, (head, fix) in enumerate(zip(heads, fixes))), ranks=2)
        for ranks in (2, others):
            self.liggghts(one_after_the_other(self.restarted(head, f"{n}.restart") + fix + dump(f"{ranks}_{n}.dump") + run
                                              for n, (head, fix) in enumerate(zip(heads, fixes))), ranks=ranks)
        for n, case in enumerate(cases):
            continued, again, of_others = (self.folder / f"{name}{n}.dump" for name in ("on", "2_", f"{others}_"))
            self.assertEqual(continued.read_bytes(), again.read_bytes(), case)
            found, expected = read_dump(of_others), read_dump(continued)
            last = max(expected)
            self.assertLess(largest_difference(forces(found[last]), forces(expected[last])), 1e-7)

    def restarted(self, head, name):
        lines = (line + "\n" for line in head.splitlines() if not line.startswith(RESTARTED))
        return "".join(lines).replace("newton          off", f"newton off\nread_restart {name}")

    def test_what_is_written_of_grains(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader
        self.moving(fast=0.0)
        self.cell(f"viscosity 1e-7 {EACH} gradient 1e-3 0 0 output 20 out.pvd {SHARED}all", "run 20\n", ranks=3)
        reader = vtkXMLPUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "out_grains_20.pvtu"))
        reader.Update()
        moved = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("displacement"))
        self.assertEqual(len(moved), len(GRAINS))
        for axis in range(3):
            self.assertLess(abs(moved[:, axis] - 20e-5 * self.DRIFT[axis]).max(), 1e-6)

    def test_what_goes_wrong_on_one_rank_ends_all_with_its_words(self):
        twins = packing()
        twins[1] = (2, *twins[0][1:])
        self.write(grains=twins)
        self.refused(f"{self.head()}fix flow all pfv {DRIVEN} {SHARED}all\nrun 1\n", "same centre", ranks=2)


if __name__ == "__main__":
    unittest.main()

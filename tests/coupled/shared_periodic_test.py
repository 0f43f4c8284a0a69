# SPDX-License-Identifier: GPL-3.0-or-later
"""A periodic simulation box with the flow on all ranks: what one rank finds, also of grains that cross the sides."""
import math
import re
import unittest

from coupled import EDGE, dump, forces, largest_difference, packing, random_velocities, read_dump, read_thermo
from periodic_test import ALL, BULK, DRIVEN, EACH, FLUID, SOLID, THERMO, PeriodicTest

SHARED = "solver amg tolerance 1e-11 ranks "
RESTARTED = ("units", "boundary", "read_data", "atom_style")
OPEN_TOP = f"viscosity 0.01 {EACH} face zlo plane 0 pressure 10 face zhi plane 0.1 pressure 0"


class SharedCell(PeriodicTest):
    DRIFT = (40.0, -30.0, 20.0)  # m/s: 4 mm in 10 steps, of a cell of 100

    def moving(self, boundary="p p p", drift=DRIFT, fast=1.0):
        self.write(boundary, {n: [fast * v + d for v, d in zip(of_grain, drift)]
                              for n, of_grain in random_velocities(packing()).items()})

    def compare(self, flow, run="run 8\n", ranks=(2, 4), within=1e-8, level=True, flows=True, **options):
        """Runs on one rank and on several; returns the rows and the grains of one."""
        one, rows = None, None
        for count in (1, *ranks):
            words = SHARED + ("all" if count > 1 else "one")
            found = self.cell(f"{flow} {words}", dump("d.dump") + run, ranks=count, **options)
            steps = read_dump(self.folder / "d.dump")
            if one is None:
                one, rows = steps, found
                continue
            self.assertIn(f"shared by {count} ranks", (self.folder / "log.liggghts").read_text())
            self.assertEqual(len(found), len(rows))
            for row, other in zip(rows, found):
                self.assertEqual(other["flow[5]"], row["flow[5]"])
                for name in ("flow", "flow[1]", "flow[2]") + (("flow[7]",) if level else ()):
                    self.assertAlmostEqual(other[name], row[name], delta=max(1e-11, within * abs(row[name])), msg=name)
                self.assertEqual(other["Step"], row["Step"])
                if flows:  # else the mass error is round-off over round-off
                    self.assertLess(abs(other["flow[3]"]), 1e-9)
                self.assertLess(other["flow[4]"], 1e-11)
            for step, of_step in steps.items():
                self.assertLess(largest_difference(forces(of_step), forces(one[step])), within, step)
        return rows, one

    def test_a_gradient_through_a_cell_that_is_periodic_all_around(self):
        self.moving(drift=(0.0, 0.0, 0.0))
        self.compare(DRIVEN, level=False)

    def test_pressures_across_and_periods_along(self):
        self.moving("p p f", drift=(0.0, 0.0, 0.0))
        self.compare(f"{OPEN_TOP} gradient 12 0 0", boundary="p p f")

    def test_grains_that_cross_sides_and_migrate(self):
        """All drift through the cell: more than one in six is wrapped on the way, and goes from rank to rank. A network a
        step, with what has strayed dealt anew."""
        self.moving(drift=[4.0 * v for v in self.DRIFT])
        for words, ranks in (("couple_every 1", (2, 4)), ("couple_every 3", (4,)),
                             ("couple_every 1 bulk_modulus 1e4", (3, 4)), ("couple_every 3 bulk_modulus 1e4", (4,))):
            rows, steps = self.compare(f"viscosity 1e-3 {ALL} {words} retriangulate 1e-9", "run 10\n", ranks=ranks,
                                       level="bulk" in words, before="neigh_modify delay 0 every 1\n")
            times = re.search("grains dealt to the ranks (.*) times", (self.folder / "log.liggghts").read_text())
            self.assertGreater(int(times.group(1)), 1)
            wrapped = sum(abs(steps[10][n][0] - steps[0][n][0]) > EDGE / 2 for n in steps[0])
            self.assertGreater(wrapped, len(steps[0]) / 6)
            self.assertGreater(rows[-1]["flow[5]"], 0)

    def test_grains_that_have_strayed_are_dealt_anew_with_the_next_network(self):
        """Of which there are no more than on one rank."""
        self.moving(drift=[2.0 * v for v in self.DRIFT])
        for words in ("", "bulk_modulus 1e4"):
            rows, _ = self.compare(f"viscosity 1e-3 {ALL} {EACH} {words} retriangulate 2e-4", "run 24\n",
                                   ranks=(4,), level=bool(words), before="neigh_modify delay 0 every 1\n")
            self.assertGreater(rows[-1]["flow[5]"], 2)
            self.assertLess(rows[-1]["flow[5]"], 12)
            times = re.search("grains dealt to the ranks (.*) times", (self.folder / "log.liggghts").read_text())
            self.assertGreater(int(times.group(1)), 1)

    def test_staged_steps(self):
        self.moving(drift=(0.0, 0.0, 0.0))
        for words in ("", "bulk_modulus 1e4"):
            self.compare(f"viscosity 5000 {ALL} coupling staged {words}", "run 4\n", ranks=(2,), level=bool(words))

    def test_a_cell_that_changes(self):
        for deform in ("x erate -5 z erate 2 remap x", "z erate -20 x volume y volume remap x"):
            self.moving(drift=(0.0, 0.0, 0.0))
            for words in ("point 0.05 0.05 0.05 pressure 0", f"bulk_modulus {BULK}"):
                self.compare(f"viscosity 0.01 {EACH} {words}", ranks=(4,), flows="volume" not in deform,
                             before=f"fix strain all deform 1 {deform}\n")

    def test_undrained_pressure_is_the_bulk_modulus_times_the_change_of_the_fluid(self):
        """Over new networks, which count the fluid anew, to second order in that change."""
        self.moving(drift=(0.0, 0.0, 0.0))
        for words, within in ((f"{EACH} retriangulate 0.9", 1e-9), (f"{EACH} retriangulate 1e-4", 1e-3),
                              ("couple_every 5 retriangulate 0.9", 1e-9)):
            rows, _ = self.compare(f"viscosity 0.01 bulk_modulus {BULK} {words}", "run 20\n", ranks=(4,),
                                   before="fix strain all deform 1 x erate -5 z erate 2 remap x\n")
            now = math.prod(rows[-2][hi] - rows[-2][lo] for lo, hi in (("Xlo", "Xhi"), ("Ylo", "Yhi"), ("Zlo", "Zhi"))) - SOLID
            self.assertAlmostEqual(rows[-1]["flow[7]"] / (BULK * (FLUID - now) / FLUID), 1.0, delta=within)

    def test_a_restart_on_the_same_ranks_writes_the_same_bytes_and_on_others_the_same_forces(self):
        self.moving()
        for words in (DRIVEN, f"{DRIVEN} bulk_modulus 1e4", f"{OPEN_TOP} bulk_modulus 1e4"):
            boundary = "p p f" if "face" in words else "p p p"
            self.moving(boundary, drift=self.DRIFT if boundary == "p p p" else (40.0, -30.0, 0.0))
            fix = f"fix flow all pfv {words} {SHARED}all\n"
            self.liggghts(self.head(boundary) + fix + "run 10\nwrite_restart file.restart\n" + dump("continued.dump") +
                          "run 10\n", ranks=2)
            head = "".join(line + "\n" for line in self.head(boundary).splitlines() if not line.startswith(RESTARTED))
            head = head.replace("newton          off", "newton off\nread_restart file.restart")
            for ranks in (2, 4):
                self.liggghts(head + fix + dump("restarted.dump") + "run 10\n", ranks=ranks)
                if ranks == 2:
                    self.assertEqual((self.folder / "continued.dump").read_bytes(),
                                     (self.folder / "restarted.dump").read_bytes(), words)
            continued, others = (read_dump(self.folder / f"{name}.dump") for name in ("continued", "restarted"))
            self.assertLess(largest_difference(forces(others[20]), forces(continued[20])), 1e-7)

    def test_what_is_written_of_grains(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader
        self.write(velocities={grain[0]: self.DRIFT for grain in packing()})
        self.cell(f"viscosity 1e-7 {EACH} gradient 1e-3 0 0 output 40 out.pvd {SHARED}all", "run 40\n", ranks=3)
        reader = vtkXMLPUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "out_grains_40.pvtu"))
        reader.Update()
        moved = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("displacement"))
        self.assertEqual(len(moved), len(packing()))
        for axis in range(3):
            self.assertLess(abs(moved[:, axis] - 40e-5 * self.DRIFT[axis]).max(), 1e-6)

    def test_what_goes_wrong_on_one_rank_ends_all_with_its_words(self):
        twins = packing()
        twins[1] = (2, *twins[0][1:])
        self.write(grains=twins)
        self.refused(f"{self.head()}fix flow all pfv {DRIVEN} {SHARED}all\nrun 1\n", "same centre", ranks=2)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""`pfv solve` under mpirun: several ranks give what one gives, and speak with one voice."""
import os
import subprocess
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest

MPIRUN = [os.environ.get("PFV_MPIRUN", "mpirun"), "--allow-run-as-root", "--oversubscribe", "--mca",
          "mpi_yield_when_idle", "1", "--mca", "orte_create_session_dirs", "1"]


class Ranks(CommandTest):
    def on_ranks(self, count, *arguments):
        command = [*MPIRUN, "-n", str(count), os.environ["PFV_COMMAND"], "solve", *map(str, arguments)]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=300)

    def test_they_give_the_forces_and_the_report_of_one(self):
        options = ["--packing", DENSE, *UNIT_BOX, *THROUGH_FLOW, "--tolerance", "1e-10"]
        self.solve(*THROUGH_FLOW, "--solver", "amg", "--tolerance", "1e-10", "--forces", "one.csv", "--report", "one.json")
        one = self.json("one.json")
        expected = self.forces("one.csv")
        forces = numpy.array(list(expected.values()))
        for count in (2, 3):
            done = self.on_ranks(count, *options, "--forces", "all.csv", "--report", "all.json")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            found = self.forces("all.csv")
            self.assertEqual(list(found), list(expected))
            scale = numpy.sqrt((forces[:, :3] ** 2).sum(axis=1).mean())
            self.assertLess(numpy.abs(numpy.array(list(found.values())) - forces).max(), 1e-7 * scale)
            every = self.json("all.json")
            self.assertEqual(every["ranks"], count)
            for name in ("spheres", "pores", "unknowns", "solver"):
                self.assertEqual(every[name], one[name], name)
            for name in ("porosity", "permeability", "permeability_error", "inflow"):
                self.assertAlmostEqual(every[name] / one[name], 1.0, delta=1e-9, msg=name)

    def test_fields_are_written_in_pieces_that_make_up_the_whole(self):
        options = [*THROUGH_FLOW, "--solver", "amg", "--tolerance", "1e-11"]
        self.solve(*options, "--vtk", "one.vtu")
        done = self.on_ranks(3, "--packing", DENSE, *UNIT_BOX, *options, "--vtk", "all.pvtu")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        one, all_ = (self.read_grid(reader, name) for reader, name in
                     ((vtkXMLUnstructuredGridReader, "one.vtu"), (vtkXMLPUnstructuredGridReader, "all.pvtu")))
        self.assertEqual(all_.GetNumberOfCells(), one.GetNumberOfCells())
        for what in ("volume", "conductance", "pressure"):
            found, expected = (vtk_to_numpy(grid.GetCellData().GetArray(what)) for grid in (all_, one))
            numpy.testing.assert_allclose(numpy.sort(found), numpy.sort(expected), rtol=1e-9, atol=1e-9 * abs(expected).max())
        for grid in (one, all_):
            ends = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
            self.assertEqual(sorted(set(numpy.diff(ends))), [1, 2])
        found, expected = (vtk_to_numpy(grid.GetPointData().GetArray("volume")).sum() for grid in (all_, one))
        self.assertAlmostEqual(found / expected, 1.0, delta=1e-12)

    def read_grid(self, reader, name):
        reader = reader()
        reader.SetFileName(str(self.folder / name))
        reader.Update()
        return reader.GetOutput()

    def test_an_error_is_one_line_and_leaves_no_file(self):
        done = self.on_ranks(2, "--packing", DENSE, "--box", "0", "0.5", "0", "1", "0", "1", *THROUGH_FLOW,
                             "--forces", "all.csv")
        own = [line for line in done.stderr.splitlines() if line.startswith("pfv: ")]
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(own), 1, done.stderr)
        self.assertIn("is not inside the box", own[0])
        self.assertFalse((self.folder / "all.csv").exists())

    def test_what_one_rank_alone_can_do_is_refused(self):
        for options, words in ((["--solver", "supernodal"], "the solver supernodal runs on one rank"),
                               (["--model", "darcy_grid", "--cells", "4", "4", "4"], "darcy_grid runs on one rank"),
                               (["--vtk", "pores.vtu"], "give a file .pvtu")):
            with self.subTest(options=options):
                done = self.on_ranks(2, "--packing", DENSE, *UNIT_BOX, *THROUGH_FLOW, *options)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()

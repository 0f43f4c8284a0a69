# SPDX-License-Identifier: GPL-3.0-or-later
"""`pfv solve` under mpirun: several ranks give what one gives, and speak with one voice."""
import os
import subprocess
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest

MPIRUN = [os.environ.get("PFV_MPIRUN", "mpirun"), "--allow-run-as-root", "--oversubscribe", "--mca",
          "mpi_yield_when_idle", "1", "--mca", "orte_create_session_dirs", "1"]

# runs a program and says the last that was seen of its largest address space
WATCHED = """"$@" > /dev/null &
while [ -r /proc/$!/status ] && text=$(< /proc/$!/status) && [[ $text == *VmPeak* ]]; do last=$text; sleep 0.02; done 2> /dev/null
wait $! || exit
last=${last#*VmPeak:}; echo "VmPeak: ${last%%kB*}"
"""


# runs a program and writes how much memory it has held, kB
MEASURED = """import os, resource, subprocess, sys
subprocess.run(sys.argv[1:], stderr=subprocess.DEVNULL)
open(f"peak_{os.getpid()}", "w").write(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss))
"""


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

    def test_periodic_cells_upright_and_tilted(self):
        """Also of spheres that stand periods away from the cell."""
        with open(DENSE) as file:
            header, *rows = file.read().splitlines()
        far = [row.split(",") for row in rows]
        for i, row in enumerate(far):
            row[1] = repr(float(row[1]) + i % 5 - 2)
        (self.folder / "far.csv").write_text("\n".join([header, *map(",".join, far)]) + "\n")
        for cell in (["--periodic", "x,y,z", "--gradient", "3", "-2", "1"], ["--periodic", "x,y,z", "--tilt", "0.2", "-0.3", "0.4"],
                     ["--periodic", "x,y", *THROUGH_FLOW]):
            options = ["--packing", "far.csv", *UNIT_BOX, *cell, "--solver", "amg", "--tolerance", "1e-10"]
            done = self.run_pfv("solve", *options, "--forces", "one.csv", "--report", "one.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            one, expected = self.json("one.json"), numpy.array(list(self.forces("one.csv").values()))
            done = self.on_ranks(3, *options, "--forces", "all.csv", "--report", "all.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            every, found = self.json("all.json"), numpy.array(list(self.forces("all.csv").values()))
            scale = numpy.sqrt((expected[:, :3] ** 2).sum(axis=1).mean())
            self.assertLessEqual(numpy.abs(found - expected).max(), 1e-7 * scale)
            self.assertEqual(every["ranks"], 3)
            for name in ("spheres", "pores", "unknowns"):
                self.assertEqual(every[name], one[name], name)
            tensors = [report["permeability_tensor"] for report in (every, one)]
            self.assertEqual(tensors[0] is None, tensors[1] is None)
            if tensors[1] is not None:
                numpy.testing.assert_allclose(*tensors, atol=1e-9 * numpy.abs(tensors[1]).max())
            if one["permeability"] is not None:
                self.assertAlmostEqual(every["permeability"] / one["permeability"], 1.0, delta=1e-9)

    def test_an_obstacle_among_the_grains(self):
        """A box, whose spheres are dealt out with the grains."""
        corners = [(x, y, z) for x in (0.3, 0.7) for y in (0.35, 0.65) for z in (0.4, 0.6)]
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        facets = [(a, b, c) for a, b, c, d in sides] + [(a, c, d) for a, b, c, d in sides]
        (self.folder / "box.stl").write_text("solid box\n" + "".join(
            "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {' '.join(map(str, corners[i]))}\n" for i in facet) +
            "endloop\nendfacet\n" for facet in facets) + "endsolid box\n")
        options = [*THROUGH_FLOW, "--solver", "amg", "--tolerance", "1e-10", "--obstacle", "box.stl"]
        self.solve(*options, "--forces", "one.csv", "--report", "one.json")
        expected, one = self.forces("one.csv"), self.json("one.json")["obstacles"][0]
        done = self.on_ranks(3, "--packing", DENSE, *UNIT_BOX, *options, "--forces", "all.csv", "--report", "all.json")
        self.assertEqual(done.returncode, 0, done.stderr)  # it warns of grains within the box
        found, every = self.forces("all.csv"), self.json("all.json")["obstacles"][0]
        self.assertEqual(list(found), list(expected))
        values, wanted = (numpy.array(list(rows.values())) for rows in (found, expected))
        self.assertLess(numpy.abs(values - wanted).max(), 1e-7 * numpy.abs(wanted).max())
        for name in ("force", "moment"):
            numpy.testing.assert_allclose(every[name], one[name], atol=1e-8 * numpy.abs(one["force"]).max())
        self.assertEqual(every["spheres"], one["spheres"])

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

    def test_no_rank_holds_the_packing(self):
        """To the end of the reading, where a sphere turns out to be outside: less than the file's text on each of four."""
        rows = 150000
        with open(self.folder / "many.csv", "w") as file:
            file.write("id,x,y,z,radius\n")
            file.writelines(f"{k},{(k * 0.6180339887498949) % 1.0!r},{(k * 0.4142135623730951) % 1.0!r},{k / rows!r},1e-4\n"
                            for k in range(1, rows + 1))
        (self.folder / "two.csv").write_text("id,x,y,z,radius\n1,0.9,0.5,0.5,0.1\n2,0.2,0.2,0.2,0.1\n")
        few, many = (self.peak_while_reading(name) for name in ("two.csv", "many.csv"))
        self.assertLess(many - few, (self.folder / "many.csv").stat().st_size / 1024)

    def peak_while_reading(self, packing):
        """Of the largest of four ranks, kB."""
        command = [*MPIRUN, "-n", "4", sys.executable, "-S", "-c", MEASURED, os.environ["PFV_COMMAND"], "solve", "--packing",
                   packing, "--box", "0", "0.5", "0", "1", "0", "1", *THROUGH_FLOW]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=300)
        files = list(self.folder.glob("peak_*"))
        self.assertEqual(len(files), 4, done.stderr)
        peaks = [int(file.read_text()) for file in files]
        for file in files:
            file.unlink()
        return max(peaks)

    def test_what_is_said_of_a_file_is_what_one_rank_says(self):
        with open(DENSE) as file:
            lines = file.read().splitlines()
        (self.folder / "twice.csv").write_text("\n".join([*lines, lines[7]]) + "\n")
        (self.folder / "no_ids.csv").write_text("\n".join(line.split(",", 1)[1] for line in lines))
        for packing, box in (("twice.csv", UNIT_BOX), ("no_ids.csv", ["--box", "auto"])):
            options = ["--packing", packing, *box, *THROUGH_FLOW, "--solver", "amg"]
            one, all_ = self.run_pfv("solve", *options), self.on_ranks(3, *options)
            own = [line for line in all_.stderr.splitlines() if line.startswith("pfv: ")]
            self.assertEqual((all_.returncode, own), (one.returncode, one.stderr.splitlines()))

    def test_a_rank_without_memory_ends_all(self):
        """It may have what two ranks need for a small packing, and a third of what its part of a large one takes."""
        options = [*UNIT_BOX, *THROUGH_FLOW, "--forces", "all.csv"]
        edge = 22
        places = (numpy.indices((edge, edge, edge)).reshape(3, -1).T + 0.5) / edge
        places += numpy.random.default_rng(1).uniform(-0.02, 0.02, places.shape) / edge
        with open(self.folder / "large.csv", "w") as file:
            file.write("id,x,y,z,radius\n")
            file.writelines(f"{k},{x},{y},{z},{0.45 / edge}\n" for k, (x, y, z) in enumerate(places, 1))
        small = self.peak_of_addresses(["--packing", DENSE, *options])
        large = self.peak_of_addresses(["--packing", "large.csv", *options])
        self.assertGreater(large, 1.05 * small)
        (self.folder / "all.csv").unlink()
        program = [os.environ["PFV_COMMAND"], "solve", "--packing", "large.csv", *map(str, options)]
        limited = ["bash", "-c", f'ulimit -v {small + (large - small) // 3}; exec "$@"', "bash", *program]
        done = subprocess.run([*MPIRUN, "-n", "1", *program, ":", "-n", "1", *limited], cwd=self.folder,
                              capture_output=True, text=True, timeout=300)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("memory", done.stderr)
        self.assertFalse((self.folder / "all.csv").exists())

    def peak_of_addresses(self, arguments):
        """Of the larger of two ranks, kB."""
        command = [*MPIRUN, "-n", "2", "bash", "-c", WATCHED, "bash", os.environ["PFV_COMMAND"], "solve", *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return max(int(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("VmPeak:"))

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

# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of spheres that other programs write give the flow of the same spheres as a table."""
import gzip
import os
import subprocess
import unittest

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest, dense_rows


def grains():
    names, rows = dense_rows()
    values = numpy.array([[float(row[names.index(name)]) for name in ("x", "y", "z", "radius")] for row in rows])
    return numpy.array([int(row[names.index("id")]) for row in rows]), values


def points_of(dataset):
    ids, values = grains()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(values[:, :3].copy(), deep=True))
    dataset.SetPoints(places)
    for name, array in (("id", numpy_to_vtkIdTypeArray(ids, deep=True)),
                        ("radius", numpy_to_vtk(values[:, 3].copy(), deep=True))):
        array.SetName(name)
        dataset.GetPointData().AddArray(array)
    return dataset


class Formats(CommandTest):
    def forces_of(self, packing, *options):
        self.solve("--forces", "forces.csv", *THROUGH_FLOW, *options, packing=packing)
        return self.read("forces.csv")

    def setUp(self):
        super().setUp()
        self.table = self.forces_of(DENSE)

    def test_vtk_writers_files_in_every_mode(self):
        kinds = ((vtk.vtkXMLUnstructuredGridWriter, vtk.vtkUnstructuredGrid, "vtu"),
                 (vtk.vtkXMLPolyDataWriter, vtk.vtkPolyData, "vtp"))
        for make_writer, make_data, ending in kinds:
            for mode in ("Ascii", "Binary", "Appended", "AppendedRaw"):
                for compressed in (False, True):
                    for wide in (32, 64):
                        writer = make_writer()
                        writer.SetInputData(points_of(make_data()))
                        writer.SetFileName(str(self.folder / f"spheres.{ending}"))
                        getattr(writer, f"SetDataModeTo{mode.replace('Raw', '')}")()
                        writer.SetEncodeAppendedData(0 if mode == "AppendedRaw" else 1)
                        writer.SetCompressorTypeToZLib() if compressed else writer.SetCompressorTypeToNone()
                        writer.SetBlockSize(1024)
                        getattr(writer, f"SetHeaderTypeToUInt{wide}")()
                        writer.Write()
                        with self.subTest(ending=ending, mode=mode, compressed=compressed, wide=wide):
                            # ASCII has fewer digits than a double
                            found = self.forces_of(f"spheres.{ending}")
                            if mode == "Ascii":
                                self.assertEqual(found.count(b"\n"), self.table.count(b"\n"))
                            else:
                                self.assertEqual(found, self.table)

    def test_our_own_tables_packed(self):
        (self.folder / "grains.csv.gz").write_bytes(gzip.compress(DENSE.read_bytes()))
        self.assertEqual(self.forces_of("grains.csv.gz"), self.table)

    def test_a_pipe(self):
        result = self.run_pfv("solve", "--packing", "/dev/stdin", *UNIT_BOX, *THROUGH_FLOW, "--forces", "forces.csv",
                              stdin=open(DENSE))
        self.assertEqual(result.returncode, 0, result.stderr)
        piped = subprocess.run(f"cat {DENSE} | {os.environ['PFV_COMMAND']} solve --packing /dev/stdin {' '.join(UNIT_BOX)} "
                               f"{' '.join(THROUGH_FLOW)} --forces piped.csv", shell=True, cwd=self.folder)
        self.assertEqual(piped.returncode, 0)
        self.assertEqual(self.read("forces.csv"), self.table)
        self.assertEqual(self.read("piped.csv"), self.table)

    def dump(self, steps, scale=1.0):
        ids, values = grains()
        text = ""
        for step in steps:
            text += (f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(ids)}\nITEM: BOX BOUNDS ff ff ff\n" +
                     f"0 {scale}\n" * 3 + "ITEM: ATOMS id type x y z vx vy vz radius \n")
            for number, row in zip(ids, values):
                x, y, z, r = (float(value) * scale for value in row)
                text += f"{number} 1 {x!r} {y!r} {z!r} {step * 1e-12} 0 0 {r!r} \n"
        return self.write("grains.dump", text)

    def test_a_snapshot_is_chosen_and_said(self):
        self.dump([0, 10])
        chosen = self.solve("--forces", "forces.csv", *THROUGH_FLOW, "--snapshot", "0", packing="grains.dump")
        self.assertEqual(self.read("forces.csv"), self.table)
        self.assertIn("the snapshot is that of step 0, number 1 of 2", chosen.stderr)
        refused = self.run_pfv("solve", "--packing", "grains.dump", "--snapshot", "7", "--box", *"010101", *THROUGH_FLOW)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("2 snapshots, of steps 0 10", refused.stderr)

    def test_grains_that_move_a_little_leave_the_permeability_out_with_a_sentence(self):
        self.dump([10])
        moving = self.solve(*THROUGH_FLOW, packing="grains.dump")
        self.assertNotIn("permeability", moving.stdout)
        self.assertIn("the grains move, up to 1e-11 m/s: no permeability is given; --at-rest leaves", moving.stderr)
        still = self.solve(*THROUGH_FLOW, "--at-rest", "--forces", "forces.csv", packing="grains.dump")
        self.assertEqual(self.read("forces.csv"), self.table)
        self.assertNotIn("no permeability", still.stderr)

    def test_a_box_around_the_spheres_or_of_a_periodic_dump(self):
        ids, values = grains()
        low, high = (values[:, :3] - values[:, 3:]).min(axis=0), (values[:, :3] + values[:, 3:]).max(axis=0)
        box = [repr(float(v)) for pair in zip(low, high) for v in pair]
        self.solve("--forces", "given.csv", *THROUGH_FLOW, box=["--box", *box])
        said = self.solve("--forces", "auto.csv", *THROUGH_FLOW, box=["--box", "auto"])
        self.assertEqual(self.read("given.csv"), self.read("auto.csv"))
        self.assertIn("the flow box was taken from it: ", said.stderr)
        self.dump([0])
        cell = self.write("cell.dump", self.read("grains.dump").replace(b"ff ff ff", b"pp pp pp"))
        said = self.solve("--report", "cell.json", "--viscosity", "1", packing=cell, box=[])
        self.assertIn("the flow box was taken from it: 0 1 0 1 0 1, periodic", said.stderr)
        self.solve("--report", "named.json", "--viscosity", "1", "--periodic", "x,y,z", packing=cell)
        self.assertEqual(self.json("cell.json")["permeability_tensor"], self.json("named.json")["permeability_tensor"])
        refused = self.run_pfv("solve", "--packing", "grains.dump", "--box", "auto", "--periodic", "x")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("is no period", refused.stderr)
        refused = self.run_pfv("solve", "--packing", "grains.dump", "--viscosity", "1")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--box or --container is required", refused.stderr)
        self.assertIn("--box dump (the simulation box of the file, 0 1 0 1 0 1)", refused.stderr)
        extent = " ".join(f"{float(bound):.6g}" for bound in box)
        self.assertIn(f"--box auto (the extent of the spheres, {extent})", refused.stderr)

    def test_the_simulation_box_of_the_dump(self):
        self.dump([0])
        self.solve("--forces", "given.csv", *THROUGH_FLOW, packing="grains.dump")
        said = self.solve("--forces", "dump.csv", *THROUGH_FLOW, packing="grains.dump", box=["--box", "dump"])
        self.assertEqual(self.read("given.csv"), self.read("dump.csv"))
        self.assertIn("the flow box was taken from it: 0 1 0 1 0 1\n", said.stderr)
        shrunk = self.write("shrunk.dump", self.read("grains.dump").replace(b"ff ff ff", b"ff ff fs"))
        tilted = self.write("tilted.dump", self.read("grains.dump").replace(
            b"BOX BOUNDS ff ff ff\n0 1.0\n0 1.0\n0 1.0", b"BOX BOUNDS xy xz yz pp pp ff\n0 1.1 0.1\n0 1 0\n0 1 0"))
        for packing, cause in ((shrunk, "along z the simulation box follows the grains"), (tilted, "is tilted"),
                               (DENSE, "states no simulation box")):
            refused = self.run_pfv("solve", "--packing", packing, "--box", "dump", *THROUGH_FLOW)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("--box dump: ", refused.stderr)
            self.assertIn(cause, refused.stderr)

    def test_millimetres(self):
        self.dump([0], 1000.0)
        self.forces_of("grains.dump", "--length-unit", "mm")
        found = numpy.loadtxt(self.folder / "forces.csv", delimiter=",", skiprows=1)
        self.forces_of(DENSE)
        table = numpy.loadtxt(self.folder / "forces.csv", delimiter=",", skiprows=1)
        self.assertLess(numpy.abs(found - table).max(), 1e-10 * numpy.abs(table[:, 1:]).max())
        for wrong in ("0", "-1", "miles", "nan"):
            refused = self.run_pfv("solve", "--packing", "grains.dump", "--length-unit", wrong, "--box", *"010101")
            self.assertEqual(refused.returncode, 2)
            self.assertIn("--length-unit", refused.stderr)


if __name__ == "__main__":
    unittest.main()

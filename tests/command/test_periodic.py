# SPDX-License-Identifier: GPL-3.0-or-later
"""Periodic axes of `pfv solve`: lattices against Zick & Homsy (1982), translation, balances, refusals."""
import math
import unittest

from command import UNIT_BOX, CommandTest

ALL = ["--periodic", "x,y,z", "--gradient", "0", "0", "-1", "--viscosity", "1"]
LATTICES = {  # centres, touching radius, drag (Zick & Homsy 1982), our K / K_exact (hydraulic radius)
    "sc": ([(.5, .5, .5)], .5, 42.1, .979),
    "bcc": ([(.25, .25, .25), (.75, .75, .75)], 3 ** .5 / 4, 162.9, 1.023),
    "fcc": ([(.25, .25, .25), (.75, .75, .25), (.75, .25, .75), (.25, .75, .75)],
            2 ** .5 / 4, 435., .921)}


class Periodic(CommandTest):
    def packing(self, centres, radius):
        rows = "".join(f"{i},{x!r},{y!r},{z!r},{radius!r}\n"
                       for i, (x, y, z) in enumerate(centres, 1))
        return self.write("cell.csv", "id,x,y,z,radius\n" + rows)

    def repeated(self, centres, n):
        return [((x + i) / n, (y + j) / n, (z + k) / n) for x, y, z in centres
                for i in range(n) for j in range(n) for k in range(n)]

    def test_lattices_are_isotropic_and_have_the_known_drag(self):
        for name, (centres, radius, drag, ratio) in LATTICES.items():
            for n in (1, 2):
                with self.subTest(lattice=name, cells=n):
                    report = self.report(*ALL, packing=self.packing(self.repeated(centres, n),
                                                                    radius / n))
                    exact = 1 / (6 * math.pi * radius * drag * len(centres)) / n ** 2
                    self.assertAlmostEqual(report["permeability"] / exact, ratio, delta=6e-4)
                    tensor = report["permeability_tensor"]
                    for i in range(3):
                        for j in range(3):
                            wanted = report["permeability"] if i == j else 0
                            self.assertAlmostEqual(tensor[i][j] / report["permeability"],
                                                   wanted / report["permeability"], delta=1e-12)
                    self.assertAlmostEqual(report["force_sum"][2], 1, delta=1e-12)
                    self.assertLess(report["force_balance_error"], 1e-14)

    def test_a_lattice_displaced_by_rounding_keeps_its_permeability(self):
        # alternating displacements of 1e-9 of the cell
        centres, radius = LATTICES["fcc"][:2]
        exact = self.report(*ALL, packing=self.packing(self.repeated(centres, 2), radius / 2))
        moved = [(x + 1e-9 * math.sin(12.9 * i), y + 1e-9 * math.sin(78.2 * i),
                  z + 1e-9 * math.sin(37.7 * i))
                 for i, (x, y, z) in enumerate(self.repeated(centres, 2))]
        jittered = self.report(*ALL, packing=self.packing(moved, radius / 2))
        self.assertAlmostEqual(jittered["permeability"] / exact["permeability"], 1, delta=1e-6)

    # 20 spheres in no order: a quasi-random sequence
    DISORDER = [((.5 + .8191725 * i) % 1, (.5 + .6710436 * i) % 1, (.5 + .5497005 * i) % 1) for i in range(20)]

    def test_one_more_cell_in_a_permeameter_adds_the_resistance_of_the_cell(self):
        """Cells on end between two pressures: L / K is that of the two ends and of the cells."""
        cell = self.report(*ALL, packing=self.packing(self.DISORDER, .15))["permeability_tensor"][2][2]
        resistance = {}
        for many in (3, 5):
            centres = [(x, y, z + k) for k in range(many) for x, y, z in self.DISORDER]
            stack = self.report("--periodic", "x,y", "--face", "zlo:pressure=1", "--face", "zhi:pressure=0",
                                "--viscosity", "1", packing=self.packing(centres, .15),
                                box=["--box", 0, 1, 0, 1, 0, many])
            resistance[many] = many / stack["permeability"]
        self.assertAlmostEqual((resistance[5] - resistance[3]) * cell / 2, 1.0, delta=1e-5)
        self.assertGreater(abs(resistance[3] * cell / 3 - 1.0), 1e-3)

    def test_translation_changes_nothing(self):
        reports = []
        for shift in ((0, 0, 0), (.37, -1.21, 3.08)):
            moved = [tuple(c + s for c, s in zip(centre, shift)) for centre in self.DISORDER]
            reports.append(self.report(*ALL, packing=self.packing(moved, .15)))
        first, second = (report["permeability_tensor"] for report in reports)
        for i in range(3):
            for j in range(3):
                self.assertAlmostEqual(first[i][j] / first[0][0], second[i][j] / first[0][0],
                                       delta=1e-11)
                self.assertAlmostEqual(first[i][j] / first[0][0], first[j][i] / first[0][0],
                                       delta=1e-11)

    def test_walls_on_the_other_axes(self):
        grains = self.packing(self.repeated(LATTICES["sc"][0], 3), .5 / 3)
        through = self.report("--periodic", "x,y", "--face", "zlo:pressure=1",
                              "--face", "zhi:pressure=0", "--viscosity", "1", packing=grains)
        mirrored = self.report("--wall", "symmetry", "--face", "zlo:pressure=1",
                               "--face", "zhi:pressure=0", "--viscosity", "1", packing=grains)
        # the simple cubic array has mirror planes where the walls stand
        self.assertAlmostEqual(through["permeability"] / mirrored["permeability"], 1, delta=1e-12)
        along = self.report("--periodic", "z", "--gradient", "0", "0", "-1", "--viscosity", "1",
                            packing=grains)
        self.assertLess(along["force_balance_error"], 1e-14)
        self.assertIsNone(through["permeability_tensor"])

    def dump(self, kinds="pp pp pp", bounds=("0 1", "0 1", "0 1")):
        """The bcc cell as a dump, after a snapshot of another box."""
        text = ""
        for step, box in enumerate((("0 9", "0 9", "0 9"), bounds)):
            centres, radius = LATTICES["bcc"][:2]
            text += f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(centres)}\nITEM: BOX BOUNDS {kinds}\n"
            text += "".join(line + "\n" for line in box) + "ITEM: ATOMS id x y z radius\n"
            text += "".join(f"{i} {x!r} {y!r} {z!r} {radius!r}\n" for i, (x, y, z) in enumerate(centres, 1))
        return self.write("cell.dump", text)

    def test_the_cell_of_a_dump(self):
        centres, radius = LATTICES["bcc"][:2]
        named = self.report(*ALL, packing=self.packing(centres, radius))
        done = self.run_pfv("solve", "--packing", self.dump(), "--periodic", "dump", "--viscosity", "1")
        self.assertEqual(done.returncode, 0)
        self.assertNotIn("no pressure", done.stderr)
        self.assertNotIn("walls stand", done.stderr)
        self.assertEqual(done.stdout.splitlines()[1].split()[:4], ["permeability", "along", "x,", "y,"])
        along_x = float(done.stdout.splitlines()[1].split()[5])
        self.assertAlmostEqual(along_x / named["permeability"], 1.0, delta=1e-5)  # printed digits

    def test_a_dump_that_is_periodic_on_some_sides(self):
        packing = self.dump("pp ff pp")
        driven = ["--face", "ylo:pressure=1", "--face", "yhi:pressure=0", "--viscosity", "1"]
        mixed = self.report("--periodic", "dump", *driven, packing=packing)
        named = self.report("--periodic", "x,z", *driven, packing=packing)
        self.assertEqual(mixed["permeability"], named["permeability"])

    def test_a_tilted_dump(self):
        """By a whole edge: the bounds in the file are those around the tilted box, the lattice is the straight one."""
        straight = self.report("--periodic", "dump", box=[], packing=self.dump())
        tilted = self.dump("xy xz yz pp pp pp", ("-1 1 -1", "0 2 0", "0 1 1"))
        for arguments, packing in ((("--periodic", "dump"), tilted),):
            report = self.report(*arguments, box=[], packing=packing)
            for i in range(3):
                self.assertAlmostEqual(report["permeability_tensor"][i][i] / straight["permeability_tensor"][i][i], 1.0,
                                       delta=1e-9)
        named = self.report("--periodic", "x,y,z", "--tilt", "-1", "0", "1", packing=tilted)
        self.assertEqual(named["permeability_tensor"], report["permeability_tensor"])

    def test_walls_around_a_periodic_dump_are_said(self):
        done = self.run_pfv("solve", "--packing", self.dump(), *UNIT_BOX, "--face", "zlo:pressure=1",
                            "--face", "zhi:pressure=0")
        self.assertEqual(done.returncode, 0)
        self.assertIn("periodic along x y z", done.stderr)
        self.assertIn("--periodic dump", done.stderr)

    def test_a_gradient_is_a_load(self):
        done = self.run_pfv("solve", "--packing", self.packing(*LATTICES["bcc"][:2]), *UNIT_BOX, *ALL)
        self.assertEqual(done.returncode, 0)
        self.assertNotIn("no pressure", done.stderr)
        self.assertNotIn("have no way", done.stderr)

    def test_cells_that_are_not_to_be_had(self):
        for dump, arguments, words in (
                (("ff ff ff",), (), "no dump of a simulation box with periodic sides"),
                (("pp pp ff",), (), "along z"),
                (("xy xz yz pp pp ff", ("0 1.3 0.2", "0 1 0.1", "0 1 0")), UNIT_BOX, "tilt xz"),
                (("pp pp pp", ("0 1", "0 x", "0 1")), (), "'0 x'"),
                (("pp pp pp", ("0 1", "0", "0 1")), (), "two numbers"),
                (("",), (), "no dump of a simulation box with periodic sides"),
                (("pp pp pp",), ("--box", "0", "1", "0", "1", "0", "2"), "along z")):
            with self.subTest(words):
                self.assert_refused(self.run_pfv("solve", "--packing", self.dump(*dump), "--periodic", "dump",
                                                 *arguments), words)
        csv = self.packing([(.5, .5, .5)], .5)
        self.assert_refused(self.run_pfv("solve", "--packing", csv, "--periodic", "dump"), "no dump")

    def test_refusals(self):
        grains = self.packing([(.5, .5, .5)], .5)
        for arguments, word in ((["--periodic", "x,q"], "'q'"), (["--periodic", "x,x"], "twice"),
                                (["--gradient", "0", "0", "1"], "not periodic"),
                                (["--periodic", "z", "--face", "zlo:pressure=1"], "zlo")):
            result = self.run_pfv("solve", "--packing", grains, *UNIT_BOX, *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertEqual(len(result.stderr.splitlines()), 1)
            self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()

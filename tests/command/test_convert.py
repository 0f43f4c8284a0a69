# SPDX-License-Identifier: GPL-3.0-or-later
"""`pfv convert`: the same flow through the file of each format, and what is said of what a format does not hold."""
import csv
import unittest

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest

FORMATS = {"csv": "a.csv", "dump": "a.dump", "data": "a.data", "yade": "a.txt", "vtu": "a.vtu"}


class Convert(CommandTest):
    def convert(self, *arguments):
        result = self.run_pfv("convert", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def test_flow_is_the_same_through_each_format(self):
        def forces(packing):
            self.solve(*THROUGH_FLOW, "--forces", "forces.csv", packing=packing)
            return self.read("forces.csv")
        expected = forces(DENSE)
        for name in FORMATS.values():
            self.convert(DENSE, name)
            self.assertEqual(forces(name), expected, name)

    def test_what_is_lost_is_said_and_the_rest_stays(self):
        self.write("in.dump", "ITEM: TIMESTEP\n50\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n0 1\n0 1\n0 2\n"
                   "ITEM: ATOMS id x y z radius vx vy vz\n5 0.1 0.2 0.3 0.1 1 2 3\n4 0.5 0.6 0.7 0.1 0 0 0\n")
        self.assertEqual(self.convert("in.dump", "out.dump").stderr, "")
        said = self.convert("in.dump", "out.txt").stderr
        for part in ("time step 50", "periodic", "velocities", "ids"):
            self.assertIn(part, said)
        self.convert("out.dump", "out.csv")
        with open(self.folder / "out.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["id"], row["x"], row["vz"]) for row in rows], [("5", "0.1", "3"), ("4", "0.5", "0")])
        self.convert("in.dump", "rest.csv", "--at-rest")
        self.assertNotIn(b"vx", self.read("rest.csv"))

    def test_units_and_format_of_choice(self):
        self.write("mm.csv", "id,x,y,z,radius\n1,100,200,300,50\n")
        self.convert("mm.csv", "m", "--format", "yade", "--length-unit", "mm")
        self.assertEqual(self.read("m"), b"#format x_y_z_r\n0.1\t0.2\t0.3\t0.05\n")

    def test_result_goes_to_standard_output_alone(self):
        said = self.convert(DENSE, "/dev/stdout", "--format", "csv").stdout
        self.assertEqual(said.count("\n"), 101)

    def test_refusals(self):
        self.write("a.csv", "id,x,y,z,radius\n1,0.1,0.2,0.3,0.05\n")
        for arguments, part in ((["a.csv", "a.csv"], "replace"), (["a.csv", "./a.csv"], "replace"),
                                (["a.csv", "b.gz"], "--format"), (["a.csv", "b.csv", "--format", "xyz"], "dump"),
                                (["a.csv", "b.csv", "--density", "1"], "density"), (["none", "b.csv"], "none"),
                                (["a.csv", "b.data", "--density", "-1"], "--density"), (["a.csv"], "--help"),
                                (["a.csv", "no/b.csv"], "folder")):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_pfv("convert", *arguments), "pfv: ", part)
        self.assertEqual([file.name for file in self.folder.iterdir()], ["a.csv"])


if __name__ == "__main__":
    unittest.main()

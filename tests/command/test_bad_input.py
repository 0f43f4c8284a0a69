# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: exit status 2, one line that says what, where and what to do, and no file."""
import unittest

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest, dense_rows, with_velocities

HEADER = "id,x,y,z,radius\n"
OUTPUTS = ["--forces", "out/forces.csv", "--report", "out/report.json", "--vtk", "out/pores.vtu"]


class BadInput(CommandTest):
    def setUp(self):
        super().setUp()
        (self.folder / "out").mkdir()

    def refuse(self, *arguments, packing=DENSE, box=UNIT_BOX, parts=()):
        result = self.run_pfv("solve", "--packing", packing, *box, *OUTPUTS, *arguments)
        self.assert_refused(result, "pfv: ", *parts)
        self.assertEqual(list((self.folder / "out").iterdir()), [])
        self.assertFalse(list(self.folder.glob("*.part")))

    def refuse_packing(self, content, *parts, arguments=THROUGH_FLOW):
        packing = self.write("packing.csv", content)
        with self.subTest(content=content[-60:]):
            self.refuse(*arguments, packing=packing, parts=parts)

    def refuse_arguments(self, *arguments, parts=()):
        with self.subTest(arguments=arguments):
            self.refuse(*arguments, parts=parts)

    def test_a_packing_that_cannot_be_read(self):
        self.refuse(*THROUGH_FLOW, packing="nowhere.csv", parts=["nowhere.csv", "No such file"])
        self.refuse(*THROUGH_FLOW, packing=self.folder, parts=["Is a directory"])
        self.refuse_packing(b"\x7fELF\x02\x01\x01\x00\x00\n\x00\xff", "packing.csv:1")
        self.refuse_packing("these are\nnot spheres\n", "packing.csv:1", "id")
        self.refuse_packing("", "packing.csv")
        self.refuse_packing(HEADER, "packing.csv", "no spheres")

    def test_a_garbled_line_of_a_packing(self):
        good = "1,0.3,0.3,0.3,0.1\n"
        for line, part in (("2,0.5,0.5", "3 fields"), ("1,0.5,0.5,0.5,0.1", "id 1"),
                           ("1.5,0.5,0.5,0.5,0.1", "'1.5'"), ("two,0.5,0.5,0.5,0.1", "'two'"),
                           ("2,nan,0.5,0.5,0.1", "x is 'nan'"), ("2,0.5,inf,0.5,0.1", "y is 'inf'"),
                           ("2,0.5,0.5,1e999,0.1", "z is '1e999'"),
                           ("2,0.5,0.5,half,0.1", "z is 'half'"),
                           ("2,0.5,0.5,0.5,0", "radius is '0'"),
                           ("2,0.5,0.5,0.5,-0.1", "radius is '-0.1'")):
            self.refuse_packing(HEADER + good + line + "\n", "packing.csv:3", part)

    def test_what_is_said_twice(self):
        for twice, parts in ((["--viscosity", "1", "--viscosity", "2"], ["--viscosity"]),
                             (["--solver", "cg", "--solver", "klu2"], ["--solver"]),
                             (["--box", *UNIT_BOX[1:]], ["--box"]),
                             (["--face", "zlo:pressure=1"], ["zlo", "repeats"])):
            flow = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=1"]
            self.refuse_arguments(*flow, *twice, parts=parts)

    def test_a_dump_that_is_cut_off(self):
        dump = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n"
                "0 1\nITEM: ATOMS id x y z radius \n1 0.3 0.3 0.3 0.1 \n")
        self.refuse_packing(dump, "cut off")

    def test_spheres_that_cannot_be_where_they_are(self):
        header, rows = dense_rows()
        twin = ["777", *rows[4][1:4], "0.01"]
        self.refuse_packing("\n".join(map(",".join, [header, *rows, twin])) + "\n", "777", rows[4][0])
        outside = ["778", "0.5", "0.5", "1.25", "0.3"]
        self.refuse_packing("\n".join(map(",".join, [header, *rows, outside])) + "\n", "778")

    def test_a_box_that_is_flat_or_inverted_or_no_box(self):
        for box in ("1 0 0 1 0 1", "0 1 0 1 0.5 0.5", "0 1 0 nan 0 1", "0 1 0 inf 0 1",
                    "0 1 0 1 0 one", "0 1 0 1 0 1e"):
            with self.subTest(box=box):
                self.refuse(*THROUGH_FLOW, box=["--box", *box.split()], parts=["box"])

    def test_a_face_that_is_not_understood(self):
        for face, part in (("top:pressure=1", "unknown face 'top'"), ("zhi", "no items"),
                           ("zhi:", "unknown item"), ("zhi:presure=1", "unknown item 'presure'"),
                           ("zhi:pressure", "needs a value"), ("zhi:pressure=", "no finite number"),
                           ("zhi:pressure=1abc", "'1abc'"), ("zhi:pressure=nan", "'nan'"),
                           ("zhi:flux=inf", "'inf'"), ("zhi:velocity=fast", "'fast'"),
                           ("zhi:sealed=1", "sealed"), ("zhi:wall=glass", "'glass'"),
                           ("zhi:pressure=1,pressure=1", "repeats"),
                           ("zhi:pressure=1,flux=1", "contradicts"),
                           ("zhi:wall=no_slip,wall=symmetry", "contradicts"),
                           ("zhi:velocity=1,velocity=1", "repeats")):
            self.refuse_arguments("--face", face, parts=["--face", part])
        self.refuse_arguments("--face", "zhi:pressure=1", "--face", "zhi:sealed",
                              parts=["contradicts"])

    def test_a_patch_that_is_not_understood(self):
        for patch in ("zhi:0,1,0,1", "zhi:0,1,0:sealed", "zhi:0,1,0,b:sealed", "up:0,1,0,1:sealed",
                      "zhi:0,1,0,1:wall=no_slip", "zhi:0,1,0,1:pressure", "zhi:1,0,0,1:sealed",
                      "zhi:0,1,2,3:sealed", "zhi:0,nan,0,1:sealed"):
            self.refuse_arguments("--patch", patch, *THROUGH_FLOW, parts=["patch"])

    def test_a_region_that_is_not_understood(self):
        for region in ("0,1,0,1,0:flux=1", "0,1,0,1,0,b:flux=1", "0,1,0,1,0,1", "0,1,0,1,2,3:flux=1",
                       "0,1,0,1,0,1:sealed", "0,1,0,1,0,1:wall=symmetry", "0,1,0,1,1,0:flux=1"):
            self.refuse_arguments("--region", region, *THROUGH_FLOW, parts=["region"])
        for point in ("0,0:flux=1", "0,0,2:flux=1", "0,0,0:speed=1"):
            self.refuse_arguments("--point", point, *THROUGH_FLOW, parts=[])
        self.refuse_arguments("--model", "darcy_grid", "--cells", "2", "2", "2", "--point",
                              ".5,.5,.5:flux=1", *THROUGH_FLOW, parts=["darcy_grid", "regions"])

    def test_numbers_out_of_range(self):
        for option, values in (("--viscosity", ("0", "-1", "nan", "inf", "thick", "1abc", "")),
                               ("--density", ("-1", "nan", "heavy")),
                               ("--bulk-modulus", ("0", "-1", "nan")),
                               ("--time-step", ("0", "-1e-3", "nan", "inf")),
                               ("--repeat", ("0", "-1", "1.5", "many"))):
            for value in values:
                self.refuse_arguments(option, value, "--face", "zhi:pressure=0", parts=[option])
        self.refuse_arguments("--gravity", "0", "0", "down", "--face", "zhi:pressure=0",
                              parts=["--gravity", "'down'"])

    def test_unknown_keywords(self):
        for option, value in (("--wall", "slip"), ("--conductance", "poiseuille"),
                              ("--solver", "magic"), ("--ordering", "random"),
                              ("--precision", "half")):
            self.refuse_arguments(option, value, *THROUGH_FLOW, parts=["unknown", value])
        self.refuse_arguments("--solver", "klu2", "--ordering", "metis", *THROUGH_FLOW,
                              parts=["klu2", "metis"])
        self.refuse_arguments("--solver", "cg", "--precision", "mixed", *THROUGH_FLOW,
                              parts=["cg", "mixed", "supernodal"])
        for tolerance in ("0", "1", "-1e-6", "small"):
            self.refuse_arguments("--tolerance", tolerance, "--solver", "cg", *THROUGH_FLOW,
                                  parts=["tolerance"])
        self.refuse_arguments("--tolerance", "1e-6", *THROUGH_FLOW,
                              parts=["supernodal", "no tolerance", "cg"])
        for threads in ("0", "65", "-1", "two", "1.5"):
            self.refuse_arguments("--threads", threads, *THROUGH_FLOW,
                                  parts=["--threads", threads, "1 to 64"])

    def test_a_compressible_fluid_without_time_step(self):
        self.refuse_arguments("--bulk-modulus", "1e9", *THROUGH_FLOW, parts=["--time-step"])

    def test_pressures_that_nothing_determines(self):
        self.refuse_packing(with_velocities(lambda x, y, z: (0, 0, -z)), arguments=[])
        self.refuse_arguments("--face", "zhi:flux=1")
        self.refuse_arguments("--face", "zhi:velocity=-1")

    def test_a_squeezed_region_that_is_cut_off_from_every_pressure(self):
        # Four big spheres close the plane z = 0.5; the grains above sink, the outlet is below. Where the
        # big ones overlap the papers' law closes further throats, so that parts cannot exchange fluid.
        lines = ["id,x,y,z,radius,vx,vy,vz"]
        spheres = [(x, y, 0.5, 0.45, 0) for x in (0.251, 0.747) for y in (0.252, 0.749)]
        spheres += [(x, y, z, 0.02, -1 if z > 0.5 else 0)
                    for z in (0.03, 0.97) for x in (0.3, 0.52, 0.7) for y in (0.31, 0.53, 0.69)]
        lines += [f"{k + 1},{x},{y},{z},{r},0,0,{v}" for k, (x, y, z, r, v) in enumerate(spheres)]
        self.refuse_packing("\n".join(lines) + "\n", "cut off", arguments=[
            "--face", "zlo:pressure=0", "--conductance", "hydraulic_radius"])

    def test_output_files_that_cannot_be_made(self):
        common = ["solve", "--packing", DENSE, *UNIT_BOX, *THROUGH_FLOW]
        for option in ("--forces", "--report", "--vtk"):
            for name in ("nowhere/file", "", "out", "out/"):
                with self.subTest(option=option, name=name):
                    self.assert_refused(self.run_pfv(*common, option, name))
        self.assert_refused(self.run_pfv(*common, "--forces", "same", "--report", "./same"), "same")
        packing = self.write("packing.csv", DENSE.read_bytes())
        result = self.run_pfv("solve", "--packing", packing, *UNIT_BOX, *THROUGH_FLOW,
                              "--forces", "packing.csv")
        self.assert_refused(result, "packing.csv")
        self.assertEqual(packing.read_bytes(), DENSE.read_bytes())


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command line says about faces, patches and the fluid reaches the flow."""
import os
import unittest

from command import THROUGH_FLOW, CommandTest, dense_rows, with_velocities


def flux(report, face):
    return report["faces"][face]["flux"]


class Pressures(CommandTest):
    def assert_close(self, value, expected, delta=1e-9):
        self.assertAlmostEqual(value / expected, 1, delta=delta)

    def test_an_imposed_flux_is_what_crosses_the_face(self):
        report = self.report("--face", "zlo:pressure=0", "--face", "zhi:flux=-2.5e-3")
        self.assert_close(flux(report, "zhi"), -2.5e-3)
        self.assert_close(flux(report, "zlo"), 2.5e-3)

    def test_grains_that_go_along_with_the_fluid_feel_no_pressure(self):
        rows = [[*row, 0, 0, 0.01] for row in dense_rows()[1]]
        lines = ["id,x,y,z,radius,vx,vy,vz"] + [",".join(map(str, row)) for row in rows]
        plug = self.write("plug.csv", "\n".join(lines) + "\n")
        report = self.report("--face", "zlo:flux=0.01", "--face", "zhi:pressure=0", "--viscosity",
                             "1", "--wall", "symmetry", "--forces", "forces.csv", packing=plug)
        self.assert_close(flux(report, "zhi"), -0.01, 1e-12)
        self.assertLess(abs(report["mass_error"]), 1e-13)
        self.assertLess(max(abs(value) for row in self.forces("forces.csv").values()
                            for value in row), 1e-12)  # 12 mu v L = 0.12 N of grains at rest

    def test_flux_goes_with_pressure_over_viscosity(self):
        faces = ["--face", "zlo:pressure=-1e3", "--face", "zhi:pressure=1e3"]
        once = self.report(*faces, "--viscosity", "2e-3")
        self.assert_close(flux(once, "zhi"), 1e6 * flux(self.report(*THROUGH_FLOW), "zhi"))
        self.assert_close(once["permeability"], self.report(*THROUGH_FLOW)["permeability"])

    def test_viscosity_is_that_of_water_unless_named(self):
        faces = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=1"]
        self.assertEqual(flux(self.report(*faces), "zhi"),
                         flux(self.report(*faces, "--viscosity", "0.001"), "zhi"))

    def test_the_wall_of_a_face_wins_over_that_of_all(self):
        sides = [argument for face in ("xlo", "xhi", "ylo", "yhi")
                 for argument in ("--face", face + ":wall=symmetry")]
        symmetry = self.report(*THROUGH_FLOW, "--wall", "symmetry")["permeability"]
        no_slip = self.report(*THROUGH_FLOW)["permeability"]
        self.assertGreater(symmetry, 1.01 * no_slip)
        self.assertEqual(self.report(*THROUGH_FLOW, *sides)["permeability"], symmetry)
        self.assertEqual(self.report(*THROUGH_FLOW, "--wall", "no_slip")["permeability"], no_slip)

    def test_items_of_one_face_may_come_in_several_arguments(self):
        packing = self.write("moving.csv", with_velocities(lambda x, y, z: (0, 0, -z)))
        together = self.report("--face", "zhi:pressure=0,velocity=-1", packing=packing)
        apart = self.report("--face", "zhi:pressure=0", "--face", "zhi:velocity=-1",
                            packing=packing)
        self.assertEqual(together["faces"], apart["faces"])

    # The box loses its lid's velocity times its area, whatever the grains do.
    def test_a_moving_face_drives_out_the_volume_that_it_sweeps(self):
        for packing in (self.write("moving.csv", with_velocities(lambda x, y, z: (0, 0, -z))),
                        self.write("still.csv", with_velocities(lambda x, y, z: (0, 0, 0)))):
            report = self.report("--face", "zhi:velocity=-1", "--face", "zlo:pressure=0",
                                 packing=packing)
            self.assert_close(report["volume_rate_sum"], -1)
            self.assert_close(flux(report, "zlo"), -1)
            self.assertLess(abs(report["mass_error"]), 1e-10)

    def test_a_box_may_have_negative_bounds_with_exponents(self):
        header, rows = dense_rows()
        moved = [[k, repr(float(x) - 0.5), repr(float(y) - 0.5), z, r] for k, x, y, z, r in rows]
        packing = self.write("moved.csv", "\n".join(map(",".join, [header, *moved])) + "\n")
        box = "--box -5e-1 .5 -0.5 +0.5 -0e0 1.".split()
        report = self.report(*THROUGH_FLOW, packing=packing, box=box)
        self.assert_close(report["permeability"], self.report(*THROUGH_FLOW)["permeability"],
                          delta=1e-6)

    def test_a_patch_lets_through_less_than_its_whole_face(self):
        faces = ["--face", "zlo:pressure=0", "--viscosity", "1"]
        small = self.report(*faces, "--patch", "zhi:.4,.6,.4,.6:pressure=1")
        self.assertGreater(flux(small, "zhi"), 0)
        self.assertLess(flux(small, "zhi"), 0.9 * flux(self.report(*THROUGH_FLOW), "zhi"))
        whole = self.report(*faces, "--patch", "zhi:-1,2,-1,2:pressure=1")
        self.assert_close(flux(whole, "zhi"), flux(self.report(*THROUGH_FLOW), "zhi"))

    def test_a_well_inside_gives_what_leaves_through_the_lid(self):
        for well in (["--point", ".5,.5,.5:flux=2"], ["--region", ".4,.6,.4,.6,.4,.6:flux=2"]):
            report = self.report("--face", "zhi:pressure=0", *well)
            opening, = report["openings"]
            self.assertEqual(opening["name"], "region 1")
            self.assertAlmostEqual(opening["flux"], 2.0, delta=1e-11)
            self.assertAlmostEqual(report["faces"]["zhi"]["flux"], -2.0, delta=1e-11)
            self.assertGreater(opening["pressure"], 0.0)
            self.assertIsNone(report["permeability"])

    def test_the_report_says_what_crosses_each_patch(self):
        report = self.report("--face", "zlo:pressure=0", "--patch", "zhi:.4,.6,.4,.6:pressure=1")
        opening, = report["openings"]
        self.assertEqual(opening["name"], "patch 1 on face zhi")
        self.assertEqual(opening["pressure"], 1.0)
        self.assertAlmostEqual(opening["flux"] / report["inflow"], 1.0, delta=1e-12)

    def test_later_patches_win(self):
        faces = ["--face", "zlo:pressure=0", "--patch", "zhi:-1,2,-1,2:pressure=1"]
        sealed = self.report(*faces, "--patch", "zhi:-1,2,-1,2:sealed")
        self.assertEqual(flux(sealed, "zhi"), 0)

    def test_a_compressible_fluid_takes_up_a_sealed_squeeze(self):
        packing = self.write("moving.csv", with_velocities(lambda x, y, z: (0, 0, -z)))
        report = self.report("--face", "zhi:velocity=-1", "--bulk-modulus", "2.2e9",
                             "--time-step", "1e-6", packing=packing)
        self.assert_close(report["volume_rate_sum"], -1)
        self.assert_close(report["storage_rate"], 1)
        self.assertLess(abs(report["mass_error"]), 1e-6)

    def test_no_pressure_anywhere_and_nothing_moving_is_p_0_with_a_line(self):
        result = self.solve("--forces", "forces.csv")
        self.assert_one_line(result.stderr)
        self.assertIn("p is 0", result.stderr)
        self.assertTrue(all(value == 0 for force in self.forces("forces.csv").values()
                            for value in force))

    def test_solvers_orderings_and_laws_can_be_chosen(self):
        chosen = self.report(*THROUGH_FLOW)
        solvers = ["supernodal", "cholmod", "tacho", "klu2"]
        if os.environ.get("PFV_WITH_MUMPS") != "OFF":
            solvers.append("mumps")
        for arguments, key, name in (*((["--solver", name], "solver", name)
                                       for name in solvers),
                                     (["--solver", "tacho"], "ordering", "metis"),
                                     (["--ordering", "amd"], "ordering", "amd"),
                                     (["--ordering", "metis"], "ordering", "metis"),
                                     (["--precision", "mixed"], "solver", "supernodal"),
                                     (["--threads", "2"], "threads", 2)):
            report = self.report(*THROUGH_FLOW, *arguments)
            self.assertEqual(report[key], name)
            self.assert_close(report["permeability"], chosen["permeability"])
        law = self.report(*THROUGH_FLOW, "--conductance", "effective_radius")
        self.assertEqual(law["conductance"], "effective_radius")
        self.assertNotAlmostEqual(law["permeability"] / chosen["permeability"], 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()

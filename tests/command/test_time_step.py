# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv time-step: the true limit of the explicit coupling, the papers' estimates, the matrices V*."""
import csv
import json
import math
import unittest

from command import DENSE, UNIT_BOX, CommandTest, dense_rows

DRAINED = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=0", "--wall", "symmetry"]


class TimeStep(CommandTest):
    def limits(self, *arguments, viscosity=1.0):
        result = self.run_pfv("time-step", "--packing", DENSE, *UNIT_BOX, *DRAINED, "--viscosity",
                              viscosity, "--grain-density", "2600", "--report", "limits.json",
                              *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.json("limits.json"), result.stdout

    def matrices(self):
        rows = list(csv.reader(self.read("v.csv").decode().splitlines()))
        self.assertEqual(rows[0], "id,radius,vxx,vxy,vxz,vyx,vyy,vyz,vzx,vzy,vzz".split(","))
        return {int(row[0]): [float(value) for value in row[1:]] for row in rows[1:]}

    def test_the_estimates_are_those_of_the_spheres_that_they_name(self):
        found, text = self.limits("--matrices", "v.csv")
        radii = {int(row[0]): float(row[4]) for row in dense_rows()[1]}
        smallest = min(radii, key=radii.get)
        self.assertEqual(found["formula"]["sphere"], smallest)
        self.assertAlmostEqual(found["formula"]["time_step"],
                               math.pi * 2600 * (2 * radii[smallest])**2 / 1200, delta=1e-12)
        matrices = self.matrices()
        self.assertEqual(len(matrices), 100)
        worst = found["viscous"]["sphere"]
        mass = 2600 * 4 / 3 * math.pi * radii[worst]**3
        # the largest eigenvalue lies between the diagonal's largest entry and the norm
        diagonal = max(matrices[worst][1], matrices[worst][5], matrices[worst][9])
        norm = math.hypot(*matrices[worst][1:])
        self.assertLess(found["viscous"]["time_step"], 2 * mass / diagonal)
        self.assertGreater(found["viscous"]["time_step"], 2 * mass / norm)
        self.assertLess(found["coupling_limit"], found["viscous"]["time_step"])
        self.assertIsNone(found["contact_limit"])
        self.assertIn("eq. 4.15", text)
        self.assertNotIn("contacts", text)

    def test_limits_go_with_one_over_the_viscosity_and_matrices_do_not(self):
        thin, _ = self.limits("--matrices", "v.csv", "--spheres", "10")
        of_thin = self.matrices()
        thick, text = self.limits("--matrices", "v.csv", "--spheres", "10", viscosity=250)
        of_thick = self.matrices()
        for name in ("viscous", "formula"):
            self.assertEqual(thin[name]["sphere"], thick[name]["sphere"])
            self.assertAlmostEqual(thick[name]["time_step"] * 250 / thin[name]["time_step"], 1.0,
                                   delta=1e-9)
        self.assertAlmostEqual(thick["coupling_limit"] * 250 / thin["coupling_limit"], 1, delta=1e-9)
        self.assertEqual(list(of_thin), [1 + 10 * i for i in range(10)])
        for sphere, row in of_thin.items():
            for a, b in zip(row, of_thick[sphere]):
                self.assertAlmostEqual(a, b, delta=1e-9 * max(map(abs, row)))
        self.assertIn("10 of 100", text)

    def test_a_light_piston_lowers_the_true_limit_alone(self):
        without, _ = self.limits("--ids", "5,6")
        sealed = ["--face", "zlo:pressure=0", "--wall", "symmetry"]
        found = []
        for mass in ("1e-2", "1e-4"):
            result = self.run_pfv("time-step", "--packing", DENSE, *UNIT_BOX, *sealed,
                                  "--viscosity", "1", "--grain-density", "2600", "--ids", "5,6",
                                  "--piston", "zhi:" + mass, "--report", "piston.json")
            self.assertEqual(result.returncode, 0, result.stderr)
            found.append(self.json("piston.json"))
        # in proportion to the mass where that is all that moves
        self.assertAlmostEqual(found[0]["coupling_limit"] / found[1]["coupling_limit"], 100, delta=3)
        self.assertLess(found[0]["coupling_limit"], 1e-2 * without["coupling_limit"])
        self.assertEqual(without["looked_at"], 2)

    def test_contacts_go_with_one_over_the_root_of_their_stiffness(self):
        soft, text = self.limits("--ids", "5", "--contact-stiffness", "1e4",
                                 "--tangential-stiffness", "5e3")
        stiff, _ = self.limits("--ids", "5", "--contact-stiffness", "1e8",
                               "--tangential-stiffness", "5e7")
        self.assertAlmostEqual(soft["contact_limit"] / stiff["contact_limit"], 100, delta=1e-6)
        self.assertAlmostEqual(soft["contact"]["time_step"] / stiff["contact"]["time_step"], 100,
                               delta=1e-6)
        self.assertIn("eq. 2.14", text)

    def test_a_report_on_standard_output_stands_alone_and_no_limit_is_null(self):
        grain = self.write("one.csv", "id,x,y,z,radius\n7,0.5,0.5,0.5,0.2\n")
        words = ["time-step", "--packing", grain, *UNIT_BOX, "--grain-density", "2600",
                 "--contact-stiffness", "1e4", "--face", "zlo:pressure=0"]
        report = json.loads(self.run_pfv(*words, "--report", "/dev/stdout").stdout)
        self.assertIsNone(report["contact_limit"])
        self.assertEqual(report["viscous"]["sphere"], 7)
        self.assertRegex(self.run_pfv(*words).stdout, "omega_max +no limit")

    def test_what_cannot_be_right_is_refused(self):
        whole = ["--packing", DENSE, *UNIT_BOX, "--grain-density", "2600"]
        for arguments, word in ((["--packing", DENSE, *UNIT_BOX], "grain-density"),
                                ([*whole, "--grain-density", "0"], "grain-density"),
                                ([*whole, "--ids", "1000"], "1000"),
                                ([*whole, "--ids", "1", "--spheres", "5"], "exclude"),
                                ([*whole, "--spheres", "0"], "--spheres"),
                                ([*whole, "--piston", "zhi"], "NAME:MASS"),
                                ([*whole, "--piston", "top:1"], "top"),
                                ([*whole, "--piston", "zhi:0"], "--piston"),
                                ([*whole, "--piston", "zhi:1", "--piston", "zhi:2"], "twice"),
                                ([*whole, "--tangential-stiffness", "1"], "--contact-stiffness"),
                                ([*whole, "--contact-stiffness", "-1"], "stiffness"),
                                ([*whole, "--report", "no/such/file.json"], "no/such"),
                                ([*whole, "--report", "a", "--matrices", "a"], "name of its own")):
            self.assert_refused(self.run_pfv("time-step", *arguments), word)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Help, version and how the command line itself is read."""
import re
import unittest

from command import DENSE, UNIT_BOX, CommandTest

OPTIONS = ("packing box face patch region point wall viscosity density gravity bulk-modulus time-step "
           "conductance solver ordering tolerance precision threads repeat forces report vtk "
           "culprits").split()


class Usage(CommandTest):
    def test_version_is_one_line_for_the_command_and_its_subcommand(self):
        for arguments in (["--version"], ["solve", "--version"]):
            result = self.run_pfv(*arguments)
            self.assertEqual(result.returncode, 0)
            self.assertRegex(result.stdout, r"^pfv \d+\.\d+\.\d+\n$")

    def test_help_names_the_subcommand(self):
        result = self.run_pfv("--help")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"\n  solve ")

    def test_help_of_solve_gives_each_option_with_its_default(self):
        result = self.run_pfv("solve", "--help")
        self.assertEqual(result.returncode, 0)
        entries = {entry.split()[0]: entry for entry in
                   re.split(r"\n  (?=--)", result.stdout)[1:]}
        for option in OPTIONS:
            self.assertRegex(entries["--" + option], r"default|required", option)

    def test_help_of_solve_gives_the_unit_of_each_quantity(self):
        text = self.run_pfv("solve", "--help").stdout
        for option, unit in (("viscosity", "Pa s"), ("density", "kg/m3"), ("gravity", "m/s2"),
                             ("bulk-modulus", "Pa"), ("time-step", ", s"), ("box", ", m")):
            self.assertRegex(text, rf"--{option} [^-]*{re.escape(unit)}")

    def test_what_is_not_understood_is_refused_with_one_line(self):
        solve = ["solve", "--packing", DENSE, *UNIT_BOX]
        for arguments in ([], ["dissolve"], ["--frobnicate"], ["solve"], ["solve", *UNIT_BOX],
                          ["solve", "--packing", DENSE], [*solve, "more"],
                          [*solve, "--frobnicate", "1"], [*solve, "--viscosity"],
                          [*solve, "--viscosity", "1", "--viscosity", "2"],
                          [*solve, *UNIT_BOX],
                          ["solve", "--packing", DENSE, "--box", "0", "1", "0", "1", "0"]):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_pfv(*arguments), "pfv: ", "--help")

    def test_what_is_nearly_right_is_told_what_is_meant(self):
        solve = ["solve", "--packing", DENSE, *UNIT_BOX]
        for arguments, said in ((["permeability", "--packing", DENSE], "there is no command 'permeability': give one of solve, convert"),
                                (["slove"], "there is no command 'slove'; is solve meant"),
                                ([], "a command is missing: give one of solve"),
                                ([*solve, "--faces", "zlo:pressure=1"], "there is no option '--faces'; is --face or --forces meant? see pfv solve --help"),
                                ([*solve, "--viscocity=1"], "there is no option '--viscocity'; is --viscosity meant"),
                                ([*solve, "--length-unit", "ell"], "--length-unit: the unit of length is 'ell': give m, cm"),
                                ([*solve, "--vtk", "pores.png"], "--vtk pores.png: ")):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_pfv(*arguments), said)

    def test_standard_output_that_cannot_be_written_is_a_failure(self):
        with open("/dev/full", "w") as full:
            result = self.run_pfv("--help", stdout=full)
        self.assertEqual(result.returncode, 1)
        self.assert_one_line(result.stderr)


if __name__ == "__main__":
    unittest.main()

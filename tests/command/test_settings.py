# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of settings: its page is up to date, and what is not read is refused."""
import os
import pathlib
import re
import sys
import unittest

from command import DENSE, THROUGH_FLOW, UNIT_BOX, CommandTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOC = ROOT / "doc"
KEYWORDS = ROOT / "pfvlib/python/keywords.cmake"

os.environ.setdefault("PFV_BIN", str(pathlib.Path(os.environ["PFV_COMMAND"]).parent))
sys.path.append(str(ROOT / "inputs/common"))
import scene  # noqa: E402


class Settings(CommandTest):
    def rows(self):
        """The cells of each row of the table."""
        page = self.run_pfv("settings").stdout
        cells = [re.split(r"(?<!\\)\|", line)[1:-1] for line in page.splitlines() if line.startswith("| ")]
        return [[cell.strip() for cell in row] for row in cells if row[0].strip() != "setting"]

    def test_the_page_is_what_the_command_prints(self):
        page = self.run_pfv("settings")
        self.assertEqual(page.returncode, 0)
        self.assertEqual(page.stdout, (DOC / "settings.md").read_text(),
                         "doc/settings.md is out of date: pfv settings > doc/settings.md")

    def test_the_page_of_the_fix_has_what_the_command_prints(self):
        syntax = self.run_pfv("settings", "--fix").stdout
        self.assertIn("<!-- made by: pfv settings --fix -->\n```\n" + syntax + "```\n",
                      (DOC / "fix_pfv.md").read_text(), "out of date: pfv settings --fix")
        for name, _, _, _, fix, *_ in self.rows():
            if fix.startswith("*"):
                self.assertIn(f"\n{name} values = ", "\n" + syntax)

    def test_settings_that_a_user_gives_to_a_scene_take_the_place_of_its_own(self):
        own = "coupling auto retriangulate mean 0.03 conductance open_throat"
        self.assertEqual(scene.fix_words(own, ""), own)
        self.assertEqual(scene.fix_words(own, "retriangulate 0.1 couple_every auto error 0.3"),
                         "coupling auto conductance open_throat retriangulate 0.1 couple_every auto error 0.3")
        self.assertEqual(scene.fix_words(own, "coupling explicit conductance hydraulic_radius"),
                         "retriangulate mean 0.03 coupling explicit conductance hydraulic_radius")
        self.assertEqual(scene.fix_words(own, "model darcy_grid 2 2 6"), "model darcy_grid 2 2 6")

    def test_the_page_of_the_solvers_has_what_the_command_prints(self):
        table = self.run_pfv("settings", "--solvers").stdout
        block = "<!-- made by: pfv settings --solvers -->\n" + table + "\n"
        self.assertTrue(block in (DOC / "solvers.md").read_text(), "out of date: pfv settings --solvers")
        [choices] = [values.split("\\|") for name, values, *_ in self.rows() if name == "solver"]
        self.assertEqual(["auto", *re.findall(r"^\| `(\w+)`", table, re.MULTILINE)], choices)

    def test_the_stub_of_the_python_module_has_what_the_command_prints(self):
        keywords = self.run_pfv("settings", "--python").stdout
        self.assertEqual(keywords, KEYWORDS.read_text(),
                         f"out of date: pfv settings --python > {KEYWORDS.relative_to(ROOT)}")

    def test_help_and_messages_name_every_kind_of_boundary(self):
        kinds = re.findall(r"(\w+):", re.search(r"PFV_BOUNDARIES \[==\[(.*?)\]==\]", KEYWORDS.read_text(), re.DOTALL)[1])
        self.assertGreaterEqual(len(kinds), 3)
        text = self.run_pfv("solve", "--help").stdout
        helps = {option: text.split(f"  --{option} ")[1].split("\n  --")[0] for option in ("face", "patch", "region")}
        unknown = self.run_pfv("solve", "--packing", DENSE, *UNIT_BOX, "--face", "zlo:presure=1")
        page = (DOC / "fix_pfv.md").read_text()
        of_fix = re.search(r"\n  boundary = (.*)", page)[1]
        for kind in kinds:
            with self.subTest(kind=kind):
                for option, entry in helps.items():
                    self.assertEqual(kind in entry, option != "region" or kind != "sealed", option)
                self.assert_refused(unknown, kind)
                self.assertRegex(of_fix, rf"\b{kind}\b")
                self.assertRegex(page, rf"\n{kind} NAME")

    def test_the_help_has_each_option_with_its_default(self):
        text = self.run_pfv("solve", "--help").stdout
        for name, _, _, default, _, option, *_ in self.rows():
            if option:
                entry = text.split("  --" + name.replace("_", "-") + " ")[1].split("\n  --")[0]
                self.assertIn(f"(default {default})", " ".join(entry.split()))

    def test_the_help_of_bench_names_what_can_be_chosen(self):
        text = " ".join(self.run_pfv("bench", "--help").stdout.split())
        choices = {name: values.split("\\|") for name, values, *_ in self.rows()}
        for name in ("solver", "ordering", "conductance", "precision"):
            self.assertGreater(len(choices[name]), 1)
            self.assertIn(": " + ", ".join(choices[name]), text)

    def test_what_is_on_or_off_is_said_by_yes_no_or_the_option_alone(self):
        packing = self.write("two.csv", "id,x,y,z,radius,vx,vy,vz\n1,.5,.5,.5,.01,0,0,1\n2,.4,.5,.4,.01,0,0,1\n")
        braked = {words: self.report("--face", "zhi:pressure=0", *words, packing=packing)["counts"]["open_water"]
                  for words in ((), ("--open-water",), ("--open-water", "yes"), ("--open-water", "no"), ("--open-water=no",))}
        self.assertEqual(list(braked.values()), [2, 2, 2, 0, 0])
        geometric = ["solve", "--packing", DENSE, *UNIT_BOX, *THROUGH_FLOW, "--volume-rates", "geometric"]
        for words in (["--torques"], ["--torques", "yes"]):
            self.assert_refused(self.run_pfv(*geometric, *words), "torques go with reciprocal")
        self.assertEqual(self.run_pfv(*geometric, "--torques", "no").returncode, 0)
        for words in (["--torques", "maybe"], ["--torques", "--torques", "no"]):
            self.assert_refused(self.run_pfv(*geometric, *words), "torques")

    def test_a_setting_that_is_not_read_is_refused_at_its_default_too(self):
        grid = ["--model", "darcy_grid", "--cells", "2", "2", "2"]
        for words, parts in ((["--tolerance", "1e-10"], ["supernodal", "no tolerance", "cg"]),
                             (["--solver", "cg", "--precision", "double"], ["cg", "precision", "supernodal"]),
                             ([*grid, "--conductance", "open_throat"], ["darcy_grid", "no conductance law"]),
                             ([*grid, "--torques"], ["darcy_grid", "no torques"]),
                             (["--drag", "di_felice"], ["pfv takes no drag", "darcy_grid"])):
            with self.subTest(words=words):
                result = self.run_pfv("solve", "--packing", DENSE, *UNIT_BOX, *THROUGH_FLOW, *words)
                self.assert_refused(result, *parts)


if __name__ == "__main__":
    unittest.main()

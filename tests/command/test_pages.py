# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual page and the completion of bash, made of what the command says of itself."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = os.environ["PFV_COMMAND"]


def options_of(name):
    text = subprocess.run([COMMAND, name, "--help"], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"^\s+(?:-\w,)?(--[a-z][a-z-]*)", text, re.MULTILINE))


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        subprocess.run(["cmake", f"-DCOMMAND={COMMAND}", "-DVERSION=1.2.3", f"-DFOLDER={cls.folder.name}",
                        "-P", ROOT / "pfvlib/app/pages.cmake"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def complete(self, *words):
        """What bash would offer for the last of the words."""
        program = ('. "$1"; shift; COMP_WORDS=(pfv "$@"); COMP_CWORD=$#; _pfv pfv "${!#}"; '
                   'printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-c", program, "bash", f"{self.folder.name}/pfv.bash", *words],
                              check=True, capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.split())

    def test_subcommands_are_completed(self):
        self.assertEqual(self.complete("so"), {"solve"})
        self.assertLessEqual({"solve", "convert", "selftest", "bench", "time-step", "settings"}, self.complete(""))

    def test_options_are_those_of_the_help(self):
        for name in ("solve", "time-step", "bench"):
            options = options_of(name)
            self.assertGreater(len(options), 5)
            self.assertLessEqual(options, self.complete(name, "--"))
        self.assertEqual(self.complete("bench", "--steps-"), {"--steps-per-network"})

    def test_files_are_left_to_bash(self):
        self.assertEqual(self.complete("solve", "--packing", "grains"), set())

    def test_the_manual_page_has_each_subcommand_and_option(self):
        page = pathlib.Path(self.folder.name, "pfv.1").read_text()
        self.assertTrue(page.startswith('.TH PFV 1 "" "pfv 1.2.3"\n'))
        self.assertIn(".SH PFV TIME-STEP\n", page)
        text = page.replace("\\-", "-")
        for option in options_of("solve"):
            self.assertIn(option, text)
        requests = set(re.findall(r"^\.(\w+)", page, re.MULTILINE))
        self.assertEqual(requests, {"TH", "SH", "B", "nf", "fi"})  # no line of a help text is taken for one


if __name__ == "__main__":
    unittest.main()

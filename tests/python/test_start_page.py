# SPDX-License-Identifier: GPL-3.0-or-later
"""Each command of the front page (doc/start.md), run as it stands there. That of C++, which takes a compiler some ten
seconds, where PFV_LONG is set (./test.sh long)."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["PFV_BUILD"])
SECTION = re.compile(r"^## (.*?)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
BLOCK = re.compile(r"(?:as `([\w.]+)`[^\n]*\n\n)?```(\w*)\n(.*?)```", re.DOTALL)


class StartPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sections = dict(SECTION.findall((ROOT / "doc/start.md").read_text()))

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "tests").symlink_to(ROOT / "tests")

    def follow(self, section, **variables):
        """Writes the files of a section and runs its commands; what they print."""
        printed = ""
        for name, language, text in BLOCK.findall(self.sections[section]):
            if name:
                (self.folder / name).write_text(text)
            if language == "sh":
                printed += self.run_in_bash(text, variables)
        return printed

    def run_in_bash(self, text, variables):
        environment = dict(os.environ, PATH=f"{BUILD}/bin:{os.environ['PATH']}", **variables)
        done = subprocess.run(["bash", "-euc", text], cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr)
        return done.stdout

    def assert_picture(self, name):
        self.assertEqual((self.folder / name).read_bytes()[:4], b"\x89PNG")

    def test_command(self):
        self.assertRegex(self.follow("The command"), r"permeability 1\.17\d*e-05 m2")
        self.assert_picture("pores.png")
        self.assertEqual(len((self.folder / "forces.csv").read_text().splitlines()), 501)

    def test_python(self):
        self.follow("Python")
        self.assertRegex(self.run_in_bash("/usr/bin/python3 first.py", {}), r"permeability 1\.17\d*e-05 m2")

    @unittest.skipUnless((BUILD / "bin/liggghts-pfv").exists(), "liggghts-pfv is not built")
    def test_liggghts(self):
        self.assertNotIn("WARNING", self.follow("LIGGGHTS"))
        self.assert_picture("history.png")

    @unittest.skipUnless("PFV_LONG" in os.environ, "behind ./test.sh long")
    def test_cpp(self):
        prefix = self.folder / "pfv"
        subprocess.run(["cmake", "--install", BUILD, "--component", "development", "--prefix", prefix], check=True,
                       stdout=subprocess.DEVNULL)
        printed = self.follow("C++", PKG_CONFIG_PATH=str(prefix / "lib/pkgconfig"))
        self.assertRegex(printed, r"permeability 1\.17\d*e-05 m2, force on all grains 1 N")


if __name__ == "__main__":
    unittest.main()

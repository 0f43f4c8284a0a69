#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`pip install --no-build-isolation .` works without a net in a virtual environment that sees Debian's packages, and
what it installs passes the module's tests. Compiles the library: behind `./test.sh long`."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import venv

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


class PipInstall(unittest.TestCase):
    def test_what_pip_installs_passes_the_tests(self):
        with tempfile.TemporaryDirectory() as folder:
            venv.create(folder, system_site_packages=True, with_pip=True)
            python = pathlib.Path(folder, "bin/python")
            subprocess.run([python, "-m", "pip", "install", "--no-index", "--no-build-isolation", ROOT], check=True)
            environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
            where = subprocess.run([python, "-c", "import pfv; print(pfv.__file__)"], check=True, env=environment,
                                   cwd=folder, stdout=subprocess.PIPE, text=True).stdout
            self.assertTrue(where.startswith(folder), where)
            for test in ("permeability", "flow", "arrays", "stubs"):
                subprocess.run([python, "-B", HERE / f"test_{test}.py"], check=True, env=environment, cwd=folder)


if __name__ == "__main__":
    unittest.main()

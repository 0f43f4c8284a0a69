# SPDX-License-Identifier: GPL-3.0-or-later
"""CMake installs the module where a Python of that prefix looks for it."""
import os
import pathlib
import subprocess
import sys
import sysconfig
import tempfile
import unittest


class Install(unittest.TestCase):
    def test_cmake_installs_a_module_that_works_without_the_build(self):
        with tempfile.TemporaryDirectory() as prefix:
            subprocess.run(["cmake", "--install", os.environ["PFV_BUILD"], "--component", "python", "--prefix", prefix],
                           check=True, stdout=subprocess.DEVNULL)
            folder = pathlib.Path(sysconfig.get_path("platlib"))
            installed = pathlib.Path(prefix, *folder.parts[folder.parts.index("lib"):])
            program = "import pfv; print(pfv.__file__, pfv.permeability([[0.5] * 3], [0.4], [[0, 1]] * 3))"
            done = subprocess.run([sys.executable, "-c", program], check=True, stdout=subprocess.PIPE, text=True,
                                  env={**os.environ, "PYTHONPATH": str(installed)}, cwd=prefix)
            file, permeability = done.stdout.split()
            self.assertEqual(pathlib.Path(file).parent, installed / "pfv")
            self.assertGreater(float(permeability), 0)
            self.assertTrue((installed / "pfv/py.typed").exists())


if __name__ == "__main__":
    unittest.main()

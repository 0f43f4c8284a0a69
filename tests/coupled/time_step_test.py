# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit that `pfv time-step` finds for a dump is the one that the fix prints."""
import json
import subprocess
import unittest

from coupled import BIN, EDGE, dump, faces, write_data
from plates import square, write_plate
from settled import SettledTest

MASS = 0.2  # kg, of the lid
LID = (f"fix lid all mesh/surface/stress/servo file lid.stl type 1 move 0 0 {EDGE} "
       f"com {EDGE / 2} {EDGE / 2} {EDGE} ctrlPV force axis 0 0 -1 target_val 20.0 "
       f"vel_max 5.0 kp 0 ki {20.0 / (5.0 * MASS)!r}\n"
       "fix plates all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes lid\n")


class TimeStep(SettledTest):
    def both(self, before, boundaries, *words):
        """(limit that the fix gives, limit of the command)"""
        flow = f"fix flow all pfv viscosity 50 density 0 {faces(**boundaries)}\n"
        printed = self.thermo("include in.packing\n" + before + flow + dump("d.dump") +
                              "thermo_style custom step f_flow[6]\n"
                              "thermo_modify norm no format float %.15g\nrun 0\n")[0]["flow[6]"]
        call = [str(BIN / "pfv"), "time-step", "--packing", "d.dump", "--box",
                *[repr(v) for v in (0.0, EDGE) * 3], "--viscosity", "50", "--grain-density", "2600",
                "--ids", "1", "--report", "limits.json", *words]
        subprocess.run(call, cwd=self.folder, check=True, capture_output=True)
        return printed, json.loads((self.folder / "limits.json").read_text())["coupling_limit"]

    def test_grains_between_faces_that_do_not_yield(self):
        printed, found = self.both("", {"zlo": "pressure 0", "zhi": "pressure 0"}, "--face",
                                   "zlo:pressure=0", "--face", "zhi:pressure=0")
        self.assertAlmostEqual(found / printed, 1.0, delta=1e-9)

    def test_grains_under_a_lid_of_finite_mass(self):
        write_plate(self.folder / "lid.stl", square(EDGE, 0.0))
        printed, found = self.both(LID, {"zlo": "pressure 0", "zhi": "mesh lid sealed"}, "--face",
                                   "zlo:pressure=0", "--piston", f"zhi:{MASS!r}")
        self.assertAlmostEqual(found / printed, 1.0, delta=1e-9)
        free, _ = self.both("", {"zlo": "pressure 0"}, "--face", "zlo:pressure=0")
        self.assertLess(printed, 0.5 * free)


if __name__ == "__main__":
    unittest.main()

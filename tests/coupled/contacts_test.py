# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts from 15 to 1e12 N/m around a flow: what springs hold at the start is all that grains can
gain, and mass and forces balance at each step."""
import json
import math
import os
import unittest

from coupled import EDGE, FLOW, HERE, CoupledTest, packing, read_thermo, write_data
from settled import WALLS

DENSITY, GRAVITY = 2600.0, 9.81  # kg/m3, m/s2
WEIGHT = f"fix g all gravity {GRAVITY} vector 0 0 -1\n"
THERMO = ("thermo_style custom step atoms ke f_flow[3] f_flow[4] f_flow[5] f_flow[8]\n"
          "thermo_modify norm no format float %.15g\nthermo 20\n")


def mass(grain):
    return DENSITY * 4 / 3 * math.pi * grain[4]**3


def overlaps(grains):
    """Depths (m) between grains, and between them and the six walls."""
    for i, (_, *centre, radius) in enumerate(grains):
        for _, *other, reach in grains[:i]:
            yield max(0.0, radius + reach - math.dist(centre, other))
        for x in centre:
            yield max(0.0, radius - x)
            yield max(0.0, radius - (EDGE - x))


class Contacts(CoupledTest):
    def script(self, stiffness, swelling, words, steps):
        """A run from overlaps, at a twentieth of the time of the fastest contact; and what grains can
        gain from springs and fall, J."""
        grains = [(*grain[:4], swelling * grain[4]) for grain in packing(4)]
        write_data(self.folder, grains, density=DENSITY)
        step = 0.05 * math.sqrt(min(map(mass, grains)) / stiffness)
        head = (HERE / "in.packing").read_text()
        head = head.replace("1.0e4", repr(stiffness)).replace("5.0e3", repr(0.5 * stiffness))
        springs = sum(0.5 * stiffness * depth**2 for depth in overlaps(grains))
        fall = sum(mass(grain) * GRAVITY * EDGE for grain in grains)
        return (head + WALLS + WEIGHT + f"fix flow all pfv {FLOW} {words}\ntimestep {step!r}\n" +
                THERMO + f"run {steps}\n"), springs + fall

    def run_checked(self, script, energy):
        self.liggghts(script)
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        for row in rows:
            self.assertLess(abs(row["flow[3]"]), 1e-12)  # mass
            self.assertLess(row["flow[4]"], 1e-14)  # forces
            self.assertLess(row["KinEng"], energy)
        self.assertGreater(rows[-1]["flow[5]"], 0)  # networks were replaced
        if "PFV_RECORD" in os.environ:  # for doc/extremes.py
            worst = {"mass": max(abs(row["flow[3]"]) for row in rows),
                     "force": max(row["flow[4]"] for row in rows)}
            with open(os.environ["PFV_RECORD"], "a", encoding="utf-8") as record:
                record.write(json.dumps(worst) + "\n")
        return rows

    def test_from_1e3_to_1e12_newton_per_metre(self):
        for stiffness in (1e3, 1e6, 1e9, 1e12):
            with self.subTest(stiffness=stiffness):
                script, energy = self.script(stiffness, 1.3, "", 200)
                rows = self.run_checked(script, energy)
                # what the water leaves of the springs' energy between two rows
                self.assertGreater(max(row["KinEng"] for row in rows), 0.002 * energy)
                self.assertEqual({row["flow[8]"] for row in rows}, {0.0})
                self.assertEqual({row["Atoms"] for row in rows}, {64.0})

    def test_so_soft_that_grains_close_pores(self):
        """The weight presses grains into each other and through the floor. Water that is cut off in a pore has
        nowhere to go: an incompressible fluid names the pore, a compressible one goes on. At 14 N/m and below
        grains vanish within others, and energy is gained where each step has another network."""
        self.refused(self.script(16.0, 1.0, "", 1200)[0], "cut off from every pressure",
                     "bulk modulus", "overlaps")
        self.run_checked(*self.script(18.0, 1.0, "bulk_modulus 1e6", 400))


if __name__ == "__main__":
    unittest.main()

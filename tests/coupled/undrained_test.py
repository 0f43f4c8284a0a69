# SPDX-License-Identifier: GPL-3.0-or-later
"""Undrained oedometer: a lid compresses a sealed box of grains and compressible fluid.

Grains are rigid (Biot's coefficient is 1), so that p = K_f / n times the strain of the box:
    undrained modulus  E_u = E_oed + K_f / n
    Skempton's B       dp / d(total stress) = 1 / (1 + n E_oed / K_f)   (uniaxial strain)
E_oed is that of the same grains without fluid."""
import math
import unittest

from coupled import EDGE, FACES, CoupledTest, faces, read_thermo, write_data
from plates import square, write_plate

N = 4  # grains along an edge, a simple cubic lattice
RADIUS = EDGE / (2 * N) * 1.001
SPACING = (EDGE + 2 * RADIUS) / (N + 1)  # all contacts, those with walls too, overlap alike
POROSITY = 1 - N**3 * 4 / 3 * math.pi * RADIUS**3 / EDGE**3
STRAIN = 1e-4
STEPS, STEP = 2000, 1e-5
WALLS = "".join(
    f"fix w{face} all wall/gran model hooke/stiffness tangential history primitive type 1 "
    f"{face[0]}plane {EDGE if face.endswith('hi') else 0.0}\n" for face in FACES if face != "zhi")
LID = ("fix lid all mesh/surface/stress file lid.stl type 1\n"
       "fix wlid all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes lid\n")
LOAD = (f"timestep {STEP}\nrun 1\n"
        f"fix down all move/mesh mesh lid linear 0 0 {-STRAIN * EDGE / (STEPS * STEP)!r}\n"
        f"run {STEPS}\nunfix down\nrun 1000\n")
SEALED = faces(zhi="mesh lid sealed")


class Undrained(CoupledTest):
    def setUp(self):
        super().setUp()
        places = [SPACING * (i + 1) - RADIUS for i in range(N)]
        write_data(self.folder, [(1 + i + N * (j + N * k), places[i], places[j], places[k], RADIUS)
                                 for i in range(N) for j in range(N) for k in range(N)])
        write_plate(self.folder / "lid.stl", square(EDGE, EDGE))

    def compressed(self, fix=""):
        """(total stress, mean pressure, networks) that the strain adds."""
        flow = " f_flow[7] f_flow[5]" if fix else ""
        self.liggghts("include in.packing\n" + WALLS + LID + fix +
                      f"thermo_style custom step f_lid[3]{flow}\n"
                      "thermo_modify norm no format float %.15g\n" + LOAD)
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        first, last = rows[1], rows[-1]
        return ((last["lid[3]"] - first["lid[3]"]) / EDGE**2,
                last.get("flow[7]", 0.0) - first.get("flow[7]", 0.0), last.get("flow[5]", 0.0))

    def test_modulus_and_skemptons_b_for_soft_to_stiff_fluids(self):
        drained, _, _ = self.compressed()
        oedometric = drained / STRAIN
        for bulk_modulus in (1e5, 1e6, 1e7, 1e8, 1e9):
            words = f"fix flow all pfv viscosity 0.01 {SEALED} bulk_modulus {bulk_modulus!r}\n"
            stress, pressure, _ = self.compressed(words)
            expected = 1 / (1 + POROSITY * oedometric / bulk_modulus)
            self.assertAlmostEqual(pressure / stress / expected, 1.0, delta=0.02)
            undrained = oedometric + bulk_modulus / POROSITY
            self.assertAlmostEqual(stress / STRAIN / undrained, 1.0, delta=0.02)

    def test_a_surface_that_follows_the_grains_pulls_no_water(self):
        """`extent` moves with the outermost grains and lets the water beyond it come along, whatever its modulus."""
        pressures = []
        for modulus in ("", "bulk_modulus 1e9"):
            self.liggghts("include in.packing\n"
                          "velocity all ramp vz 0 0.5 z 0 0.1 units box\n"
                          f"fix flow all pfv viscosity 0.01 {faces(zhi='extent pressure 0')} couple_every 1 {modulus}\n"
                          "thermo_style custom step f_flow[7] f_flow[5]\nthermo_modify norm no format float %.15g\n"
                          "thermo 1\nrun 200\n")
            rows = read_thermo((self.folder / "log.liggghts").read_text())
            self.assertGreater(rows[-1]["flow[5]"], 2)
            pressures.append([row["flow[7]"] for row in rows[10:]])
        scale = max(map(abs, pressures[0]))
        for without, stiff in zip(*pressures):
            self.assertLess(abs(stiff - without), 0.02 * scale)

    def test_new_networks_on_the_way_keep_the_pressure(self):
        words = f"fix flow all pfv viscosity 0.01 {SEALED} bulk_modulus 1e7\n"
        _, kept, none = self.compressed(words)
        _, renewed, many = self.compressed(words.replace("\n", " retriangulate 1e-5\n"))
        self.assertEqual(none, 0)
        self.assertGreater(many, 5)
        # V^f of a new network is that of the compressed pores: STRAIN / n of the pressure
        self.assertAlmostEqual(renewed / kept, 1.0, delta=2 * STRAIN / POROSITY)
        # V^f (1 + p / K_f), the mass, is that of the beginning
        self.assertAlmostEqual(renewed / (1e7 * STRAIN / (POROSITY - STRAIN)), 1.0, delta=1e-6)

    def under_a_sudden_load(self, fluid):
        """Pressure at the lid, a piston of 0.5 kg, in steps of 1 ms; drained below."""
        lid = ("fix lid all mesh/surface/stress/servo file lid.stl type 1 "
               f"com {EDGE / 2} {EDGE / 2} {EDGE} ctrlPV force axis 0 0 -1 target_val 10.0 "
               "vel_max 5.0 kp 0 ki 4.0\n" + LID[LID.index("fix wlid"):])
        flow = (f"fix flow all pfv viscosity 100 {fluid} coupling implicit "
                + faces(zlo="pressure 0", zhi="mesh lid sealed") +
                f" sensors 10 top.csv 0.03 0.03 {0.995 * EDGE}\n")
        self.liggghts("include in.packing\n" + WALLS + lid + flow + "timestep 1e-4\nrun 500\n")
        rows = (self.folder / "top.csv").read_text().splitlines()[1:]
        return [float(row.split(",")[1]) for row in rows]

    def test_consolidation_goes_over_into_that_with_an_incompressible_fluid(self):
        """After 5 ms; the difference goes with 1/K_f (0.35 % and 0.0063 % of the load were measured)."""
        limit = self.under_a_sudden_load("")[5:]
        for bulk_modulus, share in ((1e8, 4e-3), (1e10, 8e-5)):
            pressures = self.under_a_sudden_load(f"bulk_modulus {bulk_modulus!r}")[5:]
            worst = max(abs(a - b) for a, b in zip(pressures, limit)) / (10.0 / EDGE**2)
            self.assertLess(worst, share)


if __name__ == "__main__":
    unittest.main()

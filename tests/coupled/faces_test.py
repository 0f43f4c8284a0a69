# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the faces of the flow box come from: planes, walls, moving meshes, the grains."""
import math
import unittest

from coupled import EDGE, FLOW, CoupledTest, dump, faces, forces, largest_difference, packing
from coupled import read_dump, read_thermo, write_data
from plates import write_plate

MODEL = "wall/gran model hooke/stiffness tangential history"
HEAD = "include in.packing\n"
FROZEN = HEAD + "unfix integr\n"
THERMO = ("thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[4] f_flow[5]\n"
          "thermo_modify norm no format float %.15g\nthermo 1\n")
LID = ("fix lid all mesh/surface/stress file lid.stl type 1\n"
       f"fix lidw all {MODEL} mesh n_meshes 1 meshes lid\n")
SPEED = 0.001  # of the piston, m/s
DOWN = f"fix down all move/mesh mesh lid linear 0 0 {-SPEED}\n"


def piston(words):
    return ("fix flow all pfv viscosity 0.01 " +
            faces(zlo="no_slip sealed", zhi=f"mesh lid {words}") + "\n")


class Faces(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing())
        # larger than the flow box, as lids are
        write_plate(self.folder / "lid.stl", [(-0.01, -0.01, EDGE), (EDGE + 0.01, -0.01, EDGE),
                                              (EDGE + 0.01, EDGE + 0.01, EDGE),
                                              (-0.01, EDGE + 0.01, EDGE)])

    def log(self):
        return read_thermo((self.folder / "log.liggghts").read_text())

    def test_walls_give_the_forces_of_planes(self):
        walls = "".join(f"fix w{a}{k} all {MODEL} primitive type 1 {a}plane {k * EDGE}\n"
                        for a in "xyz" for k in (0, 1))
        by_wall = faces(xlo="wall wx0", xhi="wall wx1", ylo="wall wy0", yhi="wall wy1",
                        zlo="wall wz0 pressure 10", zhi="wall wz1 pressure 0")
        self.liggghts(HEAD + f"fix flow all pfv {FLOW}\n" + dump("planes.dump") + "run 0\n")
        self.liggghts(HEAD + walls + f"fix flow all pfv viscosity 0.01 {by_wall}\n" +
                      dump("walls.dump") + "run 0\n")
        self.assertEqual((self.folder / "planes.dump").read_bytes(),
                         (self.folder / "walls.dump").read_bytes())

    def test_still_mesh_gives_the_forces_of_a_plane(self):
        self.liggghts(HEAD + f"fix flow all pfv {FLOW}\n" + dump("planes.dump") + "run 0\n")
        mesh = FLOW.replace(f"face zhi plane {EDGE}", "face zhi mesh lid")
        self.liggghts(HEAD + LID + f"fix flow all pfv {mesh}\n" + dump("mesh.dump") + "run 0\n")
        planes, meshes = (forces(read_dump(self.folder / f"{n}.dump")[0])
                          for n in ("planes", "mesh"))
        # STL coordinates pass through LIGGGHTS' own reader
        self.assertLess(largest_difference(planes, meshes), 1e-12)

    def test_drained_piston_expels_its_volume_rate(self):
        """Through the face of a piston at zero pressure flows what the piston displaces; grains at
        rest add nothing (method: out = sum over its pores of inflow - dV/dt)."""
        self.liggghts(FROZEN + LID + DOWN +
                      piston("pressure 0") + THERMO + "run 3\n")
        for row in self.log()[1:]:
            self.assertAlmostEqual(row["flow[2]"] / (SPEED * EDGE**2), 1.0, delta=1e-9)
            self.assertLess(abs(row["flow[3]"]), 1e-9)
            self.assertLess(row["flow[4]"], 1e-9)

    def top_forces(self, move, words=""):
        """Forces on the upper layer of grains at rest below a lid that moves in its own plane."""
        self.liggghts(FROZEN + LID + f"fix glide all move/mesh mesh lid {move}\n" +
                      "fix flow all pfv viscosity 0.01 couple_every 1 " +
                      faces(zlo="no_slip pressure 0", zhi=f"mesh lid {words} sealed") + "\n" +
                      dump("d.dump") + "run 2\n")
        rows = read_dump(self.folder / "d.dump")[2]
        return {n: (row[:3], row[7:10]) for n, row in rows.items() if row[2] > 0.8 * EDGE}

    def test_a_lid_that_slides_takes_the_fluid_along(self):
        """In a closed box the fluid piles up before the grains in front: they are pushed back."""
        along, twice = (sum(force[0] for _, force in self.top_forces(f"linear {v} 0 0").values())
                        for v in (0.1, 0.2))
        self.assertLess(along, 0.0)
        self.assertAlmostEqual(twice / along, 2.0, delta=1e-6)
        free = self.top_forces("linear 0.1 0 0", "symmetry")
        self.assertEqual({tuple(force) for _, force in free.values()}, {(0.0, 0.0, 0.0)})

    def test_a_lid_that_turns_takes_the_fluid_round(self):
        def moment(period):
            turn = f"rotate origin {EDGE / 2} {EDGE / 2} 0 axis 0 0 1 period {period}"
            return sum((x[0] - EDGE / 2) * force[1] - (x[1] - EDGE / 2) * force[0]
                       for x, force in self.top_forces(turn).values())

        self.assertNotEqual(moment(1.0), 0.0)
        self.assertAlmostEqual(moment(1.0) / moment(-1.0), -1.0, delta=1e-3)
        self.assertAlmostEqual(moment(0.5) / moment(1.0), 2.0, delta=1e-3)

    def test_flow_every_n_steps_takes_the_displacement_of_the_mesh(self):
        """A lid that swings as A sin(2 pi t / T): its velocity changes between flow steps, and what
        leaves is what it has displaced since the last one. LIGGGHTS moves it in each step by the
        velocity of the step's end."""
        amplitude, period = 1e-7, 32e-5
        wiggle = ("fix down all move/mesh mesh lid wiggle "
                  f"amplitude 0 0 {-amplitude} period {period}\n")
        self.liggghts(FROZEN + LID + wiggle + piston("pressure 0").rstrip("\n") +
                      " couple_every 4\n" + THERMO + "run 8\n")
        rows, turn = self.log(), 2 * math.pi / 32
        for first in (1, 5):
            moved = sum(amplitude * turn * math.cos(turn * k) for k in range(first, first + 4))
            expected = moved / 4e-5 * EDGE**2
            # displacements of 1e-8 m at 0.1 m are known to 1e-9 of themselves
            self.assertAlmostEqual(rows[first + 3]["flow[2]"] / expected, 1.0, delta=1e-7)

    def test_sealed_piston_feels_the_fluid(self):
        """What the lid's stress module reports is the force of the fluid on that face."""
        flow = ("fix flow all pfv viscosity 0.01 " +
                faces(zlo="pressure 0", zhi="mesh lid no_slip sealed") + "\n")
        self.liggghts(FROZEN + LID + DOWN + flow +
                      "thermo_style custom step f_lid[1] f_lid[2] f_lid[3]\n"
                      "thermo_modify norm no format float %.15g\nthermo 1\n" + dump("d.dump") +
                      "run 1\n")
        row = self.log()[-1]
        # the network is that of the run's setup, when the lid was at the top of the box
        report, _ = self.pfv_solve("d.dump", "--face", "zlo:pressure=0", "--face",
                                   f"zhi:velocity={-SPEED}")
        face = report["faces"]["zhi"]
        expected = [p + v for p, v in zip(face["force_pressure"], face["force_viscous"])]
        self.assertGreater(expected[2], 0.0)
        for k in range(3):
            self.assertAlmostEqual(row[f"lid[{k + 1}]"], expected[k], delta=1e-9 * expected[2])

    def test_servo_with_integral_gain_is_a_piston_that_the_fluid_carries(self):
        """The servo balances its target with the fluid's pressure alone: no grain touches it. As a
        mass m = target/(vel_max ki) on the dashpot F = -C v it relaxes to v = -target/C."""
        target, mass, vel_max = 0.01, 1.0e-6, 1.0
        ki = target / (vel_max * mass)
        servo = (f"fix lid all mesh/surface/stress/servo file lid.stl type 1 com 0.05 0.05 {EDGE} "
                 f"ctrlPV force axis 0. 0. -1. target_val {target} vel_max {vel_max} "
                 f"kp 0.0 ki {ki}\n"
                 f"fix lidw all {MODEL} mesh n_meshes 1 meshes lid\n")
        # the dashpot is soft enough for this mass and step with the papers' law, not with the default
        flow = ("fix flow all pfv viscosity 1.0 conductance hydraulic_radius " +
                faces(zlo="pressure 0", zhi="mesh lid symmetry sealed") + "\n")
        self.liggghts(FROZEN + "timestep 1.0e-8\n" + servo + flow +
                      "thermo_style custom step f_lid[3] f_lid[12] f_flow[2]\n"
                      "thermo_modify norm no format float %.15g\nthermo 1000\nrun 3000\n")
        row = self.log()[-1]
        self.assertAlmostEqual(row["lid[3]"] / target, 1.0, delta=1e-6)
        self.assertGreater(row["flow[2]"], 0.0)

    def test_extent_follows_the_grains(self):
        """Faces at the extremes of the grains give the forces of planes put there."""
        grains = packing()
        low = min(z - r for _, _, _, z, r in grains)
        high = max(z + r for _, _, _, z, r in grains)
        sides = {face: "sealed" for face in ("xlo", "xhi", "ylo", "yhi")}
        extent = faces(zlo="extent pressure 10", zhi="extent pressure 0", **sides)
        planes = faces(zlo=f"plane {low!r} pressure 10", zhi=f"plane {high!r} pressure 0", **sides)
        for name, words in (("extent", extent), ("planes", planes)):
            self.liggghts(HEAD + f"fix flow all pfv viscosity 0.01 {words}\n" +
                          dump(f"{name}.dump") + "run 0\n")
        one, other = (forces(read_dump(self.folder / f"{n}.dump")[0]) for n in ("extent", "planes"))
        self.assertLess(largest_difference(one, other), 1e-12)

    def test_extent_moves_with_the_grains(self):
        """A bed that rises takes its faces along whenever the network is built anew."""
        write_data(self.folder, packing(), {grain[0]: [0.0, 0.0, 0.5] for grain in packing()})
        flow = faces(zlo="extent pressure 10", zhi="extent pressure 0") + " retriangulate 1e-6"
        self.liggghts(FROZEN + "fix integr all move linear 0 0 0.5\n"
                      f"fix flow all pfv viscosity 0.01 {flow}\n" + dump("d.dump") + "run 20\n")
        rows = read_dump(self.folder / "d.dump")[20]
        low = min(row[2] - row[3] for row in rows.values())
        high = max(row[2] + row[3] for row in rows.values())
        self.assertAlmostEqual(low - min(z - r for *_, z, r in packing()), 20 * 1e-5 * 0.5,
                               delta=1e-12)
        expected = self.pfv_forces("d.dump", "--face", "zlo:pressure=10", "--face",
                                   "zhi:pressure=0", box=(0.0, EDGE, 0.0, EDGE, low, high))
        self.assertLess(largest_difference(forces(rows), expected), 1e-10)

    def test_cosine_pressure_along_a_face(self):
        """A pressure that varies along the lid drives no mean flow through a deep bed, but pushes
        the grains below its crest down and those below its trough up."""
        flow = "viscosity 0.01 " + faces(zhi=f"plane {EDGE} pressure 0")
        self.liggghts(HEAD + f"fix flow all pfv {flow} pressure_profile zhi cosine x 0 v_amplitude "
                      f"{EDGE}\n" .replace("v_amplitude", "100") + dump("d.dump") + "run 0\n")
        rows = read_dump(self.folder / "d.dump")[0]
        step = EDGE / 5
        crest = [row[9] for row in rows.values() if row[2] > 4 * step and row[0] < step]
        trough = [row[9] for row in rows.values() if row[2] > 4 * step and row[0] > 4 * step]
        self.assertLess(max(crest), 0.0)
        self.assertGreater(min(trough), 0.0)

    def test_cosine_amplitude_from_a_variable(self):
        flow = "viscosity 0.01 " + faces(zhi=f"plane {EDGE} pressure 0")
        script = (FROZEN + "variable a equal 100*(1+step)\nfix flow all pfv " + flow +
                  f" pressure_profile zhi cosine x 0 v_a {EDGE}\n" + dump("d.dump") + "run 1\n")
        self.liggghts(script)
        steps = read_dump(self.folder / "d.dump")
        doubled = {n: [2 * v for v in f] for n, f in forces(steps[0]).items()}
        self.assertLess(largest_difference(forces(steps[1]), doubled), 1e-13)

    def test_patch_is_the_only_outlet(self):
        """A patch of zero pressure on a sealed lid: fluid put in by a flux leaves through it."""
        flow = ("viscosity 0.01 " + faces(zlo="flux 1e-6") +
                " patch zhi 0.04 0.06 0.04 0.06 pressure 0")
        self.liggghts(HEAD + f"fix flow all pfv {flow}\n" + THERMO + "run 0\n")
        row = self.log()[0]
        self.assertAlmostEqual(row["flow[1]"] / 1e-6, 1.0, delta=1e-9)
        self.assertAlmostEqual(row["flow[2]"] / 1e-6, 1.0, delta=1e-9)

    def test_what_a_point_brings_in_rises_to_the_lid(self):
        """A flux that follows a variable, at a place inside; planes above it carry it all."""
        flow = ("viscosity 0.01 " + faces(zhi="pressure 0") +
                " point 0.05 0.05 0.02 flux v_q flux_profile z 10 1 planes.csv")
        self.liggghts(FROZEN + f"variable q equal 1e-6*(1+step)\nfix flow all pfv {flow}\n" +
                      THERMO + "run 2\n")
        for step, row in enumerate(self.log()):
            self.assertAlmostEqual(row["flow[1]"] / (1e-6 * (1 + step)), 1.0, delta=1e-9)
            self.assertAlmostEqual(row["flow[2]"] / (1e-6 * (1 + step)), 1.0, delta=1e-9)
        header, *rows = (self.folder / "planes.csv").read_text().splitlines()
        self.assertTrue(header.startswith("time,0.05,0.15"))
        for step, row in enumerate(rows):
            flows = [float(word) / (1e-6 * (1 + step)) for word in row.split(",")[1:]]
            self.assertAlmostEqual(flows[0], 0.0, delta=1e-9)
            for flow in flows[4:]:
                self.assertAlmostEqual(flow, 1.0, delta=1e-9)

    def test_regions_that_mean_nothing_are_refused(self):
        for words, part in (("point 0.05 0.05 pressure 1", "coordinate"),
                            ("region 0 1 0 1 0 1 sealed", "pressure P or flux Q"),
                            ("point 0.05 0.05 7 flux 1", "outside the box"),
                            ("model darcy_grid 2 2 2 point 0.05 0.05 0.05 flux 1", "regions"),
                            ("model darcy_grid 2 2 2 flux_profile z 3 1 f.csv", "flux_profile")):
            self.refused(FROZEN + "fix flow all pfv viscosity 0.01 " + faces(zhi="pressure 0") +
                         f" {words}\nrun 1\n", part)

    def test_mesh_that_tilts_in_the_run_stops_it(self):
        self.refused(FROZEN + LID +
                     "fix turn all move/mesh mesh lid rotate origin 0. 0. 0. axis 0. 1. 0. "
                     "period 1e-3\n" +
                     piston("pressure 0") + "run 10\n", "zhi", "'lid'", "z axis")


if __name__ == "__main__":
    unittest.main()

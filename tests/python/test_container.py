# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv.Container: what `pfv solve --container` has, and faces that move."""
import copy
import json
import math
import unittest

import numpy as np
import pfv
from case import CommandCase, DATA, VISCOSITY, grains, without_times

CYLINDER = {"planes": [{"name": "bottom", "inward_normal": [0, 0, 1], "offset": 0},
                       {"name": "top", "inward_normal": [0, 0, -2], "offset": -1.5}],
            "cylinders": [{"name": "shell", "axis": [0, 0, 1], "point": [0, 0, 0], "radius": 0.5}]}
CUBE = {"planes": [{"name": side + end, "inward_normal": [float(k == axis) * sign for k in range(3)],
                    "offset": 0.0 if sign > 0 else -1.0}
                   for axis, side in enumerate("xyz") for end, sign in (("lo", 1), ("hi", -1))]}
BED = DATA / "cyl_equal_packing.csv"


def driven(shape=None, **conditions):
    return pfv.Container(shape or CYLINDER, **conditions).face("bottom", pressure=1.0).face("top", pressure=0.0)


class Command(CommandCase):
    def solve_in(self, shape, packing, *words):
        (self.folder / "cell.json").write_text(json.dumps(shape))
        return self.solve(packing, "--container", "cell.json", *words, box=None)

    def test_a_cylinder_is_that_of_the_command(self):
        report, forces = self.solve_in(CYLINDER, BED, "--face", "bottom:pressure=1", "--face", "top:pressure=0",
                                       "--face", "shell:spin=3", "--wall", "symmetry", "--face", "shell:wall=no_slip")
        bed = grains(BED.name)
        for shape in (CYLINDER, self.folder / "cell.json"):
            cell = driven(shape, wall="symmetry").face("shell", wall="no_slip", spin=3.0)
            flow = pfv.Flow(cell, viscosity=VISCOSITY, split_forces=True)
            found = flow.evaluate(bed.positions, bed.radii, ids=bed.ids)
            np.testing.assert_array_equal(found, forces[:, 1:4])
            own = without_times(flow.report())
            for key in ("permeability", "permeability_error", "faces", "porosity", "pore_volume", "force_balance_error"):
                self.assertEqual(own[key], report[key], key)
            self.assertEqual(flow.network().walls, ["bottom", "top", "shell"])
            self.assertEqual(set(flow.faces()), {"bottom", "top", "shell"})

    def test_a_cube_turned_with_patches_and_a_moving_face(self):
        turn, _ = np.linalg.qr(np.array([[1.0, 2, 0.5], [-1, 1, 0.3], [0.2, -0.4, 1]]))
        shape = copy.deepcopy(CUBE)
        for plane in shape["planes"]:
            plane["inward_normal"] = (turn @ plane["inward_normal"]).tolist()
        bed = grains()
        rows = np.column_stack([bed.ids, bed.positions @ turn.T, bed.radii])
        np.savetxt(self.folder / "turned.csv", rows, delimiter=",", header="id,x,y,z,radius", comments="", fmt="%.17g")
        middle = turn @ [0.5, 0.5, 1.0]
        block = [[at - 0.3, at + 0.3] for at in middle]
        report, forces = self.solve_in(
            shape, self.folder / "turned.csv", "--face", "zlo:pressure=1", "--face", "xhi:velocity=0.25",
            "--patch", "zhi:" + ",".join(repr(float(bound)) for interval in block for bound in interval) + ":pressure=0")
        cell = pfv.Container(shape).face("zlo", pressure=1).face("xhi", velocity=0.25).patch("zhi", block, pressure=0)
        flow = pfv.Flow(cell, viscosity=VISCOSITY)
        bed = pfv.read_packing(self.folder / "turned.csv")
        np.testing.assert_array_equal(flow.evaluate(bed.positions, bed.radii), forces[:, 1:4])
        self.assertEqual(flow.faces()["zhi"]["flux"], report["faces"]["zhi"]["flux"])
        self.assertLess(flow.faces()["zhi"]["flux"], -1e-9)

    def test_its_walls_are_drawn_as_the_command_does(self):
        (self.folder / "cell.json").write_text(json.dumps(CYLINDER))
        self.solve(BED, "--container", "cell.json", "--face", "bottom:pressure=1", "--face", "top:pressure=0",
                   "--vtk", "flow.vtu", box=None)
        bed, flow = grains(BED.name), pfv.Flow(driven(), viscosity=VISCOSITY)
        flow.evaluate(bed.positions, bed.radii)
        flow.write_fields(self.folder / "own.vtu")
        self.assertEqual((self.folder / "own_walls.vtu").read_bytes(), (self.folder / "flow_walls.vtu").read_bytes())


class Container(unittest.TestCase):
    def test_its_measures(self):
        cell = driven(wall="symmetry")
        self.assertAlmostEqual(cell.volume, math.pi * 0.25 * 0.75, 14)
        self.assertAlmostEqual(cell.area("shell"), math.pi * 0.75, 14)
        np.testing.assert_allclose([cell.lower, cell.upper], [[-0.5, -0.5, 0], [0.5, 0.5, 0.75]], atol=1e-15)
        faces = cell.faces
        self.assertEqual((faces["bottom"]["pressure"], faces["shell"]["sealed"]), (1.0, True))
        self.assertEqual((faces["shell"]["radius"], faces["top"]["offset"], faces["top"]["wall"]), (0.5, -0.75, "symmetry"))
        self.assertEqual(repr(cell), "pfv.Container(bottom: plane, top: plane, shell: cylinder)")
        other = copy.deepcopy(cell)
        self.assertIs(other.place("top", offset=-1.0), other)
        self.assertEqual((cell.upper[2], other.upper[2]), (0.75, 1.0))

    def test_a_prism_of_flats(self):
        shape = copy.deepcopy(CYLINDER)
        shape["cylinders"][0]["flats"] = 24
        cell = pfv.Container(shape)
        self.assertEqual(len(cell.faces), 26)
        self.assertAlmostEqual(cell.volume, math.pi * 0.25 * 0.75, 13)

    def test_numbers_may_be_arrays(self):
        shape = {"planes": [{"name": one["name"], "inward_normal": np.array(one["inward_normal"]),
                             "offset": np.float64(one["offset"])} for one in CUBE["planes"]]}
        self.assertAlmostEqual(pfv.Container(shape).volume, 1.0, 14)

    def test_a_lid_that_sinks_squeezes_as_the_box_does(self):
        bed, dt = grains(), 1e-3
        box = pfv.Box([[0, 1]] * 3).face("zlo", pressure=0.0).face("zhi", velocity=-0.1)
        cell = pfv.Container(CUBE).face("zlo", pressure=0.0).face("zhi", velocity=0.1)
        one, other = pfv.Flow(box, viscosity=1.0), pfv.Flow(cell, viscosity=1.0)
        for step in range(1, 4):
            box.upper = [1, 1, 1 - 0.1 * step * dt]
            one.set_box(box)
            other.set_box(cell.place("zhi", offset=-(1 - 0.1 * step * dt)))
            forces = np.array(one.advance(bed.positions, bed.radii, dt=dt))
            np.testing.assert_allclose(other.advance(bed.positions, bed.radii, dt=dt), forces, atol=1e-11 * abs(forces).max())
            self.assertAlmostEqual(other.faces()["zlo"]["flux"], -0.1, 9)
        self.assertEqual(type(one.box), pfv.Box)
        self.assertEqual(other.box.faces["zhi"]["offset"], cell.faces["zhi"]["offset"])

    def test_a_face_that_tilts(self):
        """Its volume rate is that of its motion."""
        bed = grains()
        cell = pfv.Container(CUBE).face("zlo", pressure=0.0)
        cell.face("zhi", angular_velocity=[0.3, 0, 0], pivot=[0.5, 0.0, 1.0], velocity=[0, 0, -0.05])
        flow = pfv.Flow(cell, viscosity=1.0)
        flow.evaluate(bed.positions, bed.radii)
        self.assertAlmostEqual(flow.faces()["zlo"]["flux"], 0.3 * 0.5 - 0.05, 9)

    def test_a_piston_moves_along_its_inward_normal(self):
        bed = grains()
        cell = pfv.Container(CUBE).face("zlo", pressure=0.0)
        flow = pfv.Flow(cell, viscosity=1.0)
        flow.evaluate(bed.positions, bed.radii)
        masses = np.full(len(bed), 1e3)
        free = flow.time_step_limit(masses)
        self.assertLess(flow.time_step_limit(masses, pistons={"zhi": 1.0}), free)
        with self.assertRaisesRegex(pfv.InputError, "zhi"):
            flow.time_step_limit(masses, pistons={"lid": 1.0})

    def test_what_makes_no_sense_is_refused(self):
        cell, cube = driven(), pfv.Container(CUBE)
        idle = copy.deepcopy(CUBE)
        idle["planes"].append({"name": "far", "inward_normal": [1, 0, 0], "offset": -9})
        for refused, text in (
                (lambda: pfv.Container({"planes": CUBE["planes"][:5]}), "open"),
                (lambda: pfv.Container({"plane": []}), "unknown entry"),
                (lambda: pfv.Container(idle), "far bounds nothing"),
                (lambda: pfv.Container("nowhere.json"), "cannot be read"),
                (lambda: pfv.Container({"planes": [{"name": "a", "inward_normal": [0, 0, float("nan")], "offset": 0}]}), "JSON"),
                (lambda: cell.face("lid", pressure=1), "bottom, top, shell"),
                (lambda: cell.face("shell", velocity=1.0), "no normal"),
                (lambda: cell.face("top", spin=1.0), "cylinder's"),
                (lambda: cell.face("top", wall="smooth"), "smooth"),
                (lambda: cell.place("top", radius=1.0), "is a plane"),
                (lambda: cell.place("shell"), "is a cylinder"),
                (lambda: cell.place("top", inward_normal=[0, 0, -1]), "offset"),
                (lambda: cell.copy().place("top", offset=1.0).volume, "no room"),
                (lambda: pfv.Flow(cell.copy().place("top", offset=1.0), viscosity=1.0), "no room"),
                (lambda: cell.patch("shell", [[0, 1], [0, 1]], pressure=1), "block"),
                (lambda: cell.patch("top", [[0, 1]], pressure=1), "rectangle"),
                (lambda: pfv.Flow(cell.copy().patch("top", [[3, 4], [0, 1], [0, 1]], pressure=1)), "does not reach"),
                (lambda: pfv.Flow(cube, model="darcy_grid", cells=(2, 2, 2), viscosity=1.0), "box")):
            with self.assertRaisesRegex(pfv.InputError, text):
                refused()
        with self.assertRaisesRegex(TypeError, "sliding"):
            cube.face("zhi", sliding=[1, 0, 0])
        self.assertEqual(cell.faces["top"]["offset"], -0.75)  # a refused place changes nothing
        pfv.Flow(pfv.Container(CUBE).face("zhi", pressure=0.0), viscosity=1.0)


if __name__ == "__main__":
    unittest.main()

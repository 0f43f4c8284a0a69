# SPDX-License-Identifier: GPL-3.0-or-later
"""Pipes and prisms that repeat along their axis: `boundary f f p` beside round and leaning walls."""
import math
import unittest

from coupled import EDGE, HERE, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo
from plates import funnel, quad, ring, write_mesh

MODEL = "wall/gran model hooke/stiffness tangential history"
RADIUS, MIDDLE = 0.045, EDGE / 2
SHELL = f"fix shell all {MODEL} primitive type 1 zcylinder {RADIUS} {MIDDLE} {MIDDLE}\n"
FLOW = "fix flow all pfv viscosity 0.01 container walls gradient 0 0 -20 couple_every 1"
THERMO = ("thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[4] f_flow[5]\n"
          "thermo_modify norm no format float %.15g\nthermo 1\n")
ENDS = [{"name": "start", "inward_normal": [0, 0, 1], "offset": 0.0},
        {"name": "end", "inward_normal": [0, 0, -1], "offset": -EDGE}]
TUBE = {"planes": ENDS, "cylinders": [{"name": "side", "axis": [0, 0, 1], "point": [MIDDLE, MIDDLE, 0.0], "radius": RADIUS}]}


def hexagon(turn=0.3):
    """Outward directions of six planes around the middle."""
    return [(math.cos(math.pi * k / 3 + turn), math.sin(math.pi * k / 3 + turn)) for k in range(6)]


class Pipe(CoupledTest):
    grains = [g for g in packing(8) if math.hypot(g[1] - MIDDLE, g[2] - MIDDLE) + 0.3 * g[4] < RADIUS]

    def write(self, velocities=None, shift=0.0):
        """packing.data in a box that ends with the period; grains moved along it."""
        lines = ["grains of a coupled test", "", f"{len(self.grains)} atoms", "1 atom types", ""]
        for axis, (low, high) in zip("xyz", ((-0.02, EDGE + 0.05), (-0.02, EDGE + 0.05), (0.0, EDGE))):
            lines.append(f"{low} {high} {axis}lo {axis}hi")
        lines += ["", "Atoms", ""]
        lines += [f"{n} 1 {2 * r!r} 2600.0 {x!r} {y!r} {(z + shift) % EDGE!r}" for n, x, y, z, r in self.grains]
        if velocities:
            lines += ["", "Velocities", ""]
            lines += [f"{n} {v[0]!r} {v[1]!r} {v[2]!r} 0 0 0" for n, v in sorted(velocities.items())]
        (self.folder / "packing.data").write_text("\n".join(lines) + "\n")
        self.head = (HERE / "in.packing").read_text().replace("boundary        f f f", "boundary f f p")

    def first_forces(self, script, name="pipe.dump"):
        said = self.liggghts(script + dump(name) + "run 0\n")
        return forces(read_dump(self.folder / name)[0]), said

    def test_a_primitive_cylinder_is_the_periodic_container_of_the_command(self):
        self.write()
        coupled, said = self.first_forces(self.head + SHELL + FLOW + "\n")
        self.assertIn("held by 1 walls: shell (cylinder of radius 0.045 m)", said)
        self.assertIn(f"container of {math.pi * RADIUS**2 * EDGE:.4g} m3, {len(self.grains)} grains inside, 0 outside", said)
        static = self.pfv_forces("pipe.dump", "--periodic", "z", "--gradient", "0", "0", "-20", container=TUBE)
        self.assertLess(largest_difference(coupled, static), 1e-12)
        self.write(shift=0.37 * EDGE)
        moved, _ = self.first_forces(self.head + SHELL + FLOW + "\n", "moved.dump")
        self.assertLess(largest_difference(moved, coupled), 1e-9)

    def mesh(self, name, triangles):
        write_mesh(self.folder / f"{name}.stl", triangles)
        return f"fix {name} all mesh/surface file {name}.stl type 1\nfix walls all {MODEL} mesh n_meshes 1 meshes {name}\n"

    def test_a_tube_of_triangles(self):
        self.write()
        of_area = RADIUS * math.sqrt(32 / (2 * math.pi) * math.sin(2 * math.pi / 32))
        alone, _ = self.first_forces(self.head + SHELL.replace(str(RADIUS), repr(of_area)) + FLOW + "\n")
        for beyond in (0.0, 0.01):
            tube = self.mesh("tube", funnel(ring(32, RADIUS, -beyond, MIDDLE), ring(32, RADIUS, EDGE + beyond, MIDDLE)))
            coupled, said = self.first_forces(self.head + tube + FLOW + "\n", "mesh.dump")
            self.assertIn("held by 1 walls: tube (cylinder of radius 0.04486 m for flats that lie within", said)
            self.assertLess(largest_difference(coupled, alone), 1e-6)

    def test_a_duct_of_triangles(self):
        """With lids it is none: grains could not pass them."""
        self.write()
        turn, half = 0.4, 0.05
        corners = [(MIDDLE + math.sqrt(2) * half * math.cos(turn + math.pi * (k + 0.5) / 2),
                    MIDDLE + math.sqrt(2) * half * math.sin(turn + math.pi * (k + 0.5) / 2)) for k in range(4)]
        planes = "".join(f"face side{k} plane {x!r} {y!r} 0 {-math.cos(turn + math.pi * (k + 1) / 2)!r} "
                         f"{-math.sin(turn + math.pi * (k + 1) / 2)!r} 0 " for k, (x, y) in enumerate(corners))
        expected, _ = self.first_forces(self.head + FLOW.replace("gradient", planes + "gradient") + "\n")
        low, high = [[(x, y, z) for x, y in corners] for z in (1e-4, EDGE - 1e-4)]
        sides = [t for k in range(4) for t in quad(low[k], low[(k + 1) % 4], high[(k + 1) % 4], high[k])]
        coupled, said = self.first_forces(self.head + self.mesh("duct", sides) + FLOW + "\n", "mesh.dump")
        self.assertIn("held by 4 walls", said)
        self.assertLess(largest_difference(coupled, expected), 1e-6)
        self.refused(self.head + self.mesh("duct", sides + quad(*low) + quad(*high)) + FLOW + "\nrun 0\n",
                     "left out: face duct stands across z, along which the simulation box is periodic")

    def test_leaning_planes_are_a_prism(self):
        self.write()
        walls = "".join(f"face side{k} plane {MIDDLE + 0.05 * x!r} {MIDDLE + 0.05 * y!r} 0 {-x!r} {-y!r} 0 "
                        for k, (x, y) in enumerate(hexagon()))
        coupled, said = self.first_forces(self.head + FLOW.replace("gradient", walls + "gradient") + "\n")
        self.assertIn("held by 6 walls", said)
        prism = {"planes": ENDS + [{"name": f"side{k}", "inward_normal": [-x, -y, 0],
                                    "offset": -(MIDDLE * (x + y) + 0.05)} for k, (x, y) in enumerate(hexagon())]}
        static = self.pfv_forces("pipe.dump", "--periodic", "z", "--gradient", "0", "0", "-20", container=prism)
        self.assertLess(largest_difference(coupled, static), 1e-10)

    def test_what_drives_the_fluid_is_carried_by_grains_and_the_shell(self):
        """Over a run in which grains pass the ends, from one restart file too."""
        self.write(random_velocities(self.grains, 3))
        fast = "velocity all set NULL NULL 0.5 sum yes units box\n"
        script = self.head + SHELL + fast + FLOW + " history 1 h.csv\n" + THERMO + dump("a.dump").replace("custom 1", "custom 40")
        said = self.liggghts(script + "run 40\nwrite_restart half.restart\nrun 40\n")
        rows = read_thermo(said)
        self.assertLess(max(abs(row["flow[3]"]) for row in rows), 1e-9)
        self.assertLess(max(row["flow[4]"] for row in rows), 1e-12)
        table = [line.split(",") for line in (self.folder / "h.csv").read_text().splitlines()]
        self.assertIn("shell_force_z", table[0])
        self.assertNotIn("period_zlo_force_z", table[0])
        last = read_dump(self.folder / "a.dump")[80]
        on_grains = sum(row[9] for row in last.values())
        on_shell = float(table[-1][table[0].index("shell_force_z")])
        self.assertAlmostEqual((on_grains + on_shell) / (20 * math.pi * RADIUS**2 * EDGE), 1.0, delta=1e-10)
        gone_on = self.head.split("read_data")[0] + "read_restart half.restart\n" + self.head.split("read_data       packing.data\n")[1]
        self.liggghts(gone_on + SHELL + FLOW + "\n" + THERMO + dump("b.dump").replace("custom 1", "custom 40") + "run 40\n")
        self.assertEqual(forces(read_dump(self.folder / "b.dump")[80]), forces(last))

    def test_a_duct_that_turns(self):
        """A drum without ends, filled up to the surface of its grains: each flat turns, and those above bound nothing."""
        self.write()
        rings = ring(8, 0.05, 1e-4, MIDDLE), ring(8, 0.05, EDGE - 1e-4, MIDDLE)
        drum = self.mesh("drum", funnel(*rings)) + ("fix turn all move/mesh mesh drum rotate origin 0.05 0.05 0. axis 0. 0. 1. "
                                                    "period 0.05\n")
        words = "gradient 0 0 -20 face top extent y hi pressure 0 "
        script = self.head + drum + FLOW.replace("gradient 0 0 -20", words) + "\n" + THERMO
        rows = read_thermo(self.liggghts(script + "run 40\n"))
        self.assertLess(max(abs(row["flow[3]"]) for row in rows), 1e-9)
        self.assertLess(max(row["flow[4]"] for row in rows), 1e-12)
        self.assertGreater(rows[-1]["flow[1]"], 0.0)  # what the flats push in goes out at the top

    def test_two_ranks(self):
        self.write(random_velocities(self.grains, 3))
        for ranks in (1, 2):
            self.liggghts(self.head + SHELL + FLOW + "\n" + dump(f"{ranks}.dump") + "run 20\n", ranks=ranks)
        one, two = (read_dump(self.folder / f"{ranks}.dump") for ranks in (1, 2))
        self.assertLess(largest_difference(forces(two[1]), forces(one[1])), 1e-9)

    def test_what_a_pipe_does_not_take(self):
        self.write()
        script = self.head + SHELL
        self.refused(script + FLOW.replace("gradient", f"face lid plane 0 0 {EDGE} 0 0 -1 gradient") + "\nrun 0\n",
                     "face lid: it stands across z, along which the simulation box is periodic")
        self.refused(script + "fix d all deform 1 z erate 0.1\n" + FLOW + "\nrun 0\n",
                     "the period of a pipe does not change its length")
        self.refused(script + FLOW.replace("gradient", "obstacle mesh rod gradient") + "\nrun 0\n",
                     "obstacle: it takes no periodic sides")
        slope = self.mesh("slope", quad((0.0, 0.0, 0.0), (EDGE, 0.0, 0.0), (EDGE, EDGE, 0.003), (0.0, EDGE, 0.003)))
        _, said = self.first_forces(script + slope + FLOW + "\n")
        self.assertIn("left out: face slope stands across z, along which the simulation box is periodic", said)


if __name__ == "__main__":
    unittest.main()

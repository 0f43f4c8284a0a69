# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes as users of LIGGGHTS have them, written without the fluid (scenes/in.*): only the lines of fix pfv are added,
before the last run. Accepted: the walls and their volume are those of the scene, forces are numbers, forces and masses
balance, and what the fluid does not see is warned of, and nothing else. Refused: with the remedy."""
import math
import pathlib
import re
import shutil
import unittest

from coupled import CoupledTest, read_thermo
from plates import polygon_area
from scene_meshes import write_meshes

SCENES = pathlib.Path(__file__).resolve().parent / "scenes"
EVERY = 10  # steps between two rows
WATER = "fix flow all pfv viscosity 1e-3 density 1000 "
TOP = " face top extent z hi pressure 0"
RECORD = (f"thermo_style custom step f_flow[1] f_flow[2] f_flow[3] f_flow[4] f_flow[8]\n"
          f"thermo_modify lost ignore norm no format float %.15g\nthermo {EVERY}\n"
          f"dump record all custom {EVERY} record.dump id z radius fx fy fz f_flow[1] f_flow[2] f_flow[3]\n")
BALANCE = 1e-10


def circle(radius):
    return math.pi * radius**2


def frustum(below, above, height):
    return height / 3 * (below + above + math.sqrt(below * above))


def area_below(height, corners):
    """Of a polygon's part below a height; corners (x, height) in order around it."""
    part = []
    for (x0, z0), (x1, z1) in zip(corners, corners[1:] + corners[:1]):
        if z0 <= height:
            part.append((x0, z0))
        if (z0 - height) * (z1 - height) < 0.0:
            part.append((x0 + (x1 - x0) * (height - z0) / (z1 - z0), height))
    return 0.5 * abs(sum(x0 * z1 - x1 * z0 for (x0, z0), (x1, z1) in zip(part, part[1:] + part[:1])))


def record_of(path):
    """Rows of numbers of each snapshot."""
    lines, at, shots = path.read_text().splitlines(), 0, []
    while at < len(lines):
        count = int(lines[at + 3])
        shots.append([[float(word) for word in line.split()] for line in lines[at + 9:at + 9 + count]])
        at += 9 + count
    return shots


class Scenes(CoupledTest):
    def script(self, name, fluid, before=""):
        text = (SCENES / f"in.{name}").read_text()
        write_meshes(self.folder, text)
        shutil.copy(SCENES / "in.material", self.folder)
        at = text.rindex("\nrun ") + 1
        return text[:at] + before + WATER + fluid + "\n" + RECORD + text[at:]

    def accepted(self, name, fluid, walls, volume, left_out=(), unseen=(), net=0.0, outside=0, before_the_flow=""):
        """`volume` of the container (m3), from the height of the highest grain; `net`: outflow less inflow at the end."""
        said = self.liggghts(self.script(name, fluid, before_the_flow))
        lines = said.splitlines()
        if walls:
            held = next(line for line in lines if "held by" in line)
            self.assertIn(f"held by {walls} walls: ", held)
        self.lines_are(lines, "left out: ", left_out)
        self.lines_are([line for line in lines if "WARNING" in line], "Fix pfv", unseen)
        shots = record_of(self.folder / "record.dump")
        top = max((row[1] + row[2] for row in shots[0]), default=0.0)
        found = float(re.search(r"(?:container|flow box) of (\S+) m3", said)[1])
        self.assertAlmostEqual(found / volume(top), 1.0, delta=1e-3)
        self.balances(shots, net, outside)

    def printed(self, word):
        return float(re.search(rf"^{word} (\S+)", (self.folder / "log.liggghts").read_text(), re.M)[1])

    def lines_are(self, lines, beginning, parts):
        """One line with each part, and no other with this beginning."""
        found = [line for line in lines if beginning in line]
        self.assertEqual(len(found), len(parts), found)
        for line, part in zip(found, parts):
            self.assertIn(part, line)

    def balances(self, shots, net, outside):
        for row in (row for shot in shots for row in shot):
            self.assertTrue(all(map(math.isfinite, row)), row)
        self.assertGreater(sum(math.hypot(*row[6:9]) for row in shots[-1]), 0.0)
        rows = [row for row in read_thermo((self.folder / "log.liggghts").read_text()) if "flow[1]" in row]
        self.assertGreaterEqual(len(rows), 6)
        for row in rows:
            self.assertLess(abs(row["flow[3]"]), BALANCE)
            self.assertLess(row["flow[4]"], BALANCE)
        last = rows[-1]
        self.assertEqual(last["flow[8]"], outside)
        if net is not None:
            self.assertAlmostEqual(last["flow[2]"] - last["flow[1]"], net, delta=1e-3 * abs(net) + 1e-12)

    def test_cylinder_packing(self):
        self.accepted("cylinder_packing", "container walls" + TOP, 3, lambda top: circle(0.02) * top)

    def test_hopper(self):
        wide = lambda z: (2 * math.sqrt(0.5) * (0.012 + 0.038 * z / 0.08))**2
        self.accepted("hopper", "container walls face outlet plane 0 0 0 0 0 1 pressure 0" + TOP, 6,
                      lambda top: frustum(wide(0.0), wide(top), top))

    DRAIN = "container walls region -0.005 0.005 0.01 0.02 -0.03 -0.02 pressure 0"

    def test_drum(self):
        self.accepted("drum", self.DRAIN, 3, lambda _: polygon_area(24, 0.03) * 0.03)

    def test_drum_that_is_a_third_full(self):
        self.accepted("drum_low", self.DRAIN, 26, lambda _: polygon_area(24, 0.03) * 0.03)

    def test_drum_with_lifters_in_one_file(self):
        self.refused(self.script("lifters", self.DRAIN), "mesh 'drum' is not convex", "triangle", "parts as meshes of their own")

    def test_bucket(self):
        self.accepted("bucket", "container walls" + TOP, 6, lambda top: 0.06 * 0.04 * top,
                      left_out=["mesh 'bucket'"], unseen=["mesh 'bucket' stands in the fluid, which does not see it"])

    def test_bucket_as_an_obstacle(self):
        self.accepted("bucket", "container walls obstacle mesh bucket" + TOP, 6, lambda top: 0.06 * 0.04 * top)

    def test_triaxial_with_six_servos(self):
        fluid = ("container walls face zlo pressure 0 face zhi pressure 0\n"
                 "print 'room $((f_xhi[10]-f_xlo[10])*(f_yhi[11]-f_ylo[11])*(f_zhi[12]-f_zlo[12]))'")
        self.accepted("triaxial", fluid, 6, lambda _: self.printed("room"), net=None)

    def test_packed_bed(self):
        self.accepted("packed_bed", "container walls face inlet flux 1e-5 face outlet pressure 0", 3,
                      lambda _: circle(0.018) * 0.06)
        last = read_thermo((self.folder / "log.liggghts").read_text())[-1]
        self.assertAlmostEqual(last["flow[2]"] / 1e-5, 1.0, delta=1e-10)

    def test_seepage_in_a_box(self):
        self.accepted("seepage", "container walls face xwalls1 pressure 100 face xwalls2 pressure 0", 6,
                      lambda _: 0.04 * 0.03 * 0.05)

    def test_chute(self):
        c, s = math.cos(math.radians(20)), math.sin(math.radians(20))
        ends = "".join(f" face {name} plane {k * 0.05 * c!r} 0 {-k * 0.05 * s!r} {-k * c!r} 0 {k * s!r} pressure 0"
                       for name, k in (("up", -1), ("down", 1)))
        top = f" face top plane {0.03 * s!r} 0 {0.03 * c!r} {-s!r} 0 {-c!r} pressure 0"
        self.accepted("chute", "container walls" + ends + top, 6, lambda _: 0.1 * 0.03 * 0.03)

    def test_annulus(self):
        """The inner cylinder is no wall to the fluid, and said to be none."""
        self.accepted("annulus", "container walls" + TOP, 3, lambda top: circle(0.03) * top, left_out=["wall 'inner'"],
                      unseen=["wall 'inner' cuts off 11"])

    def test_shaken_can_in_millimetres(self):
        self.accepted("shaken_can", "container walls region 0.015 0.025 0.01 0.02 0.0 0.01 pressure 0", 6,
                      lambda _: 0.04 * 0.03 * 0.04)

    def test_servo_lid_on_a_cylinder(self):
        fluid = "container walls face zwall pressure 0\nprint 'lid_at $(f_lid[12])'"
        self.accepted("cylinder_lid", fluid, 3, lambda _: circle(0.02) * self.printed("lid_at"), net=None)

    def test_wedge(self):
        wide = lambda z: 2 * (0.004 + z * math.tan(math.radians(25)))
        self.accepted("wedge", "container walls face bottom pressure 0" + TOP, 6,
                      lambda top: 0.03 * top * 0.5 * (wide(0.0) + wide(top)))

    def test_shear_cell(self):
        fluid = "container walls face lid pressure 0\nprint 'lid_at $(f_lid[12])'"
        self.accepted("shear_cell", fluid, 6, lambda _: 0.04 * 0.03 * self.printed("lid_at"), net=None)

    def test_silo(self):
        cone = frustum(polygon_area(24, 0.006), polygon_area(24, 0.02), 0.03)
        self.accepted("silo", "container walls face slide pressure 0" + TOP, 50,
                      lambda top: cone + polygon_area(24, 0.02) * (top - 0.03))

    def test_a_primitive_cylinder_over_a_cone_is_of_flats(self):
        cone = frustum(polygon_area(24, 0.006), polygon_area(24, 0.02), 0.03)
        self.accepted("silo_primitive", "container walls face outlet pressure 0" + TOP, 50,
                      lambda top: cone + 24 * math.tan(math.pi / 24) * 0.02**2 * (top - 0.03), left_out=["wall 'ceiling' bounds nothing"])

    def test_a_ceiling_above_the_surface_of_grains_in_a_cylinder(self):
        ceiling = "fix ceiling all wall/gran model hertz tangential history primitive type 1 zplane 0.095\n"
        self.accepted("cylinder_packing", "container walls" + TOP, 3, lambda top: circle(0.02) * top,
                      left_out=["wall 'ceiling' bounds nothing"], before_the_flow=ceiling)

    def test_a_drum_that_is_filled_up_to_the_grains_surface(self):
        """Of its 24 flats those above the surface bound nothing, others as it turns."""
        turned = 2 * math.pi * 2000 * 5e-5 / 4.0
        angles = [2 * math.pi * k / 24 + turned for k in range(24)]
        shell = [(0.03 * math.cos(a), 0.03 * math.sin(a)) for a in angles]
        self.accepted("drum_low", "container walls" + TOP, 27,
                      lambda top: area_below(top, shell) * 0.03, net=None)

    def test_periodic_sides(self):
        self.accepted("periodic_layer", "container walls" + TOP, 2, lambda top: 0.03 * 0.03 * top,
                      left_out=["wall 'ceiling' bounds nothing"])

    def test_column_collapse(self):
        """A box, since the fluid's walls reach as far as others let them, and the gate does not."""
        sides = " ".join(f"face {name} wall {name}" for name in ("xlo", "xhi", "ylo", "yhi", "zlo"))
        self.accepted("column_collapse", sides + " face zhi plane 0.09 pressure 0", 0, lambda _: 0.08 * 0.03 * 0.09,
                      unseen=["mesh 'gate' stands in the fluid, which does not see it"])

    def test_intruder(self):
        self.accepted("intruder", "container walls" + TOP, 6, lambda top: 0.05 * 0.05 * top)

    def test_vibrated_box(self):
        """The bottom rises and drives water out as fast as it moves."""
        time, turn = 100 * 5e-5, 2 * math.pi / 0.05
        self.accepted("vibrated_box", "couple_every 1 container walls" + TOP, 6, lambda top: 0.04 * 0.03 * top,
                      net=0.04 * 0.03 * 5e-4 * turn * math.cos(turn * time))

    def test_oedometer_ring(self):
        ring = polygon_area(32, 0.02)
        self.accepted("oedometer_ring", "container walls face base pressure 0 face lid pressure 0", 3,
                      lambda _: ring * 0.045, net=0.02 * ring)

    def test_floor_that_leans(self):
        self.accepted("leaning_floor", "container walls" + TOP, 6, lambda top: 0.04 * 0.03 * (top - 0.005))

    def test_pouring(self):
        self.accepted("pouring", "container walls face top plane 0 0 0.08 0 0 -1 pressure 0", 3,
                      lambda _: circle(0.02) * 0.08)
        self.assertEqual(len(record_of(self.folder / "record.dump")[-1]), 300)

    def test_mixer(self):
        self.accepted("mixer", "container walls" + TOP, 3, lambda top: circle(0.025) * top, left_out=["mesh 'blade'"],
                      unseen=["mesh 'blade' stands in the fluid, which does not see it"])


if __name__ == "__main__":
    unittest.main()

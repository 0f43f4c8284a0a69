#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of doc/scaling.md:  doc/scaling.py [solve] [coupled] [messages] [runs] [agreement] [million]

`pfv solve` of dense packings on several ranks, and on one from 25 000 grains on; 50 coupled steps of LIGGGHTS on one and
several ranks; what ranks tell each other, and a model fitted to it all (scaling_model.py); three small coupled runs to
their end, and how far they differ (tests/coupled/coupled_runs.py); by how much several ranks differ from one on many
packings (rank_agreement.py); all of it without a word. With `million` up to a million grains, which takes 9 GB. Every packing is made of
mirrored copies of one of 25 000 grains. CPU time, since ranks share cores here. Some minutes;
`coupled million` 20.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests/coupled"))
from coupled_runs import Runs
import rank_agreement
import scaling_model
PAGE = ROOT / "doc/scaling.md"
PFV, MAKE, LIGGGHTS, COUNTER = (ROOT / "build/bin" / name for name in ("pfv", "pfv_dense_packing", "liggghts-pfv",
                                                                   "libpfv_message_count.so"))
MPIRUN = [os.environ.get("PFV_MPIRUN", "mpirun"), "--allow-run-as-root", "--oversubscribe", "--mca",
          "mpi_yield_when_idle", "1"]
GRAINS = 25000
SIZES = {25000: (1, 1, 1), 100000: (2, 2, 1), 400000: (4, 2, 2)}
SHARED = (2, 2, 2)  # what several ranks share
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

    def command(self, counts):
        box = [text for count in counts for text in ("0", str(count))]
        return [PFV, "solve", "--packing", self.file(counts), "--box", *box, "--face", "zlo:pressure=0", "--face",
                "zhi:pressure=1", "--wall", "symmetry", "--solver", "amg", "--tolerance", TOLERANCE, "--report",
                "report.json", "--forces", "forces.csv"]

    def solve(self, counts, ranks):
        """Report, and forces of all grains."""
        command = self.command(counts)
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
        report, forces = packings.solve(SHARED, ranks)
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


SCRIPT = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
read_data grains.data
neighbor 0.004 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 1e7
fix m2 all property/global poissonsRatio peratomtype 0.25
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix g all gravity 9.81 vector 0 0 -1
fix i all nve/sphere
"""
STEPS = 50


def write_data(path, grains, counts):
    """For LIGGGHTS: the grains of a packing, and room for those at the sides."""
    with open(path, "w") as data:
        data.write(f"grains\n\n{len(grains)} atoms\n1 atom types\n\n")
        for axis, count in zip("xyz", counts):
            data.write(f"-0.1 {count + 0.1} {axis}lo {axis}hi\n")
        data.write("\nAtoms\n\n")
        ids = numpy.arange(1, len(grains) + 1)
        ones = numpy.ones(len(grains))
        numpy.savetxt(data, numpy.column_stack([ids, ones, 2.0 * grains[:, 3], 2600.0 * ones, grains[:, :3]]),
                      fmt=["%d", "%d"] + ["%.17g"] * 5)


def run_liggghts(folder, script, ranks):
    """What it prints, its CPU seconds and the memory of its largest rank, bytes."""
    (folder / "in.coupled").write_text(script)
    launch = [*MPIRUN, "-n", str(ranks)] if ranks > 1 else []
    command = [sys.executable, "-c", "import resource, subprocess, sys; "
               "done = subprocess.run(sys.argv[1:], capture_output=True, text=True); "
               "use = resource.getrusage(resource.RUSAGE_CHILDREN); "
               "print(done.stdout[-6000:], done.stderr[-2000:], 'used', use.ru_utime + use.ru_stime, use.ru_maxrss); "
               "sys.exit(done.returncode)", *launch, LIGGGHTS, "-in", "in.coupled"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    seconds, kilobytes = done.stdout.split()[-2:]
    return done.stdout, float(seconds), 1024.0 * float(kilobytes)


def phase(text, name):
    """(seconds, count) in the table at the end of a run."""
    for line in text.splitlines():
        words = line.split()
        if words[:1] == [name] and len(words) == 3:
            return float(words[1]), int(words[2])
    sys.exit(f"no phase {name} in:\n{text}")


def flow_script(counts):
    walls = " ".join(f"face {axis}{side} plane {count if side == 'hi' else 0} symmetry"
                     for axis, count in zip("xyz", counts) for side in ("lo", "hi")) + " pressure 0"
    return f"{SCRIPT}fix flow all pfv viscosity 1e-3 density 1000 solver amg couple_every 1 {walls}\nrun {STEPS}\n"


def messages(packings):
    """Their table, and what more ranks are expected to take."""
    folder, grains = packings.folder, GRAINS * numpy.prod(SHARED)
    counts = {ranks: scaling_model.counted(folder, packings.command(SHARED), MPIRUN, ranks, COUNTER) for ranks in (2, 4, 8, 16)}
    write_data(folder / "grains.data", copies(packings.block, SHARED), SHARED)
    (folder / "in.coupled").write_text(flow_script(SHARED))
    cycles = scaling_model.counted(folder, [LIGGGHTS, "-in", "in.coupled"], MPIRUN, 2, COUNTER)[0] / STEPS
    told = table(["ranks", "iterations", "messages a rank and iteration", "kB a rank and iteration", "sums over all, an iteration"],
                 [[str(ranks), f"{count[0]:.0f}", f"{count[1]:.0f}", f"{count[2] / 1e3:.0f}", f"{count[3]:.1f}"]
                  for ranks, count in counts.items()])
    model = scaling_model.Model(PAGE.read_text(), grains, counts, cycles)
    note = (f"Fitted: parts of n grains that share s of their six sides with others take 1 + {model.halo_work:.1f} s n^(-1/3) of the "
            f"work and 1 + {model.halo_memory:.1f} s n^(-1/3) of the memory; {cycles:.1f} iterations a flow step, with those of the first limit of the time step in 50 steps.\n\n")
    head = ["grains", "ranks", "a flow step, s", "of it messages, ms", "a network, s", "MB a rank", "of the best"]
    return told, note + table(head, model.rows((1000000, 10000000)))


def coupled(packings, sizes):
    rows = []
    for grains, counts in sizes.items():
        folder = packings.folder
        write_data(folder / "grains.data", copies(packings.block, counts), counts)
        own = {steps: run_liggghts(folder, f"{SCRIPT}run {steps}\n", 1)[1] for steps in (0, STEPS)}
        for ranks in (1, 2, 4) if grains < 1000000 else (1, 2):
            text, seconds, memory = run_liggghts(folder, flow_script(counts), ranks)
            networks = sum(phase(text, name)[0] for name in ("triangulate", "throats", "factor"))
            solve, solves = phase(text, "solve")
            step = sum(phase(text, name)[0] for name in ("assemble", "solve", "forces")) / solves
            rows.append([f"{grains}", f"{ranks}", f"{memory / 2**20:.0f}", f"{networks:.1f}",
                         f"{phase(text, 'triangulate')[1]}", f"{step:.3f}", f"{(own[STEPS] - own[0]) / STEPS:.3f}",
                         f"{seconds:.0f}"])
    return table(["grains", "ranks", "MB the largest rank", "networks, s", "networks", "a flow step, s",
                  "LIGGGHTS' own step, s", "the run in all, s"], rows)


ORDERS = (1, 2, 3, 4)  # of the grains, beside their own


def number(value):
    return f"{value:.0e}" if value else "0"


def runs(folder):
    """Observables of small coupled runs, and by which part of them other runs differ at most."""
    of = Runs(folder)
    rows = []
    for name in ("oedometer", "boiling", "settling"):
        first = of.observe(name)
        others = {"orders": [of.observe(name, order=order) for order in ORDERS],
                  "solver": [of.observe(name, solver="supernodal")],
                  "2": [of.observe(name, ranks=2)], "4": [of.observe(name, ranks=4)]}
        for what, value in first.items():
            apart = [max(abs(run[what] - value) for run in group) / abs(value) for group in others.values()]
            rows.append([f"{name}: {what}", f"{value:.5g}", *map(number, apart)])
    return table(["what is observed", "one rank", "four other orders of the grains", "the kept factor", "2 ranks", "4 ranks"], rows)


def agreement(folder):
    dense = numpy.loadtxt(subprocess.run([MAKE, "400"], capture_output=True, text=True, check=True).stdout.splitlines(),
                          delimiter=",", skiprows=1, usecols=(1, 2, 3, 4))
    return table(["packing", "amg: forces, rms", "worst grain", "permeability", "mumps: forces, rms", "worst grain", "permeability"],
                 rank_agreement.rows(folder, PFV, MPIRUN, dense))


def replace(name, text):
    page = PAGE.read_text()
    begin, end = f"<!-- {name}: made by doc/scaling.py -->\n", "\n<!-- end -->"
    first = page.index(begin) + len(begin)
    PAGE.write_text(page[:first] + text + page[page.index(end, first - 1):])


def memory_of_few(folder):
    """What a process holds that has a handful of grains, MB."""
    (folder / "few.csv").write_text("id,x,y,z,radius\n1,0.5,0.5,0.5,0.1\n2,0.2,0.2,0.2,0.1\n")
    subprocess.run([PFV, "solve", "--packing", "few.csv", "--box", "0", "1", "0", "1", "0", "1", "--face",
                    "zlo:pressure=0", "--face", "zhi:pressure=1", "--solver", "amg", "--report", "few.json"],
                   cwd=folder, check=True, capture_output=True)
    return json.loads((folder / "few.json").read_text())["peak_memory_bytes"] / 2**20


def main():
    words = set(sys.argv[1:])
    if words - {"solve", "coupled", "messages", "runs", "agreement", "million"}:
        sys.exit(__doc__)
    million = MILLION if "million" in words else {}
    parts = words - {"million"} or {"solve", "coupled", "messages", "runs", "agreement"}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if "runs" in parts:
            replace("runs", runs(folder))
        if "agreement" in parts:
            replace("agreement", agreement(folder))
        packings = Packings(folder) if parts & {"solve", "coupled", "messages"} else None
        if "solve" in parts:
            empty = memory_of_few(folder)
            replace("ranks", by_ranks(packings, empty))
            replace("sizes", by_size(packings, empty, {**SIZES, **million}))
        if "coupled" in parts:
            replace("coupled", coupled(packings, {size: SIZES[size] for size in (25000, 100000)} | million))
        if "messages" in parts:
            told, expected = messages(packings)
            replace("messages", told)
            replace("model", expected)


main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""What the coupled tests share: a packing, running LIGGGHTS and pfv, reading what they write.

Each test runs in a fresh temporary folder. Environment: PFV_BIN, the folder of liggghts-pfv,
libliggghts_pfv.so and pfv.
"""
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parents[1] / "inputs/common"))
from programs import BIN, liggghts_words, one_thread, solve_words

EDGE = 0.1  # of the cubic flow box, m
LONG = "PFV_LONG" in os.environ  # ./test.sh long: all is in full size
HANG = 300  # s; only a guard against a hanging run, far above what any test needs

FACES = ["xlo", "xhi", "ylo", "yhi", "zlo", "zhi"]


def in_long(full, otherwise):
    return full if LONG else otherwise


def packing(cells=5, seed=1):
    """Grains (id, x, y, z, radius) on a jittered grid in the box: none overlaps another."""
    rng = random.Random(seed)
    step = EDGE / cells
    grains = []
    for i in range(cells):
        for j in range(cells):
            for k in range(cells):
                place = [(n + 0.5 + rng.uniform(-0.08, 0.08)) * step for n in (i, j, k)]
                grains.append((len(grains) + 1, *place, step * rng.uniform(0.36, 0.41)))
    return grains


def random_velocities(grains, seed=7):
    """{id: velocity}, up to 0.01 m/s in each direction."""
    rng = random.Random(seed)
    return {grain[0]: [rng.uniform(-0.01, 0.01) for _ in range(3)] for grain in grains}


def write_data(folder, grains, velocities=None, density=2600.0):
    """packing.data for read_data, in a domain that is larger than the flow box."""
    lines = ["grains of a coupled test", "", f"{len(grains)} atoms", "1 atom types", ""]
    lines += [f"-0.02 {EDGE + 0.05} {a}lo {a}hi" for a in "xyz"] + ["", "Atoms", ""]
    lines += [f"{n} 1 {2 * r!r} {density} {x!r} {y!r} {z!r}" for n, x, y, z, r in grains]
    if velocities:
        lines += ["", "Velocities", ""]
        for n, *_ in grains:
            v = velocities.get(n, (0.0, 0.0, 0.0))
            lines.append(f"{n} {v[0]!r} {v[1]!r} {v[2]!r} 0 0 0")
    (folder / "packing.data").write_text("\n".join(lines) + "\n")


def faces(**boundaries):
    """The six face keywords; planes around the box, sealed unless a keyword says otherwise."""
    words = []
    for face in FACES:
        what = boundaries.get(face, "sealed")
        source = "" if what.split()[0] in ("wall", "mesh", "extent", "plane") else (
            f"plane {EDGE if face.endswith('hi') else 0.0} ")
        words.append(f"face {face} {source}{what}")
    return " ".join(words)


# grains of 5 MPa, as fix multisphere's examples have them
CONTACT = """fix m1 all property/global youngsModulus peratomtype 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
"""
WATER = "viscosity 0.01 " + faces(zlo="pressure 10", zhi="pressure 0")
FLOW = WATER + " couple_every 1"
DUMP = ("dump d all custom 1 {0} id x y z radius vx vy vz "
        "f_flow[1] f_flow[2] f_flow[3] f_flow[4] omegax omegay omegaz f_flow[5] f_flow[6] f_flow[7]\n"
        "dump_modify d sort id format \"%d" + " %.17g" * 17 + "\"\n")


def dump(name):
    return DUMP.format(name)


def read_dump(path):
    """{step: {id: [x, y, z, radius, velocity, force, p, spin, torque]}}"""
    steps, lines = {}, path.read_text().splitlines()
    at = 0
    while at < len(lines):
        step, count = int(lines[at + 1]), int(lines[at + 3])
        rows = [line.split() for line in lines[at + 9:at + 9 + count]]
        steps[step] = {int(row[0]): [float(value) for value in row[1:]] for row in rows}
        at += 9 + count
    return steps


def forces(rows):
    return {n: row[7:10] for n, row in rows.items()}


def share_one_core():
    """Of ranks, which turn about while they wait: on a core of its own each would go on asking for messages, at the expense
    of whatever else runs. A ./test.sh long has them on all cores."""
    if not LONG:
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def one_after_the_other(scripts):
    """One script: programs, and several ranks above all, take long to start. `each_of` divides its log."""
    return "clear\n".join(f'print "the next one"\n{script}' for script in scripts)


def each_of(log):
    return log.split("\nthe next one\n")[1:]


def read_thermo(log):
    """Rows of all runs, one dictionary each."""
    rows, names = [], None
    for line in log.splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            names = words
        elif not words or line.startswith("Loop time"):
            names = None
        elif names and len(words) == len(names):
            rows.append({name: float(word) for name, word in zip(names, words)})
    return rows


def largest_difference(a, b):
    """Largest difference between two sets of forces as a part of the largest force."""
    assert a.keys() == b.keys(), "different grains"
    scale = max(math.hypot(*force) for force in b.values())
    return max(math.dist(a[n], b[n]) for n in a) / scale


def restarted_head():
    """in.packing for a run whose grains come from file.restart."""
    skipped = ("units", "boundary", "read_data", "atom_style")
    lines = (HERE / "in.packing").read_text().splitlines()
    head = "\n".join(line for line in lines if not line.startswith(skipped)) + "\n"
    return head.replace("newton          off", "newton off\nread_restart file.restart")


class CoupledTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="pfv-coupled-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def launch(self, script, ranks=1, command=None, environment=None):
        """Runs LIGGGHTS on the script in the test's folder."""
        (self.folder / "in.test").write_text(script)
        shutil.copy(HERE / "in.packing", self.folder)
        words = liggghts_words("in.test", ranks=ranks, program=command or BIN / "liggghts-pfv")
        return subprocess.run(words, cwd=self.folder, capture_output=True, timeout=HANG, encoding="utf-8",
                              errors="replace", env={**one_thread(), **(environment or {})},
                              preexec_fn=share_one_core if ranks > 1 else None)

    def liggghts(self, script, **options):
        """A run that must succeed; returns its screen output."""
        done = self.launch(script, **options)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
        return done.stdout

    def refused(self, script, *parts, **options):
        """A run that must stop with one error line, the last of all, holding all the parts."""
        done = self.launch(script, **options)
        self.assertNotEqual(done.returncode, 0, done.stdout[-2000:])
        lines = done.stdout.splitlines()
        errors = [line for line in lines if line.startswith("ERROR")]
        self.assertEqual(len(errors), 1, done.stdout[-2000:] + done.stderr[-2000:])
        if "Fix pfv" in errors[0] and options.get("ranks", 1) == 1:
            self.assertEqual(lines[-1], errors[0])
        for part in parts:
            self.assertIn(part, errors[0])

    def pfv_solve(self, packing_file, *options, box=(0.0, EDGE) * 3, container=None):
        """(report, {id: total force}) of `pfv solve` on a packing in the test's folder, in a box or a container."""
        if container:
            (self.folder / "container.json").write_text(json.dumps(container))
        words = solve_words(packing_file, "container.json" if container else box, 0.01, "--forces", "forces.csv",
                            "--report", "report.json", *options)
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, timeout=HANG)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = (self.folder / "forces.csv").read_text().splitlines()[1:]
        rows = [line.split(",") for line in lines]
        return (json.loads((self.folder / "report.json").read_text()),
                {int(row[0]): [float(value) for value in row[1:4]] for row in rows})

    def pfv_forces(self, packing_file, *options, **room):
        return self.pfv_solve(packing_file, *options, **room)[1]

# SPDX-License-Identifier: GPL-3.0-or-later
"""By how much several ranks differ from one: the packings of tests/data, and some that are hard for a network that is
made in parts. For doc/scaling.py."""
import json
import pathlib
import subprocess

import numpy

DATA = pathlib.Path(__file__).resolve().parents[1] / "tests/data"
RANKS = (2, 3, 4, 8)
SOLVERS = {"amg": ["--tolerance", "1e-10"], "mumps": []}


def measured_packings():
    """{name: centres and radii} of the files that hold spheres."""
    found = {}
    for path in sorted(DATA.glob("*.csv")):
        head = path.read_text().split("\n", 1)[0].split(",")
        if head == ["id", "x", "y", "z", "radius"]:
            found[path.stem] = numpy.loadtxt(path, delimiter=",", skiprows=1, usecols=(1, 2, 3, 4))
    return found


def lattice(count):
    places = (numpy.stack(numpy.meshgrid(*[numpy.arange(count)] * 3), -1).reshape(-1, 3) + 0.5) / count
    return numpy.column_stack([places, numpy.full(len(places), 0.499 / count)])


def scattered(random, count, radii):
    return numpy.column_stack([random.uniform(0.0, 1.0, (count, 3)), radii])


def made_packings(dense):
    """`dense`: a dense packing of the unit cube."""
    random = numpy.random.default_rng(20)
    centres = dense[:, :3]
    apart = lambda spheres: spheres[numpy.unique(spheres[:, :3], axis=0, return_index=True)[1]]
    touching = lattice(6)
    jittered = touching.copy()
    jittered[:, :3] += 1e-13 * random.standard_normal((len(touching), 3))
    small = apart(scattered(random, 900, numpy.full(900, 0.012)))
    large = lattice(3) * [1, 1, 1, 0.4]
    free = numpy.linalg.norm(small[:, None, :3] - large[None, :, :3], axis=2).min(axis=1) > large[0, 3] + 0.012
    corner = dense.copy()
    corner *= 0.3
    return {
        "a hole in a dense bed": dense[numpy.linalg.norm(centres - 0.5, axis=1) > 0.3],
        "a free surface": dense[centres[:, 2] < 0.55],
        "size ratio 5 and more": numpy.vstack([large, small[free]]),
        "a cubic lattice, whose pores merge": touching,
        "the same, moved by rounding": jittered,
        "overlaps, and grains within others": numpy.vstack([dense * [1, 1, 1, 1.1], scattered(random, 60, numpy.full(60, 0.01))]),
        "a suspension": scattered(random, 60, random.uniform(0.01, 0.03, 60)),
        "grains in a corner": corner,
        "two beds far from each other": dense[(centres[:, 2] < 0.25) | (centres[:, 2] > 0.75)],
        "spheres at random, overlapping": scattered(random, 150, random.uniform(0.02, 0.12, 150)),
    }


class Solved:
    def __init__(self, folder, pfv, mpirun, spheres):
        self.folder, self.pfv, self.mpirun = folder, pfv, mpirun
        reach = [(spheres[:, axis] - spheres[:, 3]).min() for axis in range(3)], [(spheres[:, axis] + spheres[:, 3]).max()
                                                                                   for axis in range(3)]
        cube = spheres[:, :3].min() >= 0.0 and spheres[:, :3].max() <= 1.0
        self.box = ["0", "1"] * 3 if cube else [repr(float(bound)) for pair in zip(*reach) for bound in pair]
        numpy.savetxt(folder / "packing.csv", numpy.column_stack([numpy.arange(1, len(spheres) + 1), spheres]), delimiter=",",
                      header="id,x,y,z,radius", comments="", fmt=["%d"] + ["%.17g"] * 4)

    def by(self, solver, ranks):
        """Forces and permeability."""
        launch = [*self.mpirun, "-n", str(ranks)] if ranks > 1 else []
        done = subprocess.run([*launch, self.pfv, "solve", "--packing", "packing.csv", "--box", *self.box, "--face",
                               "zlo:pressure=0", "--face", "zhi:pressure=1", "--wall", "symmetry", "--solver", solver,
                               *SOLVERS[solver], "--report", "report.json", "--forces", "forces.csv"],
                              cwd=self.folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr)
        forces = numpy.loadtxt(self.folder / "forces.csv", delimiter=",", skiprows=1, ndmin=2, usecols=(1, 2, 3))
        return forces, json.loads((self.folder / "report.json").read_text()).get("permeability")


def worst_of(solved, solver):
    """Over all numbers of ranks: rms and worst grain of the forces over their rms, and permeability."""
    forces, permeability = solved.by(solver, 1)
    rms = numpy.sqrt((forces ** 2).sum(axis=1).mean())
    worst = numpy.zeros(3)
    for ranks in RANKS:
        f, k = solved.by(solver, ranks)
        apart = numpy.linalg.norm(f - forces, axis=1)
        of_k = abs(k / permeability - 1.0) if permeability else 0.0
        worst = numpy.maximum(worst, [numpy.sqrt((apart ** 2).mean()) / rms, apart.max() / rms, of_k])
    return worst


def rows(folder, pfv, mpirun, dense):
    made = made_packings(dense)
    groups = {f"the {len(measured_packings())} packings of tests/data": measured_packings(), **{name: {name: one}
              for name, one in made.items()}}
    for name, group in groups.items():
        worst = {solver: numpy.max([worst_of(Solved(folder, pfv, mpirun, one), solver) for one in group.values()], axis=0)
                 for solver in SOLVERS}
        yield [name, *("%.0e" % value for solver in SOLVERS for value in worst[solver])]

# SPDX-License-Identifier: GPL-3.0-or-later
"""Random packings with a given size ratio, as data files for LIGGGHTS and as CSV, and what `pfv
time-step` says of them."""
import csv
import functools
import json
import math
import random
import subprocess

import numpy as np

from samples import BIN, DENSITY, EDGE, SCENE, liggghts, must, write_data

STIFFNESS = 1.0e4  # N/m, of in.grains
POST = SCENE / "post"
DRAINED = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=0"]


def scattered(radii, rng):
    """Places for grains, large ones first: of 40 random places that with the widest gap."""
    places = np.empty((len(radii), 3))
    for k, radius in enumerate(radii):
        tries = rng.uniform(radius, EDGE - radius, (40, 3))
        gaps = np.linalg.norm(tries[:, None] - places[None, :k], axis=2) - radii[:k] - radius
        places[k] = tries[gaps.min(axis=1).argmax()] if k else tries[0]
    return places


def write_csv(path, grains):
    path.write_text("id,x,y,z,radius\n" + "".join(
        f"{n}," + ",".join(repr(float(value)) for value in grain) + "\n"
        for n, grain in enumerate(grains, 1)))


def read_csv(path):
    """Rows x, y, z, radius."""
    return np.loadtxt(path, delimiter=",", skiprows=1)[:, 1:5]


def rest_of(name, count):
    """Rows x, y, z, radius of post/NAME.rest."""
    rows = (POST / f"{name}.rest").read_text().splitlines()[9:]
    if len(rows) != count:
        raise SystemExit(f"stability: {count - len(rows)} grains of {name} left the box")
    return np.array([row.split()[1:] for row in rows], dtype=float)


def write_packing(name, grains):
    """post/NAME.csv and post/NAME.data."""
    write_csv(POST / f"{name}.csv", grains.tolist())
    # so slow that no grain moves by a part of its contact overlaps during a run
    write_data(POST / f"{name}.data", grains.tolist(), 1e-4, random.Random(1))


@functools.cache
def packed(ratio, count, solid, gap=0.0, seed=1):
    """Name of a packing whose diameters are spread evenly over 1 to `ratio` times the smallest: grains at
    random places push each other apart until they rest, and shrink by `gap` of their size. `solid` is
    their volume over that of the box. post/NAME.csv and post/NAME.data hold it."""
    name = f"ratio_{ratio:g}_{count}_{solid:g}_{seed}"
    rng = np.random.default_rng(seed)
    radii = np.sort(rng.uniform(1.0, ratio, count))[::-1]
    radii *= (1 + gap) * EDGE * (solid / (4 / 3 * math.pi * (radii**3).sum())) ** (1 / 3)
    grains = np.column_stack([scattered(radii, rng), radii]).tolist()
    data = POST / f"{name}.data"
    write_data(data, grains, 0.0, random.Random(1))
    mass = DENSITY * 4 / 3 * math.pi * radii[-1]**3
    step = 0.2 * math.sqrt(mass / STIFFNESS)
    must(liggghts("in.pack", data=data, dt=step, steps=5000, rest=25000, drag=0.02 * mass / step,
                  out=f"post/{name}.rest"))
    at_rest = rest_of(name, count)
    at_rest[:, 3] /= 1 + gap
    write_packing(name, at_rest)
    return name


@functools.cache
def rested(ratio, count, solid, steps=100000):
    """Name of `packed` after many more dry steps with strong dashpots: with size ratios of 10 and more
    grains there still give way."""
    name = packed(ratio, count, solid)
    label = f"rested_{name}"
    report, _ = time_step(POST / f"{name}.csv", "--spheres", 1, "--contact-stiffness", STIFFNESS)
    step = 0.2 * report["contact_limit"]
    lightest = DENSITY * 4 / 3 * math.pi * read_csv(POST / f"{name}.csv")[:, 3].min()**3
    must(liggghts("in.settle", data=POST / f"{name}.data", out=f"post/{label}.rest", dt=repr(step),
                  steps=steps, drag=0.05 * lightest / step, gamman=3000))
    write_packing(label, rest_of(label, count))
    return label


def contact_limit(name, stiffness=STIFFNESS):
    """s; of the contacts that there are, or of the smallest grain between two others: there may be grains
    without contacts, which meet others on their way."""
    report, _ = time_step(POST / f"{name}.csv", "--spheres", 1, "--contact-stiffness", stiffness)
    smallest = DENSITY * 4 / 3 * math.pi * read_csv(POST / f"{name}.csv")[:, 3].min()**3
    return min(report["contact_limit"], math.sqrt(2 * smallest / stiffness))


def overlaps(grains):
    """(contacts of a grain, largest overlap of two as a part of the smaller radius)"""
    contacts, largest = 0, 0.0
    for k, grain in enumerate(grains):
        others = grains[k + 1:]
        distance = np.linalg.norm(others[:, :3] - grain[:3], axis=1)
        overlap = others[:, 3] + grain[3] - distance
        contacts += 2 * int((overlap > 0).sum())
        if len(others):
            largest = max(largest, float((overlap / np.minimum(others[:, 3], grain[3])).max()))
    return contacts / len(grains), largest


def time_step(packing, *words, viscosity=1.0, law="hydraulic_radius", edge=EDGE, faces=DRAINED):
    """(report of `pfv time-step` on a CSV file, {id: V* of the grains looked at})"""
    report, matrices = POST / "time_step.json", POST / "time_step.csv"
    call = [str(BIN / "pfv"), "time-step", "--packing", str(packing), "--box",
            *["0", repr(edge)] * 3, *faces, "--viscosity", repr(viscosity), "--grain-density",
            repr(DENSITY), "--conductance", law, "--report", str(report), "--matrices",
            str(matrices), *map(str, words)]
    done = subprocess.run(call, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit("stability: " + done.stderr.strip())
    with open(matrices, newline="") as file:
        rows = list(csv.reader(file))[1:]
    return (json.loads(report.read_text()),
            {int(row[0]): np.array(row[2:], dtype=float).reshape(3, 3) for row in rows})

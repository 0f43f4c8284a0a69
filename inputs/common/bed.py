# SPDX-License-Identifier: GPL-3.0-or-later
"""Sea beds of the thesis (Catalano 2012, chapter 6): a vessel 2.0 x 0.5 m, about 1 m of grains."""
import json
import math

import numpy as np

import scene
from contact_stress import share_below

LENGTH, WIDTH = 2.0, 0.5  # m, along the wave and across it
DENSITY, FLUID_DENSITY, GRAVITY = 2600.0, 1000.0, 9.81
BUOYANT = GRAVITY * (1.0 - FLUID_DENSITY / DENSITY)
# 5000 grains of the mean size 0.06 m (thesis, tables 6.2 and 6.3); with fewer grains larger ones
# fill the same bed
MEAN_CUBE = (0.9**3 + 1.0 + 1.1**3) / 3.0
SOLID = 5000 * 4.0 / 3.0 * math.pi * 0.03**3 * MEAN_CUBE  # m3
VISCOSITY = 100.0  # Pa s at 5000 grains
VISCOSITY_KEY = (float, 0.0, "Pa s; 0: chosen from the grain size")

FRICTION = 0.57735  # of grains at rest: tan 30 degrees
# friction and sinking speed (m/s) of the grains while the bed is made
KINDS = {"dense": {"mu_fall": 0.0175, "speed": 1.0}, "loose": {"mu_fall": FRICTION, "speed": 0.15}}


def mean_radius(grains):
    return (SOLID / (grains * 4.0 / 3.0 * math.pi * MEAN_CUBE)) ** (1.0 / 3.0)


def viscosity_for(grains):
    """K/mu as with 5000 grains: K goes with d^2."""
    return VISCOSITY * (mean_radius(grains) / 0.03) ** 2


def prepare(folder, kind, grains, seed, out, made=0.0, local=0.0, given=""):
    """Restart file, dump and measures of a bed; makes it where OUT has none of this kind. `made`: with this friction
    (degrees) its grains sink and come to rest, instead of those of its kind; who reads the restart file gives another.
    `local`: local damping of its grains until then, 0 to 1. `given`: the dump of a bed that was made elsewhere, whose grains
    come to rest where they are."""
    store = folder / f"{out}_bed.json"
    wanted = {"kind": kind, "N": grains, "SEED": seed, "MADE": made, "LOCAL": local, "GIVEN": given}
    if store.exists() and json.loads(store.read_text())["of"] == wanted:
        return json.loads(store.read_text())
    radius = mean_radius(grains)
    small = 0.9 * radius
    contact_step = 0.1 * math.sqrt(DENSITY * 4 / 3 * math.pi * small**3 / (2 * 15e6 * small))
    top = SOLID / (0.22 * LENGTH * WIDTH)
    mass = DENSITY * 4.0 / 3.0 * math.pi * radius**3
    speed = KINDS[kind]["speed"]
    fall = round((top / speed + 2.0) / (2.5 * contact_step))
    variables = {"N": grains, "r2": radius, "LX": LENGTH, "LY": WIDTH, "top": top,
                 "mu_fall": math.tan(math.radians(made)) if made else KINDS[kind]["mu_fall"],
                 "mu_rest": math.tan(math.radians(made)) if made else FRICTION, "g": BUOYANT,
                 "drag": mass * BUOYANT / speed, "fall": fall,
                 "settle": round(1.5 / (2.5 * contact_step)), "local": local, "stand": int(bool(given)), "given": f"{out}.data",
                 "hold": round(1.0 / (2.5 * contact_step)), "out": out, "name": folder.name,
                 **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(seed))}}
    if given:
        write_data(folder / variables["given"], read_dump(given), radius, top)
    print(f"{kind} bed of {grains} grains, mean diameter {2 * radius:.4f} m", flush=True)
    said, cpu = scene.liggghts(folder, "../common/in.bed", variables, out + "_bed",
                               scene.Progress("bed", 0, fall, 2.5 * contact_step))
    measures = {"of": wanted, "step": int(said["bed"][0]), "contact_step": float(said["bed"][1]),
                "cpu": cpu, **measure(read_dump(folder / f"{out}.dump"))}
    store.write_text(json.dumps(measures, indent=1) + "\n")
    return measures


def read_dump(path):
    """Columns id, type, x, y, z, radius of a dump with one snapshot."""
    return np.loadtxt(path, skiprows=9)


def write_dump(path, grains):
    """As read_dump reads them."""
    bounds = [(0, LENGTH), (0, WIDTH), (0, (grains[:, 4] + grains[:, 5]).max())]
    header = ["ITEM: TIMESTEP", "0", "ITEM: NUMBER OF ATOMS", f"{len(grains)}", "ITEM: BOX BOUNDS ff ff ff",
              *(f"{low!r} {float(high)!r}" for low, high in bounds), "ITEM: ATOMS id type x y z radius"]
    np.savetxt(path, grains, fmt="%d %d %.17g %.17g %.17g %.17g", header="\n".join(header), comments="")


def write_data(path, grains, radius, top):
    """The grains of a dump as a data file of LIGGGHTS for in.bed: types by their sizes."""
    types = 1 + abs(grains[:, 5, None] / radius - [0.9, 1.0, 1.1]).argmin(axis=1)
    edges = [(-2 * radius, end + 2 * radius) for end in (LENGTH, WIDTH, top)]
    lines = ["a bed that was made elsewhere", "", f"{len(grains)} atoms", "4 atom types", "",
             *(f"{low!r} {float(high)!r} {axis}lo {axis}hi" for axis, (low, high) in zip("xyz", edges)), "", "Atoms", ""]
    lines += [f"{int(g[0])} {kind} {2 * g[5]!r} {DENSITY!r} {g[2]!r} {g[3]!r} {g[4]!r}" for g, kind in zip(grains.tolist(), types)]
    path.write_text("\n".join(lines) + "\n")


def porosity(z, radius, low, high, area=LENGTH * WIDTH):
    """Of the layer between two heights."""
    volume = 4.0 / 3.0 * math.pi * radius**3
    solid = volume @ (share_below(z, radius, high) - share_below(z, radius, low))
    return 1.0 - solid / (area * (high - low))


def surface(z, radius):
    """Mean height of the surface: the mean top of the highest grain in each of many columns is
    noisy with few grains; this is the height at which the solid of the uppermost tenth would be
    spent at the porosity of the middle."""
    order = np.argsort(z)
    middle = z[order[int(0.9 * len(z))]]
    inner = porosity(z, radius, 0.2 * middle, 0.8 * middle)
    volume = 4.0 / 3.0 * math.pi * radius**3
    above = volume @ (1.0 - share_below(z, radius, 0.8 * middle))
    return 0.8 * middle + above / ((1.0 - inner) * LENGTH * WIDTH)


def core_porosity(grains, ends):
    """Porosity one mean diameter and more away from the walls and surface of a box from 0 to `ends`, where the layers
    along them do not count: from a grid of points."""
    places, radius = grains[:, 2:5], grains[:, 5]
    margin, step = 2.0 * radius.mean(), radius.mean() / 8.0
    axes = [np.arange(margin, end - margin, step) for end in ends]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    solid = np.zeros(points.shape[:3], dtype=bool)
    for place, r in zip(places, radius):
        first = ((place - r - margin) / step).astype(int)
        last = ((place + r - margin) / step).astype(int) + 2
        near = [slice(max(0, a), max(0, b)) for a, b in zip(first, last)]
        window = points[near[0], near[1], near[2]]
        solid[near[0], near[1], near[2]] |= ((window - place)**2).sum(axis=-1) < r * r
    return float(1.0 - solid.mean())


def measure(grains):
    z, radius = grains[:, 4], grains[:, 5]
    height = surface(z, radius)
    inner = porosity(z, radius, 0.2 * height, 0.8 * height)
    return {"height": float(height), "top": float((z + radius).max()),
            "core_porosity": core_porosity(grains, (LENGTH, WIDTH, height)), "porosity": float(inner),
            "critical_gradient": float((1 - inner) * (DENSITY - FLUID_DENSITY) / FLUID_DENSITY)}

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Permeability of any packing in three directions, the pressures, and how far to trust them.

    run.py [KEY=VALUE...]      called by ./run.sh permeameter [KEY=VALUE...]
"""
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import fields
import scene
from plotting import plt

KEYS = {
    "PACKING": (str, "", "CSV with id,x,y,z,radius or LIGGGHTS dump; none: tests/data/packing_500"),
    "BOX": (str, "", "XLO,XHI,YLO,YHI,ZLO,ZHI in m; none: the extent of the grains, or of a periodic dump's cell"),
    "PERIODIC": (str, "dump", "dump: the axes that are periodic in the dump; none: walls on all sides"),
    "LAW": scene.LAW,
    "WALL": (str, "no_slip", "no_slip or symmetry side walls"),
    "OUT": scene.OUT,
}
PACKING = SCENE.parents[1] / "tests" / "data" / "packing_500.csv"
PACKING_BOX = "0,1,0,1,0,1"


def read_grains(path):
    """x, y, z, radius of a CSV file or of the last snapshot of a dump."""
    lines = Path(path).read_text().splitlines()
    if lines[0].startswith("ITEM:"):
        start = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
        names, separator = lines[start].split()[2:], None
    else:
        start, names, separator = 0, [name.strip() for name in lines[0].split(",")], ","
    columns = [names.index(name) for name in ("x", "y", "z", "radius")]
    rows = [line.split(separator) for line in lines[start + 1:] if line.strip()]
    return np.array([[float(row[c]) for c in columns] for row in rows])


def cell_of(path):
    """{axis: (low, high)} of the axes along which a dump's last simulation box is periodic."""
    lines = Path(path).read_text().splitlines()
    starts = [k for k, line in enumerate(lines) if line.startswith("ITEM: BOX BOUNDS")]
    if not starts:
        return {}
    kinds = lines[starts[-1]].split()[3:]
    if len(kinds) == 6:
        raise scene.BadSetting(f"{path}: its simulation box is tilted; give an orthogonal one")
    bounds = [line.split() for line in lines[starts[-1] + 1:starts[-1] + 4]]
    return {axis: (float(low), float(high))
            for axis, kind, (low, high) in zip("xyz", kinds, bounds) if kind == "pp"}


def extent(grains):
    low = (grains[:, :3] - grains[:, 3:]).min(axis=0)
    high = (grains[:, :3] + grains[:, 3:]).max(axis=0)
    return np.column_stack([low, high]).ravel().tolist()


def references(grains, porosity):
    """Permeability (m2) of a bed of the grains' Sauter diameter: Kozeny-Carman, van der Hoef."""
    d = 2.0 * (grains[:, 3]**3).sum() / (grains[:, 3]**2).sum()
    c = 1.0 - porosity
    drag = 10.0 * c / porosity**2 + porosity**2 * (1.0 + 1.5 * np.sqrt(c))
    return {"Kozeny-Carman": d * d * porosity**3 / (180.0 * c * c),
            "van der Hoef et al. 2005": d * d * porosity / (18.0 * c * drag)}


def driven_along(axis, box, cell):
    """1 Pa between the two faces of an axis, or from each period to the next."""
    if axis not in cell:
        return ["--face", f"{axis}lo:pressure=1", "--face", f"{axis}hi:pressure=0"]
    number = "xyz".index(axis)
    gradient = ["0", "0", "0"]
    gradient[number] = repr(-1.0 / (box[2 * number + 1] - box[2 * number]))
    return ["--gradient", *gradient]


def solve(settings, packing, box, cell):
    reports = {}
    periodic = ["--periodic", ",".join(cell)] if cell else []
    for axis in "xyz":
        out = f"{settings['OUT']}_{axis}"
        print(f"flow along {axis}", flush=True)
        reports[axis] = scene.pfv_solve(
            SCENE, packing, box, 1.0e-3, f"{out}.json", "--wall", settings["WALL"],
            "--conductance", settings["LAW"], *periodic, *driven_along(axis, box, cell),
            "--vtk", f"{out}.vtu", "--forces", f"{out}.csv")
    return reports


def confidence(report):
    """One sentence from the report's own estimate."""
    error = report.get("permeability_error")
    if error is None:
        return "no estimate of the error"
    why = "; ".join(report["outside_range"])
    return (f"Stokes flow is expected within a factor {1 + error:.2f} of each value"
            + (f", but: {why}" if why else ""))


def draw(settings, box, cell, reports):
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.8))
    for place, axis in zip(axes, "xyz"):
        flow = fields.Fields(SCENE / f"{settings['OUT']}_{axis}.vtu")
        along = "xyz".index(axis)
        across = (along + 1) % 3
        dots = place.scatter(flow.points[:, along], flow.points[:, across], c=flow["pressure"],
                             s=4, cmap="coolwarm", **({} if axis in cell else {"vmin": 0, "vmax": 1}))
        place.set(xlabel=f"{axis}, m", ylabel=f"{'xyz'[across]}, m",
                  xlim=box[2 * along:2 * along + 2], ylim=box[2 * across:2 * across + 2],
                  title=f"K = {reports[axis]['permeability']:.3e} m²")
    figure.colorbar(dots, ax=axes, label="p / Δp in the pores")
    figure.savefig(SCENE / f"{settings['OUT']}_pressures.png", dpi=90, bbox_inches="tight")
    plt.close(figure)


def work(words):
    settings = scene.parse(words, KEYS)
    packing = settings["PACKING"] or str(PACKING)
    try:
        grains = read_grains(packing)
        box = settings["BOX"] or ("" if settings["PACKING"] else PACKING_BOX)
        cell = cell_of(packing) if settings["PERIODIC"] == "dump" else {}
        box = [float(word) for word in box.split(",")] if box else extent(grains)
    except (OSError, ValueError) as problem:
        raise scene.BadSetting(f"{packing} or BOX: {problem}") from None
    if settings["PERIODIC"] not in ("dump", "none"):
        raise scene.BadSetting("PERIODIC is dump or none")
    if len(box) != 6:
        raise scene.BadSetting("BOX needs six numbers, with commas between them")
    for axis, bounds in cell.items():
        box[2 * "xyz".index(axis):2 * "xyz".index(axis) + 2] = bounds
    if cell:
        print("the dump's simulation box is periodic along " + ", ".join(
            f"{axis} ({low:g} to {high:g} m)" for axis, (low, high) in cell.items()))
    reports = solve(settings, str(Path(packing).resolve()), box, cell)
    values = [reports[axis]["permeability"] for axis in "xyz"]
    report = reports["z"]
    print(f"\nPermeameter, {report['spheres']} grains, porosity {report['porosity']:.4f}, "
          f"{report['pores']} pores, law {settings['LAW']}")
    for axis, value in zip("xyz", values):
        print(f"  K along {axis}                {value:.4e} m2   mass error "
              f"{reports[axis]['mass_error']:.1e}, force balance "
              f"{reports[axis]['force_balance_error']:.1e}")
    for name, value in references(grains, report["porosity"]).items():
        print(f"  {name:<24s} {value:.4e} m2   mean K / this {np.mean(values) / value:.3f}")
    print(f"  {confidence(report)}")
    draw(settings, box, cell, reports)
    mass = max(abs(r["mass_error"]) for r in reports.values())
    forces = max(r["force_balance_error"] for r in reports.values())
    checks = [("mass error, largest", mass, "<= 1e-10", mass <= 1e-10),
              ("force balance error, largest", forces, "<= 1e-10", forces <= 1e-10)]
    return scene.summary(SCENE, settings["OUT"], {**settings, "K": values, "box": box}, checks)


if __name__ == "__main__":
    scene.main("permeameter", work)

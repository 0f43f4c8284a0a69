# SPDX-License-Identifier: GPL-3.0-or-later
"""The printed limit over size ratio, number of grains and mass of a lid, against the papers' estimates
and, at some points, against LIGGGHTS: doc/figures/stability_maps.png and a table."""
import sys

from bisection import bears, calms_down, largest_stable, printed_with_lid, write_lid
from packings import POST, packed, time_step
from samples import SCENE, printed, sample
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402

THICK = 1e4  # Pa s: contacts play no part
SIZE_RATIOS = {"dense": {1.2: 0.60, 2: 0.605, 3: 0.61, 5: 0.63, 10: 0.66, 20: 0.68, 50: 0.69},
               "loose": {ratio: 0.45 for ratio in (1.2, 2, 3, 5, 10, 20, 50)}}  # share of the grains' volume
SIZE_GRAINS = 500
MEASURED_RATIOS = (1.2, 3, 10)
COUNTS = [125, 250, 500, 1000, 2000]
MEASURED_COUNTS = (125, 1000)
LID_MASSES = [10.0**k for k in range(-4, 2)]  # kg
LOOKED_AT = 300  # grains whose V is found


class Points:
    """One curve of the map: what is printed, estimated and measured, in seconds."""

    def __init__(self, rows, kind):
        self.rows, self.kind, self.points = rows, kind, []

    def add(self, value, limit, formula, matrix, found=None):
        self.points.append((value, limit, formula, matrix, found))
        cells = [f"{limit:.3e}", f"{limit / formula:.3g}" if formula else "",
                 f"{limit / matrix:.3g}" if matrix else "",
                 f"{found / limit:.3f}" if found else ""]
        self.rows.row(f"{self.kind} {value:g}", *cells)

    def plot(self, figure, colour, label=""):
        values, limits, formulas, matrices, found = zip(*self.points)
        figure.loglog(values, limits, "-", color=colour, label=label + "printed")
        for estimate, style, name in ((formulas, ":", "eq. 4.20"), (matrices, "--", "eq. 4.15")):
            if estimate[0]:
                figure.loglog(values, estimate, style, color=colour, label=label + name)
        shown = [(value, one) for value, one in zip(values, found) if one]
        if shown:
            figure.loglog(*zip(*shown), "o", color=colour, mfc="none", label=label + "LIGGGHTS")


def packing_point(points, name, value, measure):
    """Printed limit by `pfv time-step`, measured in LIGGGHTS where wanted."""
    report, _ = time_step(POST / f"{name}.csv", "--spheres", LOOKED_AT, viscosity=THICK)
    limit, found = report["coupling_limit"], None
    if measure:
        found = largest_stable(calms_down(f"post/{name}.data", THICK), limit, 0.9, 1.15, 0.01)
    points.add(value, limit, report["formula"]["time_step"], report["viscous"]["time_step"], found)


def sizes(figure, rows):
    for (kind, solids), colour in zip(SIZE_RATIOS.items(), ("tab:blue", "tab:orange")):
        points = Points(rows, f"size ratio, {kind},")
        for ratio, solid in solids.items():
            name = packed(ratio, SIZE_GRAINS, solid, gap=0.01 if kind == "loose" else 0.0)
            packing_point(points, name, ratio, ratio in MEASURED_RATIOS)
        points.plot(figure, colour, kind + ": ")
    figure.set(xlabel="d_max/d_min", ylabel=f"time step at {THICK:g} Pa s, s")


def counts(figure, rows):
    points = Points(rows, "grains, d_max/d_min = 1.2,")
    for count in COUNTS:
        packing_point(points, packed(1.2, count, 0.60), count, count in MEASURED_COUNTS)
    points.plot(figure, "tab:blue")
    figure.set(xlabel="grains in the box")


def lids(figure, rows):
    write_lid()
    data = sample("dense")
    points = Points(rows, "mass of the lid, kg,")
    _, estimate = printed(data, THICK)
    for mass in LID_MASSES:
        limit = printed_with_lid(data, THICK, mass)
        points.add(mass, limit, estimate, None,
                   largest_stable(bears(data, THICK, mass), limit, 0.9, 1.15, 0.01))
    points.plot(figure, "tab:blue")
    figure.set(xlabel="mass of the lid, kg", ylabel=f"time step at {THICK:g} Pa s, s")


def table():
    rows = Table("what varies", "printed limit, s", "printed / eq. 4.20", "printed / eq. 4.15",
                 "measured / printed")
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.5))
    for draw, axis in zip((sizes, counts, lids), axes):
        draw(axis, rows)
        axis.legend(fontsize=7)
    save_figure(figure, FIGURES / "stability_maps.png")
    return rows

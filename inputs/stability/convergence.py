# SPDX-License-Identifier: GPL-3.0-or-later
"""Order of the couplings in the time step: a table, and doc/figures/stability_convergence.png."""
import sys

from consolidations import consolidation, largest, percent
from samples import SCENE, printed, sample
from tables import Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure

TIME = 0.032  # s
STEPS = {"explicit": [4e-6, 2e-6, 1e-6],
         "staged": [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5],
         "implicit": [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6]}
FINEST = 2.5e-7  # s, explicit
KEPT = "retriangulate 1000"  # networks replaced at other instants would hide the order
WHAT = ("settlement", "mean pressure", "force of the fluid")
# the force of a dashpot jumps where a contact opens, at another instant in each run
DASHPOTS = {"without dashpots": 1e-6, "with dashpots": 500}  # damping, 1/s
FIGURE = SCENE.parents[1] / "doc" / "figures" / "stability_convergence.png"


def draw(errors, limit):
    """Without dashpots; errors[coupling]: rows of the time step and WHAT."""
    figure, plots = plt.subplots(1, 3, figsize=(12, 4), sharex=True, sharey=True)
    for column, (plot, what) in enumerate(zip(plots, WHAT)):
        for (coupling, rows), mark in zip(errors.items(), ("^", "o", "s")):
            plot.loglog([row[0] / limit for row in rows], [row[1 + column] for row in rows], mark + "-",
                        label=coupling)
        ends = [STEPS["explicit"][-1], STEPS["implicit"][0]]
        plot.loglog([end / limit for end in ends],
                    [errors["implicit"][2][1 + column] * end / 1e-4 for end in ends], "k:",
                    label="order 1")
        plot.axvline(1.0, color="0.7", zorder=0)
        plot.set(title=what, xlabel="time step / explicit limit")
        plot.grid(True, which="both", alpha=0.2)
    plots[0].set_ylabel("largest difference from the finest run")
    plots[0].legend()
    save_figure(figure, FIGURE)


def table():
    """Against the explicit coupling at a twentieth of its limit."""
    data = sample("dense")
    per_viscosity, _ = printed(data, 1.0)
    viscosity = 20 * per_viscosity / 1e-4
    limit = per_viscosity / viscosity

    def run(step, words, damping):
        return consolidation(data, viscosity, step, f"{words} {KEPT}", TIME, gamman=damping)

    fine = {damping: run(FINEST, "time_step_check no", damping) for damping in DASHPOTS.values()}
    rows = Table("coupling", "time step, s", "R",
                 *(f"{what}, {which}" for which in DASHPOTS for what in WHAT))
    errors = {}
    for coupling, steps in STEPS.items():
        for step in steps:
            words = "time_step_check no" if coupling == "explicit" else f"coupling {coupling}"
            off = []
            for damping, other in fine.items():
                one = run(step, words, damping)
                off += [largest(one.heights, other.heights) / (other.heights[0] - other.heights[-1]),
                        largest(one.pressures[1:], other.pressures[1:]) / max(other.pressures),
                        largest(one.forces[1:], other.forces[1:]) / max(map(abs, other.forces))]
            errors.setdefault(coupling, []).append((step, *off[:len(WHAT)]))
            rows.row(coupling, f"{step:g}", f"{step / limit:.3g}", *map(percent, off))
    draw(errors, limit)
    return rows

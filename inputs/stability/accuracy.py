# SPDX-License-Identifier: GPL-3.0-or-later
"""Accuracy of long time steps in a consolidation with retriangulations."""
import os

from samples import liggghts, must, printed, rows_of, sample
from tables import Table


def consolidation(data, viscosity, step, words, time=0.032):
    """(heights, mean pressures, retriangulations, CPU seconds) of a consolidation."""
    before = os.times().children_user
    screen = must(liggghts("in.consolidation", data=data, viscosity=viscosity, dt=repr(step),
                           steps=round(time / step), words=words))
    rows = rows_of(screen)
    return ([row[1] for row in rows], [row[2] for row in rows], rows[-1][3],
            os.times().children_user - before)


def table():
    """Against the explicit coupling at a fifth of its own limit."""
    data = sample("dense")
    limit, _ = printed(data, 1.0)
    viscosity = 20 * limit / 1e-4
    heights, pressures, *_ = consolidation(data, viscosity, 1e-6, "time_step_check no")
    settled, peak = abs(heights[-1] - heights[0]), max(pressures[1:])
    rows = Table("coupling", "time step, s", "R", "settlement", "pressure", "pressure, last quarter",
                 "new networks", "CPU / explicit at 0.8 of its limit")
    cases = [("explicit", 4e-6)] + [(coupling, step) for coupling in ("staged", "implicit")
                                    for step in (2e-4, 1e-4, 5e-5, 2.5e-5)]
    explicit_cpu = None
    for coupling, step in cases:
        words = "time_step_check no" if coupling == "explicit" else f"coupling {coupling}"
        h, p, networks, cpu = consolidation(data, viscosity, step, words)
        explicit_cpu = explicit_cpu or cpu
        off = [abs(a - b) / peak for a, b in zip(p, pressures)][1:]
        settlement = max(abs(a - b) for a, b in zip(h, heights)) / settled
        rows.row(coupling, f"{step:g}", f"{20 * step / 1e-4:.2g}", f"{100 * settlement:.2f} %",
                 f"{100 * max(off):.2f} %", f"{100 * max(off[-4:]):.2f} %", f"{networks:.0f}",
                 f"{cpu / explicit_cpu:.3f}")
    return rows

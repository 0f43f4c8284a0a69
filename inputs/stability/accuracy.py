# SPDX-License-Identifier: GPL-3.0-or-later
"""Accuracy of long time steps in a consolidation with retriangulations."""
from consolidations import consolidation, largest, percent
from samples import printed, sample
from tables import Table

TIME = 0.032  # s


def table():
    """Against the explicit coupling at a fifth of its own limit."""
    data = sample("dense")
    limit, _ = printed(data, 1.0)
    viscosity = 20 * limit / 1e-4
    fine = consolidation(data, viscosity, 1e-6, "time_step_check no", TIME)
    settled, peak = abs(fine.heights[-1] - fine.heights[0]), max(fine.pressures[1:])
    rows = Table("coupling", "time step, s", "R", "settlement", "pressure", "pressure, last quarter",
                 "new networks", "CPU / explicit at 0.8 of its limit")
    cases = [("explicit", 4e-6)] + [(coupling, step) for coupling in ("staged", "implicit")
                                    for step in (2e-4, 1e-4, 5e-5, 2.5e-5)]
    explicit_cpu = None
    for coupling, step in cases:
        words = "time_step_check no" if coupling == "explicit" else f"coupling {coupling}"
        run = consolidation(data, viscosity, step, words, TIME)
        explicit_cpu = explicit_cpu or run.cpu
        off = [abs(a - b) / peak for a, b in zip(run.pressures, fine.pressures)][1:]
        rows.row(coupling, f"{step:g}", f"{20 * step / 1e-4:.2g}",
                 percent(largest(run.heights, fine.heights) / settled), percent(max(off)),
                 percent(max(off[-4:])), run.networks, f"{run.cpu / explicit_cpu:.3f}")
    return rows

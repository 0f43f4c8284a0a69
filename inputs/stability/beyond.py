# SPDX-License-Identifier: GPL-3.0-or-later
"""Staged and implicit coupling at time steps beyond the explicit limit."""
import math

from samples import growth, must, liggghts, printed, rows_of, sample
from tables import Table

RATIOS = [2, 10, 100, 200, 1000, 10000]
CONTACT_PARTS = {"a sixth": 1e-4, "half": 3e-4}  # of the contact limit of 6e-4 s: time step, s
STEPS = 1000


def power(value):
    return f"{value:.1e}" if math.isfinite(value) else "ended by an error"


def table():
    """At two time steps, which the contacts allow; the viscosity sets R."""
    data = sample("dense")
    limit, _ = printed(data, 1.0)
    rows = Table("R", "time step, of the contacts' limit", "viscosity, Pa s", "stages", "staged",
                 "implicit", "explicit, after 3 steps")
    for ratio in RATIOS:
        for part, step in CONTACT_PARTS.items():
            viscosity = ratio * limit / step
            screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=step, steps=0,
                                   words="coupling staged"))
            left = [power(growth(data, viscosity, step, STEPS, f"coupling {coupling}"))
                    for coupling in ("staged", "implicit")]
            explicit = power(growth(data, viscosity, step, 3, "time_step_check no"))
            rows.row(ratio, part, f"{viscosity:.3g}", f"{rows_of(screen)[0][3]:.0f}", *left, explicit)
    return rows

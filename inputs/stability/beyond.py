# SPDX-License-Identifier: GPL-3.0-or-later
"""What the three couplings do at time steps beyond the explicit limit."""
import math

from samples import growth, must, liggghts, printed, rows_of, sample
from tables import Table

RATIOS = [2, 10, 100, 1000, 10000, 100000]
LARGEST_STAGED = 10000
STEP = 1e-4  # s, a sixth of the contact limit of 6e-4 s
STEPS = 1000


def power(value):
    return f"{value:.1e}" if math.isfinite(value) else "ended by an error"


def table():
    """The viscosity sets R."""
    data = sample("dense")
    limit, _ = printed(data, 1.0)
    rows = Table("R", "viscosity, Pa s", "stages", "staged", "implicit", "explicit, after 3 steps")
    for ratio in RATIOS:
        viscosity, stages, staged = ratio * limit / STEP, "", ""
        if ratio <= LARGEST_STAGED:
            screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=STEP, steps=0,
                                   words="coupling staged"))
            stages = f"{rows_of(screen)[0][3]:.0f}"
            staged = power(growth(data, viscosity, STEP, STEPS, "coupling staged"))
        rows.row(ratio, f"{viscosity:.3g}", stages, staged,
                 power(growth(data, viscosity, STEP, STEPS, "coupling implicit")),
                 power(growth(data, viscosity, STEP, 3, "time_step_check no")))
    return rows

# SPDX-License-Identifier: GPL-3.0-or-later
"""Growth that no scheme and no time step takes away: the papers' S is not the transpose of E."""
import math

from samples import SAMPLES, growth, printed, sample
from tables import Table

RATIOS = [0.5, 20, 100, 1000]


def table(viscosity=1e5, time=5000):
    """Steps so short that contacts do nothing: the fluid alone, over the same time in all runs."""
    rows = Table("sample", *(f"{'explicit' if ratio < 1 else 'staged'}, R = {ratio:g}"
                             for ratio in RATIOS), "rate x limit")
    for name in SAMPLES:
        data = sample(name)
        limit, _ = printed(data, viscosity)
        factors = []
        for ratio in RATIOS:
            words = "time_step_check no" if ratio < 1 else "coupling staged"
            once, twice = (growth(data, viscosity, ratio * limit, round(part * time / ratio), words)
                           for part in (1, 2))
            factors.append(twice / once)
        rows.row(name, *(f"{factor:.2f}" for factor in factors),
                 f"{math.log(factors[0]) / (2 * time):.1e}")
    return rows

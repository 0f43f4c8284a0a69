# SPDX-License-Identifier: GPL-3.0-or-later
"""The printed limit of the explicit coupling against the one found by bisection in LIGGGHTS."""
from samples import SAMPLES, growth, printed, sample
from tables import Table

VISCOSITIES = [10.0**k for k in range(1, 7)]  # Pa s
STEPS = 1000


def measured(data, viscosity, limit):
    """The largest stable step, by bisection to 0.3 %; s."""
    def stable(factor):
        return growth(data, viscosity, factor * limit, STEPS, "time_step_check no") <= 1.0
    low, high = 0.8, 1.4
    if not stable(low) or stable(high):
        raise SystemExit(f"stability: the limit at {viscosity:g} Pa s is not within {low} and "
                         f"{high} of the printed one")
    while high - low > 0.003:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low * limit


def table():
    rows = Table("sample", "viscosity, Pa s", "printed limit, s", "measured limit, s",
                 "measured / printed", "measured / papers' estimate")
    for name in SAMPLES:
        for viscosity in VISCOSITIES:
            limit, estimate = printed(sample(name), viscosity)
            found = measured(sample(name), viscosity, limit)
            rows.row(name, f"{viscosity:g}", f"{limit:.3e}", f"{found:.3e}",
                     f"{found / limit:.3f}", f"{found / estimate:.3f}")
    return rows

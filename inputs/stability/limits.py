# SPDX-License-Identifier: GPL-3.0-or-later
"""The printed limit of the explicit coupling against the one found by bisection in LIGGGHTS."""
from bisection import bears, calms_down, largest_stable, printed_with_lid, write_lid
from samples import SAMPLES, printed, sample
from tables import Table

VISCOSITIES = [10.0**k for k in range(1, 7)]  # Pa s
LID = 0.01  # kg


def table():
    write_lid()
    rows = Table("sample", "viscosity, Pa s", "printed limit, s", "measured limit, s",
                 "measured / printed", "measured / papers' estimate")

    def row(name, viscosity, limit, found, estimate):
        rows.row(name, f"{viscosity:g}", f"{limit:.3e}", f"{found:.3e}", f"{found / limit:.3f}",
                 f"{found / estimate:.3f}")

    for name in SAMPLES:
        data = sample(name)
        for viscosity in VISCOSITIES:
            limit, estimate = printed(data, viscosity)
            row(name, viscosity, limit, largest_stable(calms_down(data, viscosity), limit), estimate)
    data = sample("dense")
    for viscosity in VISCOSITIES:
        limit = printed_with_lid(data, viscosity, LID)
        row("dense, lid", viscosity, limit, largest_stable(bears(data, viscosity, LID), limit),
            printed(data, viscosity)[1])
    return rows

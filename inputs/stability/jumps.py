# SPDX-License-Identifier: GPL-3.0-or-later
"""How far, and how long, mean pressure and force of the fluid jump when a new network takes the place of the old
one: the velocities of the grains leave the pores of the old network as they are, not yet those of the new."""
import statistics

from consolidations import OFTEN, percent
from samples import liggghts, must, printed, rows_of, sample
from tables import Table

TIME, STEP = 0.032, 1e-4  # s; R = 20
RUNS = {"explicit": (100, 25), "staged": (1,), "implicit": (1,)}  # parts of STEP
LEFT = 0.1  # of a jump, when it is over
SEEN = 20  # steps in which it is looked for


def second_difference(values, k):
    """What step k adds to what the two before lead one to expect."""
    return abs(values[k] - 2 * values[k - 1] + values[k - 2])


def lasts(values, k, until):
    """Steps until a part LEFT is left of the distance from the line that joins step k - 1 and `until`."""
    slope = (values[until] - values[k - 1]) / (until - k + 1)
    away = [abs(values[later] - values[k - 1] - slope * (later - k + 1)) for later in range(k, until)]
    return next((count for count, one in enumerate(away) if one < LEFT * away[0]), len(away))


def table():
    data = sample("dense")
    limit, _ = printed(data, 1.0)
    viscosity = 20 * limit / STEP
    rows = Table("coupling", "R", "new networks", "jump of the mean pressure, of its peak: median, largest",
                 "jump of the force, of the largest: median, largest",
                 "steps until a tenth of the larger half is left: median",
                 "the same difference of steps without a new network, median: pressure, force")
    for coupling, all_parts in RUNS.items():
        for parts in all_parts:
            words = ("time_step_check no" if coupling == "explicit" else f"coupling {coupling}") + OFTEN
            found = rows_of(must(liggghts(
                "in.consolidation", data=data, viscosity=viscosity, dt=repr(STEP / parts),
                steps=round(TIME / STEP) * parts, often=1, words=words)), columns=8)
            pressures, networks, forces = ([row[column] for row in found] for column in (2, 3, 5))
            fresh = [k for k in range(2, len(found)) if networks[k] != networks[k - 1]]
            kept = [k for k in range(3, len(found)) if networks[k] == networks[k - 3]]
            cells, otherwise = [], []
            for values in (pressures, forces):
                scale = max(map(abs, values))
                jumps = [second_difference(values, k) / scale for k in fresh]
                cells.append(f"{percent(statistics.median(jumps))}, {percent(max(jumps))}")
                otherwise.append(percent(statistics.median(second_difference(values, k) / scale
                                                           for k in kept), 3))
            if coupling == "explicit":
                by_size = sorted(fresh, key=lambda k: second_difference(pressures, k))
                larger = [k for k in by_size[len(fresh) // 2:] if k + SEEN < len(found)]
                cells.append(f"{statistics.median(lasts(pressures, k, k + SEEN) for k in larger):g}")
            else:
                cells.append("")
            rows.row(coupling, f"{20 / parts:g}", len(fresh), *cells, ", ".join(otherwise))
    return rows

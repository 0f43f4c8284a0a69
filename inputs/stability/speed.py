# SPDX-License-Identifier: GPL-3.0-or-later
"""CPU and error of staged and implicit steps against the explicit coupling at its own limit: 1728
grains of 8 mm and 15 MPa in 250 Pa s, the thesis' viscosity."""
from consolidations import consolidation, largest, percent
from samples import printed, sample
from tables import Table

CELLS, STIFFNESS, VISCOSITY = 12, 6.4e4, 250.0  # along each edge; N/m; Pa s
STEP = 3.4e-5  # s: half of the contact limit
TIME = 240 * STEP  # s, in which networks are replaced
PARTS = {"staged": (1, 2), "implicit": (1, 2, 4)}  # of STEP
GRAVITIES = 40, 0.4  # m/s2: grains fall into place, or are pressed together where they lie
START = 16  # steps whose CPU, with that of the first network, is not counted


def rows_of_gravity(rows, data, limit, gravity):
    def run(steps, words, of=None):
        return consolidation(data, VISCOSITY, TIME / steps, words, (of or steps) * TIME / steps,
                             kn=STIFFNESS, gravity=gravity)

    def stepping(whole, steps, words):
        return (whole.cpu - run(steps, words, START).cpu) * steps / (steps - START)

    steps = START * round(TIME / (0.8 * limit) / START)
    explicit = run(steps, "time_step_check no")
    explicit_cpu = stepping(explicit, steps, "time_step_check no")
    settled, peak = explicit.heights[0] - explicit.heights[-1], max(map(abs, explicit.mean_forces))
    rows.row(gravity, "explicit", f"{TIME / steps / limit:.1f}", steps, explicit.networks, "", "", 1, 1)
    for coupling, parts in PARTS.items():
        for part in parts:
            words, long_steps = f"coupling {coupling}", round(part * TIME / STEP)
            whole = run(long_steps, words)
            cpu = stepping(whole, long_steps, words)
            rows.row(gravity, coupling, f"{STEP / part / limit:.0f}", long_steps, whole.networks,
                     percent(largest(whole.heights, explicit.heights) / settled),
                     percent(largest(whole.mean_forces, explicit.mean_forces) / peak),
                     f"{cpu / long_steps * steps / explicit_cpu:.1f}", f"{explicit_cpu / cpu:.1f}")


def table():
    data = sample("dense", CELLS, kn=STIFFNESS, dt=3e-5)
    limit, _ = printed(data, VISCOSITY)
    rows = Table("gravity, m/s²", "coupling", "R", "steps", "new networks", "settlement off",
                 "force of the fluid off", "CPU of a step / explicit", "times faster")
    for gravity in GRAVITIES:
        rows_of_gravity(rows, data, limit, gravity)
    return rows

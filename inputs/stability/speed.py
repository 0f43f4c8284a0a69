# SPDX-License-Identifier: GPL-3.0-or-later
"""CPU of staged and implicit steps against the explicit coupling at its own limit: 4913 grains of
6 mm and 15 MPa in 250 Pa s, the thesis' viscosity."""
from consolidations import consolidation, largest, percent
from samples import printed, sample
from tables import Table

CELLS, STIFFNESS, VISCOSITY = 17, 4.5e4, 250.0  # along each edge; N/m; Pa s
STEP = 2.4e-5  # s: half of the contact limit
TIME = 240 * STEP  # s, in which networks are replaced
EXPLICIT_STEPS = 1600
GRAVITIES = 40, 0.4  # m/s2: grains fall into place, or are pressed together where they lie
FINE = 4  # parts of STEP in the run that the errors are taken against


def rows_of_gravity(rows, data, limit, gravity):
    def run(step, words, time=TIME):
        return consolidation(data, VISCOSITY, step, words, time, kn=STIFFNESS, gravity=gravity)

    fine = run(STEP / FINE, "coupling staged")
    settled, peak = fine.heights[0] - fine.heights[-1], max(map(abs, fine.forces))
    explicit = "time_step_check no"
    beginning = run(0.8 * limit, explicit, 16 * 0.8 * limit)
    part = run(0.8 * limit, explicit, (16 + EXPLICIT_STEPS) * 0.8 * limit)
    steps = round(TIME / (0.8 * limit))
    explicit_cpu = (part.cpu - beginning.cpu) / EXPLICIT_STEPS * steps
    rows.row(gravity, "explicit", 0.8, steps, "not counted", "", "", 1, 1)
    for coupling in ("staged", "implicit"):
        words = f"coupling {coupling}"
        whole = run(STEP, words)
        cpu = whole.cpu - run(STEP, words, 16 * STEP).cpu
        long_steps = round(TIME / STEP)
        rows.row(gravity, coupling, f"{STEP / limit:.0f}", long_steps, whole.networks,
                 percent(largest(whole.heights, fine.heights) / settled),
                 percent(largest(whole.forces[1:], fine.forces[1:]) / peak),
                 f"{cpu / (long_steps - 16) * steps / explicit_cpu:.1f}",
                 f"{explicit_cpu / cpu * (long_steps - 16) / long_steps:.1f}")


def table():
    data = sample("dense", CELLS, kn=STIFFNESS, dt=2e-5)
    limit, _ = printed(data, VISCOSITY)
    rows = Table("gravity, m/s²", "coupling", "R", "steps", "new networks", "settlement off",
                 "force of the fluid off", "CPU of a step / explicit", "times faster")
    for gravity in GRAVITIES:
        rows_of_gravity(rows, data, limit, gravity)
    return rows

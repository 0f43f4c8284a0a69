# SPDX-License-Identifier: GPL-3.0-or-later
"""Accuracy of long time steps in a consolidation with new networks, over the size ratio."""
from consolidations import OFTEN, consolidation, largest, percent
from long_steps import of_ratio
from packings import POST, contact_limit, time_step
from samples import printed, sample
from tables import Table

SIZES = (5, 10)  # beside the dense sample, whose grains are nearly alike
SIXTHS = {"1.2": 320, "5": 640, "10": 1280}  # steps of a sixth of the contacts' limit
VISCOUS = 20  # R of such a step
PARTS = (4.0, 2.0, 1.0, 0.5)  # of such steps: R = 80, 40, 20, 10
FINE, COARSE = 0.4, 0.8  # R of the explicit runs


def samples():
    """(size ratio, data file, limit of the coupling at 1 Pa s, a sixth of the contacts' limit)"""
    data = sample("dense")
    yield "1.2", data, printed(data, 1.0)[0], 1e-4
    for size in SIZES:
        name = of_ratio(size)
        report, _ = time_step(POST / f"{name}.csv", "--spheres", 1)
        yield f"{size:g}", f"post/{name}.data", report["coupling_limit"], contact_limit(name) / 6


def table():
    """Against the explicit coupling at 0.4 of its own limit."""
    rows = Table("size ratio", "coupling", "R", "settlement", "mean pressure", "force of the fluid",
                 "new networks", "CPU / explicit at 0.8 of its limit")
    for size, data, limit, sixth in samples():
        viscosity, time = VISCOUS * limit / sixth, SIXTHS[size] * sixth

        def run(words, step):
            return consolidation(data, viscosity, step, words + OFTEN, time)

        fine = run("time_step_check no", FINE / VISCOUS * sixth)
        settled, peak = fine.heights[0] - fine.heights[-1], max(fine.mean_pressures)
        load = max(map(abs, fine.mean_forces))
        cases = [("explicit", COARSE / VISCOUS)] + [(coupling, part) for coupling in ("staged", "implicit")
                                                    for part in PARTS]
        explicit_cpu = None
        for coupling, part in cases:
            words = "time_step_check no" if coupling == "explicit" else f"coupling {coupling}"
            one = run(words, part * sixth)
            explicit_cpu = explicit_cpu or one.cpu
            rows.row(size, coupling, f"{VISCOUS * part:g}",
                     percent(largest(one.heights, fine.heights) / settled),
                     percent(largest(one.mean_pressures, fine.mean_pressures) / peak),
                     percent(largest(one.mean_forces, fine.mean_forces) / load), one.networks,
                     f"{one.cpu / explicit_cpu:.3f}")
    return rows

# SPDX-License-Identifier: GPL-3.0-or-later
"""Long steps with shear viscous forces: whether energy decays over the size ratio, and their error in a
consolidation beside that of long steps without these forces."""
import functools

from accuracy import COARSE, FINE, PARTS, SIXTHS, VISCOUS
from beyond import power
from consolidations import consolidation, largest, percent
from long_steps import (BELOW, DEFAULT, EXPLICIT, IMPLICIT, OF_MANY_STAGES, RATIOS, STAGED, STEPS, of_ratio,
                        shown)
from packings import contact_limit
from samples import energies, liggghts, must, printed, rows_of, sample
from tables import Table

SIZES = (1.2, 3, 5, 10)
SHEAR = " shear_viscous yes"
SIXTH = 1 / 6  # of the contacts' limit


@functools.cache
def limit_of(data, words):
    """Printed limit of the explicit coupling at 1 Pa s, s."""
    screen = must(liggghts("in.stability", data=data, viscosity=1.0, dt=1e-12, steps=0, words=words, law=DEFAULT))
    return next(row[2] for row in rows_of(screen))


def table():
    """As the table of long steps, with shear viscous forces; the limits with and without them."""
    rows = Table("size ratio", "limit with / without", "explicit, R = 0.9",
                 *(f"{words.split()[1]}, {ratio:g}" for words, ratios in RATIOS.items() for ratio in ratios))
    for size in SIZES:
        name = of_ratio(size)
        data = f"post/{name}.data"
        limit, step = limit_of(data, "coupling explicit" + SHEAR), SIXTH * contact_limit(name)

        def run(words, ratio):
            steps = OF_MANY_STAGES.get(ratio, STEPS[words]) if words == STAGED else STEPS[words]
            return shown(energies(data, ratio * limit / step, step, steps, words + SHEAR, law=DEFAULT))

        rows.row(f"{size:g}", f"{limit / limit_of(data, 'coupling explicit'):.3f}", run(EXPLICIT, BELOW["a sixth"]),
                 *(run(words, ratio) for words in (STAGED, IMPLICIT) for ratio in RATIOS[words]))
    return rows


def accuracy():
    """A consolidation with new networks, against the explicit coupling at 0.4 of its limit, without and with the
    forces, at the same viscosity."""
    rows = Table("shear viscous forces", "coupling", "R", "settlement of the explicit run, mm", "settlement",
                 "mean pressure", "force of the fluid", "new networks", "CPU / explicit at 0.8 of its limit")
    data, sixth = sample("dense"), 1e-4
    viscosity, time = VISCOUS * printed(data, 1.0)[0] / sixth, SIXTHS["1.2"] * sixth
    for label, shear in (("no", ""), ("yes", SHEAR)):
        def run(words, step):
            return consolidation(data, viscosity, step, words + shear, time)

        fine = run(EXPLICIT, FINE / VISCOUS * sixth)
        settled, peak = fine.heights[0] - fine.heights[-1], max(fine.mean_pressures)
        load = max(map(abs, fine.mean_forces))
        explicit_cpu = run(EXPLICIT, COARSE / VISCOUS * sixth).cpu
        for words in (STAGED, IMPLICIT):
            for part in PARTS:
                one = run(words, part * sixth)
                rows.row(label, words.removeprefix("coupling "), f"{VISCOUS * part:g}", f"{1e3 * settled:.4f}",
                         percent(largest(one.heights, fine.heights) / settled),
                         percent(largest(one.mean_pressures, fine.mean_pressures) / peak),
                         percent(largest(one.mean_forces, fine.mean_forces) / load), one.networks,
                         f"{one.cpu / explicit_cpu:.3f}")
    return rows

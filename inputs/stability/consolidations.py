# SPDX-License-Identifier: GPL-3.0-or-later
"""Full consolidations far beyond the explicit limit, networks replaced as the grains settle."""
import math
import os
from dataclasses import dataclass

from samples import DENSITY, SCENE, liggghts, must, printed, rows_of, sample
from tables import Table

CELLS = 4  # along each edge
STEP = 5.6e-4  # s: two thirds of the contact limit of these grains
STEPS = 112  # times R; a multiple of INSTANTS for each R
GRAVITY = 10.0  # m/s2: under more these few grains change places, each run at its own time
INSTANTS = 160
OFTEN = " retriangulate 0.01"  # 1 % of the largest strain: the default makes one new network in short runs, or none
RUNS = {10: ("staged", "implicit"), 100: ("staged", "implicit"), 1000: ("staged", "implicit"),
        10000: ("implicit",)}
REFERENCES = {10: ("time_step_check no", 50), 100: ("coupling implicit", 4),
              1000: ("coupling implicit", 2)}  # parts of STEP


@dataclass
class Consolidation:
    """Lists at equal intervals from the start. Means are over the interval that ends there: where networks
    are replaced, pressures jump for some steps, at another instant in each run (jumps.py)."""
    heights: tuple    # mean of the grains', m
    pressures: tuple  # mean of the pores', Pa
    networks: int     # that took the place of another
    energies: tuple   # kinetic, J
    forces: tuple     # vertical, of the fluid on the lower half of the grains, N
    mean_pressures: tuple  # without a value for the start
    mean_forces: tuple
    cpu: float        # s


def consolidation(data, viscosity, step, words, time, instants=16, **variables):
    """Runs in.consolidation; the time must be a multiple of `instants` steps."""
    before = os.times().children_user
    often = round(time / step / instants)
    assert abs(often * instants * step / time - 1.0) < 1e-9
    screen = must(liggghts("in.consolidation", data=data, viscosity=viscosity, dt=repr(step),
                           steps=often * instants, often=often, words=words, **variables))
    heights, pressures, networks, energies, forces, *sums = zip(
        *(row[1:] for row in rows_of(screen, columns=8)))
    means = [trapezoidal(*pair, often) for pair in zip(sums, (pressures, forces))]
    return Consolidation(heights, pressures, round(networks[-1]), energies, forces, *means,
                         os.times().children_user - before)


def trapezoidal(sums, values, often):
    """Means over intervals of `often` steps, with half of the value at each of their ends: LIGGGHTS' count
    the end and not the beginning."""
    return tuple(mean + 0.5 * (first - last) / often
                 for mean, first, last in zip(sums[1:], values, values[1:]))


def weight(data):
    """Of all grains under GRAVITY, N."""
    rows = (line.split() for line in (SCENE / data).read_text().splitlines())
    return GRAVITY * sum(DENSITY * math.pi / 6.0 * float(row[2])**3 for row in rows if len(row) == 7
                         and float(row[3]) == DENSITY)


def largest(values, others):
    """Largest difference of two lists."""
    return max(abs(a - b) for a, b in zip(values, others))


def percent(value, digits=2):
    return f"{100 * value:.{digits}f} %"


def table():
    data = sample("dense", CELLS)
    limit, _ = printed(data, 1.0)
    load = weight(data)
    rows = Table("R", "coupling", "steps", "new networks", "pressure at the end / largest",
                 "largest kinetic energy / work of the weight", "kinetic energy at the end / largest",
                 "settlement off", "force of the fluid off")
    reference = None
    for ratio in RUNS:
        viscosity, time = ratio * limit / STEP, ratio * STEPS * STEP

        def run(words, parts=1):
            return consolidation(data, viscosity, STEP / parts, words + OFTEN, time, INSTANTS,
                                 gravity=GRAVITY)

        if ratio in REFERENCES:
            reference = run(*REFERENCES[ratio])
        for coupling in RUNS[ratio]:
            one = run(f"coupling {coupling}")
            settled = one.heights[0] - one.heights[-1]
            rows.row(ratio, coupling, ratio * STEPS, one.networks,
                     percent(one.pressures[-1] / max(one.pressures), 1),
                     f"{max(one.energies) / (load * settled):.1e}",
                     f"{one.energies[-1] / max(one.energies):.1e}",
                     percent(largest(one.heights, reference.heights) / settled),
                     percent(largest(one.mean_forces, reference.mean_forces) / load))
    return rows

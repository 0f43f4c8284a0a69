# SPDX-License-Identifier: GPL-3.0-or-later
"""What the implicit coupling's matrix costs, as multiples of the explicit one's."""
import random
import re

from samples import SCENE, grid, liggghts, must, printed, write_data
from tables import Table

CELLS = [8, 12, 17]  # along each edge: 512, 1728 and 4913 grains


def phase_seconds(data, viscosity, step, words, steps=20):
    """CPU seconds of ordering and factorising, and of one solve, as the fix prints them."""
    screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=repr(step),
                           steps=steps, words=words))
    found = {name: (float(seconds), int(count)) for name, seconds, count in
             re.findall(r"^(order|factor|solve) +(\S+) +(\d+)$", screen, re.M)}
    return found["order"][0] + found["factor"][0], found["solve"][0] / found["solve"][1]


def table():
    rows = Table("grains", "order and factor: K / G", "solve: K / G",
                 "order and factor of K, in solves with G")
    for cells in CELLS:
        rng = random.Random(1)
        data = SCENE / "post" / f"cost_{cells}.data"
        write_data(data, grid(1.35, rng, cells), 1e-9, rng)
        viscosity = 1e4  # steps so short that contacts have no say
        limit, _ = printed(data, viscosity)
        g_factor, g_solve = phase_seconds(data, viscosity, 0.5 * limit, "time_step_check no")
        both_factors, k_solve = phase_seconds(data, viscosity, 100 * limit, "coupling implicit")
        k_factor = both_factors - g_factor  # the run makes that of G, too
        rows.row(cells**3, f"{k_factor / g_factor:.1f}", f"{k_solve / g_solve:.1f}",
                 f"{k_factor / g_solve:.0f}")
    return rows

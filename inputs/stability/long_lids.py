# SPDX-License-Identifier: GPL-3.0-or-later
"""Lids of finite mass that take their load at once, in staged and implicit steps."""
import math

from bisection import LOAD, printed_with_lid, write_lid
from long_steps import IMPLICIT, PARTS, RATIOS, STAGED
from packings import STIFFNESS
from regions import limits_of
from samples import DENSITY, EDGE, SCENE, liggghts, rows_of, sample
from tables import Table

STEPS = 1000
MASSES = (1e-4, 1e-2, 1.0)  # kg
DASHPOT = 500.0  # 1/s, of in.grains


def lid_limit(mass, touching):
    """Longest stable step (s) of a dry lid on grains of these masses, held: (dt omega)^2 / 2 + dt c / m = 2,
    with the dashpots' force at the velocities of the last step and, against a mesh, the grain's mass."""
    spring = len(touching) * STIFFNESS / mass
    dashpot = DASHPOT * sum(touching) / mass
    return (math.sqrt(dashpot**2 + 4 * spring) - dashpot) / spring


def borne(data, viscosity, step, mass, words):
    """Largest force on the lid at a hundred instants and force at the end, as parts of the load."""
    ok, screen = liggghts("in.piston", data=data, viscosity=repr(viscosity), dt=repr(step), steps=STEPS,
                          mass=mass, words=words)
    if not ok:
        return "**ended by an error**"
    forces = [row[1] / LOAD for row in rows_of(screen)]
    return f"{max(map(abs, forces)):.2f}, {forces[-1]:.3f}"


def table():
    write_lid()
    data = sample("dense")
    _, contacts = limits_of(data)
    lines = (SCENE / data).read_text().split("Atoms")[1].split("Velocities")[0].split("\n")
    grains = [(float(words[6]), 0.5 * float(words[2])) for words in map(str.split, lines) if words]
    touching = [DENSITY * 4 / 3 * math.pi * radius**3 for z, radius in grains if z + radius > EDGE]
    all_ratios = RATIOS[IMPLICIT]
    rows = Table("mass of the lid, kg", "time step, s", "coupling",
                 *(f"R = {ratio}" for ratio in all_ratios))
    for mass in MASSES:
        limit = printed_with_lid(data, 1.0, mass)
        step = PARTS["a sixth"] * min(contacts, lid_limit(mass, touching))
        for words in (STAGED, IMPLICIT):
            cells = ["" if ratio not in RATIOS[words] else
                     borne(data, ratio * limit / step, step, mass, words) for ratio in all_ratios]
            rows.row(f"{mass:g}", f"{step:.2g}", words.removeprefix("coupling "), *cells)
    return rows

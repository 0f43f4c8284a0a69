# SPDX-License-Identifier: GPL-3.0-or-later
"""The largest time step at which an explicit run in LIGGGHTS is stable."""
import math

from samples import EDGE, SCENE, growth, liggghts, must, rows_of

STEPS = 1000
LOAD = 20.0  # N, of in.piston


def calms_down(data, viscosity, words="time_step_check no", **variables):
    """Whether the kinetic energy is below its initial value after STEPS steps of a length."""
    return lambda step: growth(data, viscosity, step, STEPS, words, **variables) <= 1.0


def bears(data, viscosity, mass):
    """Whether a lid of this mass (kg) has not been thrown after STEPS steps of a length."""
    def stable(step):
        ok, screen = liggghts("in.piston", data=data, viscosity=viscosity, dt=repr(step), steps=STEPS,
                              mass=mass, words="time_step_check no")
        rows = rows_of(screen)
        if not rows or rows[0][0] != 0:
            must((False, screen))
        return ok and abs(rows[-1][1]) < 100 * LOAD
    return stable


def printed_with_lid(data, viscosity, mass):
    """The limit that the fix prints, s."""
    screen = must(liggghts("in.piston", data=data, viscosity=viscosity, dt=1e-12, steps=0, mass=mass))
    return rows_of(screen)[0][2]


def write_lid():
    """post/lid.stl, the top of the box."""
    corners = [(0, 0, EDGE), (EDGE, 0, EDGE), (EDGE, EDGE, EDGE), (0, EDGE, EDGE)]
    lines = ["solid lid"]
    for triangle in (corners[:3], [corners[0], corners[2], corners[3]]):
        lines += ["facet normal 0 0 1", " outer loop"]
        lines += [f"  vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += [" endloop", "endfacet"]
    (SCENE / "post" / "lid.stl").write_text("\n".join(lines + ["endsolid lid"]) + "\n")


def largest_stable(stable, guess, low=0.8, high=1.4, tolerance=0.003):
    """By bisection between `low` and `high` times `guess` to a part of `tolerance`; s."""
    if not stable(low * guess) or stable(high * guess):
        raise SystemExit(f"stability: the limit is not between {low * guess:.3g} and "
                         f"{high * guess:.3g} s")
    while high / low > 1.0 + tolerance:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if stable(middle * guess) else (low, middle)
    return low * guess

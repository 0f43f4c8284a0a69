# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts and coupling together: doc/figures/stability_stiffness.png and a table."""
import math
import sys

from bisection import calms_down, largest_stable
from packings import POST, packed, time_step
from samples import SCENE
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402

STIFFNESSES = [10.0**k for k in range(3, 9)]  # N/m
EVEN = 1e5  # N/m, where both limits are the same
LOOKED_AT = 300  # grains whose V is found


def in_one_motion(coupling, contact):
    """Root of (dt/dt_contact)^2 + dt/dt_coupling = 1: a motion that is the worst for both."""
    share = contact / (2 * coupling)
    return contact * (math.sqrt(share**2 + 1) - share)


def table():
    rows = Table("contact stiffness, N/m", "coupling alone (printed), s", "contacts alone, s",
                 "both in one motion, s", "eq. 4.21, s", "measured, s", "measured / both",
                 "measured / eq. 4.21")
    name = packed(1.2, 500, 0.60)
    thin, _ = time_step(POST / f"{name}.csv", "--contact-stiffness", EVEN, viscosity=1.0)
    viscosity = thin["coupling_limit"] / thin["contact_limit"]
    lines = []
    for value in STIFFNESSES:
        report, _ = time_step(POST / f"{name}.csv", "--spheres", LOOKED_AT, "--contact-stiffness", value,
                              viscosity=viscosity)
        coupling, contact = report["coupling_limit"], report["contact_limit"]
        both = in_one_motion(coupling, contact)
        estimate = min(report["contact"]["time_step"], report["viscous"]["time_step"])
        found = largest_stable(calms_down(f"post/{name}.data", viscosity, kn=value), both, 0.6, 2.0,
                               0.01)
        lines.append((coupling, contact, both, estimate, found))
        rows.row(f"{value:g}", *(f"{step:.3e}" for step in lines[-1]), f"{found / both:.2f}",
                 f"{found / estimate:.2f}")
    figure, axis = plt.subplots(figsize=(7, 5))
    names = (("coupling alone, printed", "-"), ("contacts alone, 2/omega_max", ":"),
             ("both in one motion", "k-"), ("eq. 4.21", "--"), ("LIGGGHTS", "ko"))
    for (label, style), steps in zip(names, zip(*lines)):
        axis.loglog(STIFFNESSES, steps, style, mfc="none", label=label)
    axis.set(xlabel="contact stiffness, N/m", ylabel=f"time step at {viscosity:.0f} Pa s, s")
    axis.legend(fontsize=8)
    save_figure(figure, FIGURES / "stability_stiffness.png")
    return rows

# SPDX-License-Identifier: GPL-3.0-or-later
"""Undrained loading and consolidation with a compressible fluid against theory:
doc/figures/stability_compressible.png and a table.

Grains are rigid (Biot's coefficient is 1). With E the oedometric modulus of the dry grains, n the porosity:
    Skempton's B (uniaxial)     1 / (1 + n E / K_f)
    undrained modulus           E + K_f / n
    coefficient of consolidation  k / (mu (1/E + n/K_f)); the pressure begins with B times the load
"""
import math
import subprocess
import sys

import numpy as np

from bisection import write_lid
from packings import BIN, EDGE, POST, packed
from samples import SCENE, liggghts, must, rows_of
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402

GRAINS, SOLID = 500, 0.60
MODULI = [1e6, 1e7, 1e8, 1e9, math.inf]  # Pa
DRY = 1.0  # Pa: a fluid that bears nothing
STRAIN = 1e-4
LARGE_STRAIN, LARGE_MODULUS = 1e-2, 1e7
THRESHOLDS = [1.0, 1e-2, 1e-3]  # of new networks, pore strain
LATER = (0.1, 0.2, 0.4, 0.6)  # s
LOAD, VISCOSITY = 1.0, 25.0  # N, Pa s
STEP, STEPS, EVERY = 1e-4, 6000, 20
EARLY = (0.08, 0.15)  # s: the lid has come to rest, drainage has not reached the top


def name():
    return packed(1.2, GRAINS, SOLID)


def undrained(modulus, strain=STRAIN, retriangulate=1.0, **grains):
    """(force on the lid before, added stress, added mean pressure, networks)"""
    step = min(1e-5, 1e-5 * math.sqrt(1e8 / modulus))  # sound crosses no pore in a step
    screen = must(liggghts("in.undrained", data=f"post/{name()}.data", bulk=repr(modulus),
                           strain=strain, steps=2000, dt=step, retriangulate=retriangulate,
                           **grains))
    rows = rows_of(screen)
    first, last = rows[1], rows[-1]
    return first[1], (last[1] - first[1]) / EDGE**2, last[2] - first[2], last[3]


def permeability():
    """m2, along z."""
    call = [str(BIN / "pfv"), "solve", "--packing", str(POST / f"{name()}.csv"), "--box",
            *["0", repr(EDGE)] * 3, "--wall", "symmetry", "--face", "zlo:pressure=1", "--face",
            "zhi:pressure=0"]
    done = subprocess.run(call, capture_output=True, text=True)
    words = done.stdout.split()
    if done.returncode != 0 or "permeability" not in words:
        raise SystemExit("stability: " + done.stderr.strip())
    return float(words[words.index("permeability") + 1])


def consolidation(modulus, before, **grains):
    """(times, pressure under the lid, mean pressure), pressures as parts of the load."""
    fluid = f"bulk_modulus {modulus!r}" if math.isfinite(modulus) else "couple_every 1"
    screen = must(liggghts("in.suddenly", data=f"post/{name()}.data", before=before, load=LOAD,
                           viscosity=VISCOSITY, fluid=fluid, steps=STEPS, every=EVERY, dt=STEP,
                           gamman=2000, **grains))
    sensors = np.loadtxt(POST / "suddenly.csv", delimiter=",", skiprows=1)
    rows = np.array(rows_of(screen))[1:]
    times, stress = rows[:, 0] * STEP, LOAD / EDGE**2
    top = np.interp(times, sensors[:, 0], sensors[:, 1:].mean(axis=1))
    return times, top / stress, rows[:, 2] / stress


def mean_in_theory(time_factor):
    """Of the initial pressure (Terzaghi), drained on one side."""
    orders = math.pi * (np.arange(200) + 0.5)
    return (2 / orders**2 * np.exp(-np.outer(time_factor, orders**2))).sum(axis=1)


def table():
    write_lid()
    rows = Table("K_f, Pa", "B undrained / theory", "E_u / theory", "B in theory",
                 "initial pressure under the lid, of the load", "the same / theory",
                 "mean pressure over that of the incompressible fluid, largest difference from theory",
                 "pressure under the lid, largest difference from incompressible")
    before, stress, _, _ = undrained(DRY)
    drained = stress / STRAIN
    porosity = 1.0 - SOLID
    conductivity = permeability() / VISCOSITY
    figure, axis = plt.subplots(figsize=(7, 5))
    runs = {modulus: consolidation(modulus, before) for modulus in MODULI}
    times, top_of_all, mean_of_all = runs[math.inf]
    full_theory = mean_in_theory(conductivity * drained * times / EDGE**2)
    early = (times >= EARLY[0]) & (times <= EARLY[1])
    later = times > EARLY[1]
    for modulus, (_, top, mean) in runs.items():
        skempton = 1 / (1 + porosity * drained / modulus)
        cells = ["", ""]
        if math.isfinite(modulus):
            _, stress, pressure, _ = undrained(modulus)
            cells = [f"{pressure / stress / skempton:.4f}",
                     f"{stress / STRAIN / (drained + modulus / porosity):.4f}"]
        diffusivity = conductivity / (1 / drained + porosity / modulus)
        theory = skempton * mean_in_theory(diffusivity * times / EDGE**2)
        share = (mean / mean_of_all) / (theory / full_theory)
        initial = top[early].mean()
        rows.row(f"{modulus:g}" if math.isfinite(modulus) else "incompressible", *cells,
                 f"{skempton:.4f}", f"{initial:.4f}", f"{initial / skempton:.4f}",
                 f"{100 * abs(share - 1)[later].max():.2f} %",
                 f"{100 * abs(top - top_of_all)[later].max():.2f} % of the load")
        line, = axis.plot(times, mean, label=f"K_f = {modulus:g} Pa")
        axis.plot(times, theory, ":", color=line.get_color())
        axis.plot(times, top, lw=0.7, color=line.get_color())
    axis.set(xlabel="time, s", ylabel="pressure / load", ylim=(0, 1.2),
             title="mean pressure, theory (dotted), pressure under the lid (thin)")
    axis.legend(fontsize=7)
    save_figure(figure, FIGURES / "stability_compressible.png")
    return rows


def terzaghi():
    """Mean pressure of the incompressible consolidation with and without friction."""
    write_lid()
    rows = Table("friction", "drained modulus, Pa",
                 *(f"mean pressure / load at {time:g} s: run, theory" for time in LATER))
    conductivity = permeability() / VISCOSITY
    for friction in (0.0, 0.5):
        before, stress, _, _ = undrained(DRY, friction=friction)
        times, _, mean = consolidation(math.inf, before, friction=friction)
        theory = mean_in_theory(conductivity * stress / STRAIN * times / EDGE**2)
        rows.row(friction, f"{stress / STRAIN:.3g}",
                 *(f"{np.interp(time, times, mean):.3f}, {np.interp(time, times, theory):.3f}"
                   for time in LATER))
    return rows


def conservation():
    """The mass of the fluid, V^f (1 + p / K_f), in a sealed box that is compressed through many networks."""
    write_lid()
    rows = Table("new network at a pore strain of", "new networks", "mean pressure, Pa",
                 "p / (K_f dV / V) - 1")
    expected = LARGE_MODULUS * LARGE_STRAIN / (1.0 - SOLID - LARGE_STRAIN)
    for threshold in THRESHOLDS:
        _, _, pressure, networks = undrained(LARGE_MODULUS, LARGE_STRAIN, threshold)
        rows.row(f"{threshold:g}", f"{networks:.0f}", f"{pressure:.6e}", f"{pressure / expected - 1:.1e}")
    return rows

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Beads settle in a closed tank of viscous fluid: one at several places, and clouds beside Richardson & Zaki.

    run.py [KEY=VALUE...]      called by ./run.sh settling [KEY=VALUE...]
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import scene
from plotting import plt, save_figure

KEYS = {
    "N": (int, 400, "beads of a cloud"),
    "C": (str, "0.05,0.1,0.2,0.3,0.4", "solid fractions"),
    "ONE": (int, 1, "1: single beads, too; 0: clouds alone"),
    "FALL": (float, 4.0, "how far a cloud settles while it is measured, in radii"),
    "SHEAR": (str, "yes", "shear_viscous: yes or no"),
    "SEED": scene.SEED,
    "VISCOSITY": (float, 1.0, "Pa s"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, STIFFNESS = 1e-3, 20.0  # m, N/m
DENSITY, FLUID, GRAVITY = 2500.0, 1000.0, 9.81
STEP = 0.2 * math.sqrt(DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3 / STIFFNESS)  # of in.beads
# single beads: edge and height of the tank, place of the bead (of these), what the sides and the top are
ONES = {"in the middle": (200, 200, (0.5, 0.5, 0.5), "symmetry", "pressure 0"),
        "beside two sides, open top": (200, 300, (0.2, 0.7, 0.6), "symmetry", "pressure 0"),
        "closed top": (250, 200, (0.4, 0.5, 0.5), "no_slip", "point 0 0 0 pressure 0"),
        "no-slip walls": (300, 300, (0.5, 0.3, 0.5), "no_slip", "pressure 0")}
RICHARDSON_ZAKI = 4.65
MOST = 1.4  # of it: dilute clouds stir themselves
PERMEABILITY_ERROR = 0.1  # doc/accuracy.md


def fixed_bed(fraction):
    """Fall over Stokes' of beads that cannot pass each other: drag of van der Hoef, Beetstra & Kuipers (2005)."""
    drag = 10.0 * fraction / (1.0 - fraction)**2 + (1.0 - fraction)**2 * (1.0 + 1.5 * math.sqrt(fraction))
    return (1.0 - fraction) / drag


def alone(settings):
    """Speed of a single bead (Stokes), m/s."""
    return 2.0 / 9.0 * (DENSITY - FLUID) * GRAVITY * RADIUS**2 / settings["VISCOSITY"]


def run(name, settings, variables, fall):
    steps = math.ceil(fall * RADIUS / (alone(settings) * variables.pop("expected")) / STEP)
    begin = steps // 2
    out = f"{settings['OUT']}_{name}"
    said, cpu = scene.liggghts(
        SCENE, "in.settling",
        {"r": RADIUS, "kn": STIFFNESS, "viscosity": settings["VISCOSITY"], "density": FLUID, "out": out,
         "words": scene.fix_words(f"coupling auto shear_viscous {settings['SHEAR']}", settings["FIX"]), "begin": begin,
         "steps": steps, "every": max(1, steps // 20),
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}, **variables},
        out + "_run", scene.Progress(name, 0, steps, STEP))
    record = np.genfromtxt(SCENE / f"{out}_record.csv", delimiter=",", names=True)
    ratio, networks = map(float, said["end"])
    return {"ratio": ratio, "networks": int(networks), "cpu": cpu, "steps": steps, "mass": float(abs(record["mass_error"]).max()),
            "force": float(abs(record["force_error"]).max())}


def one(number, settings):
    edge, height, at, side, top = list(ONES.values())[number]
    L, H = edge * RADIUS, height * RADIUS
    return run(f"one{number}", settings,
               {"beads": "one", "N": 1, "x0": at[0] * L, "y0": at[1] * L, "z0": at[2] * H, "L": L, "H": H, "z1": 0.0,
                "z2": H, "side": side, "top": top, "expected": 1.0}, 2.0)


def cloud(fraction, settings):
    bead = 4.0 / 3.0 * math.pi * RADIUS**3 * (0.9**3 + 1.0 + 1.1**3) / 3.0
    L = (settings["N"] * bead / fraction / 1.5)**(1.0 / 3.0)
    H = 1.5 * L
    expected = (1.0 - fraction)**RICHARDSON_ZAKI
    return {"fraction": fraction, "wanted": expected,
            **run(f"cloud{round(1000 * fraction)}", settings,
                  {"beads": "cloud", "N": settings["N"], "L": L, "H": H, "z1": 0.25 * H, "z2": 0.75 * H,
                   "side": "symmetry", "top": "pressure 0", "expected": expected}, settings["FALL"])}


def draw(clouds, base):
    figure, axes = plt.subplots(figsize=(5, 4))
    c = np.linspace(0.0, 0.5, 100)
    axes.plot(c, (1.0 - c)**RICHARDSON_ZAKI, "k-", lw=1, label="Richardson & Zaki, n = 4.65")
    axes.plot(c[1:], [fixed_bed(x) for x in c[1:]], "k--", lw=1, label="fixed bed, van der Hoef et al.")
    axes.plot([run["fraction"] for run in clouds], [run["ratio"] for run in clouds], "o", label="fix pfv")
    axes.set(xlabel="solid fraction", ylabel="mean fall / fall alone (Stokes)", yscale="log")
    axes.legend()
    save_figure(figure, f"{base}_clouds.png")


def work(words):
    settings = scene.parse(words, KEYS)
    fractions = scene.numbers(settings, "C")
    if settings["N"] < 50 or fractions[-1] > 0.45 or min(settings["FALL"], settings["VISCOSITY"]) <= 0:
        raise scene.BadSetting("N must be at least 50, C at most 0.45, FALL and VISCOSITY above 0")
    print(f"Settling: alone a bead falls at {1e3 * alone(settings):.3g} mm/s")
    rows, ones = [], {}
    for number, name in enumerate(ONES if settings["ONE"] else ()):
        found = ones[name] = one(number, settings)
        rows.append((f"one bead, {name}: fall / Stokes", found["ratio"], "0.9 to 1.1", 0.9 <= found["ratio"] <= 1.1))
    clouds = [cloud(fraction, settings) for fraction in fractions]
    for found in clouds:
        print(f"  cloud {found['fraction']:.3g}: fall {found['ratio']:.3f} of Stokes, Richardson & Zaki {found['wanted']:.3f}; "
              f"networks {found['networks']}, CPU {found['cpu']:.0f} s")
        least = (1.0 - PERMEABILITY_ERROR) * fixed_bed(found["fraction"])
        rows.append((f"cloud {found['fraction']:.3g}: fall / Richardson & Zaki", found["ratio"] / found["wanted"],
                     f"{least / found['wanted']:.2f} (fixed bed, less 10 %) to {MOST:g}",
                     least <= found["ratio"] <= MOST * found["wanted"]))
    every = [*ones.values(), *clouds]
    for what, key in (("mass error", "mass"), ("force-balance error", "force")):
        largest = max(found[key] for found in every)
        rows.append((f"{what}, largest", largest, "<= 1e-9", largest <= 1e-9))
    draw(clouds, SCENE / settings["OUT"])
    return scene.summary(SCENE, settings["OUT"], {**settings, "ones": ones, "clouds": clouds}, rows)


if __name__ == "__main__":
    scene.main("settling", work)

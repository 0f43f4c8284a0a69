#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A wave of constant amplitude on one loose bed with three conductivities (thesis section 6.3.4).

    run.py [KEY=VALUE...]      called by ./run.sh wave_permeability [KEY=VALUE...]
"""
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import bed
import scene
import wave
import wave_report
from plotting import plt, save_figure

KEYS = {
    "N": (int, 300, "grains"),
    "SEED": scene.SEED,
    "AMPLITUDE": (float, 1000.0, "of the wave, Pa"),
    "END": (float, 2.0, "duration, s"),
    "VISCOSITIES": (str, "0.1,1,5", "over that of the other wave scenes, with commas"),
    "SHAKE": scene.SHAKE,
    "SHAKE_END": (float, 0.5, "how long, s"),
    "TOP": scene.TOP,
    "LAW": scene.LAW,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}


def measures_of(run):
    _, unbalanced, _ = wave_report.series(run)
    deviators, porosities = wave_report.deviators_and_porosities(run)
    excess = run.excess()
    return {"viscosity": run.figures["viscosity"], "cpu": run.figures["cpu"],
            "excess_most": float(excess.max()), "excess_left": float(excess[-10:].mean()),
            "liquefied_most": float(run.liquefied().max()),
            "porosity_change": float(porosities[-1] - porosities[0]),
            "settlement": float(run.state["mean_z"][0] - run.state["mean_z"][-1]),
            "deviator": float(deviators[-1]), "deviators": deviators.tolist(), "porosities": porosities.tolist(),
            "unbalanced": float(np.nanmax(unbalanced[1:])),
            "networks": int(run.state["retriangulations"][-1]),
            "balance": float(abs(run.state["balance"]).max())}


def draw(runs, base):
    figure, axes = plt.subplots(3, 1, figsize=(7, 8), sharex=True)
    for run in runs:
        times, unbalanced, porosities = wave_report.series(run)
        label = f"{run.figures['viscosity']:.3g} Pa s"
        axes[0].plot(run.time, run.excess(), label=label)
        axes[1].semilogy(times[1:], unbalanced[1:], "o-", ms=3)
        axes[2].plot(times, porosities, "o-", ms=3)
    axes[0].set(ylabel="mean excess pressure, Pa")
    axes[1].set(ylabel="λ (eq. 2.16)")
    axes[2].set(ylabel="porosity", xlabel="t, s")
    axes[0].legend(fontsize=8)
    save_figure(figure, f"{base}_permeability.png")


def draw_contraction(runs, found, base):
    """Strain deviator over porosity (fig. 6.23)."""
    figure, axes = plt.subplots(figsize=(6, 4))
    for run, f in zip(runs, found):
        change = 1e3 * (np.array(f["porosities"]) - f["porosities"][0])
        axes.plot(change, f["deviators"], "o-", ms=3, label=f"{run.figures['viscosity']:.3g} Pa s")
    axes.set(xlabel="change of porosity, 1e-3", ylabel="mean strain deviator (eq. 2.21)")
    axes.legend(fontsize=8)
    save_figure(figure, f"{base}_contraction.png")


def work(words):
    settings = scene.parse(words, KEYS)
    factors = scene.numbers(settings, "VISCOSITIES")
    if settings["N"] < 100 or settings["SHAKE"] < 0:
        raise scene.BadSetting("N must be at least 100, SHAKE at least 0")
    measures = bed.prepare(SCENE, "loose", settings["N"], settings["SEED"], settings["OUT"])
    runs = []
    for k, factor in enumerate(factors):
        viscosity = factor * bed.viscosity_for(settings["N"])
        print(f"viscosity {viscosity:.3g} Pa s", flush=True)
        # the wave comes up within a tenth of a second
        runs.append(wave.run(SCENE, settings, measures, f"{settings['OUT']}_{k + 1}",
                             f"{settings['AMPLITUDE']:g}*(1.0-exp(-v_t/0.05))", settings["END"],
                             viscosity=viscosity, top=settings["TOP"], shake=settings["SHAKE"],
                             shake_end=settings["SHAKE_END"]))
    found = [measures_of(run) for run in runs]
    print(f"\nWave of {settings['AMPLITUDE']:g} Pa on a loose bed of {settings['N']} grains, "
          f"porosity {measures['core_porosity']:.3f}, {settings['END']:g} s")
    print("  viscosity        excess pressure, largest, at the end   ∇H/i_c, v3   settlement"
          "   mean deviator   CPU")
    for f in found:
        print(f"  {f['viscosity']:7.4g} Pa s {f['excess_most']:24.0f} Pa "
              f"{f['excess_left']:8.0f} Pa {f['liquefied_most']:12.2f} "
              f"{1e3 * f['settlement']:10.2f} mm {f['deviator']:13.4f} {f['cpu']:7.0f} s")
    draw(runs, SCENE / settings["OUT"])
    draw_contraction(runs, found, SCENE / settings["OUT"])
    balance = max(f["balance"] for f in found)
    checks = [("the fluid's own force balance, largest", balance, "<= 1e-10", balance <= 1e-10)]
    if len(found) > 1 and settings["END"] >= 2.0:
        left = [f["excess_left"] / f["excess_most"] for f in found]
        checks.append(("excess left / largest: least - most permeable", left[-1] - left[0], "> 0",
                       left[-1] > left[0]))
    return scene.summary(SCENE, settings["OUT"], {**settings, "runs": found}, checks)


if __name__ == "__main__":
    scene.main("wave_permeability", work)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A wave on a loose bed with and without shear viscous forces (thesis section 6.3.5).

    run.py [KEY=VALUE...]      called by ./run.sh shear_viscous [KEY=VALUE...]
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
    "TOP": scene.TOP,
    "LAW": scene.LAW,
    "VISCOSITY": bed.VISCOSITY_KEY,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}


def measures_of(run):
    _, moved = wave_report.displacements(run, run.snapshots()[-1][1])
    _, _, porosities = wave_report.series(run)
    return {"settlement": float(run.state["mean_z"][0] - run.state["mean_z"][-1]),
            "porosity_change": float(porosities[-1] - porosities[0]),
            "displacement": float(np.sqrt((moved**2).sum(axis=1).mean())),
            "deviator": float(wave_report.strain_deviator(run, run.snapshots()[-1][1]).mean()),
            "largest_energy": float(run.state["kinetic_energy"].max()),
            "time_step_limit": run.figures["time_step_limit"], "cpu": run.figures["cpu"],
            "balance": float(abs(run.state["balance"]).max())}


def draw(runs, base):
    figure, axes = plt.subplots(2, 1, figsize=(7, 6), sharex=True)
    for label, run in runs.items():
        axes[0].plot(run.state["time"], 1e3 * (run.state["mean_z"][0] - run.state["mean_z"]),
                     label=label)
        axes[1].semilogy(run.state["time"], np.maximum(run.state["kinetic_energy"], 1e-8))
    axes[0].set(ylabel="mean settlement, mm")
    axes[1].set(ylabel="kinetic energy, J", xlabel="t, s")
    axes[0].legend()
    save_figure(figure, f"{base}_shear.png")


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 100 or settings["AMPLITUDE"] <= 0 or settings["END"] <= 0:
        raise scene.BadSetting("N must be at least 100, AMPLITUDE and END above 0")
    measures = bed.prepare(SCENE, "loose", settings["N"], settings["SEED"], settings["OUT"])
    runs = {}
    for label, word in (("without", "no"), ("with", "yes")):
        print(f"{label} shear viscous forces", flush=True)
        runs[label] = wave.run(SCENE, settings, measures, f"{settings['OUT']}_{label}",
                               f"{settings['AMPLITUDE']:g}*(1.0-exp(-v_t/0.05))", settings["END"],
                               top=settings["TOP"], words=f"shear_viscous {word}")
    found = {label: measures_of(run) for label, run in runs.items()}
    print(f"\nWave of {settings['AMPLITUDE']:g} Pa on a loose bed of {settings['N']} grains, "
          f"{settings['END']:g} s, porosity {measures['core_porosity']:.3f}")
    print("  shear forces   settlement   porosity   displacement, rms   deviator   explicit limit")
    for label, f in found.items():
        print(f"  {label:<12s} {1e3 * f['settlement']:9.3f} mm {f['porosity_change']:+10.5f} "
              f"{1e3 * f['displacement']:14.2f} mm {f['deviator']:12.4f} "
              f"{f['time_step_limit']:14.3g} s")
    draw(runs, SCENE / settings["OUT"])
    ratio = found["with"]["displacement"] / found["without"]["displacement"]
    balance = max(f["balance"] for f in found.values())
    checks = [("the fluid's own force balance, largest", balance, "<= 1e-10", balance <= 1e-10),
              ("rms displacement with / without shear forces", ratio, "<= 1.05", ratio <= 1.05)]
    return scene.summary(SCENE, settings["OUT"], {**settings, "runs": found}, checks)


if __name__ == "__main__":
    scene.main("shear_viscous", work)

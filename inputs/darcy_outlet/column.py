#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The oedometer's sample consolidates with either model of the fluid: what each makes of the same
grains, and what it costs.

    run.py column [N=1000] [SEED=1]
"""
import shutil
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path[:0] = [str(SCENE.parent / "oedometer"), str(SCENE.parent / "common")]
import numpy as np  # noqa: E402

import analyse as terzaghi_analysis  # noqa: E402
import oedometer  # noqa: E402
import scene  # noqa: E402
import terzaghi  # noqa: E402
from plotting import plt, save_figure  # noqa: E402

KEYS = {"N": (int, 1000, "grains"), "SEED": scene.SEED,
        "OUT": (str, "post/column", "where results go, without ending")}
# what the coupled run needs of the sample and of the dry test
KEPT = (".restart", ".dump", "_loaded.dump", "_steady.csv", "_measured.json")


def variants(grains):
    """Models and their words of fix pfv: layers one grain high, cells two grains wide."""
    across = round(0.1 / (2.0 * oedometer.mean_radius(grains)))
    half = across // 2
    layers, wide = f"darcy_grid 1 1 {across}", f"darcy_grid {half} {half} {half}"
    return {"pfv": "",
            f"{layers}, kozeny_carman": f"model {layers} every 100 drag kozeny_carman",
            f"{layers}, di_felice": f"model {layers} every 100",
            f"{wide}, kozeny_carman": f"model {wide} every 100 drag kozeny_carman"}


def consolidate(settings, number, name, words):
    """One coupled run on the kept sample; its figures and its records."""
    base = str(SCENE / settings["OUT"]) + f"_{number}"
    if number > 0:
        for ending in KEPT:
            shutil.copy(str(SCENE / settings["OUT"]) + "_0" + ending, base + ending)
    print(f"-- {name}", flush=True)
    given = oedometer.parse([f"N={settings['N']}", f"SEED={settings['SEED']}", f"OUT={base}",
                             f"KEEP={int(number > 0)}", f"FIX={words or 'couple_every 1'}"])
    figures = oedometer.run(given)
    figures["own_K"] = permeability(base, figures, words)
    return figures, terzaghi_analysis.Run(base)


def permeability(base, figures, words):
    """That of the sample in this model, m2."""
    grid = words.split()[1:5]  # darcy_grid NX NY NZ
    model = ["--model", grid[0], "--cells", *grid[1:]] if grid else []
    box = (0.0, 0.1, 0.0, 0.1, 0.0, figures["height"])
    return scene.pfv_solve(SCENE, base + ".dump", box, 1.0, base + "_own.json",
                           "--wall", "symmetry", "--face", "zlo:pressure=5000",
                           "--face", "zhi:pressure=0", *model)["permeability"]


def draw(settings, runs):
    figure, axes = plt.subplots(1, 2, figsize=(10.5, 4))
    times = np.logspace(-3.5, np.log10(3), 300)
    for name, _, records in runs:
        axes[0].semilogx(records.T[records.T > 0], records.middle()[records.T > 0], label=name)
        axes[1].semilogx(records.T_lid[1:], records.settlement()[1:], label=name)
    axes[0].semilogx(times, terzaghi.pressure(0.5, times)[:, 0], "k--", label="Terzaghi")
    axes[1].semilogx(times, terzaghi.settlement(times), "k--", label="Terzaghi")
    axes[0].set(xlabel="T_v", ylabel="p(H/2) / load", xlim=(3e-4, 3))
    axes[1].set(xlabel="T_v", ylabel="U", xlim=(3e-4, 3))
    for part in axes:
        part.grid(alpha=0.3)
    axes[1].legend(fontsize=7)
    save_figure(figure, SCENE / f"{settings['OUT']}.png", dpi=110)


def work(words):
    settings = scene.parse(words, KEYS)
    runs = []
    for number, (name, model) in enumerate(variants(settings["N"]).items()):
        runs.append((name, *consolidate(settings, number, name, model)))
    draw(settings, runs)
    print(f"\nColumn of {settings['N']} grains, dry step {1e3 * runs[0][1]['cpu_dry_step']:.3f} ms")
    print(f"  {'':34s}{'p(H/2) rms':>11s}{'U rms':>8s}{'early p':>9s}{'K/K(pfv)':>10s}"
          f"{'CPU, s':>9s}{'ms/step':>9s}")
    rows = []
    for name, figures, _ in runs:
        print(f"  {name:34s}{figures['p_rms']:11.4f}{figures['U_rms']:8.4f}"
              f"{figures['p_early_max']:9.3f}{figures['own_K'] / runs[0][1]['own_K']:10.3f}"
              f"{figures['cpu_coupled']:9.1f}{1e3 * figures['cpu_coupled_step']:9.3f}")
        rows.append((f"{name}: mass error, largest", figures["mass_error_max"], "< 1e-10",
                     figures["mass_error_max"] < 1e-10))
    kept = ("own_K", "p_rms", "U_rms", "p_early_max", "cpu_coupled", "cpu_coupled_step",
            "cpu_dry_step", "force_balance_error_max", "strain_error", "time_step_limit")
    shown = {name: {key: figures[key] for key in kept} for name, figures, _ in runs}
    return scene.summary(SCENE, settings["OUT"], {"settings": settings, "runs": shown}, rows)

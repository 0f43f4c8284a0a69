#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What doc/oedometer.md shows: sizes and samples, the base, retriangulation thresholds, times.

    study.py      about half an hour; writes post/study.md and doc/figures/oedometer_*.png

A run that post/ already holds is taken as it is: empty post/ to repeat everything."""
import shutil
import sys

import numpy as np

import analyse
import oedometer
import terzaghi
from plotting import plt, save_figure

SAMPLES = [(300, 1), (1000, 1), (1000, 2), (1000, 3), (1000, 4), (2000, 1), (5000, 1), (5000, 2)]
THRESHOLDS = [0.0001, 0.001, 0.01]
FIGURES = oedometer.SCENE.parents[1] / "doc" / "figures"


def one_run(name, *words):
    """Summary and curves of one run."""
    base = oedometer.SCENE / "post" / name
    if not base.with_name(f"{name}_summary.json").exists():
        oedometer.run(oedometer.parse([*words, f"OUT=post/{name}"]))
    records = analyse.Run(base)
    return {**records.figures, **analyse.compare(records), "T": records.T, "p": records.middle(),
            "T_lid": records.T_lid, "U": records.settlement()}


def same_sample(name, source):
    """Gives the run `name` the sample, dry test and permeability of the run `source`."""
    for ending in (".dump", ".restart", "_loaded.dump", "_steady.csv", "_measured.json"):
        shutil.copy(oedometer.SCENE / "post" / (source + ending), oedometer.SCENE / "post" / (name + ending))


def sample_table(runs):
    lines = ["| N | seed | base | E_oed, MPa | K, m² | C_v, m²/s | p(H/2), rms | U, rms | "
             "largest p(H/2) before T_v 0.02 | strain / dry - 1 | "
             "U against the uneven layer, rms | p + σ', rms from the load | "
             "CPU with fluid, s | CPU without, s |",
             "|--|--|--|--|--|--|--|--|--|--|--|--|--|--|"]
    for r in runs:
        steps = r["cpu_coupled"] / r["cpu_coupled_step"]
        lines.append(
            f"| {r['N']} | {r['SEED']} | {r['BASE']} | {r['E_oed'] / 1e6:.3f} | {r['K']:.3e} | "
            f"{r['C_v']:.4f} ± {100 * r['C_v_relative_error']:.1f} % | "
            f"{100 * r['p_rms']:.2f} % | {100 * r['U_rms']:.2f} % | {r['p_early_max']:.3f} | "
            f"{100 * r['strain_error']:+.2f} % | {100 * r['U_rms_uneven']:.2f} % | "
            f"{100 * r['total_stress_rms']:.1f} % | {r['cpu_coupled']:.0f} | "
            f"{steps * r['cpu_dry_step']:.0f} |")
    return "\n".join(lines) + "\n"


def threshold_table(runs):
    lines = ["| threshold | retriangulations | p(H/2), rms | U, rms | largest difference of p(H/2) "
             "from the first row | of U | CPU, s |", "|--|--|--|--|--|--|--|"]
    first = runs[0]
    times = np.linspace(analyse.EARLY, 2.5, 1000)
    for r in runs:
        p = np.interp(times, r["T"], r["p"]) - np.interp(times, first["T"], first["p"])
        U = np.interp(times, r["T_lid"], r["U"]) - np.interp(times, first["T_lid"], first["U"])
        lines.append(f"| {100 * r['RETRIANGULATE']:g} % | {r['retriangulations']} | "
                     f"{100 * r['p_rms']:.2f} % | {100 * r['U_rms']:.2f} % | "
                     f"{100 * abs(p).max():.2f} % | {100 * abs(U).max():.2f} % | "
                     f"{r['cpu_coupled']:.0f} |")
    return "\n".join(lines) + "\n"


def draw_samples(runs):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), sharex=True)
    for r in runs:
        label = f"N = {r['N']}, seed {r['SEED']}" + (", fixed base" * (r["BASE"] == "fixed"))
        shown = (r["T"] > 1e-3) & (r["T"] < 2.5)
        left.semilogx(r["T"][shown],
                      r["p"][shown] - terzaghi.pressure(0.5, r["T"][shown])[:, 0], label=label)
        shown = (r["T_lid"] > 1e-3) & (r["T_lid"] < 2.5)
        right.semilogx(r["T_lid"][shown],
                       r["U"][shown] - terzaghi.settlement(r["T_lid"][shown]))
    left.set(xlabel="T_v", ylabel="p(H/2) / load, coupled - Terzaghi", ylim=(-0.2, 0.3))
    right.set(xlabel="T_v", ylabel="U, coupled - Terzaghi", ylim=(-0.1, 0.1))
    left.legend(fontsize=7)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    save_figure(figure, FIGURES / "oedometer_samples.png", dpi=120)


def study():
    FIGURES.mkdir(parents=True, exist_ok=True)
    samples = [one_run(f"N{n}_{seed}", f"N={n}", f"SEED={seed}")
               for n, seed in SAMPLES]
    samples.append(one_run("fixed", "BASE=fixed"))
    thresholds = []
    for strain in THRESHOLDS:
        name = f"threshold_{strain:g}"
        same_sample(name, "N1000_1")
        thresholds.append(one_run(name, "KEEP=1", f"RETRIANGULATE={strain}"))
    text = sample_table(samples) + "\n" + threshold_table(thresholds)
    (oedometer.SCENE / "post" / "study.md").write_text(text)
    print(text)
    draw_samples(samples)
    for name in ("curves", "isochrones", "stress"):
        shutil.copy(oedometer.SCENE / "post" / f"N5000_1_{name}.png", FIGURES / f"oedometer_{name}.png")


if __name__ == "__main__":
    try:
        study()
    except oedometer.Failure as failure:
        sys.exit(f"oedometer: {failure}")

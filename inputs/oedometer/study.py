# SPDX-License-Identifier: GPL-3.0-or-later
"""What doc/oedometer.md shows: sizes and seeds, retriangulation thresholds, times. About an hour;
`./run.sh oedometer study` writes post/study.md and doc/figures/oedometer_*.png."""
import shutil

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import analyse
import terzaghi
from run import SCENE

SAMPLES = [(1000, 1), (1000, 2), (1000, 3), (2000, 1), (5000, 1), (5000, 2)]
THRESHOLDS = [0.0001, 0.001, 0.01]
FIGURES = SCENE.parents[1] / "doc" / "figures"


def study(run, parse):
    FIGURES.mkdir(parents=True, exist_ok=True)
    samples = [one_run(run, parse, f"N={n}", f"SEED={seed}", f"OUT=post/N{n}_{seed}")
               for n, seed in SAMPLES]
    thresholds = [one_run(run, parse, "N=1000", "SEED=1", "OUT=post/N1000_1", "KEEP=1",
                          f"RETRIANGULATE={strain}") for strain in THRESHOLDS]
    text = sample_table(samples) + "\n" + threshold_table(thresholds)
    (SCENE / "post" / "study.md").write_text(text)
    print(text)
    draw_samples(samples)
    for name in ("curves", "isochrones", "stress"):
        shutil.copy(SCENE / "post" / f"N5000_1_{name}.png", FIGURES / f"oedometer_{name}.png")


def one_run(run, parse, *words):
    """Summary and curves of one run; the curves are read at once, since the next one may overwrite
    them."""
    settings = parse(words)
    summary = run(settings)
    records = analyse.Run(SCENE / settings["OUT"])
    return {**summary, "T": records.T, "p": records.middle(), "T_lid": records.T_lid,
            "U": records.settlement()}


def sample_table(runs):
    lines = ["| N | seed | E_oed, MPa | K, m2 | viscosity, Pa s | C_v, m2/s | p(H/2) rms | U rms | "
             "p(H/2) max before T_v 0.02 | strain / dry - 1 | best-fit C_v | sigma' + p rms | "
             "CPU coupled, s | CPU dry, s |",
             "|--|--|--|--|--|--|--|--|--|--|--|--|--|--|"]
    for r in runs:
        steps = r["cpu_coupled"] / r["cpu_coupled_step"]
        lines.append(
            f"| {r['N']} | {r['SEED']} | {r['E_oed'] / 1e6:.3f} | {r['K']:.3e} | "
            f"{r['viscosity']:.2f} | {r['C_v']:.4f} ± {100 * r['C_v_relative_error']:.1f} % | "
            f"{100 * r['p_rms']:.2f} % | {100 * r['U_rms']:.2f} % | {r['p_early_max']:.3f} | "
            f"{100 * r['strain_error']:+.2f} % | {r['C_v_best']:.3f} | "
            f"{100 * r['total_stress_rms']:.1f} % | {r['cpu_coupled']:.0f} | "
            f"{steps * r['cpu_dry_step']:.0f} |")
    return "\n".join(lines) + "\n"


def threshold_table(runs):
    lines = ["| threshold | retriangulations | p(H/2) rms | U rms | largest difference of p(H/2) "
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
        label = f"N = {r['N']}, seed {r['SEED']}"
        positive = (r["T"] > 1e-3) & (r["T"] < 2.5)
        left.semilogx(r["T"][positive],
                      r["p"][positive] - terzaghi.pressure(0.5, r["T"][positive])[:, 0], label=label)
        positive = (r["T_lid"] > 1e-3) & (r["T_lid"] < 2.5)
        right.semilogx(r["T_lid"][positive],
                       r["U"][positive] - terzaghi.settlement(r["T_lid"][positive]))
    left.set(xlabel="T_v", ylabel="p(H/2) / load, coupled - Terzaghi", ylim=(-0.1, 0.1))
    right.set(xlabel="T_v", ylabel="U, coupled - Terzaghi", ylim=(-0.1, 0.1))
    left.legend(fontsize=8)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(FIGURES / "oedometer_samples.png", dpi=120)
    plt.close(figure)

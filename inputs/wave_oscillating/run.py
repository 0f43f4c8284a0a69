#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which oscillating waves liquefy a loose bed, and how far they move the grains of its middle: amplitudes and periods
(thesis section 6.4).

    run.py [KEY=VALUE...]      called by ./run.sh wave_oscillating [KEY=VALUE...]
"""
import math
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
    "AMPLITUDES": (str, "200,600,1200", "Pa, with commas"),
    "PERIODS": (str, "0.5,2", "s, with commas"),
    "END": (float, 3.0, "duration of each run, s"),
    "SHAKE": scene.SHAKE,
    "TOP": scene.TOP,
    "LAW": scene.LAW,
    "VISCOSITY": bed.VISCOSITY_KEY,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
LIQUEFIED = 0.8  # of grad H / i_c: the thesis' nearly complete liquefaction


def consolidation_time(settings, measures):
    """t_c = H² γ_w ε_c / (K_d σ_c) (eq. 6.31) with ε_c = 0.01 and σ_c the weight of the bed; γ_w
    cancels, for K_d = K γ_w / μ."""
    box = (0.0, bed.LENGTH, 0.0, bed.WIDTH, 0.0, measures["top"])
    K = scene.pfv_solve(SCENE, f"{settings['OUT']}.dump", box, 1.0, f"{settings['OUT']}_K.json",
                        "--wall", "symmetry", "--conductance", settings["LAW"],
                        "--face", "zlo:pressure=1",
                        "--face", "zhi:pressure=0")["permeability"]
    height = measures["height"]
    load = bed.FLUID_DENSITY * bed.GRAVITY * measures["critical_gradient"] * height
    return height**2 * 0.01 * bed.viscosity_for(settings["N"]) / (K * load)


def mean_over_period(run, period):
    """grad H / i_c of the middle vertical averaged over one period: what builds up."""
    count = max(1, round(period / np.diff(run.time).mean()))
    return np.convolve(run.liquefied(), np.ones(count) / count, mode="valid")


def swing(run, period):
    """Horizontal displacements of the grains that began within a diameter of the middle, where the wave has its node
    (figs. 6.30 to 6.39): times; each grain's over time, m; height at rest, m; half its range over the last period."""
    shots = run.snapshots()
    moved = np.array([wave_report.displacements(run, step)[1][:, 0] for _, step in shots])
    first = run.grains(shots[0][1])
    middle = abs(first[:, 2] - bed.LENGTH / 2) < 2 * first[:, 5].mean()
    times = np.array([time for time, _ in shots])
    last = moved[times > times[-1] - period][:, middle]
    return {"times": times, "moved": moved[:, middle], "heights": first[middle, 4],
            "range": (last.max(axis=0) - last.min(axis=0)) / 2}


def draw_swings(swings, base):
    """Mean of the uppermost third over the last period; range over the height; largest over the period."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4))
    for (amplitude, period), one in swings.items():
        upper = one["heights"] > np.quantile(one["heights"], 2 / 3)
        last = one["times"] > one["times"][-1] - period
        label = f"{amplitude:g} Pa, {period:g} s"
        phase = (one["times"][last] - one["times"][last][0]) / period
        left.plot(phase, 1e3 * one["moved"][last][:, upper].mean(axis=1), label=label)
        order = np.argsort(one["heights"])
        middle.plot(1e3 * one["range"][order], one["heights"][order], lw=1, label=label)
    for amplitude in sorted({amplitude for amplitude, _ in swings}):
        line = [(period, 1e3 * abs(one["moved"]).max()) for (a, period), one in swings.items() if a == amplitude]
        right.loglog(*zip(*line), "o-", label=f"{amplitude:g} Pa")
    left.set(xlabel="t / period", ylabel="u_x, mm", title="upper third of the middle, last period")
    middle.set(xlabel="half the range of u_x, mm", ylabel="z, m", title="grains of the middle, last period",
               xscale="log")
    right.set(xlabel="period, s", ylabel="largest |u_x| of the middle, mm")
    left.legend(fontsize=6)
    right.legend(fontsize=8)
    save_figure(figure, f"{base}_displacements.png")


def draw(rows, settings, consolidation, base):
    figure, axes = plt.subplots(figsize=(6, 4))
    values = np.array([row["built_up"] for row in rows])
    dots = axes.scatter([row["period"] for row in rows], [row["amplitude"] for row in rows],
                        c=np.clip(values, 0, 1), s=260, cmap="coolwarm", vmin=0, vmax=1,
                        edgecolors="k")
    for row in rows:
        axes.annotate(f"{row['built_up']:.2f}", (row["period"], row["amplitude"]), fontsize=7,
                      ha="center", va="center")
    axes.set(xscale="log", yscale="log", xlabel="period, s", ylabel="amplitude, Pa",
             title=f"largest mean ∇H/i_c over a period, {settings['N']} grains, "
                   f"t_c = {consolidation:.1f} s")
    figure.colorbar(dots, label="1: liquefied")
    save_figure(figure, f"{base}_map.png")


def work(words):
    settings = scene.parse(words, KEYS)
    amplitudes, periods = (scene.numbers(settings, key) for key in ("AMPLITUDES", "PERIODS"))
    if settings["N"] < 100 or settings["SHAKE"] < 0:
        raise scene.BadSetting("N must be at least 100, SHAKE at least 0")
    measures = bed.prepare(SCENE, "loose", settings["N"], settings["SEED"], settings["OUT"])
    consolidation = consolidation_time(settings, measures)
    rows, swings = [], {}
    for period in periods:
        for amplitude in amplitudes:
            print(f"amplitude {amplitude:g} Pa, period {period:g} s", flush=True)
            out = f"{settings['OUT']}_{amplitude:g}_{period:g}"
            run = wave.run(SCENE, settings, measures, out,
                           f"{amplitude:g}*sin({2 * math.pi / period:.12g}*v_t)", settings["END"],
                           top=settings["TOP"], snapshots=round(16 * settings["END"] / period), shake=settings["SHAKE"],
                           records=max(400, round(40 * settings["END"] / period)))
            swings[amplitude, period] = one = swing(run, period)
            rows.append({"amplitude": amplitude, "period": period, "cpu": run.figures["cpu"],
                         "built_up": float(mean_over_period(run, period).max()),
                         "most": float(run.liquefied().max()),
                         "swing": float(one["range"].mean()), "farthest": float(abs(one["moved"]).max()),
                         "settlement": float(run.state["mean_z"][0] - run.state["mean_z"][-1]),
                         "balance": float(abs(run.state["balance"]).max())})
    print(f"\nOscillating wave on a loose bed of {settings['N']} grains, porosity "
          f"{measures['core_porosity']:.3f}")
    print(f"  t_c = {consolidation:.2f} s (eq. 6.31; thesis 10 s)")
    print("  largest ∇H/i_c along v3, mean over a period (1: liquefied)")
    print("  period, s  " + "".join(f"{a:10.0f} Pa" for a in amplitudes))
    for period in periods:
        line = [row for row in rows if row["period"] == period]
        print(f"  {period:9.2f}  " + "".join(f"{row['built_up']:13.2f}" for row in line))
    print("  horizontal displacement of the middle's grains, mm: mean half range over the last period, largest since "
          "the beginning")
    for period in periods:
        line = [row for row in rows if row["period"] == period]
        print(f"  {period:9.2f}  " + "".join(f"{1e3 * row['swing']:8.3f} {1e3 * row['farthest']:7.2f}" for row in line))
    draw(rows, settings, consolidation, SCENE / settings["OUT"])
    draw_swings(swings, SCENE / settings["OUT"])
    balance = max(row["balance"] for row in rows)
    # relative to the largest pressure, which passes through zero with the wave
    checks = [("the fluid's own force balance, largest", balance, "<= 1e-9", balance <= 1e-9)]
    low = max(row["built_up"] for row in rows if row["amplitude"] == amplitudes[0])
    checks.append((f"{amplitudes[0]:g} Pa does not liquefy: largest ∇H/i_c", low, f"< {LIQUEFIED}",
                   low < LIQUEFIED))
    if len(amplitudes) > 1 and settings["END"] >= 2.0:
        high = max(row["built_up"] for row in rows if row["amplitude"] == amplitudes[-1])
        checks.append(("∇H/i_c, highest over lowest amplitude", high / max(low, 1e-3), "> 1",
                       high > low))
    return scene.summary(SCENE, settings["OUT"],
                         {**settings, "t_c": consolidation, "runs": rows}, checks)


if __name__ == "__main__":
    scene.main("wave_oscillating", work)

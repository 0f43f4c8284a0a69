# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures and measures of waves on deformable beds, as in chapter 6 of the thesis."""
import math

import numpy as np

import bed
import contact_stress
import fields
import wave
from plotting import plt, save_figure


def save(figure, run, name):
    save_figure(figure, run.folder / f"{run.out}_{name}.png")


def displacements(run, step):
    """Places at rest and displacements of the grains at a snapshot."""
    first, now = run.grains(run.snapshots()[0][1]), run.grains(step)
    kept = np.isin(first[:, 0], now[:, 0])
    return first[kept], now[:, 2:5] - first[kept][:, 2:5]


def strain_deviator(run, step):
    """sqrt(2/3 e:e) of the deviator e of the strain around each grain since the run began (eqs. 2.20 and 2.21), as the
    fix has it in its files, by id; 0 where a neighbourhood has been torn apart."""
    found = fields.Fields(run.folder / f"{run.out}_grains_{step}.vtu")
    return found["strain_deviator"][np.argsort(found["id"])]


def layer_porosity(run, grains):
    """Between a tenth and seven tenths of the bed's height at rest, wall layers included."""
    height = run.measures["height"]
    return bed.porosity(grains[:, 4], grains[:, 5], 0.1 * height, 0.7 * height)


def series(run):
    """time, unbalanced force (eq. 2.16: mean resultant over mean contact force), porosity."""
    times, unbalanced, porosities = [], [], []
    for time, step in run.snapshots():
        contact = run.mean_contact_force(step)
        force = np.interp(time, run.state["time"], run.state["mean_force"])
        times.append(time)
        unbalanced.append(force / contact if contact > 0 else math.nan)
        porosities.append(layer_porosity(run, run.grains(step)))
    return np.array(times), np.array(unbalanced), np.array(porosities)


def deviators_and_porosities(run):
    """Mean strain deviator of the grains and the porosity at each snapshot (fig. 6.23)."""
    steps = [step for _, step in run.snapshots()]
    return (np.array([strain_deviator(run, step).mean() for step in steps]),
            np.array([layer_porosity(run, run.grains(step)) for step in steps]))


def draw_state(run):
    s = run.state
    times, unbalanced, porosities = series(run)
    figure, axes = plt.subplots(5, 1, figsize=(7, 9), sharex=True)
    axes[0].plot(s["time"], s["amplitude"])
    axes[0].set(ylabel="A, Pa")
    axes[1].semilogy(s["time"], np.maximum(s["kinetic_energy"], 1e-8))
    axes[1].set(ylabel="kinetic energy, J")
    axes[2].semilogy(times[1:], unbalanced[1:], "o-", ms=3)
    axes[2].set(ylabel="λ (eq. 2.16)")
    axes[3].plot(s["time"], s["max_z"])
    axes[3].set(ylabel="highest grain, m")
    axes[4].plot(times, porosities, "o-", ms=3)
    axes[4].set(ylabel="porosity", xlabel="t, s")
    save(figure, run, "state")


def draw_sensors(run):
    figure, axes = plt.subplots(2, 3, figsize=(12, 6), sharex=True)
    gradient = run.gradient()
    for column, v in enumerate((0, 2, 4)):
        for k in range(wave.LEVELS):
            axes[0, column].plot(run.time, run.p[:, v, k], color=f"C{k}", lw=1, label=f"p{k + 1}")
        for k in range(wave.LEVELS - 1):
            axes[1, column].plot(run.time, gradient[:, v, k], color=f"C{k}", lw=1,
                                 label=f"p{k + 1}-p{k + 2}")
        still = run.still_pressure()
        axes[0, column].plot(run.time, still[:, v, -1], "k--", lw=1, label="p6, harmonic")
        axes[0, column].set(title=f"v{v + 1}, x = {wave.VERTICALS[v]:.1f} m")
        axes[1, column].set(xlabel="t, s", ylim=(-1.5, 1.5))
    axes[0, 0].set(ylabel="p, Pa")
    axes[1, 0].set(ylabel="∇H / i_c")
    axes[0, 0].legend(fontsize=7)
    axes[1, 0].legend(fontsize=7)
    save(figure, run, "sensors")


def draw_stress(run, times):
    """Pressure along the middle vertical and effective stress over the bed's height."""
    edges = np.linspace(0.0, run.measures["height"], 11)
    shots = run.snapshots()
    figure, axes = plt.subplots(1, len(times), figsize=(3 * len(times), 3.5), sharey=True,
                                sharex=True)
    for place, wanted in zip(axes, times):
        time, step = min(shots, key=lambda shot: abs(shot[0] - wanted))
        grains, contacts = run.grains(step), run.contacts(step)
        moments = contact_stress.vertical_moments(grains[:, 0], grains[:, 4], grains[:, 5],
                                                  contacts, grains[:, 6])
        sigma = contact_stress.slices(grains[:, 4], grains[:, 5], moments, edges,
                                      bed.LENGTH * bed.WIDTH)
        row = int(np.argmin(abs(run.time - time)))
        place.plot(run.p[row, len(wave.VERTICALS) // 2] / 1e3, run.heights, "o-", ms=3,
                   label="p, v3")
        place.plot(sigma / 1e3, (edges[1:] + edges[:-1]) / 2, "s-", ms=3, label="σ'")
        place.set(title=f"t = {time:.1f} s", xlabel="kPa")
    axes[0].set(ylabel="z, m")
    axes[0].legend(fontsize=8)
    save(figure, run, "stress")


def draw_strain(run, times):
    shots = run.snapshots()
    figure, axes = plt.subplots(1, len(times), figsize=(5.5 * len(times), 3.2), sharey=True,
                                squeeze=False)
    for place, wanted in zip(axes[0], times):
        time, step = min(shots, key=lambda shot: abs(shot[0] - wanted))
        grains, moved = displacements(run, step)
        deviator = strain_deviator(run, step)
        now = grains[:, 2:5] + moved
        order = np.argsort(deviator)
        dots = place.scatter(now[order, 0], now[order, 2], c=deviator[order], s=25, vmin=0.0,
                             vmax=max(0.02, np.quantile(deviator, 0.98)), cmap="viridis")
        figure.colorbar(dots, ax=place, label="strain deviator")
        place.set(title=f"t = {time:.1f} s", xlabel="x, m", aspect="equal")
    axes[0, 0].set(ylabel="z, m")
    save(figure, run, "strain")


def draw_motion(run, times):
    """Snapshots: pressures of the pores and speeds of the grains (fig. 6.11); arrows as long as the grains'
    accelerations, the longest two diameters, in the colours of their speeds (fig. 6.13)."""
    shots = run.snapshots()
    figure, axes = plt.subplots(2, len(times), figsize=(4.6 * len(times), 5.6), sharex=True, sharey=True, squeeze=False)
    for (above, below), wanted in zip(axes.T, times):
        time, step = min(shots, key=lambda shot: abs(shot[0] - wanted))
        grains, pores = run.grains(step), fields.Fields(run.folder / f"{run.out}_pores_{step}.vtu")
        speeds = np.linalg.norm(grains[:, 7:10], axis=1)
        mass = bed.DENSITY * 4.0 / 3.0 * math.pi * grains[:, 5]**3
        accelerations = grains[:, 10:13] / mass[:, None]
        longest = max(np.linalg.norm(accelerations, axis=1).max(), 1e-300)
        arrows = 4 * grains[:, 5].mean() * accelerations / longest
        dots = above.scatter(pores.points[:, 0], pores.points[:, 2], c=pores["pressure"], s=4, cmap="coolwarm")
        figure.colorbar(dots, ax=above, label="p, Pa")
        above.scatter(grains[:, 2], grains[:, 4], s=10, facecolors="none", edgecolors="0.4", linewidths=0.3)
        drawn = below.quiver(grains[:, 2], grains[:, 4], arrows[:, 0], arrows[:, 2], speeds, angles="xy",
                             scale_units="xy", scale=1, width=3e-3, cmap="viridis")
        figure.colorbar(drawn, ax=below, label="|v|, m/s")
        above.set(title=f"t = {time:.1f} s", aspect="equal")
        below.set(title=f"acceleration up to {longest:.2g} m/s²", aspect="equal", xlabel="x, m")
    save(figure, run, "motion")


def still_until(run, tolerance):
    """Amplitude up to which the sensors stay within tolerance x A of the harmonic pressures (rms),
    after the first 100 Pa, in which what is left of the bed's own consolidation drains."""
    amplitude = np.interp(run.time, run.state["time"], run.state["amplitude"])
    error = np.sqrt(((run.p - run.still_pressure())**2).mean(axis=(1, 2)))
    beyond = np.nonzero((amplitude > 100.0) & (error > tolerance * amplitude))[0]
    return float(amplitude[beyond[0]]) if len(beyond) else float(amplitude[-1])


def unstable_at(run, speed=0.02):
    """Amplitude at which the grains' rms speed (m/s) first reaches `speed` for a tenth of a second;
    infinite where it does not."""
    mass = bed.SOLID * bed.DENSITY
    rms = np.sqrt(2.0 * run.state["kinetic_energy"] / mass)
    times = run.state["time"]
    count = max(1, int(0.1 / np.diff(times).mean()))
    fast = np.convolve(rms >= speed, np.ones(count), mode="valid") >= count
    first = np.nonzero(fast)[0]
    return float(run.state["amplitude"][first[0]]) if len(first) else math.inf

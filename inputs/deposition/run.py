#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Immersed deposition (thesis section 4.5): gradients, fronts, balance of forces, stress profiles.

    run.py [KEY=VALUE...]      called by ./run.sh deposition [KEY=VALUE...]
"""
import math
import re
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import bed
import contact_stress
import fields
import scene
from plotting import plt, save_figure

KEYS = {
    "N": (int, 400, "grains"),
    "SEED": scene.SEED,
    "VISCOSITY": (float, 10.0, "Pa s"),
    "END": (float, 16.0, "duration at 10 Pa s, s; goes with the viscosity"),
    "MODULUS": (float, 1.5e6, "E of the contact law, Pa"),
    "TOP": scene.TOP,
    "LAW": scene.LAW,
    "STRAIN": (float, 0.1, "pore strain at which the network is built anew"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS, POROSITY, HEIGHT = 0.03, 0.61, 0.967  # m, of the cloud, m: thesis table 4.4
PLANES = 36  # of the pressure profile
SENSORS = [1, 5, 9, 13, 17, 21]  # six of them
GAMMA = bed.FLUID_DENSITY * bed.GRAVITY


class Run:
    def __init__(self, settings, figures):
        self.settings, self.figures = settings, figures
        out = settings["OUT"]
        state = np.genfromtxt(SCENE / f"{out}_state.csv", delimiter=",", names=True)
        self.state = state[state["fluid"] != 0.0]
        rows = np.loadtxt(SCENE / f"{out}_profile.csv", delimiter=",", skiprows=1)
        with open(SCENE / f"{out}_profile.csv") as file:
            relative = np.array([float(word) for word in file.readline().split(",")[1:]])
        self.time, self.p = rows[:, 0], rows[:, 1:]
        self.heights = relative * HEIGHT
        if settings["TOP"] == "extent":  # the planes follow the cloud: back to fixed heights
            top = np.interp(self.time, self.state["time"], self.state["max_z"])
            self.p = np.array([np.interp(self.heights, relative * z, p, right=0.0)
                               for z, p in zip(top, self.p)])

    def gradients(self):
        """Hydraulic gradient between neighbouring sensors: time x 5."""
        p, z = self.p[:, SENSORS], self.heights[SENSORS]
        return (p[:, :-1] - p[:, 1:]) / (np.diff(z) * GAMMA)

    def snapshots(self):
        """[(time, step)] of the dumps."""
        out = SCENE / self.settings["OUT"]
        steps = sorted(int(re.search(r"\.(\d+)\.txt$", path.name)[1])
                       for path in out.parent.glob(out.name + "_grains.*.txt"))
        return [((step - self.figures["start"]) * self.figures["time_step"], step)
                for step in steps]

    def grains(self, step):
        return bed.read_dump(SCENE / f"{self.settings['OUT']}_grains.{step}.txt")

    def effective_stress(self, step, edges):
        grains = self.grains(step)
        path = SCENE / f"{self.settings['OUT']}_contacts.{step}.txt"
        lines = path.read_text().splitlines()[9:]
        contacts = np.array([line.split() for line in lines], dtype=float).reshape(-1, 5)
        z, radius = grains[:, 4], grains[:, 5]
        moments = contact_stress.vertical_moments(grains[:, 0], z, radius, contacts, grains[:, 6])
        return contact_stress.slices(z, radius, moments, edges, self.figures["area"])


def suspended_gradient(run):
    """(time, measured gradient, that of the porosity) at each output while the deposit is far below
    and the top of the cloud far above: over the planes from 0.3 to 0.75 of the cloud's height."""
    inside = slice(int(0.3 * PLANES), int(0.75 * PLANES))
    low, high = run.heights[inside][0], run.heights[inside][-1]
    shots = run.snapshots()
    critical = []
    for _, step in shots:
        grains = run.grains(step)
        n = bed.porosity(grains[:, 4], grains[:, 5], low, high, run.figures["area"])
        critical.append((1 - n) * (bed.DENSITY / bed.FLUID_DENSITY - 1))
    times = run.time[(run.time >= 0.1) & (run.time <= 0.5 * run.settings["VISCOSITY"] / 10.0)]
    measured = [-np.polyfit(run.heights[inside], p[inside], 1)[0] / GAMMA
                for p in run.p[np.searchsorted(run.time, times)]]
    return np.column_stack([times, measured, np.interp(times, [t for t, _ in shots], critical)])


def balance(run):
    """(fluid + floor - weight - change of momentum) / buoyant weight at every output."""
    s = run.state
    steps = np.round(np.diff(s["time"]) / run.figures["time_step"])
    force, now = s["fluid"] + s["floor"], s["fluid_now"] + s["floor_now"]
    # the record is the mean over the steps n+1 ... n+N; the momentum changes by the trapezoidal sum
    mean = force[1:] + (now[:-1] - now[1:]) / (2.0 * steps)
    change = np.diff(s["momentum"]) / np.diff(s["time"])
    return s["time"][1:], (mean - run.figures["weight"] - change) / run.figures["buoyant_weight"]


def fronts(run):
    """Times at which the gradients have fallen to half of the first ones for good: the deposit
    reaches that height."""
    g = run.gradients()
    smooth = np.array([np.convolve(row, np.ones(9) / 9, mode="same") for row in g.T]).T
    start = g[(run.time > 0.03) & (run.time < 0.2 * run.settings["VISCOSITY"] / 10)].mean(axis=0)
    times = []
    for k in range(g.shape[1]):
        above = np.nonzero(smooth[:, k] > 0.5 * start[k])[0]
        times.append(float(run.time[above[-1]]) if len(above) else 0.0)
    return times


def draw_sensors(run, rows, base):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    for k in SENSORS:
        left.plot(run.time, run.p[:, k] / 1e3, label=f"z = {run.heights[k]:.2f} m")
    left.set(xlabel="t, s", ylabel="excess pressure, kPa", title="six sensors")
    left.legend(fontsize=8)
    for k, g in enumerate(run.gradients().T):
        z = run.heights[SENSORS]
        right.plot(run.time, g, lw=1, label=f"{z[k]:.2f} to {z[k + 1]:.2f} m")
    right.axhline(rows[:, 2].mean(), color="k", ls="--", lw=1, label="(1-n)(ρs-ρf)/ρf")
    right.set(xlabel="t, s", ylabel="hydraulic gradient", title="between neighbours")
    right.legend(fontsize=8)
    save_figure(figure, f"{base}_sensors.png")


def draw_stress(run, base):
    edges = np.linspace(0.0, HEIGHT, 17)
    middle = (edges[1:] + edges[:-1]) / 2
    shots = run.snapshots()
    figure, axes = plt.subplots(1, 4, figsize=(12, 3.6), sharey=True, sharex=True)
    for place, part in zip(axes, (0.02, 0.25, 0.5, 1.0)):
        time, step = shots[min(len(shots) - 1, max(1, round(part * (len(shots) - 1))))]
        row = int(np.argmin(abs(run.time - time)))
        sigma = run.effective_stress(step, edges)
        place.plot(run.p[row] / 1e3, run.heights, label="p")
        place.plot(sigma / 1e3, middle, label="σ' (eq. 2.18)")
        place.plot((sigma + np.interp(middle, run.heights, run.p[row])) / 1e3, middle, "k--", lw=1,
                   label="sum")
        grains = run.grains(step)
        above = [grains_above(grains, z) for z in edges]
        place.plot(np.array(above) * run.figures["unit_weight"] / run.figures["area"] / 1e3, edges,
                   "C3:", lw=1, label="buoyant weight above")
        place.set(title=f"t = {time:.2f} s", xlabel="kPa")
    axes[0].set(ylabel="z, m")
    axes[0].legend(fontsize=7)
    save_figure(figure, f"{base}_stress.png")


def grains_above(grains, height):
    """Volume of the grains above a height, m3."""
    z, radius = grains[:, 4], grains[:, 5]
    return 4.0 / 3.0 * math.pi * radius**3 @ (1 - contact_stress.share_below(z, radius, height))


def couple(settings):
    grains, out = settings["N"], settings["OUT"]
    solid = grains * 4.0 / 3.0 * math.pi * RADIUS**3 * bed.MEAN_CUBE
    area = solid / (1 - POROSITY) / HEIGHT
    length = math.sqrt(1.2 * area)
    small = 0.9 * RADIUS
    step = 0.25 * math.sqrt(bed.DENSITY * 4 / 3 * math.pi * small**2 / (2 * settings["MODULUS"]))
    steps = math.ceil(settings["END"] * settings["VISCOSITY"] / 10.0 / step)
    every = max(1, steps // 600)
    if settings["TOP"] not in ("plane", "extent"):
        raise scene.BadSetting("TOP must be plane or extent")
    top = f"plane {HEIGHT}" if settings["TOP"] == "plane" else "extent"
    fields.clear(SCENE / f"{out}.pvd")
    for old in (SCENE / out).parent.glob((SCENE / out).name + "_*.txt"):
        old.unlink()
    print(f"deposition of {grains} grains: {steps} steps of {step:.3g} s", flush=True)
    said, cpu = scene.liggghts(SCENE, "in.deposition", {
        "N": grains, "r2": RADIUS, "LX": length, "LY": area / length, "LZ": HEIGHT,
        "viscosity": settings["VISCOSITY"], "time_step": step, "steps": steps, "every": every,
        "stride": 20 * every, "report": max(1, steps // 100), "top": top,
        "words": scene.fix_words(f"coupling auto retriangulate {settings['STRAIN']} conductance {settings['LAW']}",
                                 settings["FIX"]), "E": settings["MODULUS"], "out": out,
        **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        out + "_run", scene.Progress("deposition", 8203, 8203 + steps, step))
    unit = (bed.DENSITY - bed.FLUID_DENSITY) * bed.GRAVITY
    return {"area": area, "time_step": step, "steps": steps, "cpu": cpu,
            "time_step_limit": float(said["end"][0]), "start": int(said["end"][1]),
            "unit_weight": unit, "buoyant_weight": solid * unit,
            "weight": solid * bed.DENSITY * bed.GRAVITY}


def judge(run, settings):
    rows = suspended_gradient(run)
    ratio = rows[:, 1] / rows[:, 2]
    _, unbalanced = balance(run)
    arrivals = fronts(run)
    last = run.gradients()[-20:].mean(axis=0)
    own, mass = abs(run.state["balance"]).max(), abs(run.state["mass"]).max()
    print(f"\nDeposition of {settings['N']} grains, {settings['VISCOSITY']:g} Pa s, flow box up to "
          f"{'a plane' if settings['TOP'] == 'plane' else 'the highest grain'}")
    print(f"  gradient of the cloud       {rows[:, 1].mean():.4f} +- {rows[:, 1].std():.4f} from "
          f"{rows[0, 0]:.1f} to {rows[-1, 0]:.1f} s   (1-n)(ρs-ρf)/ρf = {rows[:, 2].mean():.4f}; "
          "thesis 0.624")
    print("  the deposit passes          "
          + ", ".join(f"{z:.2f} m at {t:.2f} s" for z, t in
                      zip(run.heights[SENSORS][:-1], arrivals)))
    print(f"  networks {int(run.state['retriangulations'][-1])}, CPU {run.figures['cpu']:.0f} s, "
          f"time step {run.figures['time_step']:.3g} s")
    full = settings["END"] >= 16.0  # long enough for the last grains and for the pressure they leave
    checks = [
        ("gradient of the cloud / buoyant weight - 1, mean", ratio.mean() - 1,
         "within 0.03", abs(ratio.mean() - 1) <= 0.03),
        ("fluid + floor + inertia / buoyant weight - 1, largest", abs(unbalanced).max(),
         "<= 0.01", abs(unbalanced).max() <= 0.01),
        ("the fluid's own force balance, largest", own, "<= 1e-10", own <= 1e-10),
        ("the fluid's mass balance, largest", mass, "<= 1e-10", mass <= 1e-10)]
    if full:
        checks += [
            ("the deposit rises from the bottom up: smallest step, s", min(np.diff(arrivals)),
             "> 0", min(np.diff(arrivals)) > 0),
            ("gradient at the end, largest", abs(last).max(), "<= 0.03", abs(last).max() <= 0.03)]
    return rows, checks, {"gradients": rows.tolist(), "arrivals": arrivals,
                          "unbalanced": float(abs(unbalanced).max())}


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 50 or settings["VISCOSITY"] <= 0 or settings["END"] <= 0.1:
        raise scene.BadSetting("N must be at least 50, VISCOSITY above 0, END above 0.1")
    run = Run(settings, couple(settings))
    rows, checks, figures = judge(run, settings)
    base = SCENE / settings["OUT"]
    draw_sensors(run, rows, base)
    draw_stress(run, base)
    return scene.summary(SCENE, settings["OUT"], {**settings, **run.figures, **figures}, checks)


if __name__ == "__main__":
    scene.main("deposition", work)

# SPDX-License-Identifier: GPL-3.0-or-later
"""A standing wave on a deformable bed (thesis chapter 6): one coupled run and what it recorded."""
import json
import math
import re
import shutil

import numpy as np

import bed
import fields
import scene

VERTICALS = np.array([0.05, 0.25, 0.5, 0.75, 0.95]) * bed.LENGTH  # v1 ... v5 of fig. 6.8
ACROSS = np.array([0.25, 0.5, 0.75]) * bed.WIDTH  # a sensor's value is the mean of three pores
LEVELS = 6  # p1 ... p6, from the bottom up


def time_step(grains):
    """A quarter of sqrt(m/k) of the smallest grain against a wall: one eighth of where the contacts
    of a dense packing become unstable."""
    small = 0.9 * bed.mean_radius(grains)
    return 0.25 * math.sqrt(bed.DENSITY * 4 / 3 * math.pi * small**2 / (2 * 15e6))


def sensor_heights(measures):
    return (np.arange(LEVELS) + 0.5) / LEVELS * measures["height"]


def sensor_words(measures):
    return " ".join(f"{x:g} {y:g} {z:g}" for x in VERTICALS for z in sensor_heights(measures)
                    for y in ACROSS)


def top_words(top, measures):
    """The flow box ends at a plane through the top of the highest grain at rest, or follows it."""
    if top == "extent":
        return "extent"
    if top == "plane":
        return f"plane {measures['top']:.6f}"
    raise scene.BadSetting("TOP must be plane or extent")


class Run:
    """The records of one run."""

    def __init__(self, folder, out, measures, figures):
        self.folder, self.out, self.measures, self.figures = folder, out, measures, figures
        self.state = np.genfromtxt(folder / f"{out}_state.csv", delimiter=",", names=True)
        rows = np.loadtxt(folder / f"{out}_sensors.csv", delimiter=",", skiprows=1)
        self.time = rows[:, 0]
        self.p = rows[:, 1:].reshape(len(rows), len(VERTICALS), LEVELS, len(ACROSS)).mean(axis=3)
        self.heights = sensor_heights(measures)
        self.weight = (bed.GRAVITY * bed.FLUID_DENSITY * measures["critical_gradient"])  # Pa/m

    def gradient(self):
        """grad H / i_c (eq. 6.28) between neighbouring sensors: time x verticals x 5."""
        return (self.p[:, :, :-1] - self.p[:, :, 1:]) / (self.weight * np.diff(self.heights))

    def liquefied(self):
        """grad H / i_c over the middle vertical, where the wave has its node, from the lowest to
        the highest sensor: 0 where the pressure is hydrostatic, 1 where the fluid carries all."""
        middle = self.p[:, len(VERTICALS) // 2]
        span = self.heights[-1] - self.heights[0]
        return (middle[:, 0] - middle[:, -1]) / (self.weight * span)

    def still_pressure(self):
        """Harmonic pressures at the sensors (eq. 6.24): time x verticals x levels."""
        wave = math.pi / bed.LENGTH
        shape = (np.cosh(wave * self.heights) / np.cosh(wave * self.measures["height"]))[None, :]
        shape = shape * np.cos(wave * VERTICALS)[:, None]
        amplitude = np.interp(self.time, self.state["time"], self.state["amplitude"])
        return amplitude[:, None, None] * shape

    def excess(self):
        """Mean of all sensors above the pressures of a bed at rest, Pa."""
        return (self.p - self.still_pressure()).mean(axis=(1, 2))

    def snapshots(self):
        """[(time, step)] of the dumps."""
        steps = sorted(int(re.search(r"\.(\d+)\.txt$", path.name)[1]) for path in
                       (self.folder / self.out).parent.glob(
                           (self.folder / self.out).name + "_grains.*.txt"))
        return [(step * self.figures["time_step"], step) for step in steps]

    def grains(self, step):
        return bed.read_dump(self.folder / f"{self.out}_grains.{step}.txt")

    def contacts(self, step):
        """id, id, force (3) of each contact between grains."""
        path = self.folder / f"{self.out}_contacts.{step}.txt"
        return np.atleast_2d(np.loadtxt(path, skiprows=9))

    def mean_contact_force(self, step):
        rows = self.contacts(step)
        if rows.size == 0:
            return 0.0
        return float(np.sqrt((rows[:, 2:5]**2).sum(axis=1)).mean())


def clear(folder, out):
    fields.clear(folder / f"{out}.pvd")
    for old in (folder / out).parent.glob((folder / out).name + "_*.txt"):
        if re.search(r"_(contacts|grains)\.\d+\.txt$", old.name):
            old.unlink()


def run(folder, settings, measures, out, amplitude, duration, viscosity=None, top="plane",
        words="", records=400, snapshots=25, shake=0.0, shake_end=math.inf,
        step_factor=1.0):
    """One wave on the bed that OUT of the settings holds; `amplitude` is a formula of v_t. `shake`
    is the force that keeps each grain moving, over its weight in the fluid (in.shake)."""
    grains = settings["N"]
    viscosity = viscosity or settings.get("VISCOSITY") or bed.viscosity_for(grains)
    step = step_factor * time_step(grains)
    steps = math.ceil(duration / step)
    every = max(1, steps // records)
    stride = every * max(1, records // snapshots)
    if out != settings["OUT"]:
        shutil.copy(folder / f"{settings['OUT']}.restart", folder / f"{out}.restart")
    clear(folder, out)
    own = f"{words or 'retriangulate 0.01'} coupling auto conductance {settings['LAW']}"
    variables = {"r2": bed.mean_radius(grains), "LX": bed.LENGTH, "LY": bed.WIDTH,
                 "viscosity": viscosity, "time_step": step, "steps": steps, "every": every,
                 "stride": stride, "report": max(1, steps // 100), "amplitude": amplitude,
                 "top": top_words(top, measures), "words": scene.fix_words(own, settings["FIX"]),
                 "sensors": sensor_words(measures), "out": out, "name": folder.name,
                 "g": bed.BUOYANT, "shake": shake, "shake_end": min(shake_end, duration + 1.0)}
    said, cpu = scene.liggghts(folder, f"in.{folder.name}", variables, out + "_run",
                               scene.Progress("wave", 0, steps, step))
    figures = {"viscosity": viscosity, "time_step": step, "steps": steps, "cpu": cpu,
               "amplitude_formula": amplitude, "duration": duration, "top": top,
               "time_step_limit": float(said["end"][0])}
    (folder / f"{out}_run.json").write_text(json.dumps({**settings, **figures}, indent=1) + "\n")
    return Run(folder, out, measures, figures)


def first_time(times, values, level):
    """When the values first reach a level; infinite where they do not."""
    over = np.nonzero(values >= level)[0]
    return float(times[over[0]]) if len(over) else math.inf

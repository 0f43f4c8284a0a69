# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of samples share, triaxial and simple shear: stress paths, measures of drained tests, figures.

A run is a dictionary: rows (of its record), strain, mean (p') and deviator (q) or what stands for them, held (the
effective stress along which the total one is held), volumetric (strain).
"""
import math

import numpy as np

from plotting import plt, save_figure

DENSITY, STIFFNESS, BULK_MODULUS = 2600.0, 15e6, 2.2e9  # of ../triaxial/in.material and of water: kg/m3, Pa, Pa
FRICTION = {"dense": 0.0175, "loose": 0.57735}  # between grains that are compressed: 1 and 30 degrees
NUDGES = [1e-12, 2e-12, 3e-12]  # m/s, of runs that differ as those of renumbered grains would
RAMP = 0.005  # axial strain at a test's rate, in whose time that rate is reached
ROWS = 200  # of a record


def time_step(radius):
    """s, that of in.material for grains of this mean radius."""
    small = 0.9 * radius
    return 0.25 * math.sqrt(DENSITY * 4 / 3 * math.pi * small**3 / (2 * STIFFNESS * small))


def record(file, volume):
    """A run, of the record that its test has written and the sample's volume, m3."""
    rows = np.genfromtxt(file, delimiter=",", names=True)[1:]
    side = 0.5 * (rows["sx"] + rows["sy"])
    return {"rows": rows, "mean": (2 * side + rows["sz"]) / 3, "deviator": rows["sz"] - side, "held": side,
            "volumetric": 1 - rows["volume"] / volume, "strain": rows["strain"]}


def path_distance(one, other, scale):
    """Distance of the points of one effective stress path, p' and q, from the line of another, over p' there or over a
    stress: largest, rms."""
    points, line = (np.column_stack([run["mean"], run["deviator"]]) for run in (one, other))
    begin, along = line[:-1], np.diff(line, axis=0)
    part = ((points[:, None] - begin) * along).sum(axis=2) / (along**2).sum(axis=1)
    nearest = begin + np.clip(part, 0, 1)[..., None] * along
    far = np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1) / (scale or points[:, 0])
    return float(far.max()), float(np.sqrt((far**2).mean()))


def difference(one, other, scale):
    """Rms over the strain of the difference of p', over p' of the other or over a stress."""
    count = min(len(one["strain"]), len(other["strain"]))
    apart = one["mean"][:count] - other["mean"][:count]
    return float(np.sqrt(((apart / (scale or other["mean"][:count]))**2).mean()))


def compared(pairs, scale=None):
    """The largest of what pairs of runs differ by, over p' or over a stress, Pa."""
    paths = np.array([path_distance(*pair, scale) for pair in pairs]).max(axis=0)
    return {"largest": float(paths[0]), "rms": float(paths[1]),
            "at_equal_strain": max(difference(*pair, scale) for pair in pairs)}


def apart(run, others, stress, pressure=None):
    """How far a run is from dry ones at constant volume, in the mean over these: its path, p' at equal strain, and its
    pore pressure (where there is none, what it would be under this total stress) from what they leave of the stress;
    rms over the stress."""
    pairs = [compared([(run, other)], stress) for other in others]
    pressure = stress - run["held"] if pressure is None else pressure
    left = [float(np.sqrt((((pressure - stress + other["held"]) / stress)**2).mean())) for other in others]
    return {"path": float(np.mean([pair["rms"] for pair in pairs])),
            "at_equal_strain": float(np.mean([pair["at_equal_strain"] for pair in pairs])),
            "pressure": float(np.mean(left))}


def scatter(alike, stress):
    """How far one of several dry runs is at most from the others."""
    found = [apart(one, [other for other in alike if other is not one], stress) for one in alike]
    return {key: max(one[key] for one in found) for key in found[0]}


def within(what, measured, limit, scattered=None):
    """A row of a scene's table; `scattered`: how far one dry run is from the others; no test can be nearer than that."""
    wanted = f"<= {limit:g}" + ("" if scattered is None else f" (a dry run: {scattered:.2g})")
    return what, measured, wanted, measured <= max(limit, scattered or 0.0)


def say_apart(what, found):
    path, mean, pressure = (100 * found[key] for key in ("path", "at_equal_strain", "pressure"))
    print(f"  from dry runs, {what:<29s} stress paths {path:5.2f} %, p' at equal strain {mean:5.2f} %, "
          f"pore pressure {pressure:5.2f} % of the stress (rms)")


def friction_angle(run, where):
    """Mobilised, degrees, from the mean stresses of some rows."""
    q, p = run["deviator"][where].mean(), run["mean"][where].mean()
    side = p - q / 3
    return math.degrees(math.asin(q / (2 * side + q)))


def drained_measures(run, volume):
    """What the drained test says; the last tenth of the rows is its end."""
    rows, end = run["rows"], np.arange(len(run["rows"])) >= 0.9 * len(run["rows"])
    smooth = np.convolve(run["deviator"], np.full(9, 1 / 9), mode="valid")
    left = np.concatenate(([0.0], np.cumsum(rows["left"][1:] * np.diff(rows["time"]))))
    lost = rows["volume"][0] - rows["volume"]
    return {"peak": float(smooth.max()), "end": float(run["deviator"][end].mean()),
            "peak_angle": friction_angle(run, slice(max(0, int(smooth.argmax())), int(smooth.argmax()) + 9)),
            "end_angle": friction_angle(run, end), "contraction": float(run["volumetric"].max()),
            "volume_at_end": float(run["volumetric"][end].mean()),
            "left": float(abs(left - lost).max() / volume), "excess": float(abs(rows["p"]).max())}


def draw_drained(found, rate, base):
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.8))
    for kind, one in found.items():
        run = one["runs"]["drained", rate]
        label = f"{kind}, n = {one['sample']['porosity']:.3f}"
        axes[0].plot(100 * run["strain"], run["rows"]["sz"] / 1e3, label=label)
        axes[1].plot(100 * run["strain"], 100 * run["volumetric"], label=label)
    axes[0].set(xlabel="axial strain, %", ylabel="effective axial stress, kPa")
    axes[1].set(xlabel="axial strain, %", ylabel="volumetric strain (compression +), %")
    axes[0].legend()
    save_figure(figure, f"{base}_drained.png")


def draw_undrained(found, rates, base):
    figure, axes = plt.subplots(1, 3, figsize=(14, 4))
    for kind, color in (("dense", "C0"), ("loose", "C1")):
        for rate, style in zip(rates, ("-", "--", ":", "-.") * len(rates)):
            wet, dry = (found[kind]["runs"][fluid, rate] for fluid in ("undrained", "dry"))
            axes[0].plot(100 * wet["strain"], wet["rows"]["p"] / 1e3, style, color=color, label=f"{kind}, {rate:g}/s")
            axes[1].plot(100 * wet["strain"], wet["deviator"] / 1e3, style, color=color)
            axes[2].plot(wet["mean"] / 1e3, wet["deviator"] / 1e3, style, color=color)
            if rate == rates[0]:
                axes[1].plot(100 * dry["strain"], dry["deviator"] / 1e3, "k-", lw=0.7)
                axes[2].plot(dry["mean"] / 1e3, dry["deviator"] / 1e3, "k-", lw=0.7)
    axes[1].plot([], [], "k-", lw=0.7, label=f"dry, constant volume, {rates[0]:g}/s")
    axes[0].set(xlabel="axial strain, %", ylabel="pore pressure, kPa")
    axes[1].set(xlabel="axial strain, %", ylabel="deviator q, kPa")
    axes[2].set(xlabel="mean effective stress p', kPa", ylabel="q, kPa")
    axes[0].legend(fontsize="small")
    axes[1].legend(fontsize="small")
    save_figure(figure, f"{base}_undrained.png")

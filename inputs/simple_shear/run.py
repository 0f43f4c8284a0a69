#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Simple shear of a dense and a loose sample between rough plates, periodic along them: drained, undrained, dry at
constant volume, and in viscous fluids.

    run.py [KEY=VALUE...]      called by ./run.sh simple_shear [KEY=VALUE...]
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import numpy as np

import bed
import meshes
import scene
from element_tests import BULK_MODULUS, FRICTION, ROWS, apart, say_apart, scatter, time_step, within
from plotting import plt, save_figure

KEYS = {
    "PLATE": (int, 7, "grains along an edge of a plate"),
    "N": (int, 400, "grains between the plates"),
    "SEED": scene.SEED,
    "STRESS": (float, 50e3, "total normal stress, Pa"),
    "RATE": (float, 0.3, "shear rate, 1/s"),
    "STRAIN": (float, 0.3, "shear strain"),
    "VISCOUS": (float, 0.1, "shear strain of the tests in viscous fluids"),
    "VISCOSITIES": (str, "10,100,1000", "of these, Pa s"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS = 0.03  # m
STEP = time_step(RADIUS)  # s
PISTON_MASS = 700.0  # kg/m2, about that of the sample
SPEED = 0.15  # m/s, of the upper plate while nothing carries it
RAMP = 0.02  # shear strain at a test's rate, in whose time that rate is reached
THIN = 1e-3  # Pa s, of the fluid in the tests that are not about its viscosity
COMPARED = 0.2  # shear strain up to which tests are compared: a band forms then in a dense sample, otherwise in each
GRAIN = 4 / 3 * math.pi * RADIUS**3 * bed.MEAN_CUBE  # m3, the mean
# m/s, at the upper plate, of dry runs that are scattered: as those of renumbered grains are, up to 1 % of its speed
NUDGES = [1e-12, 1e-9, 1e-6, 1e-4, 1e-3]
# (script, whether the upper plate is a piston, words)
TESTS = {"drained": ("drained", 1, "couple_every 1"), "undrained": ("undrained", 1, "couple_every 1"),
         "dry": ("dry", 0, ""), "viscous": ("undrained", 0, "couple_every 1 shear_viscous yes coupling auto")}


def edge(settings):
    return 2 * RADIUS * settings["PLATE"]


def write_plates(settings, out):
    """Two layers of grains that touch, and the lid behind the upper one; returns the height of that."""
    side, count = edge(settings), settings["PLATE"]
    top = settings["N"] * GRAIN / (0.3 * side**2) + 2 * RADIUS
    places = [(2 * RADIUS * (i + 0.5), 2 * RADIUS * (j + 0.5), z) for z in (0.0, top) for i in range(count)
              for j in range(count)]
    lines = ["plates", "", f"{len(places)} atoms", "4 atom types", "", f"0 {side!r} xlo xhi", f"0 {side!r} ylo yhi",
             f"{-2 * RADIUS!r} {top + 6 * RADIUS!r} zlo zhi", "", "Atoms", ""]
    lines += [f"{n} 2 {2 * RADIUS!r} 2600 {x!r} {y!r} {z!r}" for n, (x, y, z) in enumerate(places, 1)]
    (SCENE / f"{out}.data").write_text("\n".join(lines) + "\n")
    meshes.write_mesh(SCENE / f"{settings['OUT']}_lid.stl",
                      meshes.quad((0, 0, 0), (side, 0, 0), (side, side, 0), (0, side, 0)))
    return top


def common(settings):
    """Variables of both scripts."""
    return {"r2": RADIUS, "area": edge(settings)**2, "plate": settings["PLATE"]**2, "S": settings["STRESS"],
            "piston_mass": PISTON_MASS}


def prepare(settings, kind):
    """The sample under the normal stress: its file, last step, height and porosity between the plates."""
    out = f"{settings['OUT']}_{kind}"
    top = write_plates(settings, out)
    press, rest = round(0.55 * top / SPEED / STEP), 4000
    said, cpu = scene.liggghts(
        SCENE, "in.prepare",
        {**common(settings), "N": settings["N"], "mu": FRICTION[kind], "L": edge(settings), "top": top, "speed": SPEED,
         "press": press, "rest": rest, "every": 1000, "out": out,
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        f"{out}_prepare", scene.Progress(f"{kind} sample", 0, press + 2 * rest, STEP))
    height, stress = float(said["height"][0]), float(said["stress"][0])
    volumes = 4 / 3 * math.pi * bed.read_dump(SCENE / f"{out}.dump")[:, 5]**3
    # between the middles of the plates stands half of each of their grains
    solid = volumes.sum() - 0.5 * volumes[:2 * settings["PLATE"]**2].sum()
    porosity = 1 - float(solid) / (height * edge(settings)**2)
    print(f"{kind} sample of {settings['N']} grains: height {height:.3f} m, porosity {porosity:.3f}; CPU {cpu:.0f} s",
          flush=True)
    return {"name": out, "last": int(said["sample"][0]), "height": height, "porosity": porosity,
            "off": abs(stress / settings["STRESS"] - 1), "cpu": cpu}


def test(settings, sample, name, viscosity=THIN, nudge=0.0):
    """One test; its record, with the effective normal stress as its mean stress and the shear stress as deviator."""
    fluid, pressed, words = TESTS[name]
    out = f"{sample['name']}_{name}" + (f"_{viscosity:g}" if name == "viscous" else "") + (
        f"_nudge_{nudge:g}" if nudge else "")
    rate, strain = settings["RATE"], settings["VISCOUS" if name == "viscous" else "STRAIN"]
    ramp = RAMP / rate
    every = max(1, round((strain / rate + ramp / 2) / STEP / ROWS))
    _, cpu = scene.liggghts(
        SCENE, "in.simple_shear",
        {**common(settings), "fluid": fluid, "pressed": pressed, "words": scene.fix_words(words, settings["FIX"]),
         "sample": sample["name"], "out": out, "lid": f"{settings['OUT']}_lid.stl", "H": sample["height"],
         "last": sample["last"], "rate": rate, "ramp": ramp, "steps": every * ROWS, "every": every,
         "viscosity": viscosity, "bulk_modulus": BULK_MODULUS, "nudge": nudge},
        out, scene.Progress(name, sample["last"], sample["last"] + every * ROWS, STEP))
    rows = np.genfromtxt(SCENE / f"{out}.csv", delimiter=",", names=True)[1:]
    said = out.removeprefix(sample["name"] + "_").replace("_", " ")
    print(f"  {said}: {every * ROWS} steps, CPU {cpu:.0f} s", flush=True)
    return {"rows": rows, "strain": rows["strain"], "mean": rows["normal"], "deviator": rows["shear"],
            "held": rows["normal"], "cpu": cpu}


def friction(run, where):
    """Shear stress over effective normal stress, of the means of some rows."""
    return float(run["rows"]["shear"][where].mean() / run["rows"]["normal"][where].mean())


def begin_of(run):
    """Of a run as it is compared."""
    count = int((run["strain"] <= COMPARED).sum())
    return {key: run[key][:count] for key in ("strain", "mean", "deviator", "held")}


def measures_of(settings, sample, runs):
    drained, end = runs["drained"]["rows"], slice(int(0.8 * ROWS), None)
    left = np.concatenate(([0.0], np.cumsum(drained["left"][1:] * np.diff(drained["time"])))) / edge(settings)**2
    smooth = np.convolve(drained["shear"], np.full(9, 1 / 9), mode="valid")
    peak = int(smooth.argmax())
    return {"peak": friction(runs["drained"], slice(peak, peak + 9)), "end": friction(runs["drained"], end),
            "dilation": float((drained["height"][end] / sample["height"] - 1).mean()),
            "left": float(abs(left - drained["height"][0] + drained["height"]).max() / sample["height"])}


def viscous_measures(settings, run, viscosity):
    """Means over the second half of a test: shear stresses, that of the fluid over mu times the rate."""
    half = run["rows"][len(run["rows"]) // 2:]
    fluid, grains = float(half["fluid_shear"].mean()), float(half["shear"].mean())
    return {"relative": fluid / (viscosity * settings["RATE"]), "grains": grains, "fluid": fluid,
            "number": viscosity * settings["RATE"] / float(half["normal"].mean()),
            "friction": grains / float(half["normal"].mean()), "pressure": float(abs(run["rows"]["p"]).max()),
            "cpu": run["cpu"]}


def tests_of(settings, kind):
    sample, stress = prepare(settings, kind), settings["STRESS"]
    runs = {name: test(settings, sample, name) for name in ("drained", "undrained", "dry")}
    nudged = [test(settings, sample, "dry", nudge=nudge) for nudge in NUDGES]
    alike, wet = [begin_of(run) for run in [runs["dry"], *nudged]], begin_of(runs["undrained"])
    pressure = runs["undrained"]["rows"]["p"][:len(wet["strain"])]
    viscosities = scene.numbers(settings, "VISCOSITIES") if kind == "loose" else []
    viscous = {viscosity: test(settings, sample, "viscous", viscosity) for viscosity in viscosities}
    return {"sample": sample, "runs": runs, "measures": measures_of(settings, sample, runs),
            "scatter": scatter(alike, stress), "undrained": apart(wet, alike, stress, pressure),
            "viscous": {v: viscous_measures(settings, run, v) for v, run in viscous.items()},
            "cpu": sample["cpu"] + sum(run["cpu"] for run in [*runs.values(), *nudged, *viscous.values()])}


def draw(settings, found, base):
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.5))
    for (kind, one), color in zip(found.items(), ("C0", "C1")):
        drained, wet, dry = (one["runs"][name] for name in ("drained", "undrained", "dry"))
        percent = 100 * drained["strain"]
        axes[0, 0].plot(percent, drained["rows"]["shear"] / 1e3, color=color, label=f"{kind}, drained")
        axes[0, 1].plot(percent, 100 * (drained["rows"]["height"] / one["sample"]["height"] - 1), color=color)
        axes[1, 0].plot(percent, wet["rows"]["p"] / 1e3, color=color, label=f"{kind}, undrained")
        axes[1, 0].plot(percent, (settings["STRESS"] - dry["held"]) / 1e3, "k-", lw=0.7)
        axes[1, 1].plot(wet["mean"] / 1e3, wet["deviator"] / 1e3, color=color)
        axes[1, 1].plot(dry["mean"] / 1e3, dry["deviator"] / 1e3, "k-", lw=0.7)
    axes[1, 0].plot([], [], "k-", lw=0.7, label="dry, constant volume: stress - its normal stress")
    labels = (("shear strain, %", "shear stress, kPa"), ("shear strain, %", "change of height, %"),
              ("shear strain, %", "pore pressure, kPa"), ("effective normal stress, kPa", "shear stress, kPa"))
    for axis, (x, y) in zip(axes.flat, labels):
        axis.set(xlabel=x, ylabel=y)
    for axis in axes[:, 0]:
        axis.legend(fontsize="small")
    save_figure(figure, f"{base}_shear.png")


def checks_of(kind, one, stress):
    wet = one["runs"]["undrained"]["rows"]
    rows = [within(f"{kind}: normal stress / given - 1", one["sample"]["off"], 1e-3),
            within(f"{kind}, undrained: total normal stress / given - 1",
                   float(abs(wet["total"] / stress - 1).max()), 0.01),
            within(f"{kind}, undrained: p - what dry tests leave, rms / stress", one["undrained"]["pressure"], 0.03,
                   one["scatter"]["pressure"]),
            within(f"{kind}, undrained: from dry paths, rms / stress", one["undrained"]["path"], 0.03,
                   one["scatter"]["path"]),
            within(f"{kind}, drained: what has left - what the height lost, / height", one["measures"]["left"], 1e-5)]
    runs = [one["runs"][name]["rows"] for name in ("drained", "undrained")]
    return rows + [within(f"{kind}: {name.replace('_', ' ')}, largest",
                          max(float(abs(run[name]).max()) for run in runs), 1e-9)
                   for name in ("mass_error", "force_error")]


def checks(settings, found):
    rows = [row for kind, one in found.items() for row in checks_of(kind, one, settings["STRESS"])]
    dense, loose = (found[kind] for kind in ("dense", "loose"))
    falls, rises = (one["runs"]["undrained"]["rows"]["p"] / settings["STRESS"] for one in (dense, loose))
    ratio = dense["measures"]["peak"] / loose["measures"]["peak"]
    rows += [("dense, undrained: least pore pressure / stress", falls.min(), "<= -0.2", falls.min() <= -0.2),
             ("loose, undrained: largest pore pressure / stress", rises.max(), ">= 0.1", rises.max() >= 0.1),
             ("drained: peak friction of the dense over that of the loose sample", ratio, ">= 1.2", ratio >= 1.2)]
    fluids = list(loose["viscous"].values())
    relative = [one["relative"] for one in fluids]
    spread = max(relative) / min(relative)
    pressure = max(one["pressure"] for one in fluids) / BULK_MODULUS
    rows += [within("viscous, constant volume: |p| / K_f", pressure, 1e-10),
             ("viscous: fluid's shear stress / (mu times the rate), smallest", min(relative), ">= 1",
              min(relative) >= 1),
             ("viscous: that, largest over smallest of all viscosities", spread, "<= 1.2", 0 < spread <= 1.2)]
    return rows


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["PLATE"] < 4 or settings["N"] < 60 or min(settings[k] for k in ("STRESS", "RATE")) <= 0:
        raise scene.BadSetting("PLATE must be at least 4, N 60; STRESS and RATE above 0")
    if not all(0.02 <= settings[k] <= 2 for k in ("STRAIN", "VISCOUS")):
        raise scene.BadSetting("STRAIN and VISCOUS must be between 0.02 and 2")
    scene.numbers(settings, "VISCOSITIES")
    found = {kind: tests_of(settings, kind) for kind in FRICTION}
    print()
    for kind, one in found.items():
        m, p = one["measures"], one["runs"]["undrained"]["rows"]["p"] / 1e3
        print(f"{kind}: drained, shear over normal stress {m['peak']:.3f} at its peak, {m['end']:.3f} at the end; "
              f"height {100 * m['dilation']:+.2f} %\n  undrained: pore pressure between {p.min():.1f} and "
              f"{p.max():.1f} kPa; CPU {one['cpu']:.0f} s")
        say_apart("a dry run", one["scatter"])
        say_apart("undrained", one["undrained"])
        for viscosity, v in one["viscous"].items():
            print(f"  {viscosity:g} Pa s (viscous number {v['number']:.1e}): shear stress of the fluid "
                  f"{v['fluid']:.0f} Pa, {v['relative']:.2f} times mu times the rate; of the grains {v['grains']:.0f} "
                  f"Pa, {v['friction']:.3f} times the normal stress; CPU {v['cpu']:.0f} s")
    draw(settings, found, SCENE / settings["OUT"])
    measures = {kind: {key: value for key, value in one.items() if key != "runs"} for kind, one in found.items()}
    return scene.summary(SCENE, settings["OUT"], {**settings, **measures}, checks(settings, found))


if __name__ == "__main__":
    scene.main("simple_shear", work)

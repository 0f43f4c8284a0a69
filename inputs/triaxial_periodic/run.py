#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triaxial tests of a dense and a loose periodic cell: drained, undrained, dry and saturated at constant volume.

    run.py [KEY=VALUE...]      called by ./run.sh triaxial_periodic [KEY=VALUE...]
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import bed
import scene
from element_tests import BULK_MODULUS, FRICTION, RAMP, ROWS, apart, draw_drained, draw_undrained
from element_tests import drained_measures, record, say_apart, scatter, time_step, within

KEYS = {
    "N": (int, 400, "grains"),
    "SEED": scene.SEED,
    "STRESS": (float, 50e3, "isotropic stress before the test and total stress of the sides in it, Pa"),
    "RATE": (float, 0.1, "axial strain rate, 1/s"),
    "STRAIN": (float, 0.12, "axial strain of the undrained tests"),
    "DRAINED": (float, 0.2, "axial strain of the drained tests"),
    "VISCOSITY": (float, 0.02, "of the undrained tests, Pa s"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
RADIUS = 0.03  # m
STEP = time_step(RADIUS)  # s
SHRINKING = 0.5  # 1/s, of the lengths while the sample is made
SKELETON = 12e6  # Pa, what a unit of volumetric strain adds to the stress of the stiffest sample, about
PART = 0.1  # of the gain at which the sides would swing
# what drains through one pore has to be thin: the pressure there and on the other side of the cell are those of a well
DRAINED_VISCOSITY = 1e-3  # Pa s
DILATES = 0.06  # axial strain by which a dense sample has more volume, or less pore pressure, than at the beginning
# m/s, at the upper end, of dry runs that are scattered: as those of renumbered grains are, up to a fortieth of the
# speed of the test. A loose sample collapses in steps, otherwise in each of them
NUDGES = [1e-12, 1e-9, 1e-6, 1e-4, 1e-3]
GRAIN = 4 / 3 * math.pi * RADIUS**3 * bed.MEAN_CUBE  # m3, the mean
SCRIPTS = {"drained": "drained", "undrained": "undrained", "saturated": "undrained", "dry": "dry"}


def prepare(settings, kind):
    """The sample under the isotropic stress: its file, last step, lengths and porosity."""
    out = f"{settings['OUT']}_{kind}"
    press, rest = round(0.55 / SHRINKING / STEP), 4000
    said, cpu = scene.liggghts(
        SCENE, "in.prepare",
        {"N": settings["N"], "r2": RADIUS, "mu": FRICTION[kind], "edge": (settings["N"] * GRAIN / 0.3)**(1 / 3),
         "S": settings["STRESS"], "speed": SHRINKING, "press": press, "rest": rest, "every": 500, "out": out,
         **{f"s{k + 1}": prime for k, prime in enumerate(scene.primes(settings["SEED"]))}},
        f"{out}_prepare", scene.Progress(f"{kind} sample", 0, press + rest, STEP))
    lengths, stresses = ([float(word) for word in said[name]] for name in ("lengths", "stresses"))
    volume = math.prod(lengths)
    porosity = 1 - 4 / 3 * math.pi * float((bed.read_dump(SCENE / f"{out}.dump")[:, 5]**3).sum()) / volume
    print(f"{kind} sample of {settings['N']} grains: porosity {porosity:.3f}; CPU {cpu:.0f} s", flush=True)
    return {"name": out, "last": int(said["sample"][0]), "lengths": lengths, "volume": volume, "porosity": porosity,
            "off": max(abs(s / settings["STRESS"] - 1) for s in stresses), "cpu": cpu}


def gain(settings, sample, fluid):
    """Strain rate of the sides, 1/s, where the stress along them is twice what it should be; 0: constant volume."""
    if fluid in ("dry", "saturated"):
        return 0.0
    stiffness = SKELETON if fluid == "drained" else BULK_MODULUS / sample["porosity"]
    return PART * settings["STRESS"] / (2 * stiffness * STEP)


def test(settings, sample, fluid, nudge=0.0):
    """One test; its record with mean stress, deviator and volumetric strain."""
    out, rate = f"{sample['name']}_{fluid}{f'_nudge_{nudge:g}' if nudge else ''}", settings["RATE"]
    ramp = RAMP / rate
    strain = settings["DRAINED" if fluid == "drained" else "STRAIN"]
    every = max(1, round((strain / rate + ramp / 2) / STEP / ROWS))
    _, cpu = scene.liggghts(
        SCENE, "in.triaxial_periodic",
        {"fluid": SCRIPTS[fluid], "words": scene.fix_words("couple_every 1", settings["FIX"]), "gain": gain(settings, sample, fluid),
         "sample": sample["name"], "out": out, "r2": RADIUS, "S": settings["STRESS"],
         **dict(zip(("X0", "Y0", "Z0"), sample["lengths"])), "last": sample["last"], "rate": rate, "ramp": ramp,
         "steps": every * ROWS, "every": every, "bulk_modulus": BULK_MODULUS, "nudge": nudge,
         "viscosity": DRAINED_VISCOSITY if fluid == "drained" else settings["VISCOSITY"]},
        out, scene.Progress(fluid, sample["last"], sample["last"] + every * ROWS, STEP))
    print(f"  {fluid}: {every * ROWS} steps, CPU {cpu:.0f} s", flush=True)
    return {**record(SCENE / f"{out}.csv", sample["volume"]), "cpu": cpu}


def tests_of(settings, kind):
    sample, stress = prepare(settings, kind), settings["STRESS"]
    runs = {(fluid, settings["RATE"]): test(settings, sample, fluid) for fluid in SCRIPTS}
    drained, undrained, saturated, dry = runs.values()
    alike = [dry] + [test(settings, sample, "dry", nudge) for nudge in NUDGES]
    return {"sample": sample, "runs": runs, "drained": drained_measures(drained, sample["volume"]),
            "scatter": scatter(alike, stress), "saturated": apart(saturated, alike, stress),
            "undrained": apart(undrained, alike, stress, undrained["rows"]["p"]),
            "cpu": sample["cpu"] + sum(run["cpu"] for run in [*runs.values(), *alike[1:]])}


def checks_of(settings, kind, one):
    stress, rate, drained = settings["STRESS"], settings["RATE"], one["drained"]
    wet, saturated = (one["runs"][fluid, rate]["rows"] for fluid in ("undrained", "saturated"))
    rows = [within(f"{kind}: stress along each axis / given - 1, largest", one["sample"]["off"], 1e-4),
            within(f"{kind}, undrained: total stress of the sides / given - 1",
                   float(abs(wet["side"] / stress - 1).max()), 0.02),
            within(f"{kind}, undrained: p - what dry tests leave, rms / stress", one["undrained"]["pressure"], 0.01,
                   one["scatter"]["pressure"])]
    rows += [within(f"{kind}, {name}: from dry paths, rms / stress", one[name]["path"], 0.01, one["scatter"]["path"])
             for name in ("undrained", "saturated")]
    rows += [within(f"{kind}, saturated at constant volume: |p| / K_f", float(abs(saturated["p"]).max()) / BULK_MODULUS,
                    1e-10),
             within(f"{kind}, drained: what has left - what the cell lost, / volume", drained["left"], 1e-6),
             within(f"{kind}, drained: largest mean excess pressure / stress", drained["excess"] / stress, 0.01)]
    # (the mass error is a part of what moves: nothing does at constant volume)
    runs = [one["runs"][fluid, rate]["rows"] for fluid in ("drained", "undrained")]
    return rows + [within(f"{kind}: {name.replace('_', ' ')}, largest",
                          max(float(abs(run[name]).max()) for run in runs), 1e-9)
                   for name in ("mass_error", "force_error")]


def checks(settings, found):
    dense, loose = (found[kind] for kind in ("dense", "loose"))
    falls, rises = (one["runs"]["undrained", settings["RATE"]]["rows"]["p"][-10:].mean() / settings["STRESS"]
                    for one in (dense, loose))
    peak = dense["drained"]["peak"] / loose["drained"]["peak"]
    swells, shrinks = dense["drained"]["volume_at_end"], loose["drained"]["volume_at_end"]
    rows = [row for kind, one in found.items() for row in checks_of(settings, kind, one)] + [
        ("undrained: pore pressure at the end / stress, loose", rises, ">= 0.2", rises >= 0.2),
        ("drained: peak of the dense over that of the loose sample", peak, ">= 1.2", peak >= 1.2),
        ("drained: volumetric strain at the end, loose (contracts)", shrinks, "> 0", shrinks > 0)]
    if settings["STRAIN"] >= DILATES:
        rows.append(("undrained: pore pressure at the end / stress, dense", falls, "<= -0.2", falls <= -0.2))
    if settings["DRAINED"] >= DILATES:
        rows.append(("drained: volumetric strain at the end, dense (dilates)", swells, "< 0", swells < 0))
    return rows


def say(kind, one, rate):
    m, p = one["drained"], one["runs"]["undrained", rate]["rows"]["p"] / 1e3
    print(f"{kind}: drained, deviator {m['peak'] / 1e3:.1f} kPa at its peak ({m['peak_angle']:.1f} degrees), "
          f"{m['end'] / 1e3:.1f} at the end ({m['end_angle']:.1f}); volumetric strain "
          f"{100 * m['contraction']:.2f} % at most, {100 * m['volume_at_end']:.2f} % at the end\n  undrained: "
          f"pore pressure between {p.min():.1f} and {p.max():.1f} kPa, {p[-10:].mean():.1f} at the end; "
          f"CPU {one['cpu']:.0f} s")
    say_apart("a dry run", one["scatter"])
    say_apart("undrained", one["undrained"])
    say_apart("saturated at constant volume", one["saturated"])


def work(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 100 or min(settings[k] for k in ("STRESS", "VISCOSITY", "RATE")) <= 0:
        raise scene.BadSetting("N must be at least 100; STRESS, VISCOSITY and RATE above 0")
    if not all(0.02 <= settings[k] <= 0.4 for k in ("STRAIN", "DRAINED")):
        raise scene.BadSetting("STRAIN and DRAINED must be between 0.02 and 0.4")
    found = {kind: tests_of(settings, kind) for kind in FRICTION}
    print()
    for kind, one in found.items():
        say(kind, one, settings["RATE"])
    draw_drained(found, settings["RATE"], SCENE / settings["OUT"])
    draw_undrained(found, [settings["RATE"]], SCENE / settings["OUT"])
    measures = {kind: {key: value for key, value in one.items() if key != "runs"} for kind, one in found.items()}
    return scene.summary(SCENE, settings["OUT"], {**settings, **measures}, checks(settings, found))


if __name__ == "__main__":
    scene.main("triaxial_periodic", work)

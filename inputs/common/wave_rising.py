# SPDX-License-Identifier: GPL-3.0-or-later
"""A wave whose amplitude grows in time on a dense or a loose bed (thesis sections 6.3.2, 6.3.3)."""
import math

import bed
import scene
import wave
import wave_report

KEYS = {
    "N": (int, 1000, "grains"),
    "SEED": scene.SEED,
    "RATE": (float, 200.0, "growth of the amplitude, Pa/s"),
    "AMPLITUDE": (float, 0.0, "amplitude at the end, Pa; 0: 2000 if dense, 1000 if loose"),
    "SHAKE": scene.SHAKE,
    "MADE": (float, 0.0, "friction with which the bed is made and comes to rest, degrees; it has 30 in the wave. 0: as "
             "its kind"),
    "STEP": (float, 1.0, "time step over its default"),
    "TOP": scene.TOP,
    "LAW": scene.LAW,
    "VISCOSITY": bed.VISCOSITY_KEY,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
THESIS = {"dense": {"porosity": 0.368, "amplitude": 1500.0},
          "loose": {"porosity": 0.436, "amplitude": 375.0}}
LAST = {"dense": 2000.0, "loose": 1000.0}  # Pa


def number(value):
    return f"{value:.0f} Pa" if math.isfinite(value) else "not reached"


def describe(run, kind, settings):
    thesis, figures = THESIS[kind], run.figures
    return {"core_porosity": run.measures["core_porosity"],
            "still_until": wave_report.still_until(run, 0.2),
            "unstable_at": wave_report.unstable_at(run),
            "liquefied_most": float(run.liquefied().max()),
            "liquefied_end": float(run.liquefied()[-20:].mean()),
            "excess_end": float(run.excess()[-20:].mean()),
            "amplitude_end": float(run.state["amplitude"][-1]),
            "thesis": thesis, "networks": int(run.state["retriangulations"][-1]),
            "mass": float(abs(run.state["mass"]).max()),
            "balance": float(abs(run.state["balance"]).max()), **figures}


def print_table(d, kind, settings):
    print(f"\nGrowing wave on a {kind} bed, {settings['N']} grains, flow box up to "
          f"{'a plane' if settings['TOP'] == 'plane' else 'the highest grain'}")
    print(f"  porosity away from walls    {d['core_porosity']:.3f}   thesis "
          f"{d['thesis']['porosity']:.3f}")
    print(f"  pressures harmonic up to    {number(d['still_until'])}   (sensors within 20 % of A, "
          "rms)")
    print(f"  grains run away at          {number(d['unstable_at'])}   thesis about "
          f"{d['thesis']['amplitude']:.0f} Pa")
    print(f"  largest ∇H/i_c, v3          {d['liquefied_most']:.2f}   (1: liquefied), at the end "
          f"{d['liquefied_end']:.2f}")
    print(f"  networks {d['networks']}, viscosity {d['viscosity']:.4g} Pa s, time step "
          f"{d['time_step']:.3g} s (explicit limit {d['time_step_limit']:.3g} s)")
    print(f"  excess pressure at the end  {d['excess_end']:.0f} Pa, mean of the sensors; CPU "
          f"{d['cpu']:.0f} s")


def promises(run, kind, settings, d):
    checks = [("the fluid's own force balance, largest", d["balance"], "<= 1e-10",
               d["balance"] <= 1e-10),
              ("the fluid's mass balance, largest", d["mass"], "<= 1e-9", d["mass"] <= 1e-9)]
    shaken = settings["SHAKE"] > 0
    # The first hundred pascals move no grain: the bed is one at rest, and the harmonic solution
    # holds, as far as a bed of a few grains of depth can follow it.
    if settings["N"] >= 300 and not shaken:
        wanted = min(150.0, 0.99 * d["amplitude_end"])
        checks.append(("pressures harmonic (within 20 % of A, rms) up to, Pa", d["still_until"],
                       f">= {wanted:.0f}", d["still_until"] >= wanted))
    if kind == "dense" and d["amplitude_end"] >= 1000 and not shaken:
        early = float(run.liquefied()[run.time < 1000 / settings["RATE"]].max())
        checks.append(("dense: largest ∇H/i_c below 1000 Pa", early, "< 0.2", early < 0.2))
    # half a weight at 10 Hz moves the grains by some 1 cm/s, which a loose bed does not bear
    if settings["N"] >= 1000 and settings["SHAKE"] >= 0.5 and run.figures["duration"] >= 4.0:
        end = d["liquefied_end"]
        held, wanted = (abs(end) < 0.1, "< 0.1") if kind == "dense" else (end > 0.5, "> 0.5")
        checks.append((f"{kind}, shaken: ∇H/i_c along v3 at the end", end, wanted, held))
    return checks


def work(folder, kind, words):
    settings = scene.parse(words, KEYS)
    if (settings["N"] < 100 or min(settings["RATE"], settings["STEP"]) <= 0
            or min(settings["AMPLITUDE"], settings["SHAKE"]) < 0):
        raise scene.BadSetting("N must be at least 100, RATE and STEP above 0, AMPLITUDE and "
                               "SHAKE at least 0")
    settings["AMPLITUDE"] = settings["AMPLITUDE"] or LAST[kind]
    measures = bed.prepare(folder, kind, settings["N"], settings["SEED"], settings["OUT"],
                           settings["MADE"])
    duration = settings["AMPLITUDE"] / settings["RATE"]
    run = wave.run(folder, settings, measures, settings["OUT"], f"{settings['RATE']:g}*v_t",
                   duration, top=settings["TOP"], words="retriangulate mean 0.001", shake=settings["SHAKE"],
                   step_factor=settings["STEP"])
    d = describe(run, kind, settings)
    print_table(d, kind, settings)
    times = [part * duration for part in (0.1, 0.4, 0.7, 1.0)]
    wave_report.draw_state(run)
    wave_report.draw_sensors(run)
    wave_report.draw_stress(run, times)
    wave_report.draw_strain(run, times[1::2])
    wave_report.draw_motion(run, times[1:])
    return scene.summary(folder, settings["OUT"], {**settings, **d},
                         promises(run, kind, settings, d))

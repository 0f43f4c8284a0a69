#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves on loose beds that were made with more friction than their grains have in the wave, each with and without it.

    run.py [write] [KEY=VALUE...]   called by ./run.sh wave_unstable; write puts the table into README.md as well
"""
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import bed
import scene
import wave
from page_table import Table, put_into

KEYS = {
    "N": (int, 300, "grains"),
    "MADE": (str, "35,40,60", "frictions with which beds are made and come to rest, degrees; they have 30 in the wave"),
    "SEEDS": (str, "1,2", "samples of each"),
    "LOCAL": (str, "0,0.2", "local dampings of the grains while a bed is made, as YADE has them"),
    "RATE": (float, 200.0, "growth of the amplitude, Pa/s"),
    "AMPLITUDE": (float, 200.0, "amplitude at the end, Pa"),
    "YADE": (str, "no", "yes: in YADE as well, where it is installed, and its beds here"),
    "TOP": scene.TOP,
    "LAW": scene.LAW,
    "VISCOSITY": bed.VISCOSITY_KEY,
    "FIX": scene.FIX,
    "OUT": scene.OUT,
}
AVERAGED = 0.05  # s, before and after the instant of a row
PARTS = (0.25, 0.5, 0.75, 1.0)  # of the run, where a row stands


def means_at(run, instant):
    """Mean excess pressure of the sensors (Pa), gradient along the middle vertical and from the second to the fifth
    sensor of all verticals (over the critical one), and settlement of the mean grain (mm), about an instant."""
    near = abs(run.time - instant) <= AVERAGED
    recorded = abs(run.state["time"] - instant) <= AVERAGED
    return {"excess": float(run.excess()[near].mean()), "along": float(run.liquefied()[near].mean()),
            "in_depth": float(run.gradient()[near][:, :, 1:4].mean()),
            "settled": 1e3 * float(run.state["mean_z"][0] - run.state["mean_z"][recorded].mean())}


def wave_on(settings, measures, rate, out):
    duration = settings["AMPLITUDE"] / settings["RATE"]
    return wave.run(SCENE, settings, measures, out, f"{rate:g}*v_t", duration, top=settings["TOP"],
                    words="retriangulate mean 0.002")


def described(settings, made, seed, local, program, measures, runs):
    end = settings["AMPLITUDE"] / settings["RATE"] - AVERAGED
    found = {name: [means_at(run, part * end) for part in PARTS] for name, run in runs.items()}
    return {"made": made, "seed": seed, "local": local, "program": program, "porosity": measures["core_porosity"],
            "mean_porosity": measures["porosity"], **found}


def bed_made_at(settings, made, seed, local, given=""):
    """One bed: with the wave and without, at four instants. `given`: the dump of one made elsewhere."""
    settings = {**settings, "OUT": f"{settings['OUT']}_{'of_yade_' * bool(given)}{made:g}_{local:g}_{seed}"}
    measures = bed.prepare(SCENE, "loose", settings["N"], seed, settings["OUT"], made, local, given)
    runs = {"wave": wave_on(settings, measures, settings["RATE"], settings["OUT"] + "_wave"),
            "still": wave_on(settings, measures, 0.0, settings["OUT"] + "_still")}
    balances = {word: max(float(abs(run.state[word]).max()) for run in runs.values()) for word in ("mass", "balance")}
    return {**described(settings, made, seed, local, "pfv, YADE's bed" if given else "pfv", measures, runs), **balances,
            "cpu": measures["cpu"] + sum(run.figures["cpu"] for run in runs.values())}


def name_in_yade(settings, made, seed, local):
    return f"{settings['OUT']}_yade_{made:g}_{local:g}_{seed}"


def bed_in_yade(settings, made, seed, local):
    """The same by YADE alone: its grains, contacts and FlowEngine (inputs/hosts/yade_wave.py)."""
    out = name_in_yade(settings, made, seed, local)
    words = {"N": settings["N"], "MADE": made, "DAMPING": local, "SEED": seed, "RATE": settings["RATE"],
             "AMPLITUDE": settings["AMPLITUDE"], "OUT": SCENE / out}
    begin = time.time()
    ran = subprocess.run(["yade", "-n", "-x", "-j1", str(SCENE.parent / "hosts" / "yade_wave.py"),
                          *(f"{key}={value}" for key, value in words.items())], capture_output=True, text=True)
    if ran.returncode != 0:
        raise scene.Failure(f"YADE failed on the bed made at {made:g} degrees: {ran.stderr.strip()[-300:]}")
    print(f"YADE, made at {made:g} degrees with a local damping of {local:g}: {time.time() - begin:.0f} s", flush=True)
    measures = json.loads((SCENE / f"{out}_bed.json").read_text())
    runs = {name: wave.Run(SCENE, f"{out}_{name}", measures, {}) for name in ("wave", "still")}
    return described(settings, made, seed, local, "YADE", measures, runs)


def bed_of_yade(settings, made, seed, local):
    """The bed that YADE has made and run, here: only the fluid and the dashpots of contacts are others."""
    return bed_made_at(settings, made, seed, local, str(SCENE / f"{name_in_yade(settings, made, seed, local)}.dump"))


def makers(settings):
    """Who runs the beds; not YADE where it is not installed, which is said."""
    if settings["YADE"] not in ("yes", "no"):
        raise scene.BadSetting("YADE must be yes or no")
    if settings["YADE"] == "yes" and not shutil.which("yade"):
        print("YADE is not installed (Debian's package yade): its rows are left out")
    elif settings["YADE"] == "yes":
        return [bed_made_at, bed_in_yade, bed_of_yade]
    return [bed_made_at]


def spread(values, form="{:.0f}"):
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def tabulate(settings, found):
    times = [settings["AMPLITUDE"] / settings["RATE"] * part for part in PARTS]
    table = Table("made at", "local damping", "by", "porosity: away from walls; mean",
                  f"mean excess after {', '.join(f'{t:g}' for t in times)} s with the wave, Pa", "without it, Pa",
                  "∇H/i_c in depth at the end, with; without", "settled, with; without, mm")
    for kind in dict.fromkeys((one["made"], one["local"], one["program"]) for one in found):
        beds = [one for one in found if (one["made"], one["local"], one["program"]) == kind]

        def over(run, name, k, form="{:.0f}"):
            return spread([one[run][k][name] for one in beds], form)

        table.row(f"{kind[0]:g}°", f"{kind[1]:g}", kind[2],
                  "; ".join(spread([one[name] for one in beds], "{:.3f}") for name in ("porosity", "mean_porosity")),
                  *("; ".join(over(run, "excess", k) for k in range(len(PARTS))) for run in ("wave", "still")),
                  *("; ".join(over(run, name, -1, "{:.2f}") for run in ("wave", "still")) for name in ("in_depth", "settled")))
    return table.lines


def checks(found):
    coupled = [one for one in found if one["program"] != "YADE"]
    own = [one for one in coupled if one["program"] == "pfv"]
    rows = [("the fluid's own force balance, largest", max(one["balance"] for one in coupled), 1e-10),
            ("the fluid's mass balance, largest", max(one["mass"] for one in coupled), 1e-9)]
    rows = [(name, value, f"<= {most:g}", value <= most) for name, value, most in rows]
    for seed, local in sorted({(one["seed"], one["local"]) for one in own}):
        # a bed gives its weight to the fluid the more the less its friction holds it, wave or none
        beds = sorted((one for one in own if (one["seed"], one["local"]) == (seed, local)), key=lambda one: one["made"])
        for low, high in zip(beds, beds[1:]):
            if high["made"] >= 1.4 * low["made"]:
                more = high["still"][-1]["excess"] - low["still"][-1]["excess"]
                rows.append((f"sample {seed}, local damping {local:g}: excess without wave, made at {high['made']:g}° less {low['made']:g}°, Pa",
                             more, "> 0", more > 0))
    return rows


def work(words):
    write = "write" in words
    settings = scene.parse([word for word in words if word != "write"], KEYS)
    made, seeds = scene.numbers(settings, "MADE"), scene.numbers(settings, "SEEDS", int)
    dampings = scene.numbers(settings, "LOCAL", zero=True)
    if settings["N"] < 100 or min(settings["RATE"], settings["AMPLITUDE"], *seeds) <= 0 or not 0 < min(made) <= max(made) < 85:
        raise scene.BadSetting("N must be at least 100, RATE, AMPLITUDE and SEEDS above 0, MADE between 0 and 85")
    if max(dampings) >= 1:
        raise scene.BadSetting("LOCAL must be below 1")
    if settings["AMPLITUDE"] / settings["RATE"] < 8 * AVERAGED:
        raise scene.BadSetting(f"AMPLITUDE / RATE must be at least {8 * AVERAGED:g} s")
    found = [maker(settings, friction, seed, local) for friction in made for local in dampings for maker in makers(settings)
             for seed in seeds]
    lines = tabulate(settings, found)
    print(f"CPU of the runs with pfv: {sum(one.get('cpu', 0.0) for one in found):.0f} s")
    if write:
        put_into(SCENE / "README.md", "beds", lines)
    return scene.summary(SCENE, settings["OUT"], {**settings, "beds": found}, checks(found))


if __name__ == "__main__":
    scene.main("wave_unstable", work)

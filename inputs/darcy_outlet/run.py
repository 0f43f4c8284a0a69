#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Grains washed out through a hole, with either model of the fluid, and both beside each other.

    run.py [KEY=VALUE...]      called by ./run.sh darcy_outlet [KEY=VALUE...]
    run.py column [N=..]       the oedometer's sample with either model: column.py
"""
import math
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import outlet  # noqa: E402
import scene  # noqa: E402

KEYS = {
    "MODEL": (str, "both", "pfv, darcy_grid or both"),
    "ACROSS": (int, 10, "grains across the box; 20 as in the example"),
    "TIME": (float, 1.0, "simulated time, s"),
    "EVERY": (int, 100, "steps between two renewals of the porosity, darcy_grid"),
    "FIX": (str, "", "settings of fix pfv for the pores, as 'couple_every 10 retriangulate 0.05'"),
    "COUPLE": (int, 10, "time steps between two flow steps, darcy_grid"),
    "DRAG": (str, "di_felice", "di_felice or kozeny_carman, darcy_grid"),
    "FLUX": (float, 1e-5, "inflow, m3/s"),
    "VISCOSITY": (float, 1e-3, "Pa s"),
    "OUT": (str, "post/run", "where results go, without ending"),
}
CELLS = (10, 20, 10)


def settings_of(words):
    settings = scene.parse(words, KEYS)
    if settings["MODEL"] not in ("pfv", "darcy_grid", "both"):
        raise scene.BadSetting("MODEL must be pfv, darcy_grid or both")
    if settings["ACROSS"] < 4 or settings["TIME"] <= 0 or min(settings["EVERY"],
                                                                  settings["COUPLE"]) < 1:
        raise scene.BadSetting("ACROSS must be at least 4, TIME above 0, EVERY and COUPLE at "
                               "least 1")
    return settings


def time_step(across):
    """A tenth of sqrt(m/kn), as in the script."""
    radius = 0.05 / across
    return 0.1 * math.sqrt(2600.0 * 4.0 / 3.0 * math.pi * radius**3 / 1e4)


def run_model(model, settings):
    """One run; returns what it says of itself."""
    words = scene.fix_words("model pfv", settings["FIX"])
    if model == "darcy_grid":
        cells = " ".join(map(str, CELLS))
        every = max(1, settings["EVERY"] // settings["COUPLE"])  # of fix pfv: in flow steps
        words = f"model darcy_grid {cells} every {every} drag {settings['DRAG']} couple_every {settings['COUPLE']}"
    step = time_step(settings["ACROSS"])
    steps = 100 * max(1, round(settings["TIME"] / step / 100))
    out = f"{settings['OUT']}_{model}"
    for old in (SCENE / out).parent.glob(Path(out).name + "_*.[tv][xt][tu]"):
        old.unlink()  # pictures and dumps of an earlier run
    print(f"{model}: {steps} steps of {step:.3g} s", flush=True)
    said, cpu = scene.liggghts(
        SCENE, "in.darcy_outlet",
        {"across": settings["ACROSS"], "words": words, "Q": settings["FLUX"],
         "viscosity": settings["VISCOSITY"], "steps": steps, "record": max(1, steps // 200),
         "fields": max(1, steps // 10), "out": out},
        out, scene.Progress(model, 0, steps, step))
    return {"model": model, "radius": 0.05 / settings["ACROSS"], "steps": steps,
            "time_step": step, "cpu": cpu, "out": out, "grains": int(float(said["grains"][0])),
            "left": int(float(said["left"][0])), "time_step_limit": float(said["left"][1])}


def work(words):
    if words[:1] == ["column"]:
        import column
        return column.work(words[1:])
    settings = settings_of(words)
    models = ("pfv", "darcy_grid") if settings["MODEL"] == "both" else (settings["MODEL"],)
    runs = [run_model(model, settings) for model in models]
    return outlet.analyse(SCENE, settings, runs)


if __name__ == "__main__":
    scene.main("darcy_outlet", work)

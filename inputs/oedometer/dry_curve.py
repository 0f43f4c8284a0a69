# SPDX-License-Identifier: GPL-3.0-or-later
"""Stress over strain of the dry sample, loaded and unloaded in steps (thesis fig. 4.14):

    run.py dry [KEY=VALUE...]      called by ./run.sh oedometer dry [KEY=VALUE...]

takes the keys of an oedometer test, of which it uses N, SEED, BASE, OUT and KEEP; 5 and 200 kPa, as in the thesis.
"""
import numpy as np

import oedometer
import scene
from plotting import plt, save_figure

LOADS = (5.0e3, 200.0e3)  # Pa
THESIS = {5.0e3: (0.0008, "recovered"), 200.0e3: (0.0394, "not recovered")}


def curve(settings, load):
    """Strain and stress (Pa) above the confinement, at the end of each stage."""
    variables = {key: value for key, value in oedometer.common_variables(settings).items() if key != "law"}
    out = f"{settings['OUT']}_dry_{load / 1e3:g}kPa"
    said, cpu = scene.liggghts(oedometer.SCENE, "in.dry_curve", {**variables, "dF": load * oedometer.SIDE**2}, out)
    rows = np.array([[float(word) for word in said[f"stage{k}"]] for k in range(len(said))])
    return 1.0 - rows[:, 1] / rows[0, 1], rows[:, 0] / oedometer.SIDE**2 - oedometer.CONFINEMENT, cpu


def figures_of(strain, stress):
    """Of a curve up to its middle and back: secant moduli, what is left of the strain, what of the work."""
    top = len(strain) // 2
    steps = np.diff(strain) * (stress[1:] + stress[:-1]) / 2
    return {"strain": float(strain[top]), "left": float(strain[-1]),
            "modulus_loading": float((stress[top] - stress[0]) / strain[top]),
            "modulus_unloading": float((stress[top] - stress[-1]) / (strain[top] - strain[-1])),
            "initial_modulus": float((stress[1] - stress[0]) / strain[1]),
            "work_lost": float(steps.sum() / steps[:top].sum())}


def draw(curves, path):
    figure, axes = plt.subplots(1, len(curves), figsize=(10, 4))
    for place, (load, (strain, stress, _)) in zip(axes, curves.items()):
        top = len(strain) // 2
        place.plot(100 * strain[:top + 1], stress[:top + 1] / 1e3, "o-", ms=3, label="loading")
        place.plot(100 * strain[top:], stress[top:] / 1e3, "s-", ms=3, label="unloading")
        place.set(xlabel="strain, %", ylabel="stress above the confinement, kPa", title=f"{load / 1e3:g} kPa")
        place.legend(fontsize=8)
    save_figure(figure, path)


def run(words):
    settings = oedometer.parse(words)
    if not (settings["KEEP"] and (oedometer.SCENE / (settings["OUT"] + ".restart")).exists()):
        oedometer.make_sample(settings)
    curves = {}
    for load in LOADS:
        print(f"dry sample: {load / 1e3:g} kPa in steps, up and down", flush=True)
        curves[load] = curve(settings, load)
    found = {load: figures_of(strain, stress) for load, (strain, stress, _) in curves.items()}
    picture = oedometer.SCENE / (settings["OUT"] + "_dry_curves.png")
    draw(curves, picture)
    print(f"\nDry loading and unloading of {settings['N']} grains on {oedometer.CONFINEMENT / 1e3:g} kPa")
    print("  load        strain   thesis   left after unloading   of the strain   modulus, loading   unloading")
    for load, f in found.items():
        strain, left = 100 * f["strain"], 100 * f["left"]
        print(f"  {load / 1e3:3g} kPa {strain:9.4f} % {100 * THESIS[load][0]:6.2f} % {left:18.4f} % "
              f"{100 * left / strain:14.1f} % {f['modulus_loading'] / 1e6:14.3f} MPa "
              f"{f['modulus_unloading'] / 1e6:7.3f} MPa   (thesis: {THESIS[load][1]})")
    small, large = (found[load]["left"] / found[load]["strain"] for load in LOADS)
    cpu = sum(one[2] for one in curves.values())
    rows = [("5 kPa: strain left after unloading / strain", small, "<= 0.03", abs(small) <= 0.03),
            ("200 kPa: strain left after unloading / strain", large, ">= 0.05", large >= 0.05)]
    return scene.summary(oedometer.SCENE, settings["OUT"] + "_dry",
                         {**settings, "curves": {f"{load:g}": f for load, f in found.items()}, "cpu": cpu}, rows)

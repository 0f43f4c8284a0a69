#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Consolidation under 200 kPa (thesis section 4.4.2): permeability and modulus change on the way.

    run.py [KEY=VALUE...]      called by ./run.sh oedometer_large [KEY=VALUE...]
"""
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "oedometer"), str(HERE.parent / "common")]
import numpy as np

import analyse
import oedometer
import scene
import terzaghi
from plotting import plt, save_figure

KEYS = {key: oedometer.KEYS[key] for key in ("N", "SEED", "RETRIANGULATE", "LAW", "FIX")}
KEYS.update(LOAD=(float, 200.0e3, "step load, Pa"),
            FIELDS=(int, 10, "instants written for ParaView"),
            OUT=scene.OUT)
SMALL = 5000.0  # Pa: the load of the scene oedometer, at which the initial modulus is measured
THESIS = {"strain": 0.0394, "K": -0.094, "E": 5620.0 / 5895.0 - 1}


def measure(settings):
    """Sample, permeability and modulus before the load, then the dry test with the load."""
    small = {**settings, "LOAD": SMALL}
    sample = oedometer.make_sample(small)
    initial = oedometer.dry_test(small)
    sample.update(oedometer.dry_test(settings))
    oedometer.measure_permeability(settings, sample, 1.0)
    sample["E_initial"] = initial["E_oed"]
    return sample


def compare(records, C_v, height):
    """Differences of p(H/2) and U from Terzaghi with one consolidation coefficient."""
    f = records.figures
    factor = C_v / f["C_v"] * (f["height"] / height) ** 2
    times = np.linspace(analyse.EARLY, analyse.LATE, 1000)
    middle = np.interp(times, factor * records.T, records.middle())
    settled = np.interp(times, factor * records.T_lid, records.strain / f["dry_strain"])
    exact_p, exact_U = terzaghi.pressure(0.5, times)[:, 0], terzaghi.settlement(times)
    # how far the run is behind: its mean pressure above the theory's
    return {"p_rms": analyse.rms(middle - exact_p), "U_rms": analyse.rms(settled - exact_U),
            "above": float((middle - exact_p).mean()), "factor": factor}


def draw(records, initial, final, base):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    T = np.logspace(-3, np.log10(3), 300)
    for place, theory in zip(axes, (terzaghi.pressure(0.5, T)[:, 0], terzaghi.settlement(T))):
        place.semilogx(T, theory, "k--", label="Terzaghi")
    for label, case in (("initial C_v", initial), ("final C_v", final)):
        axes[0].semilogx(case["factor"] * records.T[records.T > 0],
                         records.middle()[records.T > 0], label=f"coupled, {label}")
        axes[1].semilogx(case["factor"] * records.T_lid[1:],
                         records.strain[1:] / records.figures["dry_strain"],
                         label=f"coupled, {label}")
    axes[0].set(xlabel="T_v", ylabel="p(H/2) / load", xlim=(1e-3, 3))
    axes[1].set(xlabel="T_v", ylabel="strain / dry strain", xlim=(1e-3, 3))
    for place in axes:
        place.legend(fontsize=8)
        place.grid(alpha=0.3)
    save_figure(figure, f"{base}_large.png")


def work(words):
    given = scene.parse(words, KEYS)
    given["OUT"] = str(HERE / given["OUT"])
    settings = {key: default for key, (_, default, _) in oedometer.KEYS.items()} | given
    if settings["N"] < 100 or settings["SEED"] < 1 or settings["LOAD"] <= SMALL:
        raise scene.BadSetting(f"N must be at least 100, SEED at least 1, LOAD above {SMALL:g}")
    sample = measure(settings)
    planned = oedometer.plan(settings, sample)
    print(f"consolidation: {planned['steps']} steps of {planned['time_step']:.3g} s", flush=True)
    cost = oedometer.couple(settings, sample, planned)
    Path(settings["OUT"] + "_run.json").write_text(
        json.dumps({**settings, **sample, **planned, **cost}, indent=1) + "\n")
    records = analyse.Run(settings["OUT"])
    f = records.figures
    initial = compare(records, f["K"] * f["E_initial"] / f["viscosity"], f["height"])
    final = compare(records, f["K_loaded"] * f["E_oed"] / f["viscosity"],
                    f["dry_height"]["loaded"])
    strain = float(records.strain[records.T_lid > 0.98 * records.T_lid[-1]].mean())
    print(f"\nOedometer, {f['N']} grains, load {f['LOAD'] / 1e3:g} kPa on 76 kPa")
    print(f"  final strain      {100 * strain:.2f} %   dry {100 * f['dry_strain']:.2f} %   "
          f"thesis {100 * THESIS['strain']:.2f} %")
    print(f"  permeability      {f['K']:.3e} -> {f['K_loaded']:.3e} m2, "
          f"{100 * (f['K_loaded'] / f['K'] - 1):+.1f} %   thesis {100 * THESIS['K']:+.1f} %")
    print(f"  modulus           {f['E_initial'] / 1e6:.3f} MPa (at 5 kPa) -> "
          f"{f['E_oed'] / 1e6:.3f} MPa, {100 * (f['E_oed'] / f['E_initial'] - 1):+.1f} %   "
          f"thesis {100 * THESIS['E']:+.1f} %")
    print("                    p(H/2) rms   U rms   mean above Terzaghi")
    for name, case in (("initial C_v", initial), ("final C_v", final)):
        print(f"  {name:<16s} {100 * case['p_rms']:9.2f} % {100 * case['U_rms']:6.2f} % "
              f"{100 * case['above']:+10.2f} %")
    print(f"  retriangulations  {records.retriangulations}   CPU {f['cpu_coupled']:.0f} s")
    draw(records, initial, final, settings["OUT"])
    checks = [
        ("final strain / dry strain - 1", strain / f["dry_strain"] - 1, "within 0.02",
         abs(strain / f["dry_strain"] - 1) <= 0.02),
        ("p(H/2), rms: final C_v / initial C_v", final["p_rms"] / initial["p_rms"], "< 1",
         final["p_rms"] < initial["p_rms"]),
        ("p(H/2) above Terzaghi with the initial C_v", initial["above"], "> 0", initial["above"] > 0),
        ("retriangulations", records.retriangulations, ">= 1", records.retriangulations >= 1)]
    return scene.summary(HERE, settings["OUT"], {**f, "strain": strain, "initial": initial,
                                                "final": final}, checks)


if __name__ == "__main__":
    scene.main("oedometer_large", work)

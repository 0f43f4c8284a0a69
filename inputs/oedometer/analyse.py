#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds a finished oedometer run against Terzaghi: table, figures, summary.json.

    analyse.py [post/sample]
"""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))
import numpy as np

import layers
import micro
import stress
import terzaghi
from plotting import plt, save_figure

EARLY, LATE = 0.02, 1.5  # T_v between which the curves are compared

# Widest accepted differences; doc/oedometer.md has what was measured.
TALL = {"p_rms": 0.03, "U_rms": 0.03, "U_rms_uneven": 0.02, "p_early": (0.97, 1.03), "strain": 0.02}
# Below 5000 grains a sample is six to twelve grains high and its two drained layers hold a tenth of
# the settlement: U 0.027 to 0.036 in samples of 1000 grains.
LOW = {**TALL, "U_rms": 0.04}


def limits_for(grains):
    return TALL if grains >= 5000 else LOW


class Run:
    """The records of one run, in T_v and divided by the load."""

    def __init__(self, base):
        self.base = Path(base)
        self.figures = json.loads(self._path("_run.json").read_text())
        f = self.figures
        self.load = f["LOAD"]
        lid = np.genfromtxt(self._path("_lid.csv"), delimiter=",", names=True)
        with open(self._path("_profile.csv")) as file:
            self.heights = np.array([float(word) for word in file.readline().split(",")[1:]])
        profile = np.loadtxt(self._path("_profile.csv"), delimiter=",", skiprows=1)
        self.rest_height = lid["H"][lid["time"] <= 0][-1]
        loaded = lid["time"] >= 0
        self.T_lid = lid["time"][loaded] / f["unit"]
        self.strain = 1 - lid["H"][loaded] / self.rest_height
        self.retriangulations = int(lid["retriangulations"][-1])
        rest_time = profile[0, 0] - lid["time"][0]  # flow time at which the load comes
        self.T = (profile[:, 0] - rest_time) / f["unit"]
        self.p = profile[:, 1:] / self.load

    def _path(self, ending):
        return self.base.parent / (self.base.name + ending)

    def middle(self):
        return self.p[:, len(self.heights) // 2]

    def settlement(self):
        return self.strain / self.figures["dry_strain"]

    def late(self):
        """End of the comparison: of a run that was cut short its own."""
        return min(LATE, self.T[-1], self.T_lid[-1])

    def at(self, T_v):
        """Row of the profile nearest to T_v, and its own T_v."""
        row = int(np.argmin(abs(self.T - T_v)))
        return self.p[row], self.T[row]

    def thermo(self):
        """Rows step, F, H, mass error, force balance, retriangulations, time-step limit."""
        rows = []
        for line in self._path("_coupled.txt").read_text(errors="replace").splitlines():
            words = line.split()
            if len(words) == 7 and words[0].isdigit() and int(words[0]) > self.figures["rest_to"]:
                rows.append([float(word) for word in words])
        return np.array(rows)


def rms(difference):
    return float(np.sqrt(np.mean(difference**2)))


def compare(run):
    """The figures of the comparison, without judging them."""
    f = run.figures
    times = np.linspace(EARLY, run.late(), 1000)
    middle = np.interp(times, run.T, run.middle())
    settled = np.interp(times, run.T_lid, run.settlement())
    late = run.strain[run.T_lid >= min(2.5, 0.98 * run.T_lid[-1])].mean()
    thermo = run.thermo()
    slices, effective, total = stress.profile(run, 0.1)
    planes, uneven_times, uneven_p, uneven_U = layers.predict(run.base, f)
    uneven_middle = np.interp(times, uneven_times, uneven_p[:, len(planes) // 2])
    error = abs(f["E_oed_unloading"] / f["E_oed"] - 1) + abs(f["K_loaded"] / f["K"] - 1)
    return {
        "p_rms": rms(middle - terzaghi.pressure(0.5, times)[:, 0]),
        "U_rms": rms(settled - terzaghi.settlement(times)),
        "p_rms_uneven": rms(middle - uneven_middle),
        "U_rms_uneven": rms(settled - np.interp(times, uneven_times, uneven_U)),
        "p_early_max": float(run.middle()[(run.T > 0) & (run.T < EARLY)].max()),
        "T_v_of_p_early_max": float(run.T[(run.T > 0) & (run.T < EARLY)][
            run.middle()[(run.T > 0) & (run.T < EARLY)].argmax()]),
        "strain_final": float(late),
        "strain_error": float(late / f["dry_strain"] - 1),
        "p_rest": float(abs(run.p[run.T < 0][-1]).max()),
        "C_v_relative_error": error,
        "C_v_best": best_consolidation(run, times, middle),
        "effective_stress": {"height": slices.tolist(), "sigma_effective": effective.tolist(),
                             "sigma_total": total.tolist()},
        "total_stress_rms": rms(total - 1),
        "retriangulations": run.retriangulations,
        "mass_error_max": float(abs(thermo[:, 3]).max()),
        "force_balance_error_max": float(abs(thermo[:, 4]).max()),
        "time_step_limit": float(thermo[:, 6].min()),
    }


def best_consolidation(run, times, middle):
    """C_v that would fit p(H/2) best, divided by the measured one: says whether a difference is one
    of time scale or of shape."""
    factors = np.linspace(0.8, 1.25, 226)
    errors = [rms(middle - terzaghi.pressure(0.5, factor * times)[:, 0]) for factor in factors]
    return float(factors[int(np.argmin(errors))])


def judge(run, figures):
    """(what, measured, wanted, held) for each promise."""
    limits = limits_for(run.figures["N"])
    low, high = limits["p_early"]
    rows = [
        ("p(H/2): rms difference from Terzaghi / load", figures["p_rms"],
         f"<= {limits['p_rms']}", figures["p_rms"] <= limits["p_rms"]),
        ("U: rms difference from the uneven layer", figures["U_rms_uneven"],
         f"<= {limits['U_rms_uneven']}", figures["U_rms_uneven"] <= limits["U_rms_uneven"]),
        (f"largest p(H/2) / load before T_v = {EARLY}", figures["p_early_max"],
         f"{low} .. {high}", low <= figures["p_early_max"] <= high),
    ]
    if run.late() >= 0.99 * LATE:  # a shorter run has not settled but for its drained layers, which Terzaghi has not
        rows.insert(1, ("U: rms difference from Terzaghi", figures["U_rms"],
                        f"<= {limits['U_rms']}", figures["U_rms"] <= limits["U_rms"]))
        rows.append(("final strain / dry strain - 1", figures["strain_error"],
                     f"within {limits['strain']}", abs(figures["strain_error"]) <= limits["strain"]))
    limit = figures["time_step_limit"]
    if run.figures["explicit"]:
        rows.append(("time step / viscous limit of this sample", run.figures["time_step"] / limit,
                     "< 1", run.figures["time_step"] < limit))
    return rows


def draw(run, figures):
    draw_curves(run)
    draw_isochrones(run)
    draw_stress(run, figures)


def save(figure, run, name):
    save_figure(figure, run.base.parent / f"{run.base.name}_{name}.png", dpi=120)


def draw_curves(run):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    times = np.logspace(-3.5, np.log10(3), 300)
    left.semilogx(run.T[run.T > 0], run.middle()[run.T > 0], label="coupled")
    left.semilogx(times, terzaghi.pressure(0.5, times)[:, 0], "k--", label="Terzaghi")
    planes, uneven_times, uneven_p, uneven_U = layers.predict(run.base, run.figures)
    left.semilogx(uneven_times, uneven_p[:, len(planes) // 2], "C2:", label="uneven layer")
    right.semilogx(uneven_times, uneven_U, "C2:", label="uneven layer")
    left.set(xlabel="T_v", ylabel="p(H/2) / load", xlim=(3e-4, 3))
    right.semilogx(run.T_lid[1:], run.settlement()[1:], label="coupled")
    right.semilogx(times, terzaghi.settlement(times), "k--", label="Terzaghi")
    right.set(xlabel="T_v", ylabel="U = strain / dry strain", xlim=(3e-4, 3))
    for axes in (left, right):
        axes.legend()
        axes.grid(alpha=0.3)
    figure.suptitle(f"{run.figures['N']} grains, seed {run.figures['SEED']}")
    save(figure, run, "curves")


def draw_isochrones(run):
    figure, axes = plt.subplots(figsize=(5, 5))
    z = np.linspace(0, 1, 101)
    for number, T_v in enumerate((0.02, 0.05, 0.1, 0.2, 0.5, 1.0)):
        if T_v > run.T[-1]:
            break
        p, T_row = run.at(T_v)
        axes.plot(p, run.heights, "o", ms=3, color=f"C{number}", label=f"T_v = {T_v:g}")
        axes.plot(terzaghi.pressure(z, T_row)[0], z, "-", lw=1, color=f"C{number}")
    axes.set(xlabel="p / load", ylabel="z / H", title="points: coupled, lines: Terzaghi")
    axes.legend(fontsize=8)
    save(figure, run, "isochrones")


def draw_stress(run, figures):
    figure, axes = plt.subplots(figsize=(5, 5))
    profile = figures["effective_stress"]
    p, T_row = run.at(0.1)
    z = np.linspace(0, 1, 101)
    axes.plot(p, run.heights, "C0o-", ms=3, label="p")
    axes.plot(profile["sigma_effective"], profile["height"], "C1s-", ms=4,
              label="effective stress (eq. 2.18)")
    axes.plot(profile["sigma_total"], profile["height"], "C2^-", ms=4, label="sum")
    exact = terzaghi.pressure(z, T_row)[0]
    axes.plot(exact, z, "k--", lw=1, label="Terzaghi")
    axes.plot(1 - exact, z, "k--", lw=1)
    axes.set(xlabel="increment / load", ylabel="z / H", title=f"T_v = {T_row:.3f}")
    axes.legend(fontsize=8)
    save(figure, run, "stress")


def print_table(run, figures, rows):
    f = run.figures
    spread = 100 * figures["C_v_relative_error"]
    lines = [
        ("height", f"{f['dry_height']['rest']:.5f} m"),
        ("dry strain", f"{100 * f['dry_strain']:.4f} %   "
                       f"(unloading {100 * f['dry_strain_unloading']:.4f} %)"),
        ("E_oed, dry", f"{f['E_oed'] / 1e6:.3f} MPa   "
                       f"(unloading {f['E_oed_unloading'] / 1e6:.3f} MPa)"),
        ("permeability", f"{f['K']:.4e} m2   (loaded {f['K_loaded']:.4e} m2)"),
        ("viscosity", f"{f['viscosity']:.3g} Pa s"),
        ("C_v = K E_oed / mu", f"{f['C_v']:.5f} m2/s +- {spread:.2f} %   "
                               f"(best fit: {figures['C_v_best']:.3f} C_v)"),
        ("retriangulations", f"{figures['retriangulations']} at a pore strain of "
                             f"{f['RETRIANGULATE']:g}"),
        ("mass, force balance", f"{figures['mass_error_max']:.1e}, "
                                f"{figures['force_balance_error_max']:.1e} (largest)"),
        ("p + effective stress", f"{figures['total_stress_rms']:.3f} rms from the load at "
                                 "T_v = 0.1"),
        ("CPU per step", f"{1e3 * f['cpu_coupled_step']:.3f} ms coupled, "
                         f"{1e3 * f['cpu_dry_step']:.3f} ms dry"),
    ]
    print(f"\nOedometer, {f['N']} grains (seed {f['SEED']}), "
          f"load {f['LOAD'] / 1e3:g} kPa on 76 kPa")
    for name, text in lines:
        print(f"  {name:<24s} {text}")
    print()
    for what, measured, wanted, held in rows:
        print(f"  {'ok    ' if held else 'FAILED'} {what:<46s} {measured:8.4f}   {wanted}")


def analyse(base):
    run = Run(base)
    figures = compare(run)
    rows = judge(run, figures)
    print_table(run, figures, rows)
    draw(run, figures)
    figures.update(micro.report(run))
    summary = {**run.figures, **figures, "passed": all(held for *_, held in rows),
               "checks": [{"what": what, "measured": measured, "wanted": wanted, "held": held}
                          for what, measured, wanted, held in rows]}
    target = run.base.parent / (run.base.name + "_summary.json")
    target.write_text(json.dumps(summary, indent=1))
    print(f"\n  figures and {target.name} are in {target.parent}")
    return summary


if __name__ == "__main__":
    words = sys.argv[1:] or [str(Path(__file__).resolve().parent / "post/sample")]
    sys.exit(0 if analyse(words[0])["passed"] else 1)

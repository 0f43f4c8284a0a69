# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 4.5 to 4.12 of Catalano 2012: doc/figures/stability_thesis.png and a table. Volume rates are the
papers' E (`volume_rates geometric`) but for what `pfv time-step` finds, which takes S^T."""
import csv
import subprocess
import sys

import numpy as np

from bisection import calms_down, largest_stable
from packings import (DRAINED, EDGE, POST, STIFFNESS, packed, read_csv, time_step, write_csv)
from samples import SCENE, growth, printed
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402
from programs import solve_words  # noqa: E402

GRAINS = 500
RATIOS = [1.02, 3, 10]
DENSE = {1.02: 0.60, 3: 0.61, 10: 0.66}  # volume of the grains over that of the box; jammed
LOOSE = 0.45
GEOMETRIC = "time_step_check no volume_rates geometric"
# conductance law, whether with the papers' E
METHODS = {"papers' law and E": ("hydraulic_radius", True), "papers' law, S^T": ("hydraulic_radius", False),
           "default law and E": ("open_throat", True), "default law, S^T": ("open_throat", False)}
SIZES = [10.0**k for k in np.arange(-5, 0.01, 0.25)]  # of one grain, as parts of the mean
SCALES = [0.25, 0.5, 1.0, 2.0, 4.0]
STEPS_420 = [10.0**k for k in np.arange(-1.2, 1.61, 0.1)]  # of eq. 4.20
VISCOSITIES = [10.0**k for k in range(-3, 6)]
THICK = 1e4  # Pa s: contacts play no part


def dense(ratio=1.02):
    return packed(ratio, GRAINS, DENSE[ratio])


KINDS = {"dense": dense, "loose": lambda ratio: packed(ratio, GRAINS, LOOSE, gap=0.01)}


def central(grains):
    """Id of the grain next to the middle."""
    return 1 + int(np.linalg.norm(grains[:, :3] - 0.5 * EDGE, axis=1).argmin())


def papers_matrix(name, chosen, law="hydraulic_radius", edge=EDGE):
    """V* (m) of one grain with the papers' E: the force on it while it moves alone, of unit viscosity."""
    grains = read_csv(POST / f"{name}.csv").tolist()
    columns = []
    for axis in range(3):
        motion = ["1" if k == axis else "0" for k in range(3)]
        (POST / "moving.csv").write_text("id,x,y,z,radius,vx,vy,vz\n" + "".join(
            ",".join([str(n), *map(repr, grain), *(motion if n == chosen else "000")]) + "\n"
            for n, grain in enumerate(grains, 1)))
        call = solve_words(POST / "moving.csv", (0.0, edge) * 3, 1, *DRAINED, "--conductance", law,
                           "--volume-rates", "geometric", "--forces", str(POST / "moving_forces.csv"))
        done = subprocess.run(call, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit("stability: " + done.stderr.strip())
        with open(POST / "moving_forces.csv", newline="") as file:
            force = next(row for row in csv.DictReader(file) if int(row["id"]) == chosen)
        columns.append([-float(force["f" + name]) for name in "xyz"])
    return np.array(columns).T


def homothety(figure, rows):
    grains = read_csv(POST / f"{dense()}.csv")
    chosen = central(grains)
    found = []
    for scale in SCALES:
        write_csv(POST / "scaled.csv", scale * grains)
        found.append(np.diag(papers_matrix("scaled", chosen, edge=scale * EDGE)))
    found = np.array(found)
    size = 2 * grains[chosen - 1, 3]
    for axis, name in enumerate("xyz"):
        figure.plot(SCALES, found[:, axis], "o-", label=f"V*$_{{{name}{name}}}$, m")
        figure.plot(SCALES, found[:, axis] / (size * np.array(SCALES)) / 1e3, "s--",
                    label=f"V*$_{{{name}{name}}}$/d / 1000")
    figure.set(xlabel="homothety ratio", title="4.5: size of all grains")
    figure.legend(fontsize=7)
    per_size = found / (size * np.array(SCALES))[:, None]
    spread = (np.ptp(per_size, axis=0) / per_size.mean(axis=0)).max()
    rows.row("4.5", "V*/d over the size of all grains", "constant", f"constant to {spread:.0e}")


def slope(sizes, values, low, high):
    """Exponent of a power law between two sizes."""
    inside = [k for k, size in enumerate(sizes) if low <= size * (1 + 1e-9) and size <= high * (1 + 1e-9)]
    return np.polyfit(np.log([sizes[k] for k in inside]), np.log([values[k] for k in inside]), 1)[0]


def one_size(of_mass, of_size, rows):
    """One grain shrinks, all others keep their size."""
    grains = read_csv(POST / f"{dense()}.csv")
    chosen, mean = central(grains), 2 * grains[:, 3].mean()
    for name, (law, papers) in METHODS.items():
        values = []
        for size in SIZES:
            changed = grains.copy()
            changed[chosen - 1, 3] = 0.5 * size * mean
            write_csv(POST / "shrunk.csv", changed)
            matrix = (papers_matrix("shrunk", chosen, law) if papers else
                      time_step(POST / "shrunk.csv", "--ids", chosen, law=law)[1][chosen])
            values.append(np.trace(matrix) / 3 / mean)
        per_mass = [value / size**3 for value, size in zip(values, SIZES)]
        of_mass.loglog(SIZES, [value / per_mass[-1] for value in per_mass], "o-", ms=3, label=name)
        of_size.loglog(SIZES, values, "o-", ms=3, label=f"V*/d_av, {name}")
        spread = [value for value, size in zip(per_mass, SIZES) if size >= 0.0999]
        rows.row("4.7", f"exponent of V* in d, d/d_av from 1e-5 to 0.1, {name}", "2",
                 f"{slope(SIZES, values, 1e-5, 0.1):.2f}")
        rows.row("4.7", f"exponent of V* in d, d/d_av from 0.1 to 1, {name}", "3",
                 f"{slope(SIZES, values, 0.1, 1.0):.2f}")
        rows.row("4.7", f"V*/d at d/d_av = 1e-5, {name} (Stokes: 3 pi = 9.42)", "",
                 f"{values[0] / SIZES[0]:.2g}")
        rows.row("4.6", f"V*/M, largest over smallest, d/d_av from 0.1 to 1, {name}",
                 "a narrow range", f"{max(spread) / min(spread):.1f}")
    scale = values[-1]
    for power in (1, 2, 3, 4):
        of_size.loglog(SIZES, [scale * size**power for size in SIZES], ":", lw=1, label=f"d^{power}")
    of_size.set(xlabel="d / d_av", ylim=(1e-12 * scale, 10 * scale), title="4.7: one grain shrinks")
    of_mass.set(xlabel="d / d_av", title="4.6: V*/M, one grain shrinks (1 at d = d_av)")
    of_size.legend(fontsize=7)
    of_mass.legend(fontsize=7)


def sizes(figure):
    for ratio in RATIOS:
        radii = np.sort(read_csv(POST / f"{dense(ratio)}.csv")[:, 3])
        share = np.cumsum(radii**3) / (radii**3).sum()
        figure.semilogx(radii / radii.mean(), 100 * share, label=f"d_max/d_min = {ratio:g}")
    figure.set(xlabel="d / d_av", ylabel="% by volume", title="4.8: sizes")
    figure.legend(fontsize=7)


def each(values, form):
    """"1.02: a; 3: b; 10: c" for the size ratios."""
    return "; ".join(f"{ratio:g}: {form(values[ratio])}" for ratio in RATIOS)


def distributions(figures, rows):
    """Diagonals of V*/d of all grains; returns the reports by kind and ratio."""
    reports = {}
    for row, (kind, make) in enumerate(KINDS.items()):
        found, uneven = {}, {}
        for figure, ratio in zip(figures[row], RATIOS):
            name = make(ratio)
            grains = read_csv(POST / f"{name}.csv")
            reports[kind, ratio], matrices = time_step(POST / f"{name}.csv")
            found[ratio] = np.concatenate([np.diag(v) / (2 * grains[n - 1, 3])
                                           for n, v in matrices.items()])
            uneven[ratio] = diagonal_errors(matrices)
            figure.hist(found[ratio], bins=40, weights=np.full(3 * len(grains), 1 / len(grains)))
            figure.axvline(400, color="black", ls=":", label="thesis' $\\beta$ = 400")
            figure.set(xlabel="V*$_{ii}$ / d", ylabel="$N_i$ / N",
                       title=f"4.{10 + row}: {kind}, d_max/d_min = {ratio:g}")
            figure.legend(fontsize=7)
        rows.row(f"4.{10 + row}", f"V*_ii/d, {kind}: median, largest",
                 "all below 400" if kind == "dense" else "lower than dense",
                 each(found, lambda values: f"{np.median(values):.0f}, {values.max():.0f}"))
        rows.row("text", f"V*_ii against the eigenvalues of V*, {kind}: median, largest difference",
                 "1.02: 0.1 to 0.5 %; 10: 1.7 to 6.0 % (one grain each)" if kind == "dense" else "",
                 each(uneven, lambda errors: f"{100 * np.median(errors):.1f}, {100 * max(errors):.0f} %"))
    return reports


def diagonal_errors(matrices):
    """|V_ii - D_ii| / V_ii, both in ascending order, of the matrices with a positive diagonal."""
    errors = []
    for matrix in matrices.values():
        entries = np.sort(np.diag(matrix))
        if entries[0] > 0:
            errors += list(abs(entries - np.sort(np.linalg.eigvals(matrix).real)) / entries)
    return errors


def instability(figure, reports, rows):
    """Kinetic energy after 400 steps over the time step in units of eq. 4.20."""
    for kind, make in KINDS.items():
        of_formula, of_matrix = {}, {}
        for ratio in RATIOS:
            report = reports[kind, ratio]
            data = f"post/{make(ratio)}.data"
            formula = report["formula"]["time_step"]
            limit = printed(data, THICK, "volume_rates geometric")[0] * THICK
            steps = [part for part in STEPS_420 if part * formula < 4 * limit]
            energies = [growth(data, THICK, part * formula / THICK, 400, GEOMETRIC) for part in steps]
            line, = figure.loglog(steps, [min(energy, 1e12) for energy in energies],
                                  "o-" if kind == "dense" else "s--", ms=3, label=f"{kind}, {ratio:g}")
            figure.axvline(limit / formula, color=line.get_color(), lw=0.7, ls=":")
            found = largest_stable(calms_down(data, THICK, GEOMETRIC), limit / THICK, 0.9, 1.15, 0.02) * THICK
            of_formula[ratio] = found / formula
            of_matrix[ratio] = found / report["viscous"]["time_step"]
        rows.row("4.9", f"unstable from, in units of eq. 4.20, {kind}", "0.95",
                 each(of_formula, lambda value: f"{value:.2f}"))
        rows.row("4.9", f"the same in units of eq. 4.15, {kind}", "",
                 each(of_matrix, lambda value: f"{value:.2f}"))
    figure.axvline(0.95, color="black", label="thesis, 0.95")
    figure.set(xlabel="time step / eq. 4.20", ylabel="kinetic energy / initial", ylim=(1e-4, 1e12),
               title="4.9: dotted: printed limits")
    figure.legend(fontsize=6)


def both_limits(figure, rows):
    """Eq. 4.22 with a safety of 0.8 over the viscosity."""
    name = dense()
    report, _ = time_step(POST / f"{name}.csv", "--contact-stiffness", STIFFNESS)
    contact = report["contact"]["time_step"]
    coupling = printed(f"post/{name}.data", 1.0, "volume_rates geometric")[0]
    measured, taken = [], []
    for viscosity in VISCOSITIES:
        true = min(coupling / viscosity, report["contact_limit"])
        measured.append(largest_stable(calms_down(f"post/{name}.data", viscosity, GEOMETRIC), true, 0.4,
                                       1.6, 0.01))
        taken.append(0.8 * min(contact, report["formula"]["time_step"] / viscosity))
    figure.loglog(VISCOSITIES, taken, "k-", label="eq. 4.22, 0.8 min(2.14, 4.20)")
    figure.loglog(VISCOSITIES, [coupling / mu for mu in VISCOSITIES], "--",
                  label="printed limit of the coupling")
    figure.axhline(report["contact_limit"], ls=":", label="contacts, 2/omega_max")
    figure.loglog(VISCOSITIES, measured, "o", label="measured in LIGGGHTS")
    figure.set(xlabel="viscosity, Pa s", ylabel="time step, s", title="4.12: dense, 1.02")
    figure.legend(fontsize=7)
    rows.row("4.12", "eq. 4.22 (safety 0.8) over the measured limit at "
             f"{VISCOSITIES[0]:g} and {VISCOSITIES[-1]:g} Pa s", "below 1",
             f"{taken[0] / measured[0]:.2f} and {taken[-1] / measured[-1]:.2f}")


def table():
    rows = Table("figure", "what", "thesis", "here")
    figure, axes = plt.subplots(4, 3, figsize=(14, 16))
    homothety(axes[0][0], rows)
    one_size(axes[0][1], axes[0][2], rows)
    sizes(axes[1][0])
    reports = distributions(axes[2:], rows)
    instability(axes[1][1], reports, rows)
    both_limits(axes[1][2], rows)
    save_figure(figure, FIGURES / "stability_thesis.png")
    return rows

# SPDX-License-Identifier: GPL-3.0-or-later
"""Staged and implicit coupling beyond the explicit limit, over size ratio, contact stiffness, number of grains
and mass of a lid: doc/figures/stability_long_steps.png and four tables."""
import math
import sys

import numpy as np
from matplotlib.colors import ListedColormap

from beyond import power
from bisection import LOAD, printed_with_lid, write_lid
from consolidations import GRAVITY, consolidation
from maps import SIZE_GRAINS, SIZE_RATIOS
from packings import POST, STIFFNESS, packed, read_csv, rested, time_step
from regions import limits_of
from samples import DENSITY, EDGE, SCENE, energies, liggghts, rows_of, sample
from stiffness import STIFFNESSES
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402

STEPS = 1000
PARTS = {"a sixth": 1 / 6, "half": 1 / 2}  # of the contacts' limit
STAGED, IMPLICIT = "coupling staged", "coupling implicit"
SHEAR = " shear_viscous yes"
RATIOS = [10, 30, 100, 1000, 10000]  # R, time step over the printed limit
TRIED = {STAGED: RATIOS[:4], IMPLICIT: RATIOS, STAGED + SHEAR: RATIOS[:4]}
SIZES = (1.2, 3, 5, 10, 20)
STIFFNESS_RATIOS = (10, 30, 1000)
COUNTS, COUNT_RATIO = {1000: 0.62, 5000: 0.64}, 100  # share of the grains' volume: in contact
LID_MASSES = [10.0**k for k in range(-4, 2)]  # kg
DASHPOT = 500.0  # 1/s, of in.grains
FIRST = 600  # steps after which growth is measured, to STEPS


def decays(found):
    """Whether a run of eleven energies ends below the first and its last instants below those of its middle:
    energy goes to and fro between motion and springs."""
    return found[-1] <= 1.0 and max(found[-3:]) <= max(found[3:6])


def shown(found):
    return power(found[-1]) if decays(found) else f"**{power(found[-1])}**"


class Rows:
    """Runs of one packing at one time step, a row a coupling."""

    def __init__(self):
        self.table = Table("what varies", "time step, of the contacts' limit", "coupling",
                           *(f"R = {ratio}" for ratio in RATIOS))
        self.stable = {}  # by what varies, part and words: {R: whether it decays}

    def add(self, what, name, part, tried, stiffness=STIFFNESS):
        report, _ = time_step(POST / f"{name}.csv", "--spheres", 1, "--contact-stiffness", stiffness)
        step = PARTS[part] * report["contact_limit"]
        for words, ratios in tried.items():
            found = {ratio: energies(f"post/{name}.data", ratio * report["coupling_limit"] / step, step,
                                     STEPS, words, kn=stiffness) for ratio in ratios}
            self.stable[what, part, words] = {ratio: decays(one) for ratio, one in found.items()}
            self.table.row(what, part, words.removeprefix("coupling "),
                           *(shown(found[ratio]) if ratio in found else "" for ratio in RATIOS))


def of_ratio(ratio):
    return rested(ratio, SIZE_GRAINS, SIZE_RATIOS["dense"][ratio])


def draw_sizes(stable):
    figure, axes = plt.subplots(2, len(TRIED), figsize=(4 * len(TRIED), 6), sharey=True)
    for line, part in zip(axes, PARTS):
        for axis, words in zip(line, TRIED):
            grid = np.full((len(RATIOS), len(SIZES)), np.nan)
            for column, size in enumerate(SIZES):
                for ratio, good in stable[f"size ratio {size:g}", part, words].items():
                    grid[RATIOS.index(ratio), column] = good
            axis.pcolormesh(range(len(SIZES)), range(len(RATIOS)), np.ma.masked_invalid(grid), vmin=0,
                            vmax=1, shading="nearest", cmap=ListedColormap(["#d9705f", "#8fc98b"]),
                            edgecolors="white")
            axis.set(xticks=range(len(SIZES)), xticklabels=[f"{size:g}" for size in SIZES],
                     yticks=range(len(RATIOS)), yticklabels=RATIOS, xlabel="size ratio",
                     title=f"{words.removeprefix('coupling ')}, {part} of the contacts' limit")
            axis.title.set_fontsize(9)
        line[0].set_ylabel("R")
    save_figure(figure, FIGURES / "stability_long_steps.png")


def table():
    rows = Rows()
    for ratio in SIZES:
        for part in PARTS:
            rows.add(f"size ratio {ratio:g}", of_ratio(ratio), part, TRIED)
    for value in STIFFNESSES:
        rows.add(f"stiffness, N/m, {value:g}", of_ratio(SIZES[0]), "a sixth",
                 dict.fromkeys((STAGED, IMPLICIT), STIFFNESS_RATIOS), value)
    for count, solid in COUNTS.items():
        rows.add(f"grains {count}", packed(1.2, count, solid), "a sixth",
                 dict.fromkeys((STAGED, IMPLICIT), (COUNT_RATIO,)))
    draw_sizes(rows.stable)
    return rows.table


def rate(found, limits):
    """Of the velocity, in units of the inverse limit, from FIRST to STEPS; `limits` in a step."""
    factor = found[-1] / found[10 * FIRST // STEPS]
    return f"{math.log(factor) / (2 * limits * (STEPS - FIRST)):.1e}" if factor > 1.0 else "decays"


def floating():
    """Grains that touch nothing, and what the fluid does to them by itself."""
    ratio, parts = 10, 20  # R; an explicit run at half of its limit
    rows = Table("size ratio", "grains that touch nothing", "grains that their own motion drives on",
                 "fastest of them, rate x limit", "staged, R = 10", "staged, half of the step",
                 "explicit, R = 0.5", "staged, R = 10, shear_viscous")
    for size in SIZES:
        name = of_ratio(size)
        data, grains = f"post/{name}.data", read_csv(POST / f"{name}.csv")
        report, matrices = time_step(POST / f"{name}.csv", "--spheres", len(grains),
                                     "--contact-stiffness", STIFFNESS)
        masses = DENSITY * 4 / 3 * math.pi * grains[:, 3]**3
        own = [-np.linalg.eigvals(matrix).real.min() / masses[n - 1] * report["coupling_limit"]
               for n, matrix in matrices.items()]
        driven = [value for value in own if value > 1e-12]  # others than zero by rounding
        step = PARTS["a sixth"] * report["contact_limit"]
        viscosity = ratio * report["coupling_limit"] / step
        runs = [energies(data, viscosity, step / part, STEPS * part, words)
                for words, part in ((STAGED, 1), (STAGED, 2), ("time_step_check no", parts),
                                    (STAGED + SHEAR, 1))]
        rows.row(f"{size:g}", sum(is_free(grains, k) for k in range(len(grains))), len(driven),
                 f"{max(driven):.1e}" if driven else "", *(rate(run, ratio) for run in runs))
    return rows


def shaken():
    """What the growth of `floating` does to a consolidation with new networks, and what takes it away."""
    name = of_ratio(10)
    data = f"post/{name}.data"
    report, _ = time_step(POST / f"{name}.csv", "--spheres", 1, "--contact-stiffness", STIFFNESS)
    step = PARTS["a sixth"] * report["contact_limit"]
    rows = Table("R", "coupling", "steps", "new networks", "kinetic energy at the end, J",
                 "mean pressure at the end, Pa", "settlement, μm", "CPU / staged")
    for ratio, tried in ((10, (STAGED, IMPLICIT, "time_step_check no", STAGED + SHEAR,
                               "time_step_check no" + SHEAR)),
                         (100, (STAGED, IMPLICIT, STAGED + SHEAR))):
        viscosity = ratio * report["coupling_limit"] / step
        staged_cpu = None
        for words in tried:
            part = 1 if "coupling" in words else 4 * ratio  # explicit: at a quarter of its limit
            run = consolidation(data, viscosity, step / part, words, STEPS * step, 10, gravity=GRAVITY)
            staged_cpu = staged_cpu or run.cpu
            rows.row(ratio, words.removeprefix("coupling ").replace("time_step_check no", "explicit"),
                     STEPS * part, run.networks, f"{run.energies[-1]:.1e}", f"{run.pressures[-1]:.0f}",
                     f"{1e6 * (run.heights[0] - run.heights[-1]):.1f}", f"{run.cpu / staged_cpu:.2f}")
    return rows


def is_free(grains, k):
    """Whether grain k touches neither another nor a wall."""
    gaps = np.linalg.norm(grains[:, :3] - grains[k, :3], axis=1) - grains[:, 3] - grains[k, 3]
    gaps[k] = math.inf
    place, radius = grains[k, :3], grains[k, 3]
    return gaps.min() > 0.0 and place.min() > radius and (place + radius).max() < EDGE


def lid_limit(mass, touching):
    """Longest stable step (s) of a dry lid on grains of these masses, held: (dt omega)^2 / 2 + dt c / m = 2,
    with the dashpots' force at the velocities of the last step and, against a mesh, the grain's mass."""
    spring = len(touching) * STIFFNESS / mass
    dashpot = DASHPOT * sum(touching) / mass
    return (math.sqrt(dashpot**2 + 4 * spring) - dashpot) / spring


def borne(data, viscosity, step, mass, words):
    """Largest force on the lid at a hundred instants and force at the end, as parts of the load."""
    ok, screen = liggghts("in.piston", data=data, viscosity=repr(viscosity), dt=repr(step), steps=STEPS,
                          mass=mass, words=words)
    if not ok:
        return "**ended by an error**"
    forces = [row[1] / LOAD for row in rows_of(screen)]
    return f"{max(map(abs, forces)):.2f}, {forces[-1]:.3f}"


def lids():
    write_lid()
    data = sample("dense")
    _, contacts = limits_of(data)
    lines = (SCENE / data).read_text().split("Atoms")[1].split("Velocities")[0].split("\n")
    grains = [(float(words[6]), 0.5 * float(words[2])) for words in map(str.split, lines) if words]
    touching = [DENSITY * 4 / 3 * math.pi * radius**3 for z, radius in grains if z + radius > EDGE]
    rows = Table("mass of the lid, kg", "time step, s", "coupling",
                 *(f"R = {ratio}" for ratio in RATIOS))
    for mass in LID_MASSES:
        limit = printed_with_lid(data, 1.0, mass)
        step = PARTS["a sixth"] * min(contacts, lid_limit(mass, touching))
        for words in (STAGED, IMPLICIT):
            cells = ["" if ratio not in TRIED[words] else
                     borne(data, ratio * limit / step, step, mass, words) for ratio in RATIOS]
            rows.row(f"{mass:g}", f"{step:.2g}", words.removeprefix("coupling "), *cells)
    return rows

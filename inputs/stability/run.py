#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the explicit coupling of LIGGGHTS with the fluid becomes unstable, and how far the staged
and the implicit one go: the tables of doc/stability.md.

    run.py         called by ./run.sh stability; prints the tables
    run.py write   puts them into doc/stability.md as well
"""
import json
import math
import os
import random
import re
import subprocess
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
BIN = Path(os.environ.get("PFV_BIN", SCENE.parents[1] / "build" / "bin"))
PAGE = SCENE.parents[1] / "doc" / "stability.md"
EDGE, DENSITY = 0.1, 2600.0  # m, kg/m3
CELLS = 5
SAMPLES = {"dense": 1.35, "loose": 1.0}  # factor on the radii of a jittered grid
VISCOSITIES = [10.0**k for k in range(1, 7)]  # Pa s
RATIOS = [2, 10, 100, 200, 1000, 10000]
CONTACT_PARTS = {"a sixth": 1e-4, "half": 3e-4}  # of the contact limit of 6e-4 s: time step, s
COST_CELLS = [8, 12, 17]  # along each edge: 512, 1728 and 4913 grains
GROWTH_RATIOS = [0.5, 20, 100, 1000]
STEPS = 1000


def grid(factor, rng, cells=CELLS):
    step = EDGE / cells
    return [[(n + 0.5 + rng.uniform(-0.08, 0.08)) * step for n in (i, j, k)] +
            [factor * step * rng.uniform(0.36, 0.41)]
            for i in range(cells) for j in range(cells) for k in range(cells)]


def write_data(path, grains, speed, rng):
    lines = ["grains of the stability study", "", f"{len(grains)} atoms", "1 atom types", ""]
    lines += [f"-0.02 {EDGE + 0.02} {a}lo {a}hi" for a in "xyz"] + ["", "Atoms", ""]
    lines += [f"{n} 1 {2 * r!r} {DENSITY} {x!r} {y!r} {z!r}"
              for n, (x, y, z, r) in enumerate(grains, 1)]
    lines += ["", "Velocities", ""]
    lines += [f"{n} " + " ".join(repr(speed * rng.uniform(-1, 1)) for _ in range(3)) + " 0 0 0"
              for n in range(1, len(grains) + 1)]
    path.write_text("\n".join(lines) + "\n")


def liggghts(script, **variables):
    """(whether the run reached its end, screen output)"""
    words = [str(BIN / "liggghts-pfv"), "-in", script, "-log", "none"]
    for name, value in variables.items():
        words += ["-var", name, str(value)]
    done = subprocess.run(words, cwd=SCENE, capture_output=True, encoding="utf-8", errors="replace",
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    return done.returncode == 0, done.stdout


def must(ok_and_screen):
    ok, screen = ok_and_screen
    if not ok:
        raise SystemExit("stability: " + next(
            (line for line in screen.splitlines() if "ERROR" in line), "liggghts-pfv failed"))
    return screen


def make_sample(name, factor):
    rng = random.Random(1)
    data = SCENE / "post" / f"{name}.data"
    write_data(data, grid(factor, rng), 0.0, rng)
    must(liggghts("in.settle", data=data, out=f"post/{name}.rest"))
    rows = (SCENE / "post" / f"{name}.rest").read_text().splitlines()[9:]
    # so slow that no grain moves by a part of its contact overlaps during a run
    write_data(data, [[float(word) for word in row.split()[1:]] for row in rows], 1e-9, rng)
    return f"post/{name}.data"


def rows_of(screen):
    rows = []
    for line in screen.splitlines():
        words = line.split()
        if len(words) == 4 and re.fullmatch(r"\d+", words[0]):
            rows.append([float(word) for word in words])
    return rows


def growth(data, viscosity, step, steps, words):
    """Kinetic energy at the end of a run over that at its beginning; infinite where it broke off."""
    ok, screen = liggghts("in.stability", data=data, viscosity=viscosity, dt=repr(step),
                          steps=steps, words=words)
    rows = rows_of(screen)
    if not rows or rows[0][0] != 0:
        must((False, screen))
    energies = [row[1] for row in rows]
    broken = not ok or not all(math.isfinite(energy) for energy in energies)
    return math.inf if broken else energies[-1] / energies[0]


def printed(data, viscosity):
    """(limit, papers' estimate) that the fix prints at setup, s."""
    screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=1e-12, steps=0))
    found = re.search(r"explicit coupling (\S+) s \(papers' .*?: (\S+) s\)", screen)
    limit = next(row[2] for row in rows_of(screen))
    return limit, float(found.group(2))


def measured(data, viscosity, limit):
    """The largest stable step, by bisection to 0.3 %; s."""
    def stable(factor):
        return growth(data, viscosity, factor * limit, STEPS, "time_step_check no") <= 1.0
    low, high = 0.8, 1.4
    if not stable(low) or stable(high):
        raise SystemExit(f"stability: the limit at {viscosity:g} Pa s is not within {low} and "
                         f"{high} of the printed one")
    while high - low > 0.003:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low * limit


def limits_table(samples):
    lines = ["| sample | viscosity, Pa s | printed limit, s | measured limit, s | measured / printed "
             "| measured / papers' estimate |", "|---|---|---|---|---|---|"]
    for name, data in samples.items():
        for viscosity in VISCOSITIES:
            limit, estimate = printed(data, viscosity)
            found = measured(data, viscosity, limit)
            lines.append(f"| {name} | {viscosity:g} | {limit:.3e} | {found:.3e} | "
                         f"{found / limit:.3f} | {found / estimate:.3f} |")
            print(lines[-1], flush=True)
    return lines


def power(value):
    return f"{value:.1e}" if math.isfinite(value) else "ended by an error"


def beyond_table(data, steps=1000):
    """At two time steps, which the contacts allow; the viscosity sets R."""
    limit, _ = printed(data, 1.0)
    lines = ["| R | time step, of the contacts' limit | viscosity, Pa s | stages | staged | implicit "
             "| explicit, after 3 steps |", "|---|---|---|---|---|---|---|"]
    for ratio in RATIOS:
        for part, step in CONTACT_PARTS.items():
            viscosity = ratio * limit / step
            screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=step, steps=0,
                                   words="coupling staged"))
            left = [power(growth(data, viscosity, step, steps, f"coupling {coupling}"))
                    for coupling in ("staged", "implicit")]
            explicit = power(growth(data, viscosity, step, 3, "time_step_check no"))
            lines.append(f"| {ratio} | {part} | {viscosity:.3g} | {rows_of(screen)[0][3]:.0f} | "
                         f"{left[0]} | {left[1]} | {explicit} |")
            print(lines[-1], flush=True)
    return lines


def consolidation(data, viscosity, step, words, time=0.032):
    """(heights, mean pressures, retriangulations, CPU seconds) of a consolidation."""
    before = os.times().children_user
    screen = must(liggghts("in.consolidation", data=data, viscosity=viscosity, dt=repr(step),
                           steps=round(time / step), words=words))
    rows = rows_of(screen)
    return ([row[1] for row in rows], [row[2] for row in rows], rows[-1][3],
            os.times().children_user - before)


def accuracy_table(data):
    """Against the explicit coupling at a fifth of its own limit."""
    limit, _ = printed(data, 1.0)
    viscosity = 20 * limit / 1e-4
    heights, pressures, *_ = consolidation(data, viscosity, 1e-6, "time_step_check no")
    settled, peak = abs(heights[-1] - heights[0]), max(pressures[1:])
    lines = ["| coupling | time step, s | R | settlement | pressure | pressure, last quarter "
             "| new networks | CPU / explicit at 0.8 of its limit |",
             "|---|---|---|---|---|---|---|---|"]
    cases = [("explicit", 4e-6)] + [(coupling, step) for coupling in ("staged", "implicit")
                                    for step in (2e-4, 1e-4, 5e-5, 2.5e-5)]
    explicit_cpu = None
    for coupling, step in cases:
        words = "time_step_check no" if coupling == "explicit" else f"coupling {coupling}"
        h, p, networks, cpu = consolidation(data, viscosity, step, words)
        explicit_cpu = explicit_cpu or cpu
        off = [abs(a - b) / peak for a, b in zip(p, pressures)][1:]
        settlement = max(abs(a - b) for a, b in zip(h, heights)) / settled
        lines.append(f"| {coupling} | {step:g} | {20 * step / 1e-4:.2g} | {100 * settlement:.2f} % | "
                     f"{100 * max(off):.2f} % | {100 * max(off[-4:]):.2f} % | {networks:.0f} | "
                     f"{cpu / explicit_cpu:.3f} |")
        print(lines[-1], flush=True)
    return lines


def phase_seconds(data, viscosity, step, words, steps=20):
    """CPU seconds of ordering and factorising, and of one solve, as the fix prints them."""
    screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=repr(step),
                           steps=steps, words=words))
    found = {name: (float(seconds), int(count)) for name, seconds, count in
             re.findall(r"^(order|factor|solve) +(\S+) +(\d+)$", screen, re.M)}
    return found["order"][0] + found["factor"][0], found["solve"][0] / found["solve"][1]


def cost_table():
    lines = ["| grains | order and factor: A / G | solve: A / G "
             "| order and factor of A, in solves with G |", "|---|---|---|---|"]
    for cells in COST_CELLS:
        rng = random.Random(1)
        data = SCENE / "post" / f"cost_{cells}.data"
        write_data(data, grid(1.35, rng, cells), 1e-9, rng)
        viscosity = 1e4  # steps so short that contacts have no say
        limit, _ = printed(data, viscosity)
        g_factor, g_solve = phase_seconds(data, viscosity, 0.5 * limit, "time_step_check no")
        both_factors, a_solve = phase_seconds(data, viscosity, 100 * limit, "coupling implicit")
        a_factor = both_factors - g_factor  # the run makes that of G, too
        lines.append(f"| {cells**3} | {a_factor / g_factor:.1f} | {a_solve / g_solve:.1f} | "
                     f"{a_factor / g_solve:.0f} |")
        print(lines[-1], flush=True)
    return lines


def growth_table(samples, viscosity=1e5, time=5000):
    """Steps so short that contacts do nothing: the fluid alone, over the same time in all runs."""
    lines = ["| sample | " + " | ".join(
        f"{'explicit' if ratio < 1 else 'staged'}, R = {ratio:g}" for ratio in GROWTH_RATIOS) +
        " | rate x limit |", "|---" * (len(GROWTH_RATIOS) + 2) + "|"]
    for name, data in samples.items():
        limit, _ = printed(data, viscosity)
        factors = []
        for ratio in GROWTH_RATIOS:
            words = "time_step_check no" if ratio < 1 else "coupling staged"
            once, twice = (growth(data, viscosity, ratio * limit, round(part * time / ratio), words)
                           for part in (1, 2))
            factors.append(twice / once)
        lines.append(f"| {name} | " + " | ".join(f"{factor:.2f}" for factor in factors) +
                     f" | {math.log(factors[0]) / (2 * time):.1e} |")
        print(lines[-1], flush=True)
    return lines


def write_page(tables):
    text = PAGE.read_text()
    for name, lines in tables.items():
        begin, end = f"<!-- table {name} -->\n", "<!-- end of table -->"
        start = text.index(begin) + len(begin)
        text = text[:start] + "\n".join(lines) + "\n" + text[text.index(end, start):]
    PAGE.write_text(text)


def main(words):
    if words not in ([], ["write"]):
        raise SystemExit("stability: use `run.py` or `run.py write`")
    samples = {name: make_sample(name, factor) for name, factor in SAMPLES.items()}
    tables = {"beyond": beyond_table(samples["dense"]),
              "accuracy": accuracy_table(samples["dense"]), "costs": cost_table(),
              "growth": growth_table(samples), "limits": limits_table(samples)}
    (SCENE / "post" / "tables.json").write_text(json.dumps(tables, indent=1) + "\n")
    if words:
        write_page(tables)


if __name__ == "__main__":
    main(sys.argv[1:])

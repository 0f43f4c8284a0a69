# SPDX-License-Identifier: GPL-3.0-or-later
"""The grains of the study, and LIGGGHTS runs with them. SAMPLES are made once a command."""
import functools
import math
import random
import re
import subprocess
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.append(str(SCENE.parent / "common"))
from programs import BIN, error_of, liggghts_words, one_thread

EDGE, DENSITY = 0.1, 2600.0  # m, kg/m3
SAMPLES = {"dense": 1.35, "loose": 1.0}  # factor on the radii of a jittered grid


def grid(factor, rng, cells=5):
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
    words = liggghts_words(script, {name: str(value) for name, value in variables.items()}, "none")
    done = subprocess.run(words, cwd=SCENE, capture_output=True, encoding="utf-8",
                          errors="replace", env=one_thread())
    return done.returncode == 0, done.stdout


def must(ok_and_screen):
    ok, screen = ok_and_screen
    if not ok:
        raise SystemExit("stability: " + (error_of(screen) or "liggghts-pfv failed"))
    return screen


@functools.cache
def sample(name, cells=5, **contacts):
    """Data file of the settled grains, cells along each edge, relative to the scene."""
    rng = random.Random(1)
    label = f"{name}_{cells}"
    data = SCENE / "post" / f"{label}.data"
    write_data(data, grid(SAMPLES[name], rng, cells), 0.0, rng)
    must(liggghts("in.settle", data=data, out=f"post/{label}.rest", **contacts))
    rows = (SCENE / "post" / f"{label}.rest").read_text().splitlines()[9:]
    # so slow that no grain moves by a part of its contact overlaps during a run
    write_data(data, [[float(word) for word in row.split()[1:]] for row in rows], 1e-9, rng)
    return f"post/{label}.data"


def rows_of(screen, columns=4):
    """Lines of so many numbers, a whole one first."""
    number = r"[-+]?(\d+\.?\d*(e[-+]?\d+)?|nan|inf)"
    row = re.compile(r"\d+" + rf"(\s+{number}){{{columns - 1}}}")
    return [[float(word) for word in line.split()] for line in map(str.strip, screen.splitlines())
            if row.fullmatch(line)]


def energies(data, viscosity, step, steps, words, script="in.stability", **variables):
    """Kinetic energies of a run at eleven instants, as parts of the first; one infinite entry where it broke
    off."""
    ok, screen = liggghts(script, data=data, viscosity=viscosity, dt=repr(step), steps=steps,
                          words=words, **variables)
    rows = rows_of(screen)
    if not rows or rows[0][0] != 0:
        must((False, screen))
    found = [row[1] / rows[0][1] for row in rows]
    return found if ok and all(map(math.isfinite, found)) else [math.inf]


def growth(data, viscosity, step, steps, words, script="in.stability", **variables):
    """Kinetic energy at the end of a run over that at its beginning; infinite where it broke off."""
    return energies(data, viscosity, step, steps, words, script, **variables)[-1]


def printed(data, viscosity, words="coupling explicit"):
    """(limit, papers' estimate) that the fix prints at setup, s."""
    screen = must(liggghts("in.stability", data=data, viscosity=viscosity, dt=1e-12, steps=0,
                           words=words))
    found = re.search(r"explicit coupling (\S+) s \(papers' .*?: (\S+) s\)", screen)
    limit = next(row[2] for row in rows_of(screen))
    return limit, float(found.group(2))

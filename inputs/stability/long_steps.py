# SPDX-License-Identifier: GPL-3.0-or-later
"""All couplings over size ratio, conductance law, contact stiffness and number of grains:
doc/figures/stability_long_steps.png and a table."""
import sys

from beyond import power
from maps import SIZE_GRAINS, SIZE_RATIOS
from packings import POST, STIFFNESS, contact_limit, packed, rested, time_step
from samples import SCENE, energies
from stiffness import STIFFNESSES
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402

PARTS = {"a sixth": 1 / 6, "half": 1 / 2}  # of the contacts' limit
EXPLICIT, STAGED, IMPLICIT = "time_step_check no", "coupling staged", "coupling implicit"
BELOW = {"a sixth": 0.9, "half": 0.7}  # R of the explicit coupling; at half the contacts take a part
RATIOS = {STAGED: (10, 100, 1000, 10000), IMPLICIT: (10, 100, 1000, 10000, 100000)}  # R
FEW = {STAGED: (10, 1000), IMPLICIT: (10, 1000, 100000)}
STEPS = {EXPLICIT: 500, IMPLICIT: 500, STAGED: 500}
OF_MANY_STAGES = {1000: 300, 10000: 200}  # staged steps, 48 and 150 stages each
SIZES = (1.2, 3, 5, 10, 20, 50)
DEFAULT, PAPERS = "open_throat", "hydraulic_radius"
LONGER, LONGER_SIZES, SHOWN = 4000, (10, 20, 50), (1, 3, 5, 10)  # steps; instants, tenths of them
LONGER_RUNS = ((EXPLICIT, 0.9), (STAGED, 10), (IMPLICIT, 1000), (IMPLICIT, 100000))
MANY, SOLID, OF_MANY = 5000, 0.64, 0.4  # grains; their share of the volume, in contact; of the steps


def decays(found):
    """Whether a run of eleven energies ends below the first and its last instants below those of its middle:
    energy goes to and fro between motion and springs."""
    return found[-1] <= 1.0 and max(found[-3:]) <= max(found[3:6])


def shown(found):
    return power(found[-1]) if decays(found) else f"**{power(found[-1])}**"


class Rows:
    """A row a packing, law and time step."""

    def __init__(self):
        self.table = Table("what varies", "law", "time step, of the contacts' limit",
                           "explicit, R = 0.9 or 0.7",
                           *(f"{words.split()[1]}, {ratio:g}" for words, ratios in RATIOS.items()
                             for ratio in ratios))
        self.found = {}  # of the default law at a sixth, by what varies: {(words, R): eleven energies}

    def add(self, what, name, law, part, tried=None, stiffness=STIFFNESS, of_steps=1.0):
        limit = time_step(POST / f"{name}.csv", "--spheres", 1, law=law)[0]["coupling_limit"]
        step = PARTS[part] * contact_limit(name, stiffness)

        def run(words, ratio):
            steps = OF_MANY_STAGES.get(ratio, STEPS[words]) if words == STAGED else STEPS[words]
            return energies(f"post/{name}.data", ratio * limit / step, step,
                            round(of_steps * steps), words, kn=stiffness, law=law)

        tried = tried or RATIOS
        found = {(EXPLICIT, BELOW[part]): run(EXPLICIT, BELOW[part])}
        found.update({(words, ratio): run(words, ratio) for words, ratios in tried.items()
                      for ratio in ratios})
        if law == DEFAULT and part == "a sixth":
            self.found[what] = found
        columns = [(EXPLICIT, BELOW[part])] + [(words, ratio) for words, ratios in RATIOS.items()
                                               for ratio in ratios]
        self.table.row(what, law, part, *(shown(found[key]) if key in found else "" for key in columns))


def of_ratio(ratio):
    return rested(ratio, SIZE_GRAINS, SIZE_RATIOS["dense"][ratio])


def draw_sizes(found):
    """Energy at the end over R and size ratio, default law at a sixth of the contacts' limit."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), sharey=True)
    for axis, words in zip(axes, RATIOS):
        for size in SIZES:
            runs = found[f"size ratio {size:g}"]
            axis.loglog(RATIOS[words], [runs[words, ratio][-1] for ratio in RATIOS[words]], "o-",
                        label=f"size ratio {size:g}")
        axis.axhline(1.0, color="black", lw=0.8)
        axis.set(xlabel="R", title=words)
        axis.grid(True, alpha=0.2)
    axes[0].set_ylabel("kinetic energy at the end / at the beginning")
    axes[0].legend(fontsize=7)
    save_figure(figure, FIGURES / "stability_long_steps.png")


def longer():
    """Runs that the table above ends while large grains still swing."""
    rows = Table("size ratio", "coupling", "R", *(f"after {LONGER * k // 10} steps" for k in SHOWN))
    for size in LONGER_SIZES:
        name = of_ratio(size)
        limit = time_step(POST / f"{name}.csv", "--spheres", 1, law=DEFAULT)[0]["coupling_limit"]
        step = PARTS["a sixth"] * contact_limit(name)
        for words, ratio in LONGER_RUNS:
            found = energies(f"post/{name}.data", ratio * limit / step, step, LONGER, words, law=DEFAULT)
            rows.row(f"{size:g}", words.removeprefix("coupling ").replace(EXPLICIT, "explicit"),
                     f"{ratio:g}", *(power(found[k]) for k in (SHOWN if len(found) > 1 else [0])))
    return rows


def table():
    rows = Rows()
    for size in SIZES:
        for law, part in ((DEFAULT, "a sixth"), (DEFAULT, "half"), (PAPERS, "a sixth")):
            rows.add(f"size ratio {size:g}", of_ratio(size), law, part)
    for value in STIFFNESSES:
        rows.add(f"stiffness {value:g} N/m", of_ratio(SIZES[0]), DEFAULT, "a sixth", FEW, value)
    many = packed(1.2, MANY, SOLID)
    rows.add(f"{MANY} grains", many, DEFAULT, "a sixth", FEW, of_steps=OF_MANY)
    rows.add(f"{MANY} grains", many, PAPERS, "a sixth", FEW, of_steps=OF_MANY)
    draw_sizes(rows.found)
    return rows.table

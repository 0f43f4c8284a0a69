# SPDX-License-Identifier: GPL-3.0-or-later
"""Where each coupling is stable, over time step and viscosity: doc/figures/stability_regions.png and a
table of the longest stable step."""
import sys

from matplotlib.colors import ListedColormap

from packings import POST, STIFFNESS, time_step, write_csv
from samples import SCENE, growth, sample
from tables import FIGURES, Table

sys.path.insert(0, str(SCENE.parent / "common"))
from plotting import plt, save_figure  # noqa: E402

COUPLINGS = ["explicit", "staged", "implicit"]
VISCOSITIES = [10.0**k for k in range(-1, 5)]  # Pa s
TIME_STEPS = [1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 2e-4, 4e-4, 6e-4, 8e-4]  # s
STEPS = 500


def limits_of(data):
    """Limits of the coupling at 1 Pa s and of the contacts, s."""
    lines = (SCENE / data).read_text().split("Atoms")[1].split("Velocities")[0].split("\n")
    write_csv(POST / "regions.csv", [[float(words[k]) for k in (4, 5, 6)] + [0.5 * float(words[2])]
                                     for words in (line.split() for line in lines) if words])
    report, _ = time_step(POST / "regions.csv", "--spheres", 1, "--contact-stiffness", STIFFNESS)
    return report["coupling_limit"], report["contact_limit"]


def is_stable(data, coupling, viscosity, step):
    words = "time_step_check no" if coupling == "explicit" else f"coupling {coupling}"
    return growth(data, viscosity, step, STEPS, words) <= 1.0


def table():
    data = sample("dense")
    coupling_limit, contact_limit = limits_of(data)
    found = {coupling: [[is_stable(data, coupling, viscosity, step) for viscosity in VISCOSITIES]
                        for step in TIME_STEPS] for coupling in COUPLINGS}
    rows = Table("viscosity, Pa s", *(f"{coupling}, longest stable step, s" for coupling in COUPLINGS))
    for column, viscosity in enumerate(VISCOSITIES):
        longest = []
        for coupling in COUPLINGS:
            stable = [step for step, row in zip(TIME_STEPS, found[coupling]) if row[column]]
            longest.append(f"{max(stable):g}" if stable else f"below {TIME_STEPS[0]:g}")
        rows.row(f"{viscosity:g}", *longest)
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), sharey=True)
    for axis, coupling in zip(axes, COUPLINGS):
        axis.pcolormesh(VISCOSITIES, TIME_STEPS, found[coupling], shading="nearest", vmin=0, vmax=1,
                        cmap=ListedColormap(["#d9705f", "#8fc98b"]))
        axis.plot(VISCOSITIES, [coupling_limit / viscosity for viscosity in VISCOSITIES], "k-",
                  label="printed limit")
        axis.axhline(contact_limit, color="black", ls=":", label="contacts, 2/omega_max")
        axis.set(xscale="log", yscale="log", ylim=(TIME_STEPS[0], 2 * TIME_STEPS[-1]), title=coupling,
                 xlabel="viscosity, Pa s")
        axis.legend(fontsize=7)
    axes[0].set(ylabel="time step, s")
    save_figure(figure, FIGURES / "stability_regions.png")
    return rows

# SPDX-License-Identifier: GPL-3.0-or-later
"""Stress and strain of single grains at a tenth of the consolidation (thesis figs. 4.17 and 4.18), from the files of
grains that the fix has written: of the contacts by eq. 2.18, of the neighbourhood by eqs. 2.20 and 2.21."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))
import numpy as np

import fields
import terzaghi
from contact_stress import share_below
from plotting import plt, save_figure

AT, APART = 0.1, 0.03  # T_v, and by how much a file may miss it


class Grains:
    """Of one file: height, radius, vertical strain and V sigma', compression positive."""

    def __init__(self, path):
        found = fields.Fields(path)
        order = np.argsort(found["id"])
        self.place, self.radius = found.points[order], found["radius"][order]
        self.volume = 4.0 / 3.0 * np.pi * self.radius**3
        self.strain = -found["strain"][order, 2]
        self.moment = -found["contact_stress"][order, 2] * self.volume


def files_of(run):
    """The last file before the load and the one nearest to T_v = 0.1, with its T_v; None where there is no such."""
    path = run.base.with_name(run.base.name + ".pvd")
    if not run.figures["FIELDS"] or not path.exists():
        return None
    f = run.figures
    loaded = (f["rest_to"] - f["step"]) * f["time_step"]  # flow time
    times = [((time - loaded) / f["unit"], grains) for time, _, grains in fields.collection(path)]
    before = [grains for T, grains in times if T < 1e-9]
    T, grains = min(times, key=lambda one: abs(one[0] - AT))
    return (before[-1], grains, T) if before and abs(T - AT) < APART else None


def measure(run):
    """Profiles over slices one grain high, and what single grains scatter; None where files are wanting."""
    files = files_of(run)
    if not files:
        return None
    before, after, T = Grains(files[0]), Grains(files[1]), files[2]
    f, height = run.figures, run.rest_height
    edges = np.linspace(0.0, height, round(height / (1.1e-2 * (1000 / f["N"]) ** (1 / 3))) + 1)
    below = np.array([share_below(before.place[:, 2], before.radius, edge) for edge in edges])
    below[0], below[-1] = 0.0, 1.0
    share = np.diff(below, axis=0)
    area = height**2  # a cube
    stress = share @ (after.moment - before.moment) / (np.diff(edges) * area) / run.load
    strains = (after.strain - before.strain) * f["E_oed"] / run.load  # 1: that of the load
    strain = share @ (before.volume * strains) / (share @ before.volume)
    heights = (edges[1:] + edges[:-1]) / 2 / height
    p, _ = run.at(T)
    pressure = np.interp(heights, run.heights, p)
    inside = slice(1, -1)  # tetrahedra at the plates have walls for corners
    slope = float(stress[inside] @ strain[inside] / (strain[inside] @ strain[inside]))
    mean = np.interp(before.place[:, 2] / height, heights, strain)
    return {"T_v": T, "height": heights, "stress": stress, "strain": strain, "pressure": pressure, "slope": slope,
            "stress_rms": rms(stress[inside] - (1 - terzaghi.pressure(heights, T)[0])[inside]),
            "strain_rms": rms(strain[inside] - (1 - terzaghi.pressure(heights, T)[0])[inside]),
            "correlation": float(np.corrcoef(stress[inside], strain[inside])[0, 1]),
            "fluctuation": rms(strains - mean), "grains": (before.place, strains)}


def rms(values):
    return float(np.sqrt(np.mean(np.asarray(values)**2)))


def draw(run, found, path):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.5))
    z = np.linspace(0, 1, 101)
    exact = terzaghi.pressure(z, found["T_v"])[0]
    for values, label in ((found["pressure"], "p / load"), (found["stress"], "σ' / load (eq. 2.18)"),
                          (found["strain"], "ε E_oed / load (eq. 2.21)")):
        left.plot(values, found["height"], "o-", ms=4, label=label)
    left.plot(exact, z, "k--", lw=1, label="Terzaghi")
    left.plot(1 - exact, z, "k--", lw=1)
    left.set(ylabel="z / H", title=f"T_v = {found['T_v']:.3f}")
    left.legend(fontsize=8)
    percent = 100 * run.load / run.figures["E_oed"]
    middle.plot(percent * found["strain"], found["stress"] * run.load / 1e3, "o", label="slices")
    most = np.array([0.0, max(found["strain"].max(), found["stress"].max())])
    middle.plot(percent * most, most * run.load / 1e3, "k--", lw=1, label="E_oed of the dry test")
    middle.set(xlabel="ε, %", ylabel="σ', kPa")
    middle.legend(fontsize=8)
    place, strains = found["grains"]
    near = abs(place[:, 1] - place[:, 1].mean()) < 0.015
    dots = right.scatter(1e3 * place[near, 0], 1e3 * place[near, 2], c=strains[near], s=30e3 / len(place) + 10,
                         cmap="viridis", vmin=0, vmax=1.2)
    figure.colorbar(dots, ax=right, label="ε E_oed / load")
    right.set(xlabel="x, mm", ylabel="z, mm", aspect="equal", title="grains in the middle, y within 15 mm")
    save_figure(figure, path, dpi=100)


def report(run):
    """Table and figure, where the run has files for them; its figures."""
    found = measure(run)
    if not found:
        return {}
    draw(run, found, run.base.with_name(run.base.name + "_micro.png"))
    print(f"\n  single grains at T_v = {found['T_v']:.3f}, slices without the two at the plates:")
    print(f"  σ' of contacts from Terzaghi, rms of the load          {found['stress_rms']:8.4f}")
    print(f"  ε E_oed of tetrahedra from Terzaghi, rms of the load   {found['strain_rms']:8.4f}")
    print(f"  σ' over ε: slope / E_oed, correlation                  {found['slope']:8.4f} {found['correlation']:8.4f}")
    print(f"  ε of single grains from their slice's, rms, E_oed/load {found['fluctuation']:8.4f}")
    return {"micro": {key: value.tolist() if isinstance(value, np.ndarray) else value
                      for key, value in found.items() if key != "grains"}}

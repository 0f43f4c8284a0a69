#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables and figures of doc/pore_scale.md, from its text in doc/pore_scale.in.md:  doc/pore_scale.py [BUILD]

The radii of all facets of two beds, and the pressures of the pores at points where finite elements were asked for them.
A few seconds; needs the Python module.
"""
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
sys.path.insert(0, str(BUILD / "python"))
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pfv

DATA = ROOT / "tests/data"
BEDS = {"bed_200": "200 spheres, gaps of 2 % and more", "packing_500": "500 spheres of a DEM run, overlaps of 3 %"}
LAWS = {"hydraulic_radius": "hydraulic radius", "open_throat": "open throat"}


def bed(name):
    rows = np.genfromtxt(DATA / f"{name}.csv", delimiter=",", names=True)
    return np.column_stack([rows[k] for k in "xyz"]), rows["radius"]


def flow_through(name, wall, law):
    """Between faces at 1 and 0 Pa along z."""
    box = pfv.Box([[0, 1]] * 3, wall=wall)
    box.face("zlo", pressure=1.0).face("zhi", pressure=0.0)
    flow = pfv.Flow(box, pfv.Fluid(viscosity=1.0), conductance=law)
    flow.evaluate(*bed(name))
    return flow


# ---------------------------------------------------------------------------------------- throats

def fluid_area(places, radii):
    """Of a triangle of centres, without the spheres' discs: sectors at its corners, less what lies beyond the side."""
    area = 0.5 * np.linalg.norm(np.cross(places[1] - places[0], places[2] - places[0]))
    left = area
    for i in range(3):
        one, other = places[(i + 1) % 3] - places[i], places[(i + 2) % 3] - places[i]
        left -= 0.5 * radii[i]**2 * np.arccos(one @ other / np.linalg.norm(one) / np.linalg.norm(other))
        height = 2 * area / np.linalg.norm(other - one)
        if height < radii[i]:
            left += radii[i]**2 * np.arccos(height / radii[i]) - height * np.sqrt(radii[i]**2 - height**2)
    return left


def radii_of_facets(name):
    """R_h and R_eff (m) and fluid area (m2) of each facet between three spheres: from the conductances of both laws,
    g = A R_h^2 / (2 mu) and g = 2 pi R_eff^4 / mu (Chareyre et al. 2012, eqs. 7-10)."""
    places, radii = bed(name)
    flow = flow_through(name, "no_slip", "hydraulic_radius")
    effective = flow_through(name, "no_slip", "effective_radius").throat_conductances()
    hydraulic, net = flow.throat_conductances(), flow.network()
    throat = {tuple(sorted(pores)): t for t, pores in enumerate(net.throat_pores)}
    found = []
    for cell, (corners, neighbours) in enumerate(zip(net.cell_vertices, net.cell_neighbours)):
        for opposite, other in enumerate(neighbours):
            facet = np.delete(corners, opposite)
            if other < cell or facet.min() < 0:
                continue
            pores = net.cell_pore[cell], net.cell_pore[other]
            spheres, t = net.vertex_sphere[facet], throat[tuple(sorted(pores))]
            length = np.linalg.norm(net.pore_centres[pores[0]] - net.pore_centres[pores[1]])
            area = fluid_area(places[spheres], radii[spheres])
            if area > 0 and min(hydraulic[t], effective[t]) > 0:
                found.append((np.sqrt(2 * hydraulic[t] * length / area),
                              (effective[t] * length / (2 * np.pi))**0.25, area))
    return np.array(found).T


def throat_table(path):
    lines = ["| packing | facets | R_h / R_eff, mean | median | 5 %, 95 % | mean R_h / mean R_eff | correlation | "
             "R_eff > R_h |",
             "|--|--|--|--|--|--|--|--|"]
    figure, axes = plt.subplots(1, len(BEDS), figsize=(10, 4.5))
    narrow = math.nan
    for place, (name, what) in zip(axes, BEDS.items()):
        hydraulic, effective, area = radii_of_facets(name)
        ratio, size = hydraulic / effective, bed(name)[1].mean()
        if (ratio < 1).any():
            narrow = np.median(area[ratio < 1]) / np.median(area)
        low, high = np.percentile(ratio, (5, 95))
        lines.append(f"| {what} | {len(ratio)} | {ratio.mean():.2f} | {np.median(ratio):.2f} | {low:.2f}, {high:.2f} | "
                     f"{hydraulic.mean() / effective.mean():.2f} | {np.corrcoef(hydraulic, effective)[0, 1]:.2f} | "
                     f"{100 * (ratio < 1).mean():.1f} % |")
        place.plot(hydraulic / size, effective / size, ".", ms=2)
        most = 1.02 * max(hydraulic.max(), effective.max()) / size
        place.plot([0, most], [0, most], "k--", lw=1, label="R_eff = R_h")
        place.set(xlabel="R_h / mean radius", ylabel="R_eff / mean radius", xlim=(0, most), ylim=(0, most), title=what)
        place.legend(fontsize=8)
    save(figure, path)
    return "\n".join(lines), f"{100 * narrow:.0f} %"


# -------------------------------------------------------------------------------------- pressures

def points(name):
    return np.genfromtxt(DATA / f"stokes_{name}_points.csv", delimiter=",", names=True)


def of_pores(name, law, places):
    """Pressures of the pores at the places."""
    return flow_through(name, "symmetry", law).pressure_at(places)


def pressure_rows(name, found):
    places = np.column_stack([found[k] for k in "xyz"])
    exact, linear = found["pressure"], 1.0 - found["z"]
    rows = []
    for law, what in LAWS.items():
        pores = of_pores(name, law, places)
        apart = pores - exact
        rows.append(f"| {what} | {error_cells(apart)} | {np.corrcoef(pores - linear, exact - linear)[0, 1]:.3f} |")
    return [*rows, f"| straight from face to face | {error_cells(linear - exact)} | |"]


def error_cells(apart):
    return f"{100 * rms(apart):.2f} % | {100 * apart.mean():+.2f} % | {100 * np.quantile(abs(apart), 0.95):.1f} %"


def spread_within_pores(name, found):
    """Part of the variance of the finite elements' pressure that the mean of each pore does not hold; the best that a
    pressure a pore can do."""
    places = np.column_stack([found[k] for k in "xyz"])
    pores = of_pores(name, "hydraulic_radius", places)
    _, pore = np.unique(pores, return_inverse=True)
    mean = np.bincount(pore, found["pressure"]) / np.bincount(pore)
    return rms(found["pressure"] - mean[pore]), len(mean)


def gradients(found, places, radii):
    """Where the finite elements have their gradients: mean of |grad p| in the narrowest and widest thirds of the room,
    by the distance to the second nearest sphere."""
    spots = np.column_stack([found[k] for k in "xyz"])
    apart = np.sort(np.linalg.norm(spots[:, None] - places, axis=2) - radii, axis=1)
    order = np.argsort(apart[:, 1])
    thirds = np.array_split(found["gradient"][order], 3)
    return [float(third.mean()) for third in thirds]


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def draw_pressures(name, found, path):
    on_plane = found["x"] == 0.5
    places = np.column_stack([found[k] for k in "xyz"])[on_plane]
    pores = of_pores(name, "hydraulic_radius", places)
    centres, radii = bed(name)
    figure, axes = plt.subplots(1, 3, figsize=(14, 4.6), sharey=True)
    for place, values, title in ((axes[0], found["pressure"][on_plane], "finite elements"), (axes[1], pores, "pores")):
        dots = place.scatter(places[:, 1], places[:, 2], c=values, s=9, marker="s", vmin=0, vmax=1,
                             cmap=plt.get_cmap("viridis", 20))
        place.set(title=f"p, {title}", xlabel="y", aspect="equal", xlim=(0, 1), ylim=(0, 1))
        figure.colorbar(dots, ax=place)
    steep = axes[2].scatter(places[:, 1], places[:, 2], c=found["gradient"][on_plane], s=9, marker="s", cmap="magma",
                            vmin=0, vmax=np.quantile(found["gradient"], 0.99))
    axes[2].set(title="|∇p|, finite elements", xlabel="y", aspect="equal")
    figure.colorbar(steep, ax=axes[2])
    axes[0].set(ylabel="z")
    for place in axes:
        for centre, radius in zip(centres, radii):
            if abs(centre[0] - 0.5) < radius:
                cut = np.sqrt(radius**2 - (centre[0] - 0.5)**2)
                place.add_patch(plt.Circle(centre[1:], cut, color="0.85", zorder=0))
    save(figure, path)


def pressure_table(name, path):
    found = points(name)
    draw_pressures(name, found, path)
    spread, pores = spread_within_pores(name, found)
    narrow, middle, wide = gradients(found, *bed(name))
    lines = ["| | difference, rms | mean | 95 % within | correlation of p - (1 - z) |", "|--|--|--|--|--|",
             *pressure_rows(name, found),
             f"| mean of the finite elements in each of {pores} pores | {100 * spread:.2f} % | 0 | | |"]
    return "\n".join(lines), f"{narrow:.2f}, {middle:.2f} and {wide:.2f} Pa/m"


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})
    plt.close(figure)


def main():
    figures = ROOT / "doc/figures"
    pressures, steep = pressure_table("bed_25", figures / "pore_scale_pressures.png")
    throats, narrow = throat_table(figures / "pore_scale_throats.png")
    text = (ROOT / "doc/pore_scale.in.md").read_text(encoding="utf-8")
    for name, value in {"throats": throats, "narrow": narrow, "pressures": pressures,
                        "points": str(len(points("bed_25"))), "gradients": steep}.items():
        text = text.replace("{{" + name + "}}", value)
    (ROOT / "doc/pore_scale.md").write_text(text, encoding="utf-8")


main()

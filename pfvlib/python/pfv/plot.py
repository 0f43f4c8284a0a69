# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of what fix pfv and pfv solve write, by matplotlib.

    python3 -m pfv.plot history.csv                      time series of a run (fix pfv ... history)
    python3 -m pfv.plot profile.csv sensors.csv          pressures over the height, at places
    python3 -m pfv.plot forces.csv --packing grains.csv  forces on grains (pfv solve --forces)
    python3 -m pfv.plot pores.vtu                        slices of pressure (pfv solve --vtk, fix pfv ... output)

What a file holds is told from its header. Each becomes a picture beside it (-o names another one). As a module:
`pfv.plot.figure(path)` returns matplotlib's figure. Nothing is computed here but what is drawn.
"""
import argparse
import io
import pathlib
import sys

import numpy as np

from . import read_packing
from ._errors import Error, InputError, lacking
from ._tables import Table

try:
    from matplotlib import colormaps
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import EllipseCollection
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
except ImportError as missing:
    lacking(__name__, "pfv.plot draws with matplotlib: install python3-matplotlib", missing)

_PANEL = (7.5, 2.1)  # inches


class NotebookFigure(Figure):
    """matplotlib's Figure, which a notebook shows as the last value of a cell although pyplot does not know of it."""

    def _repr_png_(self):
        picture = io.BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()


def _figure(width, height):
    figure = NotebookFigure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _name_lines(axes):
    """Beside the axes, where no line is."""
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), fontsize="small", frameon=False, borderaxespad=0)


# -------------------------------------------------------------------------------------------- history

def _along(table, name):
    """The component of a face's force that is largest over the run."""
    return max("xyz", key=lambda axis: np.nanmax(np.abs(table[f"{name}_force_{axis}"])))


def _panel_of_forces(table):
    lines = [(f"grains, {axis}", table[f"force_{axis}"]) for axis in "xyz"]
    lines += [(f"{name}, {_along(table, name)}", table[f"{name}_force_{_along(table, name)}"])
              for name in table.ending_in("_force_x")]
    largest = max(np.nanmax(np.abs(values)) for _, values in lines)
    return "force of the fluid, N", [line for line in lines if np.nanmax(np.abs(line[1])) > 1e-3 * largest]


def _panel_of_fluxes(table):
    """Into the box; outflow below zero."""
    lines = [(name, table[f"{name}_flux"]) for name in table.ending_in("_flux") if table.has_values(f"{name}_flux")]
    lines += [(name, table[f"{name} flux"]) for name in table.ending_in(" flux")]
    if table.has_values("volume_rate_sum"):
        lines.append(("rate of the pores", table["volume_rate_sum"]))
    largest = max([np.nanmax(np.abs(values)) for _, values in lines], default=0)
    return "flux into the box, m³/s", [line for line in lines if np.nanmax(np.abs(line[1])) > 1e-3 * largest]


def _panel_of_motion(table):
    moved = [(f"{name} moved", table[f"{name}_position"] - table[f"{name}_position"][0])
             for name in table.ending_in("_position")]
    return "displacement, m", [line for line in moved if np.any(line[1] != 0)]


def _panel_of_pressures(table):
    lines = [("mean", table["mean_pressure"])]
    lines += [(name, table[f"{name} pressure"]) for name in table.ending_in(" pressure")]
    return "pressure, Pa", lines


def _panels(table):
    """[(label of the axis, [(name, values)], logarithmic)] of what the run has."""
    panels = [(*_panel_of_pressures(table), False), (*_panel_of_fluxes(table), False),
              (*_panel_of_forces(table), False), (*_panel_of_motion(table), False),
              *((label, [(name, table[name])] if table.has_values(name) else [], False) for label, name in
                (("pore strain", "strain"), ("porosity", "porosity"), ("permeability, m²", "permeability"))),
              ("balance errors", [(name.replace("_error", "").replace("_", " "), np.abs(table[name])) for name in
                                  ("mass_error", "force_balance_error", "fluid_balance_error")
                                  if table.has_values(name)], True),
              ("count", [("solves made", table["solves"]), ("solves saved", table["steps"] - table["solves"]),
                         ("networks", table["networks"])], False)]
    return [panel for panel in panels if panel[1]]


def history_figure(path):
    """Time series of a history file: a panel for each kind of quantity that the run has."""
    table = Table(path)
    panels = _panels(table)
    figure = _figure(_PANEL[0], _PANEL[1] * len(panels) + 0.4)
    all_axes = np.atleast_1d(figure.subplots(len(panels), sharex=True))
    for axes, (label, lines, logarithmic) in zip(all_axes, panels):
        for name, values in lines:
            axes.plot(table["time"], np.where(values > 0, values, np.nan) if logarithmic else values, label=name,
                      lw=1.2, marker="." if len(values) < 40 else None)
        axes.set_ylabel(label, fontsize="small")
        axes.tick_params(labelsize="small")
        if logarithmic:
            axes.set_yscale("log")
        else:
            axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useMathText=True)
        axes.grid(alpha=0.3)
        _name_lines(axes)
    all_axes[-1].set_xlabel("time, s")
    figure.align_ylabels()
    return figure


# --------------------------------------------------------------------------- profiles and sensors

def profile_figure(path, most_lines=9):
    """Rows of a profile or flux_profile at times spread over the run."""
    table = Table(path)
    heights = np.array([float(name) for name in table.names[1:]])
    rows = np.column_stack([table[name] for name in table.names[1:]])
    shown = np.unique(np.linspace(0, len(rows) - 1, most_lines).round().astype(int))
    figure = _figure(6.5, 4.2)
    axes = figure.subplots()
    for row, colour in zip(shown, colormaps["viridis"](np.linspace(0, 0.95, len(shown)))):
        axes.plot(rows[row], heights, color=colour, marker=".", label=f"{table['time'][row]:.4g} s")
    axes.set(xlabel="value on the plane (pressure, Pa; flux, m³/s)", ylabel="place across the box, part of its edge",
             ylim=(0, 1))
    axes.grid(alpha=0.3)
    _name_lines(axes)
    return figure


def sensors_figure(path):
    """The pressure at each place over time."""
    table = Table(path)
    figure = _figure(7.5, 3.6)
    axes = figure.subplots()
    for name in table.names[1:]:
        axes.plot(table["time"], table[name], label=name.replace(" ", ", "), lw=1.2)
    axes.set(xlabel="time, s", ylabel="pressure, Pa")
    axes.grid(alpha=0.3)
    _name_lines(axes)
    axes.get_legend().set_title("x, y, z, m", prop={"size": "small"})
    return figure


# --------------------------------------------------------------------------------------------- forces

def _circles(axes, places, radii, values, norm, label, figure):
    circles = EllipseCollection(2 * radii, 2 * radii, np.zeros_like(radii), units="xy", offsets=places,
                                offset_transform=axes.transData, array=values, norm=norm, cmap="viridis",
                                edgecolors="none")
    axes.add_collection(circles)
    axes.set_aspect("equal")
    axes.set(xlim=(np.min(places[:, 0] - radii), np.max(places[:, 0] + radii)),
             ylim=(np.min(places[:, 1] - radii), np.max(places[:, 1] + radii)))
    if label:
        figure.colorbar(circles, ax=axes, label=label, shrink=0.85)


def _forces_in_space(table, packing, figure):
    place = {number: row for row, number in enumerate(packing.ids)}
    unknown = [int(number) for number in table["id"] if int(number) not in place]
    if unknown:
        raise InputError(f"{table.path}: the packing has no sphere {unknown[0]}: give the packing that was solved")
    rows = [place[int(number)] for number in table["id"]]
    x, r = np.array(packing.positions)[rows], np.array(packing.radii)[rows]
    total = np.column_stack([table[name] for name in ("fx", "fy", "fz")])
    size = np.linalg.norm(total, axis=1)
    left, right = figure.subplots(1, 2)
    for axis, name in enumerate("xyz"):
        left.plot(total[:, axis], x[:, 2], ".", ms=3, label=f"f{name}")
    left.set(xlabel="force of the fluid, N", ylabel="z, m")
    left.grid(alpha=0.3)
    left.ticklabel_format(axis="x", style="sci", scilimits=(-3, 4), useMathText=True)
    left.legend(loc="upper center", bbox_to_anchor=(0.5, 1.1), ncols=3, fontsize="small", frameon=False,
                borderaxespad=0)
    middle = 0.5 * (x[:, 1].min() + x[:, 1].max())
    cut = np.abs(x[:, 1] - middle) < r
    section = np.sqrt(r[cut]**2 - (x[cut, 1] - middle)**2)
    _circles(right, x[cut][:, [0, 2]], section, size[cut], Normalize(0, size.max()), "|force|, N", figure)
    right.set(xlabel="x, m", ylabel="z, m")
    right.set_title(f"spheres cut at y = {middle:.3g} m", fontsize="small")


def forces_figure(path, packing=None):
    """Forces on spheres: over the height and on a section where the packing is given, else their parts."""
    table = Table(path)
    figure = _figure(10, 4.4) if packing else _figure(5.5, 4.4)
    if packing:
        _forces_in_space(table, read_packing(packing), figure)
        return figure
    axes = figure.subplots()
    for name in "xyz":
        axes.plot(table[f"fp{name}"], table[f"fv{name}"], ".", ms=3, label=f"along {name}")
    axes.set(xlabel="pressure part, N", ylabel="viscous part, N")
    axes.ticklabel_format(style="sci", scilimits=(-3, 4), useMathText=True)
    axes.grid(alpha=0.3)
    _name_lines(axes)
    return figure


# ---------------------------------------------------------------------------------------------- pores

def pores_figure(path):
    """Pressure in the pores of three slices through the middle, each a tenth of the room thick."""
    from ._vtu import Grid
    grid = Grid(path)
    points, pressure = grid.points, grid.array("pressure")
    lower, upper = points.min(axis=0), points.max(axis=0)
    norm = Normalize(pressure.min(), pressure.max())
    figure = _figure(12, 4)
    for axes, axis in zip(figure.subplots(1, 3), range(3)):
        across, up = [k for k in range(3) if k != axis]
        middle = 0.5 * (lower[axis] + upper[axis])
        near = np.abs(points[:, axis] - middle) < 0.05 * (upper[axis] - lower[axis])
        dots = axes.scatter(points[near, across], points[near, up], c=pressure[near], norm=norm, s=12, cmap="coolwarm")
        axes.set_aspect("equal")
        axes.set(xlabel=f"{'xyz'[across]}, m", ylabel=f"{'xyz'[up]}, m")
        axes.set_title(f"{'xyz'[axis]} = {middle:.3g} m", fontsize="small")
    figure.colorbar(dots, ax=figure.axes, label="pressure in the pores, Pa", shrink=0.85)
    return figure


# ---------------------------------------------------------------------------------------- any of them

def _is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True


def _is_place(word):
    return len(word.split()) == 3 and all(map(_is_number, word.split()))


def figure(path, packing=None):
    """The figure of a file by its header. `packing`: of a forces file, any that read_packing takes.

    Returns matplotlib's Figure. Raises InputError for a file that is none of those that are drawn."""
    path = pathlib.Path(path)
    if path.suffix == ".vtu":
        return pores_figure(path)
    names = Table(path).names
    if {"step", "time", "mass_error"} <= set(names):
        return history_figure(path)
    if names[:2] == ["id", "fx"]:
        return forces_figure(path, packing)
    if names[0] == "time" and len(names) > 1 and all(map(_is_number, names[1:])):
        return profile_figure(path)
    if names[0] == "time" and len(names) > 1 and all(map(_is_place, names[1:])):
        return sensors_figure(path)
    raise InputError(f"{path}: is no history, profile, sensors or forces file: its columns are {', '.join(names[:6])}")


def main(words=None):
    parser = argparse.ArgumentParser("python3 -m pfv.plot", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--packing", help="of a forces file: the spheres, in any format that pfv solve reads")
    parser.add_argument("-o", "--output", help="the picture (.png, .pdf, .svg); with one FILE (default: FILE with .png)")
    parser.add_argument("--dpi", type=int, default=110)
    asked = parser.parse_args(words)
    if asked.output and len(asked.files) > 1:
        parser.error("-o names one picture, and there are several files")
    try:
        for file in asked.files:
            picture = pathlib.Path(asked.output or pathlib.Path(file).with_suffix(".png"))
            drawn = figure(file, asked.packing)
            drawn.savefig(picture, dpi=asked.dpi)
            print(picture)
    except (Error, ImportError, OSError, ValueError) as problem:
        print(f"pfv.plot: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

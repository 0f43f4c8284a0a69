# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of fields that fix pfv and pfv solve have written, by VTK, also without a screen (xvfb).

    python3 -m pfv.render flow_grains_100.vtu --color force      grains by force, pressure, displacement, velocity, ...
    python3 -m pfv.render flow_pores_100.vtu --slice y=0.05       a slice of pressure (--grains FILE.vtu: with grains)
    python3 -m pfv.render flow_pores_100.vtu --throats            throats by flux
    python3 -m pfv.render flow.pvd -o run.gif                     an animation; with --slice and --throats, too

As a module: `pfv.render.figure(path, ...)` returns matplotlib's figure, `animation(path, picture, ...)` writes a .gif.
"""
import argparse
import pathlib
import sys

import numpy as np

from ._display import ensure_screen
from ._errors import Error, InputError, lacking

try:
    from ._vtu import Grid, collection
except ImportError as missing:
    lacking(__name__, str(missing), missing)
try:
    from matplotlib import colormaps
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.figure import Figure
except ImportError as missing:
    lacking(__name__, "pfv.render writes its pictures with matplotlib: install python3-matplotlib", missing)

from .plot import NotebookFigure

# what each module is for: glyphs, tubes, cutting, interpolating; the last three register themselves
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkGlyph3D, vtkTubeFilter
from vtkmodules.vtkFiltersPoints import vtkPointInterpolator, vtkVoronoiKernel
from vtkmodules.vtkFiltersSources import vtkOutlineSource, vtkPlaneSource, vtkRegularPolygonSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)
import vtkmodules.vtkInteractionStyle  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

UNITS = {"force": "N", "pressure": "Pa", "displacement": "m", "velocity": "m/s", "fluid_velocity": "m/s", "radius": "m",
         "flux": "m³/s", **{f"{name}_stress{end}": "Pa" for name in ("fluid", "contact", "inertial")
                            for end in ("", "_deviator")}}
_PIXELS = (900, 750)


# -------------------------------------------------------------------------------------- pieces of VTK

def _lookup(norm, name):
    table = vtkLookupTable()
    colours = colormaps[name](np.linspace(0, 1, 256))
    table.SetNumberOfTableValues(256)
    for k, colour in enumerate(colours):
        table.SetTableValue(k, *colour)
    low, high = norm.vmin, norm.vmax
    table.SetTableRange(low, high if high > low else low + (abs(low) or 1.0))
    if isinstance(norm, LogNorm):
        table.SetScaleToLog10()
    return table


def _vtk_array(values, name):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    return array


def _points(places, **arrays):
    data, points = vtkPolyData(), vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(_vtk_array(places, "places"))
    data.SetPoints(points)
    for name, values in arrays.items():
        data.GetPointData().AddArray(_vtk_array(values, name))
    return data


def _actor(filter, norm=None, colormap=None, field=None, colour=None):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(filter.GetOutputPort())
    if field:
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(field)
        mapper.SetLookupTable(_lookup(norm, colormap))
        mapper.UseLookupTableScalarRangeOn()
    else:
        mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    if colour:
        actor.GetProperty().SetColor(*colour)
    return actor


def _glyphs(data, source, scale):
    """One copy of the source for each point, as large as the field `scale` says."""
    data.GetPointData().SetActiveScalars(scale)
    glyph = vtkGlyph3D()
    glyph.SetInputData(data)
    glyph.SetSourceConnection(source.GetOutputPort())
    glyph.SetScaleModeToScaleByScalar()
    glyph.ScalingOn()
    return glyph


def _outline(lower, upper):
    source = vtkOutlineSource()
    source.SetBounds([bound for pair in zip(lower, upper) for bound in pair])
    return _actor(source, colour=(0.3, 0.3, 0.3))


# ------------------------------------------------------------------------------- what can be shown

def size_of(values):
    """Of vectors their length; of numbers themselves."""
    return values if values.ndim == 1 else np.linalg.norm(values, axis=1)


def _spheres(grid, values, norm, colormap):
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(20)
    source.SetPhiResolution(14)
    data = _points(grid.points, radius=grid.array("radius"), value=values)
    return [_actor(_glyphs(data, source, "radius"), norm, colormap, "value")]


def _throat_lines(grid):
    """(ends, |flux|) of the throats."""
    flux, grid = grid.cell_array("flux"), grid.grid
    nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    pores = grid.GetNumberOfPoints()
    return nodes[pores:].reshape(-1, 2), np.abs(flux[pores:])


def _tubes(grid, values, norm, colormap):
    ends, _ = _throat_lines(grid)
    shown = values > norm.vmin
    places = grid.points[ends[shown]].reshape(-1, 3)
    width = 0.004 * np.ptp(grid.points, axis=0).max() * np.sqrt(values[shown] / norm.vmax)
    data = _points(places, value=np.repeat(values[shown], 2), width=np.repeat(np.maximum(width, 0.08 * width.max()), 2))
    data.GetPointData().SetActiveScalars("width")
    lines = vtkCellArray()
    for k in range(shown.sum()):
        lines.InsertNextCell(2, (2 * k, 2 * k + 1))
    data.SetLines(lines)
    tube = vtkTubeFilter()
    tube.SetInputData(data)
    tube.SetNumberOfSides(6)
    tube.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    return [_actor(tube, norm, colormap, "value")]


def _plane(lower, upper, axis, place):
    across, up = [(1, 2), (0, 2), (0, 1)][axis]
    origin, one, two = (np.array(lower, dtype=float) for _ in range(3))
    one[across], two[up] = upper[across], upper[up]
    for corner in (origin, one, two):
        corner[axis] = place
    source = vtkPlaneSource()
    source.SetOrigin(*origin)
    source.SetPoint1(*one)
    source.SetPoint2(*two)
    source.SetResolution(240, 240)
    return source


def _slice(grid, values, norm, colormap, cut, grains=None):
    """The pressure of the nearest pore at each place of a plane, and discs where it cuts grains."""
    axis, place = cut
    lower, upper = grid.points.min(axis=0), grid.points.max(axis=0)
    if not lower[axis] <= place <= upper[axis]:
        raise InputError(f"the slice {'xyz'[axis]}={place:g} is outside the pores, which reach from {lower[axis]:g} to "
                         f"{upper[axis]:g} m")
    interpolator = vtkPointInterpolator()
    plane = _plane(lower, upper, axis, place)
    interpolator.SetInputConnection(plane.GetOutputPort())
    interpolator.SetSourceData(_points(grid.points, value=values))
    interpolator.SetKernel(vtkVoronoiKernel())
    actors = [_actor(interpolator, norm, colormap, "value")]
    actors[0].GetProperty().LightingOff()
    if grains is not None:
        actors.append(_discs(grains, axis, place, 1e-3 * np.ptp(grid.points, axis=0).max()))
    return actors


def _discs(grains, axis, place, lift):
    """In front of the slice, on the side of the camera."""
    distance, radius = grains.points[:, axis] - place, grains.array("radius")
    cut = np.abs(distance) < radius
    places = grains.points[cut].copy()
    places[:, axis] = place + (-lift if axis == 1 else lift)
    source = vtkRegularPolygonSource()
    source.SetNumberOfSides(32)
    source.SetRadius(1.0)
    source.SetNormal(*np.eye(3)[axis])
    data = _points(places, radius=np.sqrt(radius[cut]**2 - distance[cut]**2))
    actor = _actor(_glyphs(data, source, "radius"), colour=(0.45, 0.45, 0.45))
    actor.GetProperty().LightingOff()
    return actor


# ----------------------------------------------------------------------------------------- the picture

def _shot(actors, lower, upper, cut=None):
    """The pixels of a view: from above and aside, or square onto a slice."""
    ensure_screen()
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.SetBackground(1, 1, 1)
    for actor in actors:
        renderer.AddActor(actor)
    if cut is None:
        renderer.AddActor(_outline(lower, upper))
    window.SetOffScreenRendering(1)
    window.SetSize(*_PIXELS)
    window.SetMultiSamples(8)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    middle = 0.5 * (lower + upper)
    from_where = np.array([0.9, -1.6, 0.8]) if cut is None else np.eye(3)[cut[0]] * (-1 if cut[0] == 1 else 1)
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + from_where * np.linalg.norm(upper - lower)))
    camera.SetViewUp(*([0, 1, 0] if cut and cut[0] == 2 else [0, 0, 1]))
    if cut is not None:
        camera.ParallelProjectionOn()
    renderer.ResetCamera([bound for pair in zip(lower, upper) for bound in pair])
    if cut is not None:
        camera.Zoom(1.25)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    width, height, _ = image.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)[::-1]
    window.Finalize()
    return pixels.copy()


def _without_margins(pixels):
    inked = (pixels < 250).any(axis=2)
    rows, columns = np.flatnonzero(inked.any(axis=1)), np.flatnonzero(inked.any(axis=0))
    return pixels[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1] if len(rows) else pixels


class _View:
    """What is drawn of a file: values, their colours and the actors."""

    def __init__(self, path, color=None, cut=None, throats=False, grains=None):
        self.grid, self.cut = Grid(path), cut
        self.grains = Grid(grains) if grains else None
        self.throats = throats
        if throats:
            self.name, self.values = "flux", _throat_lines(self.grid)[1]
        else:
            self.name = color or ("force" if self.grid.holds_spheres and "force" in self.grid.names() else
                                  "pressure" if "pressure" in self.grid.names() else "radius")
            self.values = size_of(self.grid.array(self.name))
        if not throats and not self.grid.holds_spheres and cut is None:
            middle = 0.5 * (self.grid.points[:, 1].min() + self.grid.points[:, 1].max())
            self.cut = (1, middle)

    def norm(self):
        if self.throats:
            largest = self.values.max() or 1.0
            return LogNorm(1e-3 * largest, largest)
        return Normalize(self.values.min(), self.values.max())

    @property
    def colormap(self):
        return "coolwarm" if self.name == "pressure" else "viridis"

    def bounds(self):
        reach = self.grid.array("radius")[:, None] if self.grid.holds_spheres else 0.0
        return (self.grid.points - reach).min(axis=0), (self.grid.points + reach).max(axis=0)

    def actors(self, norm):
        if self.throats:
            return _tubes(self.grid, self.values, norm, self.colormap)
        if self.grid.holds_spheres:
            if self.cut:
                raise InputError(f"{self.grid.path}: holds grains; a slice is one of the pores' file")
            return _spheres(self.grid, self.values, norm, self.colormap)
        return _slice(self.grid, self.values, norm, self.colormap, self.cut, self.grains)

    def label(self):
        name = {"flux": "|flux| of the throats"}.get(self.name, self.name.replace("_", " "))
        unit = UNITS.get(self.name)
        if not self.throats and self.grid.array(self.name).ndim > 1:
            name = f"|{name}|"
        return f"{name}, {unit}" if unit else name


def _figure_of(view, norm=None, bounds=None, title=None):
    norm = norm or view.norm()
    lower, upper = bounds or view.bounds()
    pixels = _shot(view.actors(norm), lower, upper, view.cut)
    figure = NotebookFigure(figsize=(8, 6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    axes.imshow(pixels if bounds else _without_margins(pixels))
    axes.set_axis_off()
    if view.cut:
        across, up = "xyz".replace("xyz"[view.cut[0]], "")
        axes.set_title(f"{'xyz'[view.cut[0]]} = {view.cut[1]:.4g} m, {across} to the right, {up} upward",
                       fontsize="medium", loc="left")
    if title:
        axes.set_title(title, fontsize="medium", loc="right")
    figure.colorbar(ScalarMappable(norm, view.colormap), ax=axes, label=view.label(), shrink=0.8)
    return figure


def figure(path, color=None, cut=None, throats=False, grains=None):
    """A picture of a .vtu file as matplotlib's Figure.

    Grains are coloured by the field `color` (default force; of vectors the length). Pores show as a slice of a field
    (default pressure), cut = (axis 0-2, place in m), through the middle along y where it is not given; `grains`, their
    .vtu, adds the discs in which the slice cuts them. throats: throats by the size of their flux, the thousandth part
    of the largest and more. Raises InputError, RuntimeError where there is no screen."""
    return _figure_of(_View(path, color, cut, throats, grains))


def animation(path, picture, color=None, cut=None, throats=False, frames=40):
    """The steps of a .pvd collection as a .gif, on one scale of colours: grains, or a slice or the throats of its pores.

    frames: at most so many steps, spread evenly. Returns the number of frames."""
    from matplotlib.animation import PillowWriter
    steps = collection(path)
    chosen = [steps[k] for k in np.unique(np.linspace(0, len(steps) - 1, min(frames, len(steps))).round().astype(int))]
    of_pores = throats or cut is not None
    views = [_View(fluid if of_pores else grains, color, cut, throats, grains if cut is not None else None)
             for _, fluid, grains, _ in chosen]
    norms, bounds = [view.norm() for view in views], [view.bounds() for view in views]
    norm = type(norms[0])(min(one.vmin for one in norms), max(one.vmax for one in norms))
    room = np.min([low for low, _ in bounds], axis=0), np.max([high for _, high in bounds], axis=0)
    pixels = [_frame(_figure_of(view, norm, room, f"{time:.4g} s")) for view, (time, *_) in zip(views, chosen)]
    sheet = Figure(figsize=(8, 6), frameon=False)
    FigureCanvasAgg(sheet)
    shown = sheet.figimage(pixels[0])
    writer = PillowWriter(fps=6)
    with writer.saving(sheet, picture, dpi=100):
        for one in pixels:
            shown.set_data(one)
            writer.grab_frame()
    return len(chosen)


def _frame(drawn):
    drawn.set_dpi(100)
    drawn.canvas.draw()
    return np.asarray(drawn.canvas.buffer_rgba()).copy()


def _cut_of(words):
    axis, equals, place = words.partition("=")
    try:
        if not equals or axis not in ("x", "y", "z"):
            raise ValueError
        return "xyz".index(axis), float(place)
    except ValueError:
        raise InputError(f"--slice {words} is no AXIS=PLACE, e.g. y=0.5") from None


def draw(asked):
    """Writes the picture that a command line asks for; what has been written, in words."""
    cut = _cut_of(asked.slice) if asked.slice else None
    animated = pathlib.Path(asked.file).suffix == ".pvd"
    picture = asked.output or str(pathlib.Path(asked.file).with_suffix(".gif" if animated else ".png"))
    if animated:
        if not picture.endswith(".gif"):
            raise InputError(f"-o {picture}: an animation is written as .gif")
        frames = animation(asked.file, picture, asked.color, cut, asked.throats, asked.frames)
        return f"{picture}, {frames} frames"
    figure(asked.file, asked.color, cut, asked.throats, asked.grains).savefig(picture, dpi=asked.dpi)
    return picture


def parser():
    parser = argparse.ArgumentParser("python3 -m pfv.render", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="FILE", help="a .vtu, or a .pvd for an animation")
    parser.add_argument("--color", metavar="FIELD", help="default: force of grains, pressure of pores")
    parser.add_argument("--slice", metavar="AXIS=PLACE", help="of pores, m (default: through the middle along y)")
    parser.add_argument("--throats", action="store_true", help="throats by flux")
    parser.add_argument("--grains", metavar="FILE.vtu", help="the grains that a slice cuts")
    parser.add_argument("--frames", type=int, default=40, help="most steps of an animation (default 40)")
    parser.add_argument("-o", "--output", help="the picture (default: FILE with .png, .gif)")
    parser.add_argument("--dpi", type=int, default=110)
    return parser


def main(words=None):
    try:
        print(draw(parser().parse_args(words)))
    except (Error, OSError, ValueError, RuntimeError) as problem:
        print(f"pfv.render: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

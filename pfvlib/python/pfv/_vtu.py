# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields that fix pfv and pfv solve write for ParaView, read by VTK."""
import os
import pathlib
import xml.etree.ElementTree as ElementTree

from ._errors import InputError

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    raise ImportError(".vtu files are read with VTK: install python3-vtk9") from missing


class Grid:
    """A .vtu file: `points` (N x 3), fields of points and of cells, VTK's own object in `grid`."""

    def __init__(self, path):
        self.path = str(path)
        try:
            with open(path, "rb") as file:
                known = b"<VTKFile" in file.read(2048)
        except OSError as problem:
            raise InputError(f"cannot read {path}: {problem.strerror}") from None
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(os.fspath(path))
        if known:
            reader.Update()
        self.grid = reader.GetOutput()
        if not known or reader.GetErrorCode() or not self.grid.GetNumberOfPoints():
            raise InputError(f"{path}: is no .vtu file with points: give one of `pfv solve --vtk` or `fix pfv ... output`; "
                             "`pfv convert` makes one of spheres in another format")
        self.points = vtk_to_numpy(self.grid.GetPoints().GetData())

    def names(self):
        data = self.grid.GetPointData()
        return [data.GetArrayName(k) for k in range(data.GetNumberOfArrays())]

    def array(self, name):
        """A field of the points."""
        if name not in self.names():
            raise InputError(f"{self.path}: has no field {name}: there are {', '.join(self.names()) or 'none'}")
        return vtk_to_numpy(self.grid.GetPointData().GetArray(name))

    def cell_array(self, name):
        array = self.grid.GetCellData().GetArray(name)
        if array is None:
            raise InputError(f"{self.path}: its cells have no field {name}")
        return vtk_to_numpy(array)

    @property
    def holds_spheres(self):
        return "radius" in self.names()


def collection(path):
    """[(time, file of the fluid, of the grains, of the walls or None)] of a .pvd, in order."""
    path, steps = pathlib.Path(path), {}
    try:
        entries = list(ElementTree.parse(path).getroot().iter("DataSet"))
        for entry in entries:
            files = steps.setdefault(float(entry.get("timestep")), [None, None, None])
            files[int(entry.get("part"))] = path.parent / entry.get("file")
    except (OSError, ElementTree.ParseError, TypeError, ValueError, IndexError) as problem:
        raise InputError(f"{path}: is no collection of fix pfv's output ({problem})") from None
    if not steps:
        raise InputError(f"{path}: lists no file")
    return [(time, *files) for time, files in sorted(steps.items())]

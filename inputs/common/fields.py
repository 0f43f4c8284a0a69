# SPDX-License-Identifier: GPL-3.0-or-later
"""The .vtu and .pvd files of fix pfv and pfv solve, read with VTK's own reader."""
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


class Fields:
    """Points and their arrays; `ends` are the two pores of each throat, `flux` its flow rate;
    `cells` are the arrays of the cells."""

    def __init__(self, path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        if reader.GetErrorCode():
            raise OSError(f"{path}: VTK cannot read it")
        grid = reader.GetOutput()
        self.points = vtk_to_numpy(grid.GetPoints().GetData())
        self.arrays, self.cells = ({data.GetArrayName(k): vtk_to_numpy(data.GetArray(k))
                                    for k in range(data.GetNumberOfArrays())}
                                   for data in (grid.GetPointData(), grid.GetCellData()))
        flux = grid.GetCellData().GetArray("flux")
        if flux:
            nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
            self.ends = nodes[len(self.points):].reshape(-1, 2)
            self.flux = vtk_to_numpy(flux)[len(self.points):]

    def __getitem__(self, name):
        return self.arrays[name]

    def imposed(self):
        """Which pores have an imposed pressure, in a flow without moving grains: what their throats
        carry does not add up to zero."""
        net = np.zeros(len(self.points))
        np.add.at(net, self.ends[:, 0], self.flux)
        np.add.at(net, self.ends[:, 1], -self.flux)
        return abs(net) > 1e-8 * abs(self.flux).max()

    def plane_flux(self, axis, position, counted=None):
        """Flow rate through a plane, positive along the axis: of the throats between pores on
        either side (of those that are counted), so that it is conserved from plane to plane."""
        place = self.points[:, axis][self.ends]
        crossing = (place[:, 1] > position).astype(float) - (place[:, 0] > position)
        return float((self.flux * crossing)[slice(None) if counted is None else counted].sum())

    def darcy_velocity(self, edges, volume):
        """Mean flux vectors (m/s) in blocks: edges along each axis; each throat carries its flow
        along its line and belongs to the block of its middle. Shape: blocks x 3."""
        start, end = self.points[self.ends[:, 0]], self.points[self.ends[:, 1]]
        middle = (start + end) / 2
        sums = [np.histogramdd(middle, bins=edges, weights=self.flux * (end - start)[:, k])[0]
                for k in range(3)]
        return np.stack(sums, axis=-1) / volume


def collection(path):
    """[(time, pores file, grains file)] of a .pvd."""
    path, steps = Path(path), {}
    for entry in ElementTree.parse(path).getroot().iter("DataSet"):
        files = steps.setdefault(float(entry.get("timestep")), [None, None])
        if int(entry.get("part")) < 2:  # the walls come behind
            files[int(entry.get("part"))] = path.parent / entry.get("file")
    return [(time, *files) for time, files in sorted(steps.items())]


def clear(path):
    """Removes a collection and the files of an earlier run that it would list."""
    path = Path(path)
    for old in path.parent.glob(path.stem + "_*_*.vtu"):
        old.unlink()
    path.unlink(missing_ok=True)

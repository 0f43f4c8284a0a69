# SPDX-License-Identifier: GPL-3.0-or-later
"""Pore-scale flow through the grains of a DEM model: pressures, forces on grains, permeability.

    import pfv
    k = pfv.permeability(positions, radii, [[0, 1], [0, 1], [0, 1]])      # m2

    box = pfv.Box([[0, 1], [0, 1], [0, 1]], wall="symmetry")
    box.face("zlo", pressure=1.0).face("zhi", pressure=0.0)
    flow = pfv.Flow(box, pfv.Fluid(viscosity=1e-3))
    forces = flow.advance(positions, radii, velocities, dt)              # N x 3, N

SI units throughout; arrays have a row for each sphere, pore or throat. An array of float64 in C order is
read where it stands; others are copied. `pfv.settings()` lists the keywords of Flow.
"""
from ._errors import AccuracyWarning, Error, FileError, InputError, PackingWarning, SolverError
from ._pfv import (Box, Container, Flow, Fluid, Network, Packing, RigidBody, __version__, citation, contact_stresses,
                   dense_packing, inertial_stresses, permeability, read_packing, settings, write_packing)

__all__ = ["AccuracyWarning", "Box", "Container", "Error", "FileError", "Flow", "Fluid", "InputError",
           "Network", "Packing", "PackingWarning", "RigidBody", "SolverError", "citation", "contact_stresses", "dense_packing",
           "inertial_stresses", "permeability", "read_packing", "settings", "write_packing"]

# SPDX-License-Identifier: GPL-3.0-or-later
"""A fluid in LAMMPS by pfv.Flow through `fix external`: see lammps_settling.py.

    program.command("fix fluid all external pf/callback 1 1")
    Fluid(program, "fluid", pfv.Box(...).face("zhi", pressure=0), viscosity=0.3)
"""
import numpy as np
import pfv


class Fluid:
    """Between all atoms of a `lammps.lammps`, in a box at rest; settings: those of pfv.Flow. One rank."""

    def __init__(self, program, fix, box, **settings):
        self.program, self.flow, self.last = program, pfv.Flow(box, **settings), None
        self.after = lambda fluid: None  #: called after each step
        program.set_fix_external_callback(fix, self.step)

    def step(self, _, number, local, tags, places, forces):
        """After the contacts, before the second half of nve/sphere: v is that of the middle of the step."""
        array = self.program.numpy.extract_atom
        radii, velocities = array("radius")[:local], array("v")[:local]
        order = np.argsort(tags[:local])  # LAMMPS sorts its atoms anew from time to time
        forces[order] = self.flow.advance(places[order], radii[order], velocities[order],
                                          self.program.extract_global("dt"), ids=tags[order],
                                          commit=self.last not in (None, number))  # not at the setup of a run
        self.last = number
        self.after(self)

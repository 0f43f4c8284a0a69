# SPDX-License-Identifier: GPL-3.0-or-later
"""A fluid in YADE by pfv.Flow, in the place of FlowEngine: see yade_oedometer.py and doc/from_flow_engine.md.

    fluid = Fluid(walls, {"yhi": {"pressure": 0}}, viscosity=20)
    O.engines = [ForceResetter(), ..., InteractionLoop(...), PyRunner(iterPeriod=1, command="fluid.step()"), ..., NewtonIntegrator()]
"""
import numpy as np
import pfv
from yade.wrapper import Omega, Sphere

O = Omega()


class Fluid:
    """Between the spheres of O.bodies and six walls in the order of aabbWalls(thickness=0). faces: {name: words of
    pfv.Box.face}; settings: those of pfv.Flow."""

    def __init__(self, walls, faces, **settings):
        self.walls, self.faces = [O.bodies[k] for k in walls], faces
        self.spheres = [body for body in O.bodies if isinstance(body.shape, Sphere)]
        self.radii = np.array([body.shape.radius for body in self.spheres])
        self.flow = pfv.Flow(self.box(), **settings)

    def box(self):
        places = [wall.state.pos[k // 2] for k, wall in enumerate(self.walls)]
        box = pfv.Box(np.reshape(places, (3, 2)), wall="symmetry")
        for k, name in enumerate(box.faces):
            box.face(name, velocity=self.walls[k].state.vel[k // 2], **self.faces.get(name, {}))
        return box

    def step(self):
        """Between the contacts' engine and NewtonIntegrator, when O.dt, places and velocities belong together."""
        places, velocities = (np.array([(v[0], v[1], v[2]) for v in vectors])  # faster than YADE's own iteration
                              for vectors in ([body.state.pos for body in self.spheres], [body.state.vel for body in self.spheres]))
        self.flow.set_box(self.box())
        forces = self.flow.advance(places, self.radii, velocities, O.dt)
        on_walls = [tuple(force) for force in self.flow.face_forces().values()]
        for body, force in zip(self.spheres + self.walls, [*forces.tolist(), *on_walls]):
            O.forces.addF(body.id, force)

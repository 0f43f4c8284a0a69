# SPDX-License-Identifier: GPL-3.0-or-later
"""An oedometer of YADE with pfv.Flow and with YADE's own FlowEngine, both beside Terzaghi.

    PYTHONPATH=build/python yade -n -x -j1 inputs/hosts/yade_oedometer.py [N=500] [OUT=FILE.json]

Spheres are compressed to 10 kPa and loaded and unloaded by 2 kPa until they answer elastically; then the load on the top
rises by 2 kPa at once, and water leaves through the top. The modulus comes from the same step without water, the
permeability from each engine with the grains at rest; nothing is fitted. Prints a table and writes OUT.
"""
import json
import math
import os
import sys
import time

import numpy as np
import pfv

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path += [HERE, os.path.join(HERE, "..", "oedometer")]
import terzaghi
from yade_flow import Fluid

SETTINGS = {"N": 500, "OUT": "yade_oedometer.json", **dict(word.split("=", 1) for word in sys.argv[1:])}
CONFINING, LOAD, VISCOSITY, YOUNG = 10e3, 2e3, 60.0, 5e6  # Pa, Pa, Pa s, Pa
DRAINED_TOP = {"yhi": {"pressure": 0.0}}
STEPS_A_UNIT = 4000  # of T_v


# -------------------------------------------------------------------------------------- the sample

def make_sample():
    """Spheres at rest between six planes under the same stress from all sides. Returns the walls' ids."""
    grains = FrictMat(young=YOUNG, poisson=0.5, frictionAngle=math.radians(20), density=2600, label="grains")
    O.materials.append([grains, FrictMat(young=YOUNG, poisson=0.5, frictionAngle=0, density=0, label="plates")])
    walls = O.bodies.append(aabbWalls([Vector3(0, 0, 0), Vector3(1, 1, 1)], thickness=0, material="plates"))
    cloud = yade.pack.SpherePack()
    cloud.makeCloud(Vector3(0, 0, 0), Vector3(1, 1, 1), -1, 0.3, int(SETTINGS["N"]), False, 0.95, seed=1)
    O.bodies.append([sphere(centre, radius, material="grains") for centre, radius in cloud])
    press = TriaxialStressController(thickness=0, stressMask=7, internalCompaction=True, maxMultiplier=1.004,
                                     finalMaxMultiplier=1.0004, goal1=-CONFINING, goal2=-CONFINING, goal3=-CONFINING,
                                     label="press")
    contacts = InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
                               [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]), contacts,
                 GlobalStiffnessTimeStepper(timeStepUpdateInterval=100, timestepSafetyCoefficient=0.8, label="stepper"),
                 press, NewtonIntegrator(damping=0.2, label="newton")]
    while unbalancedForce() > 1e-3 or abs(press.meanStress + CONFINING) > 1e-3 * CONFINING:
        O.run(1000, True)
    return walls


def edges(walls):
    return [O.bodies[walls[2 * k + 1]].state.pos[k] - O.bodies[walls[2 * k]].state.pos[k] for k in range(3)]


def middle(walls):
    return 0.5 * sum(O.bodies[walls[k]].state.pos[1] for k in (2, 3))


def insert(engine):
    """Behind the contacts, before the plates' control and the integrator."""
    O.engines = O.engines[:3] + [engine] + O.engines[3:]


# -------------------------------------------------------------------------------------- two engines

class WithPfv:
    """By pfv.Flow; `settings` are its own."""

    def __init__(self, **settings):
        self.settings = dict(viscosity=VISCOSITY, **settings)

    def permeability(self, walls):
        spheres = [body for body in O.bodies if isinstance(body.shape, Sphere)]
        bounds = [[O.bodies[walls[2 * k + end]].state.pos[k] for end in (0, 1)] for k in range(3)]
        return pfv.permeability([body.state.pos for body in spheres], [body.shape.radius for body in spheres], bounds,
                                axis="y", wall="symmetry", **self.settings)

    def begin(self, walls):
        global fluid
        fluid = Fluid(walls, DRAINED_TOP, **self.settings)
        insert(PyRunner(iterPeriod=1, command="fluid.step()"))

    def pressure(self, walls):
        return fluid.flow.plane_pressure("y", middle(walls))


class WithFlowEngine:
    """By YADE's own, with the walls' planes as borders and the conductances as they are."""

    def engine(self, walls, bottom_is_open):
        return FlowEngine(wallIds=walls, useSolver=3, permeabilityFactor=1, viscosity=VISCOSITY, slipBoundary=True,
                          bndCondIsPressure=[0, 0, int(bottom_is_open), 1, 0, 0],
                          bndCondValue=[0, 0, 1.0 if bottom_is_open else 0.0, 0, 0, 0], boundaryUseMaxMin=[0] * 6,
                          meshUpdateInterval=-1, defTolerance=0.01, clampKValues=False, label="flow")

    def permeability(self, walls):
        O.engines = [ForceResetter(), self.engine(walls, True)]
        for body in O.bodies:
            body.state.vel = (0, 0, 0)
        O.step()
        across, along, up = edges(walls)
        return VISCOSITY * abs(flow.getBoundaryFlux(walls[2])) * along / (across * up)

    def begin(self, walls):
        insert(self.engine(walls, False))

    def pressure(self, walls):
        return flow.averageSlicePressure(middle(walls))


# ------------------------------------------------------------------------------------------- runs

def hold_sides():
    """From here on the top alone moves."""
    press.stressMask, press.internalCompaction, press.wall_bottom_activated = 2, False, False
    press.goal1 = press.goal3 = 0


def load_dry(walls, before, after, parts=20):
    """The settlement (m) without water, the load in small parts, so that no swing compacts the grains."""
    height = edges(walls)[1]
    for part in range(1, parts + 1):
        press.goal2 = -CONFINING - before - (after - before) * part / parts
        O.run(300, True)
    O.run(3000, True)
    return height - edges(walls)[1]


def consolidate(engine, walls, coefficient, time_step, until):
    """Rows of T_v, settlement (m), pressure at mid-height (Pa), and CPU seconds a step."""
    O.loadTmp("sample")
    press.goal2 = -CONFINING - LOAD
    stepper.active, O.dt = False, time_step
    engine.begin(walls)
    before, rows, begin, start = edges(walls)[1], [], time.process_time(), O.iter
    while (O.iter - start) * time_step * coefficient < until:
        O.run(max(1, STEPS_A_UNIT // 200), True)
        rows.append([(O.iter - start) * time_step * coefficient, before - edges(walls)[1], engine.pressure(walls)])
    return np.array(rows), (time.process_time() - begin) / (O.iter - start)


def compare(name, engine, walls, settlement):
    O.loadTmp("sample")
    height, permeability = edges(walls)[1], engine.permeability(walls)
    modulus = LOAD * height / settlement
    coefficient = permeability * modulus / VISCOSITY / height**2  # T_v a second
    time_step = 1 / (STEPS_A_UNIT * coefficient)
    rows, seconds = consolidate(engine, walls, coefficient, time_step, 1.5)
    late = rows[:, 0] > 0.05  # the load arrives within a part of that
    # drained at its top alone: the upper half of a layer that is twice as high
    pressure, degree = terzaghi.pressure(0.25, rows[late, 0])[:, 0], terzaghi.settlement(rows[late, 0])
    errors = [float(np.sqrt(np.mean((measured - theory)**2)))
              for measured, theory in ((rows[late, 2] / LOAD, pressure), (rows[late, 1] / settlement, degree))]
    print(f"{name:22s} K {permeability:.3e} m2  E {modulus:.3e} Pa  dt {time_step:.2e} s  "
          f"rms beside Terzaghi: p {100 * errors[0]:.1f} %, U {100 * errors[1]:.1f} %  "
          f"final U {rows[-1, 1] / settlement:.3f}  {1e3 * seconds:.2f} ms a step", flush=True)
    return {"permeability": permeability, "modulus": modulus, "time_step": time_step, "rms_pressure": errors[0],
            "rms_settlement": errors[1], "cpu_a_step": seconds, "rows": rows.tolist()}


def main():
    walls = make_sample()
    hold_sides()
    for _ in range(3):
        load_dry(walls, 0, LOAD)
        load_dry(walls, LOAD, 0)
    O.saveTmp("sample")
    settlement = load_dry(walls, 0, LOAD)
    engines = {"FlowEngine": WithFlowEngine(), "pfv": WithPfv(), "pfv, partition yade": WithPfv(partition="yade")}
    results = {name: compare(name, engine, walls, settlement) for name, engine in engines.items()}
    with open(SETTINGS["OUT"], "w", encoding="ascii") as file:
        json.dump({"spheres": int(SETTINGS["N"]), "settlement": settlement, **results}, file)


main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Times YADE's FlowEngine on a packing; run by against_yade.py and doc/error_vs_time.py:

    yade -n -x -j1 yade_flow.py PACKING.csv RESULT.json symmetry|no_slip

The column sinks on its base, as in `pfv bench`: grains are moved between the steps, outside the clock.
A rebuild takes YADE two steps, triangulation in one and factorisation in the next: their sum is given.
"""
import csv
import json
import resource
import sys
import time

packing_file, result_file, wall = sys.argv[-3:]


def peak_bytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def timed_step():
    start = time.process_time()
    O.step()
    return time.process_time() - start


with open(packing_file, encoding="ascii") as file:
    grains = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
O.materials.append(FrictMat(young=1e7, poisson=0.5, frictionAngle=0.5, density=2600, label="m"))
walls = O.bodies.append(aabbWalls([Vector3(0, 0, 0), Vector3(1, 1, 1)], thickness=0, material="m"))
spheres = O.bodies.append([sphere((g["x"], g["y"], g["z"]), g["radius"], material="m")
                           for g in grains])
flow = FlowEngine(wallIds=walls, useSolver=3, permeabilityFactor=1, viscosity=1, slipBoundary=wall == "symmetry",
                  bndCondIsPressure=[0, 0, 0, 0, 1, 1], bndCondValue=[0, 0, 0, 0, 0, 1],
                  boundaryUseMaxMin=[0] * 6, meshUpdateInterval=-1, defTolerance=-1)
O.engines = [ForceResetter(), flow]
O.dt = 1e-6
bare = peak_bytes()


def move():
    for k in spheres:
        position = O.bodies[k].state.pos
        O.bodies[k].state.pos = (position[0], position[1], position[2] * (1 - 1e-6))


first = timed_step()
inflow = flow.getBoundaryFlux(walls[5])
steps, rebuilds = [], []
for _ in range(10):
    move()
    steps.append(timed_step())
for _ in range(3):
    move()
    flow.updateTriangulation = True
    one = timed_step()
    move()
    rebuilds.append(one + timed_step())
steps.sort()
rebuilds.sort()
with open(result_file, "w", encoding="ascii") as file:
    json.dump({"first": first, "rebuild": rebuilds[1], "step": steps[len(steps) // 2],
               "memory": peak_bytes() - bare, "inflow": inflow}, file)

# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed of inputs/common/bed.py and a wave on it, both in YADE: grains, contacts and its own FlowEngine.

    yade -n -x -j1 inputs/hosts/yade_wave.py OUT=NAME [N=300] [MADE=60] [DAMPING=0.2] [SEED=1] [RATE=200] [AMPLITUDE=200] [BED=DUMP]

Spheres sink slowly under their weight in the fluid and come to rest with the friction MADE (degrees) and YADE's local damping
DAMPING (with BED they stand where the dump of a bed of N grains has them); then they have 30 degrees and no damping, and the pressure on the surface grows as in wave_unstable. Writes
NAME_bed.json, NAME.dump (the bed at rest), NAME_wave_state.csv and NAME_wave_sensors.csv, and with _still in place of _wave the same without the wave,
as the runs of LIGGGHTS do.
"""
import json
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path.insert(0, os.path.join(HERE, "..", "common"))  # before the wave of the standard library
import bed
import wave

SETTINGS = {"N": 300, "MADE": 60.0, "DAMPING": 0.2, "SEED": 1, "RATE": 200.0, "AMPLITUDE": 200.0, "BED": "", "OUT": "yade"}
for word in sys.argv[1:]:
    key, _, value = word.partition("=")
    SETTINGS[key] = type(SETTINGS[key])(value)
RADIUS = bed.mean_radius(SETTINGS["N"])
TOP = bed.SOLID / (0.22 * bed.LENGTH * bed.WIDTH)  # of the vessel, m
YOUNG, FRICTION, SINKING = 15e6, 30.0, bed.KINDS["loose"]["speed"]
FLOW_STEP = 0.1 * wave.time_step(SETTINGS["N"])  # s, less than half of FlowEngine's limit
NETWORK_EVERY = 0.02  # s
FIRST_GRAIN = 6  # the walls come first; y is up


def make_vessel():
    """Walls and spheres that do not touch."""
    O.materials.append(FrictMat(young=YOUNG, poisson=0.5, frictionAngle=math.radians(SETTINGS["MADE"]), density=bed.DENSITY,
                                label="grains"))
    O.materials.append(FrictMat(young=YOUNG, poisson=0.5, frictionAngle=0, density=bed.DENSITY, label="walls"))
    O.bodies.append(aabbWalls([(0, 0, 0), (bed.LENGTH, TOP, bed.WIDTH)], thickness=0, material="walls"))
    if SETTINGS["BED"]:
        for row in bed.read_dump(SETTINGS["BED"]):
            O.bodies.append(sphere((row[2], row[4], row[3]), row[5], material="grains"))
        return
    chance = np.random.default_rng(SETTINGS["SEED"])
    radii = np.sort(RADIUS * chance.choice([0.9, 1.0, 1.1], SETTINGS["N"]))[::-1]
    centres = np.empty((0, 3))
    for radius in radii:
        room = np.array([bed.LENGTH, TOP, bed.WIDTH]) - radius
        while True:
            centre = chance.uniform(radius, room)
            if (((centres - centre)**2).sum(axis=1) > (radii[:len(centres)] + radius)**2).all():
                break
        centres = np.vstack([centres, centre])
        O.bodies.append(sphere(centre, radius, material="grains"))


def spheres():
    return [O.bodies[k] for k in range(FIRST_GRAIN, FIRST_GRAIN + SETTINGS["N"])]


def engines(*fluid, damping):
    contacts = InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
                               [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])
    return [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]), contacts, *fluid,
            NewtonIntegrator(damping=damping, gravity=(0, -bed.BUOYANT, 0), label="newton")]


def run_for(seconds):
    O.run(int(seconds / O.dt), True)


def make_bed():
    mass = bed.DENSITY * 4 / 3 * math.pi * RADIUS**3
    brake = LinearDragEngine(nu=mass * bed.BUOYANT / SINKING / (6 * math.pi * RADIUS),
                             ids=[body.id for body in spheres()])
    O.engines = engines(brake, damping=SETTINGS["DAMPING"])
    small = min(body.shape.radius for body in spheres())
    O.dt = 0.3 * math.sqrt(bed.DENSITY * 4 / 3 * math.pi * small**2 / (2 * YOUNG))
    if SETTINGS["BED"]:  # contacts that do not slide, until their shear forces are there again
        newton.damping, brake.nu = 0.5, 0.0
        run_for(2 * O.dt)
        set_friction(80.0)
        run_for(1.0)
        set_friction(SETTINGS["MADE"])
    else:
        run_for(TOP / SINKING + 2.0)
        brake.nu = 0.0
    newton.damping = max(SETTINGS["DAMPING"], 0.2)  # to come to rest
    for _ in range(8):
        run_for(0.5)
        if max(body.state.vel.norm() for body in spheres()) < 1e-4:
            break


def grains():
    """Columns id, type, x, y, z, radius with z up, as in the dumps of LIGGGHTS."""
    return np.array([[b.id, 1, b.state.pos[0], b.state.pos[2], b.state.pos[1], b.shape.radius] for b in spheres()])


def set_friction(degrees):
    O.materials["grains"].frictionAngle = math.radians(degrees)
    for contact in O.interactions:
        if contact.isReal and min(contact.id1, contact.id2) >= FIRST_GRAIN:
            contact.phys.tangensOfFrictionAngle = math.tan(math.radians(degrees))


def run_wave(measures, rate, name):
    """State and sensors at 100 instants of one wave on the bed at hand."""
    O.resetTime()
    O.dt = FLOW_STEP
    set_friction(FRICTION)
    flow = FlowEngine(useSolver=3, viscosity=bed.viscosity_for(SETTINGS["N"]), slipBoundary=True, clampKValues=False,
                      waveAction=True, bndCondIsPressure=[0, 0, 0, 1, 0, 0], bndCondValue=[0] * 6,
                      boundaryUseMaxMin=[0, 0, 0, 1, 0, 0], meshUpdateInterval=round(NETWORK_EVERY / FLOW_STEP),
                      defTolerance=-1)
    O.engines = engines(flow, damping=0.0)
    heights = wave.sensor_heights(measures)
    sensors = [(x, z, y) for x in wave.VERTICALS for z in heights for y in wave.ACROSS]
    mass = np.array([body.state.mass for body in spheres()])
    every = max(1, round(SETTINGS["AMPLITUDE"] / SETTINGS["RATE"] / FLOW_STEP / 100))
    with open(f"{name}_state.csv", "w") as state, open(f"{name}_sensors.csv", "w") as pressures:
        print("time,amplitude,kinetic_energy,mean_z", file=state)
        print("time", *(f"p{k + 1}" for k in range(len(sensors))), sep=",", file=pressures)
        height = np.mean([body.state.pos[1] for body in spheres()])
        print(0.0, 0.0, 0.0, repr(float(height)), sep=",", file=state)
        for _ in range(100):
            flow.sineMagnitude = rate * (O.time + 0.5 * every * FLOW_STEP)
            O.run(every, True)
            speed = np.array([body.state.vel.norm() for body in spheres()])
            height = np.mean([body.state.pos[1] for body in spheres()])
            print(O.time, rate * O.time, 0.5 * (mass * speed**2).sum(), repr(float(height)), sep=",", file=state)
            print(O.time, *(flow.getPorePressure(place) for place in sensors), sep=",", file=pressures)


make_vessel()
make_bed()
measures = bed.measure(grains())
with open(SETTINGS["OUT"] + "_bed.json", "w") as file:
    json.dump(measures, file, indent=1)
bed.write_dump(SETTINGS["OUT"] + ".dump", grains())
O.saveTmp("bed")
run_wave(measures, SETTINGS["RATE"], SETTINGS["OUT"] + "_wave")
O.loadTmp("bed")
run_wave(measures, 0.0, SETTINGS["OUT"] + "_still")

# SPDX-License-Identifier: GPL-3.0-or-later
"""The STL files of the scenes of scenes/, by name."""
import math

from plates import funnel, lid, lying, quad, ring, write_mesh


def turned(triangles, angle):
    """About the axis y."""
    c, s = math.cos(angle), math.sin(angle)
    return [tuple((c * x + s * z, y, -s * x + c * z) for x, y, z in triangle) for triangle in triangles]


def plate(axis, half=0.025, middle=(0.0, 0.0, 0.0)):
    """A square normal to an axis."""
    corners = []
    for a, b in ((-half, -half), (half, -half), (half, half), (-half, half)):
        place = list(middle)
        place[(axis + 1) % 3] += a
        place[(axis + 2) % 3] += b
        corners.append(tuple(place))
    return quad(*corners)


def can(edges):
    """A closed box from the origin."""
    x, y, z = edges
    low, high = ([(a * x, b * y, c * z) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))] for c in (0, 1))
    return funnel(low, high) + lid(low) + lid(high)


def drum(sides, radius, length):
    ends = [ring(sides, radius, z) for z in (0.0, length)]
    return lying(funnel(*ends) + lid(ends[0]) + lid(ends[1]))


def chute():
    """A floor and two sides, along x, 20 degrees steep."""
    a, b = -0.05, 0.05
    sides = [quad((a, y, 0.0), (b, y, 0.0), (b, y, 0.04), (a, y, 0.04)) for y in (0.0, 0.03)]
    floor = quad((a, 0.0, 0.0), (b, 0.0, 0.0), (b, 0.03, 0.0), (a, 0.03, 0.0))
    return turned(floor + sides[0] + sides[1], math.radians(20))


def leaning(side):
    """One plate of a trough that is 0.008 m wide at z = 0 and leans by 25 degrees."""
    run, height = 0.06 * math.tan(math.radians(25)), 0.06
    return quad((side * 0.004, -0.01, 0.0), (side * 0.004, 0.04, 0.0), (side * (0.004 + run), 0.04, height),
                (side * (0.004 + run), -0.01, height))


def lifters():
    """A drum with four plates along its shell."""
    plates = []
    for k in range(4):
        c, s = math.cos(math.pi * k / 2), math.sin(math.pi * k / 2)
        plates += quad(*[(r * c, y, r * s) for r, y in ((0.03, 0.0), (0.024, 0.0), (0.024, 0.03), (0.03, 0.03))])
    return drum(24, 0.03, 0.03) + plates


def bucket():
    """A floor and a back in the middle of the grains."""
    return (quad((0.012, 0.01, 0.006), (0.03, 0.01, 0.006), (0.03, 0.03, 0.006), (0.012, 0.03, 0.006)) +
            quad((0.012, 0.01, 0.006), (0.012, 0.03, 0.006), (0.012, 0.03, 0.026), (0.012, 0.01, 0.026)))


MESHES = {
    "hopper": lambda: funnel(ring(4, 0.012, 0.0, start=0.5), ring(4, 0.05, 0.08, start=0.5)),
    "slide": lambda: plate(2, 0.02),
    "drum": lambda: drum(24, 0.03, 0.03),
    "lifters": lifters,
    "bucket": bucket,
    "plate_x": lambda: plate(0),
    "plate_y": lambda: plate(1),
    "plate_z": lambda: plate(2),
    "plate_wide": lambda: plate(2, 0.028),
    "chute": chute,
    "can": lambda: [tuple(tuple(1e3 * v for v in corner) for corner in t) for t in can((0.04, 0.03, 0.04))],
    "left": lambda: leaning(-1),
    "right": lambda: leaning(1),
    "shell": lambda: funnel(ring(24, 0.02, 0.03), ring(24, 0.02, 0.1)),
    "cone": lambda: funnel(ring(24, 0.006, 0.0), ring(24, 0.02, 0.03)),
    "gate": lambda: quad((0.03, -0.005, -0.005), (0.03, 0.035, -0.005), (0.03, 0.035, 0.09), (0.03, -0.005, 0.09)),
    "ring": lambda: funnel(ring(32, 0.02, -0.005), ring(32, 0.02, 0.06)),
    "leaning": lambda: quad((-0.005, -0.005, -0.00125), (0.045, -0.005, 0.01125), (0.045, 0.035, 0.01125),
                            (-0.005, 0.035, -0.00125)),
    "blade": lambda: quad((0.0, 0.004, 0.004), (0.0, 0.02, 0.004), (0.0, 0.02, 0.02), (0.0, 0.004, 0.02)),
}


def write_meshes(folder, script):
    """Those that a script names."""
    for name, triangles in MESHES.items():
        if f" {name}.stl" in script:
            write_mesh(folder / f"{name}.stl", triangles())

# SPDX-License-Identifier: GPL-3.0-or-later
"""The five scenes: what runs, and the curves by which two runs are compared."""
import dataclasses
import re

import numpy as np

import grains
import scene
from grains import SCENE


@dataclasses.dataclass
class Case:
    name: str
    script: str
    sample: tuple       # rows, box, types
    steps: int
    variables: dict
    curves: dict        # column: scale; a function takes the column of the reference
    what: str = ""

    def data(self, renumbered):
        rows, box, types = self.sample
        return grains.write_data(self.name, rows, box, types, 7 if renumbered else None)


def span(column):
    return abs(column[-1] - column[0])


def largest(column):
    return abs(column).max()


def oedometer(part):
    sample, settings, measured, planned = grains.oedometer_sample()
    variables = {"N": settings["N"], "phi": grains.oedometer.solid_fraction(settings["N"]),
                 "height": measured["height"], "viscosity": planned["viscosity"],
                 "time_step": planned["time_step"],
                 "piston_mass": grains.oedometer.piston_mass(settings["N"])}
    return Case("oedometer", "oedometer", sample, int(part * planned["steps"]), variables,
                {"height": span, "pressure": largest}, "mean pressure, settlement")


def compression(part):
    sample, places = grains.compressed()
    return Case("compression", "compression", sample, int(4000 * part), {**places, "viscosity": 1e-3},
                {"side": 6e4, "top": 6e4, "bottom": 6e4, "volume": span},
                "stresses on three plates, volume strain")


def outlet(part):
    return Case("outlet", "outlet", grains.outlet(), int(6000 * part),
                {"viscosity": 1e-3, "mass": 2.6e-3, "dt": 5e-5, "LY": 0.2},
                {"path": span, "path_near": span, "pressure": largest},
                "mean path of all grains and of those near the hole, mean pressure")


def seepage(part):
    sample = grains.bed()
    weight = sum(1600.0 * 9.81 * 4 / 3 * np.pi * row[4]**3 for row in sample[0])
    return Case("seepage", "seepage", sample, int(3000 * part),
                {"viscosity": 0.1, "mass": 2.6e-3, "dt": 5e-5, "LZ": 0.1, "carried": weight / 0.01, "mu": 0.5},
                {"height": 0.01, "floor": weight}, "height, force on the floor")


def settling(part):
    sample = grains.settling()
    weight = sum(1600.0 * 9.81 * 4 / 3 * np.pi * row[4]**3 for row in sample[0])
    return Case("settling", "settling", sample, int(4000 * part),
                {"viscosity": 0.1, "LZ": 0.1, "mass": 2.6e-3, "kn": 1e3, "dt": 1.6e-4, "mu": 0.5},
                {"height": span, "floor": weight}, "height, force on the floor")


def two_sizes(part):
    sample = grains.two_sizes()
    weight = sum(1600.0 * 9.81 * 4 / 3 * np.pi * row[4]**3 for row in sample[0])
    return Case("two_sizes", "settling", sample, int(2000 * part),
                {"viscosity": 0.02, "LX": 0.0936, "LY": 0.0936, "LZ": 0.0936, "mass": 2e-4, "kn": 1e3, "dt": 4e-5,
                 "mu": 0.5}, {"height": span, "floor": weight}, "height, force on the floor")


def loaded_oedometer(part):
    """Under 200 kPa, so that the sample shrinks by some percent."""
    case = oedometer(part)
    case.name = "oedometer_200"
    case.variables["dF"] = 2000.0
    return case


CASES = {"oedometer": oedometer, "compression": compression, "outlet": outlet, "seepage": seepage,
         "settling": settling}
STRAINED = {"oedometer, 200 kPa": loaded_oedometer, "compression": compression, "outlet": outlet,
            "seepage": seepage, "settling": settling, "two sizes": two_sizes}


def run(case, words, name, renumbered=False):
    """Curves (rows of a record) and costs of one run, or None where it ends with an error."""
    out = f"post/{case.name}_{name}"
    variables = {**case.variables, "data": case.data(renumbered), "words": words, "steps": case.steps,
                 "record": max(1, case.steps // 100), "out": out}
    try:
        said, cpu = scene.liggghts(SCENE, f"in.{case.script}", variables, out)
    except scene.Failure:
        return None

    # the run itself, without that of in.limits
    log = (SCENE / (out + ".log")).read_text().split("solve_interval limits")[0]
    return costs(log, case.steps) | {"cpu": cpu, "limit": float(said["limits"][0]), "fresh_limit": float(said["fresh"][0]), "curves": np.genfromtxt(
        SCENE / (out + ".csv"), names=True)}


def costs(log, steps):
    phases = {name: (float(seconds), int(count)) for name, seconds, count in re.findall(
        r"^(triangulate|order|factor|total|solve)\s+(\S+)\s+(\d+)$", log, re.M)}
    mass = re.search(r"mass error (\S+)", log)
    solved = re.search(r"solved at (\d+) of", log)
    return {"networks": phases["triangulate"][1], "solves": int(solved.group(1)) if solved else None,
            "all_solves": phases["solve"][1], "flow": phases["total"][0], "steps": steps,
            "mass_error": float(mass.group(1))}


def errors(case, run, reference):
    """(root mean square, largest) of the differences over the run as parts of the scales: of the curve that
    errs most."""
    found = []
    for column, scale in case.curves.items():
        exact = reference["curves"][column]
        size = scale(exact) if callable(scale) else scale
        difference = (run["curves"][column] - exact) / size
        found.append((float(np.sqrt(np.mean(difference**2))), float(abs(difference).max())))
    return max(found)[0], max(pair[1] for pair in found)

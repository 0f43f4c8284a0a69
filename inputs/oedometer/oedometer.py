# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of an oedometer test: sample, dry test, permeability, coupled run, comparison with Terzaghi."""
import json
import math
import re
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent
sys.path.insert(0, str(SCENE.parent / "common"))
import analyse
import scene
from scene import BadSetting, Failure, Progress, liggghts, pfv_solve, primes

SIDE, DENSITY, CONFINEMENT = 0.1, 2600.0, 76.0e3  # m, kg/m3, Pa

KEYS = {
    "N": (int, 1000, "grains"),
    "SEED": scene.SEED,
    "LOAD": (float, 5000.0, "step load, Pa"),
    "VISCOSITY": (float, 0.0, "Pa s; 0: chosen from the grain size"),
    "TIME_STEP": (float, 0.0, "s; 0: chosen from contact and viscous limit"),
    "BASE": (str, "floating", "floating or fixed"),
    "END": (float, 2.6, "duration of the loading, T_v"),
    "RETRIANGULATE": (float, 0.01, "pore strain"),
    "LAW": scene.LAW,
    "FIELDS": (int, 0, "instants of the consolidation written for ParaView; 0: none"),
    "FIX": scene.FIX,
    "OUT": scene.OUT,
    "KEEP": (int, 0, "1: take the sample, dry test and permeability that OUT holds"),
}


def parse(words):
    settings = scene.parse(words, KEYS)
    if settings["N"] < 100 or settings["SEED"] < 1 or settings["LOAD"] <= 0:
        raise BadSetting("N must be at least 100, SEED at least 1, LOAD above 0")
    if settings["BASE"] not in ("floating", "fixed"):
        raise BadSetting("BASE must be floating or fixed")
    return settings


def solid_fraction(grains):
    """Fraction of the 0.1 m cube that the grains fill at 76 kPa, walls included: fitted to samples
    of 1000 and 5000 grains, so that the sample is a cube within 1 %."""
    return 0.654 - 0.49 * grains ** (-1.0 / 3.0)


def mean_radius(grains):
    mean_cube = (0.9**3 + 1.0 + 1.1**3) / 3.0
    volume = solid_fraction(grains) * SIDE**3 / grains
    return (volume / (4.0 / 3.0 * math.pi * mean_cube)) ** (1.0 / 3.0)


def viscosity_for(grains):
    """K/mu independent of the grain size. README.md has the two limits between which this lies."""
    return 5.0 * (mean_radius(grains) / 3.07e-3) ** 2


def viscous_limit(grains, viscosity):
    """Largest stable step of the explicit coupling: the papers' pi rho d^2/(1200 mu) times 0.25,
    measured for clusters of grains in dense packings. Fix pfv knows the limit of the sample."""
    diameter = 1.8 * mean_radius(grains)
    return 0.25 * math.pi * DENSITY * diameter**2 / (1200.0 * viscosity)


def is_explicit(words):
    """Whether the words of fix pfv leave it the coupling that its limit holds for."""
    return not re.search(r"\bcoupling +(staged|implicit|auto)\b", words)


def piston_mass(grains):
    """An eighth of one layer of grains, kg: README.md says why neither more nor less."""
    return 0.02 * mean_radius(grains) / mean_radius(1000)


def permeability(dump, bottom, height, viscosity, report, law):
    """Permeability (m2) of a dump with frictionless side walls, as in the coupled run."""
    box = (0.0, SIDE, 0.0, SIDE, bottom, bottom + height)
    return pfv_solve(SCENE, dump, box, viscosity, report, "--wall", "symmetry",
                     "--conductance", law, "--face", "zlo:pressure=5000",
                     "--face", "zhi:pressure=0")["permeability"]


def common_variables(settings):
    return {"N": settings["N"], "phi": solid_fraction(settings["N"]),
            "F0": CONFINEMENT * SIDE**2, "base_moves": int(settings["BASE"] == "floating"),
            "law": settings["LAW"], "out": settings["OUT"]}


def make_sample(settings):
    print(f"sample of {settings['N']} grains, seed {settings['SEED']}, under "
          f"{CONFINEMENT / 1e3:.0f} kPa", flush=True)
    seeds = {f"s{k + 1}": prime for k, prime in enumerate(primes(settings["SEED"]))}
    said, cpu = liggghts(SCENE, "in.prepare", {**common_variables(settings), **seeds},
                         settings["OUT"] + "_prepare", Progress("sample", 0, 20001, 0.0))
    return {"step": int(said["sample"][0]), "height": float(said["sample"][1]),
            "contact_step": float(said["sample"][2]), "cpu_prepare": cpu}


def dry_test(settings):
    """Loads and unloads the sample by LOAD without fluid."""
    print("dry test: load and unload", flush=True)
    force = settings["LOAD"] * SIDE**2
    said, cpu = liggghts(SCENE, "in.dry", {**common_variables(settings), "dF": force},
                         settings["OUT"] + "_dry")
    height = {name: float(said[name][0]) for name in ("rest", "early", "loaded", "unloaded")}
    loading = (height["rest"] - height["loaded"]) / height["rest"]
    unloading = (height["unloaded"] - height["loaded"]) / height["rest"]
    return dict(dry_height=height, loaded_bottom=float(said["loaded"][1]),
                dry_strain=loading, dry_strain_unloading=unloading,
                dry_drift=(height["early"] - height["loaded"]) / height["rest"] / loading,
                E_oed=settings["LOAD"] / loading, E_oed_unloading=settings["LOAD"] / unloading,
                cpu_dry=cpu, cpu_dry_step=cpu / 14000)


def prepare(settings):
    """Sample and dry test. Returns what they measured."""
    return {**make_sample(settings), **dry_test(settings)}


def measure_permeability(settings, sample, viscosity):
    out, height = settings["OUT"], sample["dry_height"]
    sample["K"] = permeability(out + ".dump", 0.0, sample["height"], viscosity,
                               out + "_K.json", settings["LAW"])
    sample["K_loaded"] = permeability(out + "_loaded.dump", sample["loaded_bottom"],
                                      height["loaded"], viscosity, out + "_K_loaded.json", settings["LAW"])


def plan(settings, sample):
    """Viscosity, time step and numbers of steps of the coupled run."""
    grains = settings["N"]
    viscosity = settings["VISCOSITY"] or viscosity_for(grains)
    limit = viscous_limit(grains, viscosity)
    explicit = is_explicit(settings["FIX"])
    longest = 0.6 * limit if explicit else math.inf
    step = settings["TIME_STEP"] or min(0.8 * sample["contact_step"], longest)
    if "K" not in sample:
        measure_permeability(settings, sample, viscosity)
    consolidation = sample["K"] / viscosity * sample["E_oed"]  # C_v, m2/s
    unit = (sample["height"] / 2.0) ** 2 / consolidation  # time at which T_v = 1, s
    stride = max(1, round(0.1 * unit / step))
    every = max(1, round(0.0005 * unit / step))
    first = -(-(sample["step"] + 500) // stride) * stride
    return {"viscosity": viscosity, "time_step": step, "C_v": consolidation, "unit": unit,
            "stride": stride, "every": every, "rest_to": first,
            "steps": round(settings["END"] * unit / step), "viscous_limit_estimate": limit,
            "explicit": explicit}


def fields_every(settings, planned):
    """Steps between two files: a stride or a part or multiple of it, so that one is written where the load comes."""
    strides = planned["steps"] / settings["FIELDS"] / planned["stride"]
    return round(strides) * planned["stride"] if strides >= 1 else max(1, round(planned["stride"] * strides))


def couple(settings, sample, planned):
    grains, out = settings["N"], settings["OUT"]
    for old in (SCENE / out).parent.glob(Path(out).name + "_[cg]*.txt"):
        if re.search(r"_(contacts|grains)\.\d+\.txt$", old.name):
            old.unlink()
    variables = {key: planned[key] for key in
                 ("viscosity", "time_step", "stride", "every", "rest_to", "steps")}
    variables["report"] = max(1, planned["steps"] // 100)
    variables.update(common_variables(settings), dF=settings["LOAD"] * SIDE**2,
                     piston_mass=piston_mass(grains))
    has_throats = "darcy_grid" not in settings["FIX"].split()
    own = f"retriangulate {settings['RETRIANGULATE']} conductance {settings['LAW']}" if has_throats else ""
    variables["words"] = scene.fix_words(own, settings["FIX"])
    if settings["FIELDS"]:
        variables["words"] += f" output {fields_every(settings, planned)} {out}.pvd contact_stress"
        variables["contacts"] = "yes"
    first, last = sample["step"], planned["rest_to"] + planned["steps"]
    _, cpu = liggghts(SCENE, "in.oedometer", variables, out + "_coupled",
                      Progress("consolidation", first, last, planned["time_step"]))
    return {"cpu_coupled": cpu, "cpu_coupled_step": cpu / (last - first)}


def run(settings):
    """All stages; returns the measured figures, which it also writes to OUT_summary.json."""
    store = SCENE / (settings["OUT"] + "_measured.json")
    if settings["KEEP"] and store.exists():
        sample = json.loads(store.read_text())
    else:
        sample = prepare(settings)
    planned = plan(settings, sample)
    store.write_text(json.dumps(sample, indent=1))
    print(f"consolidation: viscosity {planned['viscosity']:.3g} Pa s, "
          f"{planned['steps']} steps of {planned['time_step']:.3g} s, "
          f"T_v = 1 at {planned['unit']:.4f} s", flush=True)
    cost = couple(settings, sample, planned)
    figures = {**settings, **sample, **planned, **cost}
    (SCENE / (settings["OUT"] + "_run.json")).write_text(json.dumps(figures, indent=1))
    return analyse.analyse(SCENE / settings["OUT"])

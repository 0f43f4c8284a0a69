# SPDX-License-Identifier: GPL-3.0-or-later
"""Small forms of the scenes in inputs/ for doc/error_vs_time.md: each prepares its sample once and then runs it with
settings of fix pfv, and says by which curves, and against which theory, its result is judged."""
import dataclasses
import importlib.util
import json
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
INPUTS, DATA = ROOT / "inputs", ROOT / "tests" / "data"
sys.path.insert(0, str(INPUTS / "common"))  # before Python's own module wave
import bed  # noqa: E402
import element_tests  # noqa: E402
import scene  # noqa: E402
import wave  # noqa: E402


@dataclasses.dataclass
class Outcome:
    """curves: {name: (x, y, size)}; size: what a difference of y is divided by, a number or a function of the finest
    run's y. theory: distance from the theory, or None."""
    curves: dict
    cpu: float
    log: str = ""
    theory: float | None = None


@dataclasses.dataclass
class Form:
    """prepare(module, settings) -> what runs share; run(module, settings, shared, factor) -> Outcome; factor: on the
    viscosity. `own`: what the scene asks of fix pfv itself. `rows`: settings beside those that all scenes are tried with,
    {name: words of fix pfv}."""
    scene: str
    words: str
    what: str
    run: object
    prepare: object = lambda module, settings: None
    theory: str = ""
    own: str = ""
    rows: dict = dataclasses.field(default_factory=dict)
    sizes: tuple = ()
    moves: bool = True      # new networks, solves that may be left out
    title: str = ""         # of a scene's second form

    def name(self):
        return self.title or self.scene


def span(y):
    return float(np.ptp(y))


def largest(y):
    return float(abs(y).max())


def module_of(name):
    """inputs/NAME/run.py, as a module."""
    folder = INPUTS / name
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
    known = f"run_of_{name}"
    if known not in sys.modules:
        spec = importlib.util.spec_from_file_location(known, folder / "run.py")
        sys.modules[known] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[known])
    return sys.modules[known]


def settings_of(form, module, out, words="", grains=None):
    """Of the small form, with settings of fix pfv and another number of grains."""
    owners = (module, getattr(module, "oedometer", None), getattr(module, "wave_rising", None))
    keys = next(owner.KEYS for owner in owners if hasattr(owner, "KEYS"))
    given = form.words.split() + [f"N={grains}"] * bool(grains) + [f"OUT={out}"]
    return {"SEED": 1, **scene.parse(given, keys), "FIX": words}  # wave_unstable has several


def warnings(log):
    """What a run was warned of: a time step beyond the explicit limit, held pressures that drive a piston."""
    screen = pathlib.Path(f"{log}.txt").read_text(errors="replace")
    beyond = max(map(float, re.findall(r"WARNING.* is (\S+) times the limit of the explicit coupling", screen)), default=0.0)
    return ", ".join([f"{beyond:.2g} times the explicit limit"] * (beyond > 0)
                     + ["held pressures drive a piston"] * ("drives a piston" in screen))


def costs(log):
    """CPU seconds of the flow, networks and flow steps of the run, from the table at its end, and what was warned of."""
    text = pathlib.Path(f"{log}.log").read_text(errors="replace")
    found = {"triangulate": (0.0, None)}  # a Darcy grid has no networks
    found |= {name: (float(seconds), int(count)) for name, seconds, count in re.findall(
        r"^(triangulate|total)\s+(\S+)\s+(\d+)$", text, re.M)}
    return {"flow": found["total"][0], "networks": found["triangulate"][1], "steps": found["total"][1],
            "warned": warnings(log)} if "total" in found else {}


# ------------------------------------------------------------------------------ beds, hoppers, columns

def boiling_prepare(module, settings):
    variables = module.room("box", settings)
    return variables, module.prepare("box", settings, variables)


def boiling_run(module, settings, shared, factor):
    settings["VISCOSITY"] *= factor
    run = module.couple("box", settings, *shared)
    record, m = module.Record(run), module.measures(run)
    return Outcome({"pressure drop": (record.Q, record.p, 1.0)}, run["cpu"], run["out"] + "_run",
                   max(abs(m["slope"] - 1), abs(m["plateau"] - 1)))


def clumps_run(module, settings, _, factor):
    settings["VISCOSITY"] *= factor
    run = module.settle("fours", settings, module.four())
    return Outcome({"mean height": (run["rows"]["time"], run["rows"]["height"], span)}, run["cpu"],
                   f"{settings['OUT']}_fours_run")


def column_run(module, settings, _, factor):
    settings["VISCOSITY"] *= factor
    geometry = module.geometry_of(settings)
    run = module.sample("high", settings, geometry, module.TOPS["high"].format(**geometry))
    rows = np.genfromtxt(f"{settings['OUT']}_high_record.csv", delimiter=",", names=True)
    return Outcome({"mean place": (rows["time"], rows["x"], span)}, run["cpu"], f"{settings['OUT']}_high_run")


def outlet_run(module, settings, _, factor):
    settings["VISCOSITY"] *= factor
    run = module.run_model(settings["MODEL"], settings)
    rows = module.outlet.record(module.SCENE, run)
    return Outcome({"mean pressure": (rows["time"], rows["mean_pressure"], largest)}, run["cpu"], run["out"])


def deposition_run(module, settings, _, factor):
    end = settings["END"] * settings["VISCOSITY"]
    settings["VISCOSITY"] *= factor
    settings["END"] = end / settings["VISCOSITY"]
    run = module.Run(settings, module.couple(settings))
    rows = module.suspended_gradient(run)
    ratio = rows[:, 1] / rows[:, 2]
    return Outcome({"gradient": (rows[:, 0], ratio, 1.0), "mean height": (run.state["time"], run.state["mean_z"], span)},
                   run.figures["cpu"], f"{settings['OUT']}_run", abs(float(ratio.mean()) - 1))


def drum_run(module, settings, _, factor):
    run = module.turn("wet", settings, settings["VISCOSITY"] * factor)
    return Outcome({"angle": (run["turns"], run["angle"], largest)}, run["cpu"], f"{settings['OUT']}_wet_run")


def hopper_run(module, settings, _, factor):
    run = module.discharge("closed", settings, settings["TIME"], settings["VISCOSITY"] * factor)
    rows = run["rows"]
    return Outcome({"beads out": (rows["time"], run["begun"] - rows["count"], span)}, run["cpu"],
                   f"{settings['OUT']}_closed_run")


def plate_run(module, settings, _, factor):
    run = module.pull("fast", settings, settings["SPEED"], settings["VISCOSITY"] * factor)
    rows = run["rows"][run["rows"]["u"] >= module.WINDOW * run["rows"]["u"][-1]]
    return Outcome({"resistance": (rows["u"], run["lift"] - rows["all"], largest)}, run["cpu"], f"{settings['OUT']}_fast_run")


# ------------------------------------------------------------------------------ settling, permeability

def fall(module, settings, found, name, theory):
    rows = np.genfromtxt(f"{settings['OUT']}_{name}_record.csv", delimiter=",", names=True)
    return Outcome({"speed": (rows["time"], rows["ratio"], largest)}, found["cpu"], f"{settings['OUT']}_{name}_run", theory)


def cloud_run(module, settings, _, factor):
    settings["VISCOSITY"] *= factor
    found = module.cloud(0.2, settings)
    return fall(module, settings, found, "cloud200", abs(found["ratio"] / found["wanted"] - 1))


def bead_run(module, settings, _, factor):
    settings["VISCOSITY"] *= factor
    found = module.one(0, settings)
    return fall(module, settings, found, "one0", abs(found["ratio"] - 1))


YADE = "yade"  # in place of settings of fix pfv
REFERENCES = [line.split(",") for line in (DATA / "stokes_36_permeability.csv").read_text().split()[1:]]


def permeability_of(module, settings, packing, wall):
    """m2, and CPU seconds."""
    before = scene.child_seconds()
    report = scene.pfv_solve(module.SCENE, str(DATA / packing), (0, 1, 0, 1, 0, 1), 1.0, f"{settings['OUT']}.json",
                             "--wall", wall, "--face", "zlo:pressure=1", "--face", "zhi:pressure=0",
                             *option_words(settings["FIX"]))
    return report["permeability"], scene.child_seconds() - before


def permeability_by_yade(packing, wall, out):
    """The same by YADE's FlowEngine: its first step, without the start of the program."""
    if not shutil.which("yade"):
        raise scene.Failure("YADE is not installed")
    result = pathlib.Path(f"{out}_yade.json")
    result.unlink(missing_ok=True)
    done = subprocess.run(["yade", "-n", "-x", "-j1", str(ROOT / "tests/bench/yade_flow.py"), str(DATA / packing),
                           str(result), wall], capture_output=True, text=True)
    if not result.exists():
        raise scene.Failure(f"YADE wrote no result: {(done.stderr or done.stdout).strip()[-200:]}")
    found = json.loads(result.read_text())
    return abs(found["inflow"]), found["first"]  # of a unit cube, Pa and viscosity


def permeameter_run(module, settings, _, __):
    """The packings of 36 spheres, against their finite elements."""
    ratios, cpu = [], 0.0
    for packing, wall, permeability, _ in REFERENCES:
        found, seconds = (permeability_by_yade(packing, wall, settings["OUT"]) if settings["FIX"] == YADE
                          else permeability_of(module, settings, packing, wall))
        ratios.append(found / float(permeability))
        cpu += seconds
    error = np.array(ratios) - 1
    return Outcome({"permeability": (np.arange(4.0), np.array(ratios), 1.0)}, cpu,
                   theory=float(np.sqrt((error**2).mean())))


def option_words(words):
    """Settings of fix pfv as options of the command."""
    words = words.split()
    return [word for k in range(0, len(words), 2) for word in (f"--{words[k]}", words[k + 1])]


# ------------------------------------------------------------------------------ element tests, oedometers

def shear_prepare(module, settings):
    sample = module.prepare(settings, "loose")
    return sample, module.test(settings, sample, "dry")


def shear_run(module, settings, shared, factor):
    sample, dry = shared
    wet, stress = module.test(settings, sample, "undrained", module.THIN * factor), settings["STRESS"]
    theory = element_tests.apart(wet, [dry], stress, wet["rows"]["p"])["pressure"]
    return Outcome({"pore pressure": (wet["strain"], wet["rows"]["p"] / stress, 1.0)}, wet["cpu"],
                   f"{sample['name']}_undrained", theory)


def triaxial_prepare(module, settings):
    sample = module.prepare(settings, "dense")
    return sample, module.test(settings, sample, "dry", *rate_of(settings))


def rate_of(settings):
    """The rate at which the scene with several of them is asked for."""
    return (float(settings["RATES"]),) if "RATES" in settings else ()


def triaxial_run(module, settings, shared, factor):
    (sample, dry), stress = shared, settings["STRESS"]
    settings["VISCOSITY"] *= factor
    wet = module.test(settings, sample, "undrained", *rate_of(settings))
    theory = element_tests.apart(wet, [dry], stress, wet["rows"]["p"])["pressure"]
    log = f"{sample['name']}_undrained" + "".join(f"_{rate:g}" for rate in rate_of(settings))
    return Outcome({"pore pressure": (wet["strain"], wet["rows"]["p"] / stress, 1.0)}, wet["cpu"], log, theory)


def cell_run(module, settings, _, factor):
    settings["VISCOSITY"] *= factor
    run = module.couple(settings)
    rows, found = module.record(settings)[1:], module.measures(settings, run)
    return Outcome({"mean pressure": (rows["time"], rows["mean_p"], largest), "height": (rows["time"], rows["H"], span)},
                   run["cpu"], f"{settings['OUT']}_run", abs(found["pressure"]))


def oedometer_prepare(module, settings):
    """Sample and dry test are kept beside the first run, and those after it take them from there."""
    sample = module.oedometer.prepare(settings)
    module.oedometer.plan(settings, sample)
    pathlib.Path(settings["OUT"] + "_measured.json").write_text(json.dumps(sample))


def oedometer_run(module, settings, _, factor):
    oedometer = module.oedometer
    settings.update(KEEP=1, VISCOSITY=factor * oedometer.viscosity_for(settings["N"]))
    figures = oedometer.run(settings)
    records = oedometer.analyse.Run(settings["OUT"])
    loaded = records.T >= 0.0
    theory = max(figures["p_rms"], figures["U_rms"]) if settings["LOAD"] < 1e5 else None
    return Outcome({"p(H/2)": (records.T[loaded], records.middle()[loaded], 1.0),
                    "U": (records.T_lid, records.settlement(), 1.0)},
                   figures["cpu_coupled"], f"{settings['OUT']}_coupled", theory)


# ------------------------------------------------------------------------------ waves

def bed_for(kind, made=0.0):
    return lambda module, settings: bed.prepare(module.SCENE, kind, settings["N"], settings["SEED"], settings["OUT"], made)


def wave_with(amplitude, largest_amplitude, duration, words=""):
    """Runs a wave whose amplitude is a formula of v_t; the mean excess pressure over the largest amplitude, and how
    far the bed settles."""
    def run(module, settings, measures, factor):
        out = settings["OUT"] + "_wave"
        viscosity = factor * (settings.get("VISCOSITY") or bed.viscosity_for(settings["N"]))
        one = wave.run(module.SCENE, settings, measures, out, amplitude, duration, viscosity=viscosity, words=words)
        return Outcome({"sensors": (one.time, one.p.reshape(len(one.time), -1) / largest_amplitude, 1.0),
                        "settlement": (one.state["time"], one.state["mean_z"], span)},
                       one.figures["cpu"], out + "_run")
    return run


def still_run(module, settings, _, __):
    found = module.one_size(int(settings["N"]), settings)
    pressure = found["flow"]["pressure"] / module.AMPLITUDE
    return Outcome({"pressure": (np.arange(float(len(pressure))), pressure, 1.0)}, found["cpu"],
                   f"{settings['OUT']}_{settings['N']}", found["rms"])


# ------------------------------------------------------------------------------ all of them

COUPLINGS = {f"coupling {name}": f"coupling {name}" for name in ("staged", "implicit")}
GRID = "model darcy_grid 1 1 6 every 100 drag kozeny_carman"
RISING = dict(amplitude="1000*v_t", largest_amplitude=300.0, duration=0.3, words="retriangulate mean 0.001")
COMES_UP = dict(amplitude="1000*(1.0-exp(-v_t/0.05))", largest_amplitude=1000.0, duration=0.2)
SWINGS = dict(amplitude="400*sin(12.566370614*v_t)", largest_amplitude=400.0, duration=0.6)
UNSTABLE = 1900.0  # Pa: its grains give their weight to the fluid

FORMS = [
    Form("boiling", "SHAPE=box N=300 END=0.4", "pressure drop over the discharge", boiling_run, boiling_prepare,
         "Darcy's law, then the buoyant weight", sizes=(150, 600)),
    Form("clumps", "N=25 TIME=0.15", "mean height of clumps of four", clumps_run,
         rows={"coupling auto": "coupling auto", "coupling staged": "coupling staged"},
         own="coupling implicit retriangulate mean 0.03"),
    Form("column_collapse", "N=100 END=0.03", "mean place of the beads", column_run,
         rows={**COUPLINGS, "no shear viscous forces": "shear_viscous no"},
         own="shear_viscous yes"),
    Form("darcy_outlet", "MODEL=pfv ACROSS=8 TIME=0.2", "mean pressure", outlet_run,
         rows={"Darcy grid, 4 x 8 x 4": "model darcy_grid 4 8 4 every 10 drag di_felice couple_every 10"}),
    Form("deposition", "N=100 END=0.6", "hydraulic gradient of the cloud, mean height", deposition_run,
         theory="the buoyant weight", rows={**COUPLINGS, "Darcy grid, 2 x 2 x 6": GRID.replace("1 1 6", "2 2 6")},
         sizes=(50, 200),
         own="coupling auto retriangulate 0.1"),
    Form("drum_underwater", "N=300 TURN=0.05 PERIOD=3", "angle of the bed", drum_run, rows=COUPLINGS,
         own="coupling auto retriangulate mean 0.03"),
    Form("hopper_underwater", "N=200 TIME=0.3", "beads that have left", hopper_run, rows=COUPLINGS),
    Form("oedometer", "N=300 END=1.5", "p in the middle, settlement", oedometer_run, oedometer_prepare,
         "Terzaghi", rows={**COUPLINGS, "Darcy grid, 6 layers": GRID}, sizes=(150, 600),
         own="retriangulate 0.01"),
    Form("oedometer", "N=300 END=1 LOAD=200000", "p in the middle, settlement", oedometer_run, oedometer_prepare,
         rows=COUPLINGS, title="oedometer_large",
         own="retriangulate 0.01"),
    Form("permeameter", "", "permeability of four packings of 36 spheres", permeameter_run, theory="finite elements",
         rows={"conductance effective_radius": "conductance effective_radius", "solver cg": "solver cg",
               "solver gauss_seidel": "solver gauss_seidel", "YADE's FlowEngine": YADE}, moves=False),
    Form("plate_uplift", "N=300 TRAVEL=3e-4", "resistance to the plate", plate_run, rows=COUPLINGS,
         own="retriangulate mean 0.03"),
    Form("settling", "N=80 FALL=2", "speed of a cloud of 20 %", cloud_run, theory="Richardson and Zaki",
         rows={**COUPLINGS, "no shear viscous forces": "shear_viscous no"}, sizes=(160, 320),
         own="coupling auto shear_viscous yes"),
    Form("settling", "", "speed of a single bead", bead_run, theory="Stokes", title="settling, one bead",
         rows={**COUPLINGS, "no shear viscous forces": "shear_viscous no"},
         own="coupling auto shear_viscous yes"),
    Form("shear_viscous", "N=100", "pressures at sensors, settlement", wave_with(**COMES_UP | {
        "words": "shear_viscous yes"}), bed_for("loose"), rows={**COUPLINGS, "no shear viscous forces": "shear_viscous no"},
         own="coupling auto shear_viscous yes"),
    Form("simple_shear", "PLATE=5 N=120 STRAIN=0.04 RATE=0.6", "pore pressure, undrained", shear_run, shear_prepare,
         "dry shear at constant volume", rows=COUPLINGS,
         own="couple_every 1"),
    Form("triaxial", "N=200 RATES=0.3 STRAIN=0.06", "pore pressure, undrained", triaxial_run, triaxial_prepare,
         "dry compression at constant volume", rows=COUPLINGS,
         own="couple_every 1"),
    Form("triaxial_cylinder", "N=200 TIME=0.2", "mean pressure, height", cell_run, theory="slow drainage", rows=COUPLINGS),
    Form("triaxial_periodic", "N=120 STRAIN=0.02 RATE=0.3", "pore pressure, undrained", triaxial_run, triaxial_prepare,
         "dry compression at constant volume", rows=COUPLINGS,
         own="couple_every 1"),
    Form("wave_dense", "N=100", "pressures at sensors, settlement", wave_with(**RISING), bed_for("dense"), rows=COUPLINGS,
         own="coupling auto retriangulate mean 0.001"),
    Form("wave_loose", "N=100", "pressures at sensors, settlement", wave_with(**RISING), bed_for("loose"), rows=COUPLINGS,
         own="coupling auto retriangulate mean 0.001"),
    Form("wave_oscillating", "N=100", "pressures at sensors, settlement", wave_with(**SWINGS), bed_for("loose"),
         rows=COUPLINGS,
         own="coupling auto retriangulate 0.01"),
    Form("wave_permeability", "N=100", "pressures at sensors, settlement", wave_with(**COMES_UP), bed_for("loose"),
         rows=COUPLINGS,
         own="coupling auto retriangulate 0.01"),
    Form("wave_still", "N=312 SEED=2", "pressures in all pores", still_run, theory="harmonic pressures", moves=False,
         sizes=(1250,)),
    Form("wave_unstable", "N=100", "pressures at sensors, settlement",
         wave_with("200*v_t", UNSTABLE, 0.4, "retriangulate mean 0.002"), bed_for("loose", 60.0), rows=COUPLINGS,
         own="coupling auto retriangulate mean 0.002"),
]

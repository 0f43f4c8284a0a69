# SPDX-License-Identifier: GPL-3.0-or-later
"""What the time of a coupled run goes into, and over the steps between two networks (thesis figs. 5.2 and 5.10):

    run.py parts [KEY=VALUE...]      called by ./run.sh oedometer parts [KEY=VALUE...]

takes the keys of an oedometer test. The sample under its load, a flow step at each step: with a new network, and so a
new factor, at each of them, with one that is kept, and with Gauss-Seidel's solver. CPU seconds of the phases as the fix
tells them at its end; LIGGGHTS' own are those of the dry test.
"""
import json
import re

import oedometer
import scene
from plotting import plt, save_figure

RUNS = {"new network each step": ("retriangulate 1e-12", 60), "network and factor kept": ("", 2000),
        "Gauss-Seidel, network kept": ("solver gauss_seidel tolerance 1e-6", 40)}
GROUPS = {"triangulation": ("triangulate",), "throats, matrix": ("throats", "assemble"),
          "ordering, factor": ("order", "factor"), "solve": ("solve",), "forces": ("forces",)}
BETWEEN = (1, 10, 100, 1000, 10000)  # steps between two networks


def phases_of(text):
    """{phase: (CPU seconds, times)} of the last table that the fix has printed."""
    table = text[text.rindex("phase         CPU seconds       count"):]
    return {name: (float(seconds), int(count)) for name, seconds, count in
            re.findall(r"^(\w+) +([\d.eE+-]+) +(\d+)$", table[:table.index("total") + 60], re.MULTILINE)}


def one_run(settings, sample, name, words, steps):
    planned = oedometer.plan({**settings, "FIX": ""}, sample)
    out = f"{settings['OUT']}_parts_{len(words)}"
    variables = {**oedometer.common_variables(settings), "viscosity": planned["viscosity"],
                 "time_step": planned["time_step"], "rest_to": sample["step"] + 2, "steps": steps, "report": steps, "every": 10 * steps, "stride": 10**9,
                 "dF": settings["LOAD"] * oedometer.SIDE**2, "piston_mass": oedometer.piston_mass(settings["N"]),
                 "words": f"couple_every 1 conductance {settings['LAW']} {words}", "result": out}
    print(f"{name}: {steps} steps", flush=True)
    _, cpu = scene.liggghts(oedometer.SCENE, "in.oedometer", variables, out)
    phases = phases_of((oedometer.SCENE / f"{out}.txt").read_text(errors="replace"))
    parts = {group: sum(phases[phase][0] for phase in of if phase in phases) for group, of in GROUPS.items()}
    parts["rest of the flow"] = max(0.0, phases["total"][0] - sum(parts.values()))
    return {"parts": parts, "networks": phases["triangulate"][1], "steps": phases["total"][1], "cpu": cpu}


def per_step(run, dry):
    """CPU ms a step."""
    return {"LIGGGHTS": 1e3 * dry, **{name: 1e3 * seconds / run["steps"] for name, seconds in run["parts"].items()}}


def over_networks(each, kept):
    """{steps between networks: (LIGGGHTS, flow)}, ms a step: what a network costs is what the first run spends more."""
    of_network = {name: max(0.0, each[name] - kept[name]) for name in each if name != "LIGGGHTS"}
    always = sum(kept[name] for name in of_network)
    return {between: (kept["LIGGGHTS"], always + sum(of_network.values()) / between) for between in BETWEEN}


def draw(steps, networks, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    bottom = [0.0] * len(steps)
    for part in next(iter(steps.values())):
        shares = [100 * of[part] / sum(of.values()) for of in steps.values()]
        left.bar(list(steps), shares, bottom=bottom, label=part)
        bottom = [b + s for b, s in zip(bottom, shares)]
    left.set(ylabel="part of the CPU time, %", ylim=(0, 100))
    left.tick_params(axis="x", labelsize=8)
    left.legend(fontsize=7)
    names = [f"{between}\n{dry + flow:.3g} ms" for between, (dry, flow) in networks.items()]
    parts_of = [100 * dry / (dry + flow) for dry, flow in networks.values()]
    right.bar(names, parts_of, label="LIGGGHTS")
    right.bar(names, [100 - part for part in parts_of], bottom=parts_of, label="flow")
    right.set(xlabel="steps between two networks; CPU of a step", ylabel="part of the CPU time, %", ylim=(0, 100))
    right.legend(fontsize=8)
    save_figure(figure, path)


def run(words):
    settings = oedometer.parse(words)
    store = oedometer.SCENE / (settings["OUT"] + "_measured.json")
    sample = json.loads(store.read_text()) if settings["KEEP"] and store.exists() else oedometer.prepare(settings)
    store.write_text(json.dumps(sample, indent=1))
    runs = {name: one_run(settings, sample, name, *how) for name, how in RUNS.items()}
    steps = {name: per_step(one, sample["cpu_dry_step"]) for name, one in runs.items()}
    each, kept, sweeps = steps.values()
    networks = over_networks(each, kept)
    print(f"\nParts of the CPU time of a coupled run of {settings['N']} grains, ms a step and %")
    for name, of in steps.items():
        whole = sum(of.values())
        print(f"  {name:<28s} {whole:9.3f}   " + "  ".join(f"{part} {value:.3f} ({100 * value / whole:.0f})"
                                                         for part, value in of.items()))
    print("  steps between networks: coupled over dry")
    print("  " + "  ".join(f"{between}: {(dry + flow) / dry:.2f}" for between, (dry, flow) in networks.items()))
    draw(steps, networks, oedometer.SCENE / (settings["OUT"] + "_parts.png"))
    of_solver = sweeps["solve"] / sum(sweeps.values())
    flow = {name: of["solve"] + of["ordering, factor"] for name, of in (("each", each), ("kept", kept))}
    rows = [("Gauss-Seidel: solve / all", of_solver, ">= 0.7", of_solver >= 0.7),
            ("coupled / dry, networks 1000 steps apart", sum(networks[1000]) / networks[1000][0], "> 1",
             sum(networks[1000]) > networks[1000][0]),
            ("factor and solve a step, kept / each new", flow["kept"] / flow["each"], "< 1", flow["kept"] < flow["each"])]
    return scene.summary(oedometer.SCENE, settings["OUT"] + "_parts",
                         {**settings, "ms_a_step": steps, "runs": runs,
                          "between_networks": {str(between): pair for between, pair in networks.items()}}, rows)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the results of yade_oedometer.py and lammps_settling.py into doc/from_flow_engine.md and doc/figures.

    page.py yade_oedometer.json lammps_settling.json
"""
import json
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "inputs/common"), str(ROOT / "inputs/oedometer")]
import page_table
import plotting
import terzaghi

PAGE = ROOT / "doc/from_flow_engine.md"
LOAD = 2e3  # Pa, of yade_oedometer.py


def put_oedometer(results):
    runs = {name: run for name, run in results.items() if isinstance(run, dict)}
    own = np.array(runs["FlowEngine"]["rows"])
    table = page_table.Table("fluid", "K, m²", "p, rms beside Terzaghi", "U, rms beside Terzaghi", "p, rms beside FlowEngine",
                             "U, rms beside FlowEngine", "CPU a step, DEM included")
    for name, run in runs.items():
        rows = np.array(run["rows"])
        number = min(len(rows), len(own))
        beside = [100 * np.sqrt(np.mean((rows[:number, column] - own[:number, column])**2)) / scale
                  for column, scale in ((2, LOAD), (1, results["settlement"]))]
        table.row(name, f"{run['permeability']:.4e}", f"{100 * run['rms_pressure']:.1f} %", f"{100 * run['rms_settlement']:.1f} %",
                  *(f"{value:.2f} %" if name != "FlowEngine" else "" for value in beside), f"{1e3 * run['cpu_a_step']:.1f} ms")
    page_table.put_into(PAGE, "oedometer", table.lines)
    draw(results, runs)


def draw(results, runs):
    figure, (left, right) = plotting.plt.subplots(1, 2, figsize=(10, 3.8))
    for style, (name, run) in zip(("-", "--", ":"), runs.items()):
        rows = np.array(run["rows"])
        left.semilogx(rows[:, 0], rows[:, 2] / LOAD, style, label=name)
        right.semilogx(rows[:, 0], rows[:, 1] / results["settlement"], style, label=name)
    times = np.geomspace(0.005, 1.5, 200)
    for axes, values in ((left, terzaghi.pressure(0.25, times)[:, 0]), (right, terzaghi.settlement(times))):
        axes.semilogx(times, values, "k-", lw=0.8, label="Terzaghi")
        axes.grid(alpha=0.3)
        axes.set_xlabel("T_v")
    left.set_ylabel("p(H/2) / load")
    right.set_ylabel("settlement / dry settlement")
    left.legend(fontsize="small")
    plotting.save_figure(figure, ROOT / "doc/figures/yade_oedometer.png", dpi=110)


def put_settling(results):
    table = page_table.Table("time, s", "carried by the water, part of the weight", "mass error", "networks so far")
    for time, carried, mass, networks in results["rows"]:
        table.row(f"{time:.1f}", f"{100 * carried / results['weight']:.1f} %", f"{mass:.0e}", networks)
    table.row(f"largest rest of all forces in {results['steps']} steps", f"{results['balance']:.1e} of their sizes", "", "")
    page_table.put_into(PAGE, "settling", table.lines)


put_oedometer(json.loads(pathlib.Path(sys.argv[1]).read_text()))
put_settling(json.loads(pathlib.Path(sys.argv[2]).read_text()))

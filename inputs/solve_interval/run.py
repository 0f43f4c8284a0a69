#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How often the flow has to be solved, and the network built: the tables of doc/couple_every.md.

    run.py [TABLE...]         called by ./run.sh solve_interval; prints the tables (all unless some are named)
    run.py write [TABLE...]   puts them into doc/couple_every.md as well
    run.py intervals outlet,settling    of some scenes alone
"""
import math
import sys

import cases
import scene
from page_table import Table, put_into

PAGE = cases.SCENE.parents[1] / "doc" / "couple_every.md"
FINE = "retriangulate mean 0.002"
USUAL = "retriangulate mean 0.01"  # the default
FIXED = (1, 2, 5, 10, 20, 50, 100)
TOLERANCES = (0.03, 0.1, 0.3, 1)  # % of the load
THINNER = (1e-8, 1e-6, 1e-4, 1e-3)  # parts by which the scatter table changes the viscosity
THRESHOLDS = ["0.01", "0.02", "0.05", "0.1", "mean 0.005", "mean 0.01", "mean 0.02", "mean 0.04"]
HELD = {"oedometer, 200 kPa": 1}  # steps that the networks' study solves the flow for; 5 elsewhere


def percent(part):
    return f"{100 * part:.2g} %"


def frontier(points):
    """Of (error, cost): those than which none has both less."""
    best = []
    for error, cost in sorted(points):
        if not best or cost < best[-1][1]:
            best.append((error, cost))
    return best


def cost_at(error, points):
    """What the curve of fixed intervals costs at an error: between its points the logarithms go straight."""
    best = frontier(points)
    if error <= best[0][0]:
        return best[0][1]
    for (e0, c0), (e1, c1) in zip(best, best[1:]):
        if error < e1:
            part = math.log(error / e0) / math.log(e1 / e0)
            return c0 * (c1 / c0) ** part
    return best[-1][1]


def measured(case, words, label, exact=None, renumbered=False):
    run = cases.run(case, words, label, renumbered)
    if run is not None and exact is not None:
        run["error"], run["worst"] = cases.errors(case, run, exact)
    return run


def intervals_of(name, table, ratios):
    case = cases.CASES[name](1.0)
    exact = measured(case, f"couple_every 1 {FINE}", "fine")
    fixed = []

    def show(setting, run):
        if run is None:
            table.row(name, setting, "ends with an error", "", "", "", "", "")
            return
        table.row(name, setting, run["solves"] if run["solves"] is not None else run["steps"] // every,
                  run["networks"], percent(run["error"]), percent(run["worst"]), f"{run['flow']:.2f}",
                  f"{run['cpu']:.2f}")

    for every in FIXED:
        run = measured(case, f"couple_every {every} {USUAL}", f"every_{every}", exact)
        show(f"{every}", run)
        fixed += [run] if run else []
    again = measured(case, f"couple_every 1 {USUAL}", "again", renumbered=True)
    noise = cases.errors(case, again, fixed[0])[0]
    for tolerance in TOLERANCES:
        run = measured(case, f"couple_every auto error {tolerance} {USUAL}", f"auto_{tolerance}", exact)
        show(f"auto error {tolerance:g}", run)
        cells = [name, tolerance, percent(run["error"]), percent(noise), percent(fixed[0]["error"])]
        for floor in (noise, fixed[0]["error"]):
            for cost in ("flow", "cpu"):
                points = [(max(r["error"], floor), r[cost]) for r in fixed]
                cells.append(f"{run[cost] / cost_at(max(run['error'], floor), points):.2f}")
        ratios.append(cells)


def intervals(names):
    table = Table("scene", "`couple_every`", "solves", "networks", "error (rms)", "largest",
                  "CPU of the flow, s", "CPU of the run, s")
    ratios = []
    for name in names or cases.CASES:
        intervals_of(name, table, ratios)
    print()
    second = Table("scene", "tolerance, %", "error of auto", "renumbered grains", "error of every step",
                   "flow / fixed", "run / fixed", "flow / fixed, errors below those of every step equal",
                   "run / fixed, the same")
    for cells in ratios:
        second.row(*cells)
    return table.lines + [""] + second.lines


def scatter(names):
    """What a scene's curves change by when the fluid's forces change by next to nothing."""
    table = Table("scene", *(f"viscosity changed by {part:g}" for part in THINNER))
    for name in names or cases.CASES:
        case = cases.CASES[name](1.0)
        exact = measured(case, f"couple_every 1 {USUAL}", "scatter")
        viscosity = case.variables["viscosity"]
        cells = []
        for part in THINNER:
            case.variables["viscosity"] = viscosity * (1.0 + part)
            cells.append(percent(measured(case, f"couple_every 1 {USUAL}", "scatter", exact)["error"]))
        table.row(name, *cells)
    return table.lines


def strains(names):
    table = Table("scene", "`retriangulate`", "networks", "error (rms)", "largest",
                  "error x networks", "CPU of the flow, s", "mass error", "limit / that of a new network")
    for name in names or cases.STRAINED:
        case = cases.STRAINED[name](1.0)
        held = f"couple_every {HELD.get(name, 5)}"
        exact = measured(case, f"{held} {FINE}", "fine")
        for words in THRESHOLDS:
            run = measured(case, f"{held} retriangulate {words}", words.replace(" ", "_"), exact)
            if run is None:
                table.row(name, words, "ends with an error", *[""] * 6)
                continue
            table.row(name, words, run["networks"], percent(run["error"]), percent(run["worst"]),
                      f"{run['error'] * run['networks']:.2g}", f"{run['flow']:.2f}",
                      f"{abs(run['mass_error']):.0e}", f"{run['limit'] / run['fresh_limit']:.3f}")
    return table.lines


def old_defaults(names):
    """The compression in water: the defaults before, those now, and steps of both."""
    case = cases.compression(1.0)
    exact = measured(case, f"couple_every 1 {FINE}", "fine")
    table = Table("settings", "solves", "networks", "error (rms)", "largest", "CPU of the flow, s", "old / this")
    first = None
    for words in ("couple_every 1 retriangulate 0.01", f"couple_every 1 {USUAL}", f"couple_every auto {USUAL}",
                  "couple_every auto retriangulate mean 0.02", "couple_every auto retriangulate mean 0.04",
                  "couple_every 10 retriangulate 0.05"):
        run = measured(case, words, words.replace(" ", "_"), exact)
        first = first or run["flow"]
        table.row(words, run["solves"] or run["all_solves"] - 1, run["networks"], percent(run["error"]),
                  percent(run["worst"]), f"{run['flow']:.2f}", f"{first / run['flow']:.1f}")
    return table.lines


TABLES = {"intervals": intervals, "scatter": scatter, "strains": strains, "old_defaults": old_defaults}


def work(words):
    write = words[:1] == ["write"]
    names = [word for word in words[write:] if word in TABLES] or list(TABLES)
    scenes = [word for word in words[write:] if word not in TABLES]
    known = {*cases.CASES, *cases.STRAINED}
    chosen = [name for word in scenes for name in word.split(",")]
    for name in chosen:
        if name not in known:
            raise scene.BadSetting(f"there is no table or scene '{name}'; tables: {', '.join(TABLES)}; "
                                   f"scenes: {', '.join(sorted(known))}")
    for name in names:
        print(f"{name}:", flush=True)
        lines = TABLES[name](chosen)
        if write:
            put_into(PAGE, name, lines)
    return True


if __name__ == "__main__":
    scene.main("solve_interval", work)

#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of doc/solvers.md that stand between markers, each by its program:

    tests/bench/solver_tables.py [--build BUILD] [TABLE...]      (solvers, bound, precision, background, refreshed,
                                                                 cells, sizes, once, auto, tolerance, starts, flux)

CPU times: compare the columns of a table, which one run has made.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "doc/solvers.md"


def output(*command):
    done = subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True,
                          env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
    return done.stdout.strip()


def precision(build):
    lines = ["| CPU ms of a step | 5000 spheres | 20000 spheres | residual |", "|--|--|--|--|"]
    with tempfile.TemporaryDirectory() as folder:
        for name in ("double", "mixed"):
            report = pathlib.Path(folder) / "bench.json"
            output(build / "bin/pfv", "bench", "--spheres", "5000,20000", "--precision", name,
                   "--repeat", 3, "--report", report)
            rows = json.loads(report.read_text())["rows"]
            steps = [f"{1e3 * row['cpu_seconds']['step']['median']:.3g}" for row in rows]
            residuals = ", ".join(f"{row['residual']:.0e}" for row in rows)
            lines.append(f"| {name} | " + " | ".join(steps) + f" | {residuals} |")
    return "\n".join(lines)


SIZES = (1000, 5000, 20000)
SOLVERS = ("supernodal", "cholmod", "tacho", "mumps", "klu2", "amg", "cg", "gauss_seidel")
ORDERINGS = ("geometric", "metis", "amd", "auto")


def solve_bench(build, *options):
    """{(solver, ordering): {spheres: counters}}, medians of runs in random order."""
    report = json.loads(output(build / "bin/pfv_solve_bench", "--benchmark_repetitions=3", *options,
                               "--benchmark_enable_random_interleaving=true", "--benchmark_format=json"))
    rows = {}
    for row in report["benchmarks"]:
        if row.get("aggregate_name") == "median":
            solver, ordering, spheres = row["run_name"].split("/")[:3]
            rows.setdefault((solver, ordering), {})[int(spheres)] = row
    return dict(sorted(rows.items(), key=lambda row: (SOLVERS.index(row[0][0]), ORDERINGS.index(row[0][1]))))


def digits(number):
    return f"{number:.3g}" if number < 999.5 else f"{float(f'{number:.3g}'):.0f}"


def entries(sizes, text, value):
    return " / ".join(text(value(sizes[size])) if size in sizes else "–" for size in SIZES)


def solvers(build):
    rows = solve_bench(build)
    lines = ["| solver, ordering | order 1k / 5k / 20k | factor | solve | order + factor + 100 solves | "
             "over supernodal's | MB held | residual |", "|--" * 8 + "|"]
    for (solver, ordering), sizes in rows.items():
        ours = rows.get(("supernodal", ordering), rows["supernodal", "geometric"])
        cells = [entries(sizes, digits, lambda row, name=name: row[name])
                 for name in ("order", "factor", "solve", "hundred")]
        ratios = " / ".join(f"{sizes[size]['hundred'] / ours[size]['hundred']:.2f}" if size in sizes else "–"
                            for size in SIZES)
        name = f"{solver}, {ordering}" if ordering != "auto" else solver
        lines.append(f"| {name} | " + " | ".join(cells) + f" | {ratios} | " +
                     entries(sizes, digits, lambda row: row["memory_MB"]) + " | " +
                     entries(sizes, "{:.0e}".format, lambda row: row["residual"]) + " |")
    load = ", ".join(f"{load:.1f}" for load in os.getloadavg())
    return f"Load averages at the end {load}.\n\n" + "\n".join(lines)


def bound(build):
    sizes = solve_bench(build, "--benchmark_filter=supernodal/geometric")["supernodal", "geometric"]
    lines = ["| spheres | entries of L, million | bandwidth, GB/s | bound, ms | solve, ms | solve / bound |",
             "|--" * 6 + "|"]
    for size, row in sizes.items():
        lines.append(f"| {size} | {row['entries_M']:.3g} | {row['bandwidth_GB_s']:.3g} | {row['bound']:.3g} | "
                     f"{row['solve']:.3g} | {row['solve'] / row['bound']:.2f} |")
    return "\n".join(lines)


def cpu_of_solving(build, packing, solver, runs):
    """Least CPU s of whole programs, and what one said of its solver."""
    least = float("inf")
    for _ in range(runs):
        before = os.times()
        output(build / "bin/pfv", "solve", "--packing", packing, *"--box 0 1 0 1 0 1 --wall symmetry".split(), "--face",
               "zlo:pressure=0", "--face", "zhi:pressure=1", "--solver", solver, "--report", packing.with_suffix(".json"))
        after = os.times()
        least = min(least, after.children_user + after.children_system - before.children_user - before.children_system)
    return least, json.loads(packing.with_suffix(".json").read_text())["solver"]


def once(build):
    lines = ["| spheres | `pfv solve` by `supernodal`, s | by `amg`, s | `auto` takes | over the better |", "|--" * 5 + "|"]
    with tempfile.TemporaryDirectory() as folder:
        for size in ONCE_SIZES:
            packing = pathlib.Path(folder) / "packing.csv"
            packing.write_text(output(build / "bin/pfv_dense_packing", size))
            runs = 5 if size <= 20000 else 1
            found = {solver: cpu_of_solving(build, packing, solver, runs)[0] for solver in ("supernodal", "amg")}
            taken = cpu_of_solving(build, packing, "auto", 1)[1]
            lines.append(f"| {size} | {found['supernodal']:.3g} | {found['amg']:.3g} | {taken} | "
                         f"{found[taken] / min(found.values()):.2f} |")
    return "\n".join(lines)


ONCE_SIZES = (1000, 2000, 5000, 10000, 14900, 15000, 20000, 50000, 100000, 200000)
AUTO_SIZES = (1000, 2000, 5000, 10000, 20000, 49000, 50000, 100000, 200000)

TABLES = {
    "solvers": solvers,
    "bound": bound,
    "precision": precision,
    "background": lambda build: output(build / "bin/pfv_background_bench"),
    "refreshed": lambda build: output(build / "bin/pfv_refresh_bench").partition("\n\n")[2],
    "cells": lambda build: output(build / "bin/pfv_refresh_bench", "cells"),
    "sizes": lambda build: output(build / "bin/pfv_amg_bench", "sizes", 5000, 20000, 100000),
    "once": once,
    "auto": lambda build: output(build / "bin/pfv_amg_bench", "auto", *AUTO_SIZES),
    "tolerance": lambda build: output(build / "bin/pfv_amg_bench", "tolerance"),
    "starts": lambda build: output(build / "bin/pfv_amg_bench", "starts"),
    "flux": lambda build: output(build / "bin/pfv_amg_bench", "flux"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("tables", nargs="*", metavar="TABLE", choices=list(TABLES))
    arguments = parser.parse_args()
    for name in arguments.tables or TABLES:
        table = TABLES[name](arguments.build)
        mark = re.compile(f"(<!-- {name}: [^>]*-->\n).*?(<!-- end -->)", re.S)
        text, count = mark.subn(lambda m: m[1] + table + "\n" + m[2], DOCUMENT.read_text())
        if count != 1:
            raise SystemExit(f"{DOCUMENT.name} has no markers for {name}")
        DOCUMENT.write_text(text)
        print(f"{name}\n{table}\n")


if __name__ == "__main__":
    main()

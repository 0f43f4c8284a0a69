#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of doc/solvers.md that stand between markers, each by its program:

    tests/bench/solver_tables.py [--build BUILD] [TABLE...]      (precision, background, refreshed, cells)

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


TABLES = {
    "precision": precision,
    "background": lambda build: output(build / "bin/pfv_background_bench"),
    "refreshed": lambda build: output(build / "bin/pfv_refresh_bench").partition("\n\n")[2],
    "cells": lambda build: output(build / "bin/pfv_refresh_bench", "cells"),
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

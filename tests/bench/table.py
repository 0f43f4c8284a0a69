#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the benchmarks of each phase and writes doc/benchmarks.md:  tests/bench/table.py [BUILD]

Times are CPU milliseconds of one thread, medians of five repetitions; they are this machine's, so
quote ratios of one table. Peak memory is that of one `pfv solve` a size, in a process of its own.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
SIZES = (1000, 5000, 20000)


def phases():
    command = [BUILD / "bin/pfv_phases", "--benchmark_format=json", "--benchmark_repetitions=5",
               "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.05"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def solve_report(size, folder):
    packing, report = folder / f"{size}.csv", folder / f"{size}.json"
    with open(packing, "w", encoding="ascii") as file:
        subprocess.run([BUILD / "bin/pfv_dense_packing", str(size)], check=True, stdout=file)
    subprocess.run([BUILD / "bin/pfv", "solve", "--packing", packing, "--box", "0", "1", "0", "1",
                    "0", "1", "--wall", "symmetry", "--face", "zlo:pressure=0", "--face",
                    "zhi:pressure=1", "--repeat", "20", "--report", report],
                   check=True, capture_output=True)
    return json.loads(report.read_text())


def main():
    measured = phases()
    times = {}
    for row in measured["benchmarks"]:
        if row["aggregate_name"] == "median":
            phase, size = row["run_name"].split("/")
            times.setdefault(phase, {})[int(size)] = row["cpu_time"]
    with tempfile.TemporaryDirectory() as folder:
        reports = {size: solve_report(size, pathlib.Path(folder)) for size in SIZES}

    head = "| | " + " | ".join(f"{size} grains" for size in SIZES) + " |\n"
    rule = "|---|" + "---|" * len(SIZES) + "\n"
    text = "# Benchmarks\n\nMade by `tests/bench/table.py` (dense random packings, solid fraction " \
           "0.6, of the project's own; CPU\nmilliseconds of one thread, medians of five). " \
           "Absolute times are this machine's: compare within the table.\n\n"
    text += f"Load average before the run: {measured['context']['load_avg'][0]:.1f}; " \
            f"{os.cpu_count()} cores.\n\n## Phases\n\n" + head + rule
    for phase, by_size in times.items():
        name = phase.replace("_", " ")
        text += f"| {name} | " + " | ".join(f"{by_size[size]:.3g}" for size in SIZES) + " |\n"
    text += "\n`rebuild` is everything from a packing to forces, `step` what a kept network costs; both " \
            "use the\nautomatic ordering, which is geometric, while the rows of the solver alone show METIS.\n"
    text += "\n## `pfv solve --repeat 20`\n\n" + head + rule
    rows = (("pores", lambda r: r["pores"]), ("unknowns", lambda r: r["unknowns"]),
            ("whole solve, CPU ms", lambda r: f"{1e3 * r['seconds']['total']:.3g}"),
            ("step, CPU ms", lambda r: f"{1e3 * r['seconds']['step']:.3g}"),
            ("peak memory, MB", lambda r: f"{r['peak_memory_bytes'] / 1e6:.0f}"),
            ("residual", lambda r: f"{r['residual']:.1e}"),
            ("mass error", lambda r: f"{abs(r['mass_error']):.1e}"))
    for name, value in rows:
        text += f"| {name} | " + " | ".join(str(value(reports[size])) for size in SIZES) + " |\n"
    document = ROOT / "doc/benchmarks.md"
    others = re.search(r"\n## (Against YADE|Only what a scene needs)\n.*", document.read_text(), re.S)
    document.write_text(text + (others[0] if others else ""))  # the sections of other scripts stay
    print(text)


if __name__ == "__main__":
    main()

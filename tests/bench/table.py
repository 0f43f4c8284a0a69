#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times each phase with `pfv bench` and writes doc/benchmarks.md:  tests/bench/table.py [BUILD]

CPU time of the whole process, medians of five; absolute times are this machine's, so quote ratios
of one table.
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


def bench(*options):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "bench.json"
        subprocess.run([BUILD / "bin/pfv", "bench", "--spheres", ",".join(map(str, SIZES)), *options,
                        "--report", report], check=True, capture_output=True,
                       env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        return json.loads(report.read_text())


def table(head, rows):
    """rows: (name, one text a size)."""
    lines = [f"| {head} | " + " | ".join(f"{size} grains" for size in SIZES) + " |",
             "|---" * (len(SIZES) + 1) + "|"]
    return "\n".join(lines + [f"| {name} | " + " | ".join(cells) + " |" for name, cells in rows])


def medians(report, clock, name):
    return [row[clock][name]["median"] for row in report["rows"]]


def milliseconds(report, clock, name):
    return [f"{1e3 * seconds:.3g}" for seconds in medians(report, clock, name)]


def phases(report):
    rows = [(name, milliseconds(report, "cpu_seconds", name)) for name in report["rows"][0]["cpu_seconds"]]
    for name, key, form in (("pores", "pores", "d"), ("unknowns", "unknowns", "d"),
                            ("residual", "residual", ".1e"), ("mass error", "mass_error", ".1e")):
        rows.append((name, [format(row[key], form) for row in report["rows"]]))
    rows.append(("peak memory, MB", [f"{row['memory_bytes'] / 1e6:.0f}" for row in report["rows"]]))
    return table("CPU ms", rows)


def steps(runs):
    return table("wall ms", [(f"{what}, {name}", milliseconds(report, "wall_seconds", what))
                             for what in ("rebuild", "step") for name, report in runs.items()])


def main():
    runs = {"one thread": bench(), "two threads": bench("--threads", "2"),
            "one thread, mixed precision": bench("--precision", "mixed")}
    report = runs["one thread"]
    text = f"""# Benchmarks

Made by `tests/bench/table.py` with `pfv bench` (dense random packings of the project's own, solid
fraction 0.6; one thread, medians of five). Absolute times are this machine's: compare within a table.
Load average before the run {report['machine']['load_before']:.1f}, after it {report['machine']['load_after']:.1f}; {report['machine']['cores']} cores.

## Phases

{phases(report)}

`rebuild` is everything from a packing to forces where a network was before, `first` the same from nothing, `step` what a kept network costs while the grains'
velocities change by 0.1 % a step. `solve` is the first one on a network: it reads the factor for the first time, and a second
solve finds out whether a step needs corrections, which these do not; that is why it is above a whole `step`.

## Threads and precision

{steps(runs)}
"""
    document = ROOT / "doc/benchmarks.md"
    others = re.search(r"\n## (Against YADE|Only what a scene needs)\n.*", document.read_text(), re.S)
    document.write_text(text + (others[0] if others else ""))  # the sections of other scripts stay
    print(text)


if __name__ == "__main__":
    main()

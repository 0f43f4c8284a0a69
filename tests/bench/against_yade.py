#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times YADE's FlowEngine and this library in turn on the same packings, one thread each, and writes
the section of doc/benchmarks.md:

    tests/bench/against_yade.py [--build BUILD] [--rounds N] [SPHERES...]

Needs Debian's package yade. CPU seconds of whole processes' threads; quote the ratios.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADING = "## Against YADE"
ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def run(command):
    done = subprocess.run([str(word) for word in command], env=ONE_THREAD, capture_output=True,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"{pathlib.Path(command[0]).name} failed: {(done.stderr or done.stdout)[-500:]}")


def ours(build, size, folder):
    report = folder / "ours.json"
    run([build / "bin/pfv", "bench", "--spheres", size, "--repeat", 3, "--report", report])
    row = json.loads(report.read_text())["rows"][0]
    return {"rebuild": row["cpu_seconds"]["rebuild"]["median"],
            "step": row["cpu_seconds"]["step"]["median"], "memory": row["memory_bytes"]}


def theirs(packing, folder):
    result = folder / "yade.json"
    result.unlink(missing_ok=True)
    run(["yade", "-n", "-x", "-j1", ROOT / "tests/bench/yade_flow.py", packing, result])
    if not result.exists():
        sys.exit("yade wrote no result; run tests/bench/yade_flow.py by hand to see why")
    return json.loads(result.read_text())


def section(rows, loads):
    text = (f"{HEADING}\n\nMade by `tests/bench/against_yade.py`: YADE 2023.02a (Debian's `yade`: FlowEngine,"
            " CHOLMOD, `useSolver=3`)\nand `pfv bench` in turn on the same packings, one thread each, medians;"
            " CPU time. YADE's rebuild is a later one,\nthe sum of the two steps that it takes; memory is what"
            " the process needs above the loaded packing. Load\naverage "
            f"{min(loads):.0f} to {max(loads):.0f} on {os.cpu_count()} cores while it ran: quote the ratios.\n\n"
            "| spheres | rebuild, ms: YADE / pfv | ratio | step, ms: YADE / pfv | ratio | memory, MB: YADE / pfv |"
            " part |\n|--|--|--|--|--|--|--|\n")
    for size, (yade, pfv) in rows.items():
        cells = [str(size)]
        for key in ("rebuild", "step"):
            cells += [f"{1e3 * yade[key]:.3g} / {1e3 * pfv[key]:.3g}", f"{yade[key] / pfv[key]:.2f}"]
        cells += [f"{yade['memory'] / 1e6:.0f} / {pfv['memory'] / 1e6:.0f}",
                  f"{pfv['memory'] / yade['memory']:.0%}"]
        text += "| " + " | ".join(cells) + " |\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("spheres", type=int, nargs="*")
    arguments = parser.parse_args()
    if not shutil.which("yade"):
        sys.exit("there is no yade: apt-get install yade")
    rows, loads = {}, [os.getloadavg()[0]]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for size in arguments.spheres or [5000, 20000, 50000]:
            packing = folder / "packing.csv"
            with open(packing, "w", encoding="ascii") as file:
                subprocess.run([arguments.build / "bin/pfv_dense_packing", str(size)], check=True,
                               stdout=file)
            rounds = [(theirs(packing, folder), ours(arguments.build, size, folder))
                      for _ in range(arguments.rounds)]
            rows[size] = [{key: statistics.median(pair[side][key] for pair in rounds)
                           for key in ("rebuild", "step", "memory")} for side in (0, 1)]
            loads.append(os.getloadavg()[0])
    document = ROOT / "doc/benchmarks.md"
    before, _, after = document.read_text().partition(HEADING)
    rest = after.find("\n## ")
    document.write_text(before.rstrip() + "\n\n" + section(rows, loads)
                        + (after[rest:] if rest >= 0 else ""))
    print(section(rows, loads))


if __name__ == "__main__":
    main()

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
LARGE = 50000  # spheres from which on one round is enough: minutes
ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def run(command):
    done = subprocess.run([str(word) for word in command], env=ONE_THREAD, capture_output=True,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"{pathlib.Path(command[0]).name} failed: {(done.stderr or done.stdout)[-500:]}")


def ours(build, size, folder):
    report = folder / "ours.json"
    rows = []
    for threads, repeat in ((1, 3), (2, 2)):
        run([build / "bin/pfv", "bench", "--spheres", size, "--repeat", repeat, "--threads", threads,
             "--report", report])
        rows.append(json.loads(report.read_text())["rows"][0])
    result = {"memory": rows[0]["memory_bytes"]}
    for key in ("rebuild", "step"):
        result[key] = rows[0]["cpu_seconds"][key]["median"]
        result[f"shared {key}"] = rows[1]["wall_seconds"][key]["median"]
    return result


def theirs(packing, folder):
    result = folder / "yade.json"
    result.unlink(missing_ok=True)
    run(["yade", "-n", "-x", "-j1", ROOT / "tests/bench/yade_flow.py", packing, result, "symmetry"])
    if not result.exists():
        sys.exit("yade wrote no result; run tests/bench/yade_flow.py by hand to see why")
    return json.loads(result.read_text())


def section(rows, loads, rounds):
    text = (f"{HEADING}\n\nMade by `tests/bench/against_yade.py`: YADE 2023.02a (Debian's `yade`: FlowEngine,"
            " CHOLMOD, `useSolver=3`)\nand `pfv bench` in turn on the same packings, one thread each, medians;"
            " CPU time. YADE's rebuild is a later one,\nthe sum of the two steps that it takes; memory is what"
            " the process needs above the loaded packing. Load\naverage "
            f"{min(loads):.0f} to {max(loads):.0f} on {os.cpu_count()} cores while it ran: quote the ratios (median, least"
            f" to most of {rounds} rounds; one from {LARGE} spheres on).\nThe last column is the wall time of our rebuild and step with two threads,"
            " against YADE's CPU time of one.\n\n"
            "| spheres | rebuild, ms: YADE / pfv | ratio | step, ms: YADE / pfv | ratio | memory, MB: YADE / pfv |"
            " part | two threads: rebuild, step |\n|--|--|--|--|--|--|--|--|\n")
    for size, pairs in rows.items():
        median = [{key: statistics.median(pair[side][key] for pair in pairs) for key in pairs[0][side]}
                  for side in (0, 1)]
        yade, pfv = median
        cells = [str(size)]
        for key in ("rebuild", "step"):
            ratios = [pair[0][key] / pair[1][key] for pair in pairs]
            cells += [f"{1e3 * yade[key]:.3g} / {1e3 * pfv[key]:.3g}",
                      f"{statistics.median(ratios):.2f} ({min(ratios):.2f}–{max(ratios):.2f})"]
        cells += [f"{yade['memory'] / 1e6:.0f} / {pfv['memory'] / 1e6:.0f}",
                  f"{pfv['memory'] / yade['memory']:.0%}",
                  " and ".join(f"{yade[key] / pfv[f'shared {key}']:.2f}" for key in ("rebuild", "step"))]
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
            rows[size] = [(theirs(packing, folder), ours(arguments.build, size, folder))
                          for _ in range(arguments.rounds if size < LARGE else 1)]
            loads.append(os.getloadavg()[0])
    document = ROOT / "doc/benchmarks.md"
    before, _, after = document.read_text().partition(HEADING)
    rest = after.find("\n## ")
    document.write_text(before.rstrip() + "\n\n" + section(rows, loads, arguments.rounds)
                        + (after[rest:] if rest >= 0 else ""))
    print(section(rows, loads, arguments.rounds))


if __name__ == "__main__":
    main()

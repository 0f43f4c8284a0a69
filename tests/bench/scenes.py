#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene costs that asks for no more than it needs, and writes the section of doc/benchmarks.md:

    tests/bench/scenes.py [BUILD] [SPHERES]

Each row is a `pfv solve` of its own on the same packing: CPU time and peak memory of the process, and
the report's counts, where the scene writes one.
"""
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build"
SPHERES = int(sys.argv[2]) if len(sys.argv) > 2 else 5000
HEADING = "## Only what a scene needs"
COUNTS = ("triangulate", "order", "factor", "solve", "force_matrix", "volume_rate")

# name, further arguments, whether the grains move
SCENES = (
    ("permeability only", [], False),
    ("still grains with forces", ["--report", "r.json", "--forces", "f.csv"], False),
    ("the same with gravity", ["--report", "r.json", "--forces", "f.csv", "--gravity", "0", "0",
                               "-9.81"], False),
    ("moving grains", ["--report", "r.json", "--forces", "f.csv"], True),
    ("moving grains with gravity", ["--report", "r.json", "--forces", "f.csv", "--gravity", "0",
                                    "0", "-9.81"], True),
)


def run(command, folder):
    """CPU seconds and peak bytes of one process."""
    process = subprocess.Popen([str(word) for word in command], cwd=folder,
                               stdout=subprocess.DEVNULL,
                               env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit("pfv solve failed: " + " ".join(str(word) for word in command))
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def packings(folder):
    """The same grains at rest and in motion."""
    text = subprocess.run([BUILD / "bin/pfv_dense_packing", str(SPHERES)], check=True,
                          capture_output=True, text=True).stdout
    rows = text.split()
    (folder / "still.csv").write_text(text)
    moving = [rows[0] + ",vx,vy,vz"] + [f"{row},0,0,-{row.split(',')[3]}" for row in rows[1:]]
    (folder / "moving.csv").write_text("\n".join(moving) + "\n")


def libraries(program):
    listed = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
    names = [line.split()[0] for line in listed.splitlines() if "=>" in line]
    has = [word for word in ("vtk", "dmumps", "liggghts", "mpi") if any(word in n for n in names)]
    return len(names), has


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        packings(folder)
        text = (f"{HEADING}\n\nMade by `tests/bench/scenes.py` with {SPHERES} spheres: processes of `pfv "
                "solve`, reading and writing included; load\naverage "
                f"{os.getloadavg()[0]:.0f}. Counts are the report's (permeability alone writes none: its "
                "forces are not made).\n\n| scene | CPU, s | peak memory, MB | "
                + " | ".join(COUNTS) + " |\n" + "|--" * (3 + len(COUNTS)) + "|\n")
        for scene, arguments, moves in SCENES:
            (folder / "r.json").unlink(missing_ok=True)
            cpu, memory = run([BUILD / "bin/pfv", "solve", "--packing",
                               "moving.csv" if moves else "still.csv", "--box", "0", "1", "0", "1",
                               "0", "1", "--wall", "symmetry", "--face", "zlo:pressure=0",
                               "--face", "zhi:pressure=1", *arguments], folder)
            report = folder / "r.json"
            counts = json.loads(report.read_text())["counts"] if report.exists() else {}
            text += (f"| {scene} | {cpu:.2f} | {memory / 1e6:.0f} | "
                     + " | ".join(str(counts.get(key, "–")) for key in COUNTS) + " |\n")
    number, special = libraries(BUILD / "bin/pfv")
    text += (f"\n`pfv` links {number} shared libraries, among them of VTK, MUMPS, LIGGGHTS and MPI: "
             f"{', '.join(special) or 'none'}"
             " (the solver mumps, and what Debian's Amesos2 itself depends on).\n")
    document = ROOT / "doc/benchmarks.md"
    before, _, after = document.read_text().partition(HEADING)
    rest = after.find("\n## ")
    document.write_text(before.rstrip() + "\n\n" + text + (after[rest:] if rest >= 0 else ""))
    print(text)


if __name__ == "__main__":
    main()

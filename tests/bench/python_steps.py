#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a step from Python costs beside one from C++ (that nothing is copied tests/python/test_arrays.py checks):

PYTHONPATH=build/python PFV_COMMAND=build/bin/pfv tests/bench/python_steps.py [GRAINS...]

The host in C++ is `pfv solve --repeat`: the same grains from a file, the same steps on a kept network. CPU times, medians
of the steps, the least of some rounds in which both hosts take turns.
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import pfv

STEPS, ROUNDS = 200, 5
BOX = [[0, 1]] * 3


class Bed:
    """Moving grains, as arrays and as a file."""

    def __init__(self, spheres, folder):
        grains = pfv.dense_packing(spheres)
        self.x, self.r = np.array(grains.positions), np.array(grains.radii)
        self.v = np.column_stack([0.1 * self.x[:, 1], np.zeros(spheres), np.zeros(spheres)])
        self.path = pathlib.Path(folder, "bed.csv")
        pfv.write_packing(self.path, pfv.Packing(self.x, self.r, self.v))

    def from_python(self):
        """s a step: (all of it, without what the library counts itself)"""
        flow = pfv.Flow(pfv.Box(BOX).face("zlo", pressure=1.0).face("zhi", pressure=0.0))
        flow.evaluate(self.x, self.r, self.v)
        counted, each = flow.report()["seconds"]["total"], []
        for _ in range(STEPS):
            start = time.process_time()
            flow.evaluate(self.x, self.r, self.v)
            each.append(time.process_time() - start)
        return statistics.median(each), (sum(each) - flow.report()["seconds"]["total"] + counted) / STEPS

    def from_cpp(self):
        report = self.path.with_name("report.json")
        subprocess.run([os.environ.get("PFV_COMMAND", "build/bin/pfv"), "solve", "--packing", self.path, "--box", *"010101",
                        "--face", "zlo:pressure=1", "--face", "zhi:pressure=0", "--repeat", str(STEPS), "--report", report],
                       check=True, capture_output=True)
        return json.loads(report.read_text())["seconds"]["step"]


print("| grains | C++, ms a step | Python, ms | over C++, % | outside the library, us | % |")
print("|---|---|---|---|---|---|")
with tempfile.TemporaryDirectory() as folder:
    for spheres in [int(word) for word in sys.argv[1:]] or (200, 1000, 5000, 20000):
        bed = Bed(spheres, folder)
        rounds = [(bed.from_cpp(), *bed.from_python()) for _ in range(ROUNDS)]
        cpp, python, outside = (min(column) for column in zip(*rounds))
        print(f"| {spheres} | {1e3 * cpp:.3f} | {1e3 * python:.3f} | {100 * (python / cpp - 1):.2f} | {1e6 * outside:.1f} | "
              f"{100 * outside / python:.2f} |", flush=True)

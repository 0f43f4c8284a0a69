#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a step from Python costs beside the library's own time: PYTHONPATH=build/python tests/bench/python_steps.py"""
import time

import numpy as np
import pfv

STEPS = 200


def measure(spheres):
    """CPU seconds of a step of moving grains on a kept network: all, and those that the library counts."""
    bed = pfv.dense_packing(spheres)
    velocities = np.column_stack([0.1 * bed.positions[:, 1], np.zeros(spheres), np.zeros(spheres)])
    flow = pfv.Flow(pfv.Box([[0, 1]] * 3).face("zlo", pressure=1.0).face("zhi", pressure=0.0))
    flow.evaluate(bed.positions, bed.radii, velocities)
    before, start = flow.report()["seconds"]["total"], time.process_time()
    for _ in range(STEPS):
        flow.evaluate(bed.positions, bed.radii, velocities)
    whole = time.process_time() - start
    return whole / STEPS, (flow.report()["seconds"]["total"] - before) / STEPS


print("| grains | a step, ms | of it outside the library, us | per cent |")
print("|---|---|---|---|")
for spheres in (200, 1000, 5000, 20000):
    whole, inside = measure(spheres)
    print(f"| {spheres} | {1e3 * whole:.3f} | {1e6 * (whole - inside):.1f} | {100 * (whole - inside) / inside:.2f} |")

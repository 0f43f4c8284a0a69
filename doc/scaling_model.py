# SPDX-License-Identifier: GPL-3.0-or-later
"""What several ranks tell each other, and what that and the tables of doc/scaling.md make one expect of more. For
doc/scaling.py."""
import json
import math
import subprocess

LATENCY = 2e-6    # s a message, and a step of a sum over all ranks
BANDWIDTH = 10e9  # bytes a second from rank to rank
PREDICTED = (1, 16, 64, 256, 1024)


def counted(folder, command, mpirun, ranks, library):
    """Cycles, and messages, bytes and sums a cycle of the mean rank."""
    name = folder / "messages.json"
    subprocess.run([*mpirun, "-x", f"LD_PRELOAD={library}", "-x", f"PFV_MESSAGE_COUNT={name}", "-n", str(ranks), *command],
                   cwd=folder, check=True, capture_output=True)
    found = json.loads(name.read_text())
    cycles = found["cycles"]
    return cycles, found["messages"] / cycles / ranks, found["bytes"] / cycles / ranks, found["sums"] / cycles


def shared_sides(ranks):
    """How many of the six sides of a part are shared with another, in the mean: parts by halving the longest edge."""
    cuts = [1, 1, 1]
    while math.prod(cuts) < ranks:
        cuts[cuts.index(min(cuts))] *= 2
    return 2.0 * sum(1.0 - 1.0 / cut for cut in cuts)


def rows_of(page, name):
    """Numbers of a table of the page."""
    begin = page.index(f"<!-- {name}: made by")
    lines = page[begin:page.index("<!-- end -->", begin)].splitlines()[3:]
    return [[float(cell) for cell in line.strip("| ").split("|")] for line in lines if line.startswith("|")]


def mean(values):
    values = list(values)
    return sum(values) / len(values)


class Model:
    """`grains`: of the table `ranks`; `counts`: {ranks: what `counted` gives} for that packing; `cycles`: of a step."""

    def __init__(self, page, grains, counts, cycles):
        ranks = rows_of(page, "ranks")
        several = ranks[1:]
        part = lambda row: (grains / row[0]) ** (1.0 / 3.0)
        self.halo_work = mean((row[8] / ranks[0][8] - 1.0) * part(row) / shared_sides(int(row[0])) for row in several)
        self.halo_memory = mean((row[2] - 1.0) * part(row) / shared_sides(int(row[0])) for row in several)
        of_one = [row for row in rows_of(page, "coupled") if row[1] == 1]
        self.network, self.step = (max(of_one)[3] / max(of_one)[0], max(of_one)[5] / max(of_one)[0])  # s a grain
        self.memory = ranks[0][1] / grains  # MB a grain
        self.messages = max(count[1] for count in counts.values())
        self.sums = mean(count[3] for count in counts.values())
        self.bytes = mean(count[2] / shared_sides(p) / (grains / p) ** (2.0 / 3.0) for p, count in counts.items())
        self.cycles = cycles

    def halo(self, factor, grains, ranks):
        return 1.0 + factor * shared_sides(ranks) * (grains / ranks) ** (-1.0 / 3.0)

    def telling(self, grains, ranks):
        """s a flow step."""
        if ranks == 1:
            return 0.0
        sent = self.bytes * shared_sides(ranks) * (grains / ranks) ** (2.0 / 3.0)
        return self.cycles * (self.messages * LATENCY + sent / BANDWIDTH + self.sums * LATENCY * math.log2(ranks))

    def rows(self, sizes):
        for grains in sizes:
            for ranks in PREDICTED:
                each = self.halo(self.halo_work, grains, ranks) / ranks * grains
                telling = self.telling(grains, ranks)
                step = self.step * each + telling
                yield [f"{grains}", f"{ranks}", f"{step:.2g}", f"{1e3 * telling:.1f}", f"{self.network * each:.2g}",
                       f"{self.memory * grains / ranks * self.halo(self.halo_memory, grains, ranks):.0f}",
                       f"{100.0 * self.step * grains / ranks / step:.0f} %"]

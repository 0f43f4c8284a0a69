# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory over many retriangulations. PFV_REBUILDS: how many (default 200, in ./test.sh long 2000)."""
import itertools
import json
import os
import statistics
import unittest

from coupled import FLOW, CoupledTest, packing, random_velocities, read_thermo, write_data
from settled import WALLS

REBUILDS = int(os.environ.get("PFV_REBUILDS", "400"))
SAMPLES = 10
# memory of LIGGGHTS that is no file's (a loaded machine brings pages of libraries in late), from
# the shell that it starts
SAMPLE = """process=$PPID
until grep -q liggghts /proc/$process/comm; do
  process=$(awk '/^PPid:/ {print $2}' /proc/$process/status)
done
awk '/^RssAnon:/ {print $2}' /proc/$process/status >> memory.txt
"""


class Endurance(CoupledTest):
    def resident(self, words):
        """kB at the end of each tenth of the run, and its retriangulations."""
        write_data(self.folder, packing(5), random_velocities(packing(5)))
        (self.folder / "sample.sh").write_text(SAMPLE)
        (self.folder / "memory.txt").write_text("")
        tenth = f"run {REBUILDS // SAMPLES}\nshell sh sample.sh\n"
        self.liggghts("include in.packing\n" + WALLS + "fix g all gravity 9.81 vector 0 0 -1\n"
                      f"fix flow all pfv {FLOW} retriangulate 1e-9 {words}\n"
                      "thermo_style custom step f_flow[5]\n" + tenth * SAMPLES)
        rows = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertGreaterEqual(rows[-1]["flow[5]"], REBUILDS - 2)
        memory = [int(line) for line in (self.folder / "memory.txt").read_text().splitlines()]
        self.assertEqual(len(memory), SAMPLES)
        return memory

    def test_resident_memory_is_flat(self):
        """Of 125 grains, whose network and factor take more than a megabyte: a leak grows in every
        tenth, the allocator takes a few megabytes in the first two hundred networks and keeps them. So the median rise of a
        tenth tells them apart (0 to 12 kB measured), and a wide bound is left for what grows by jumps."""
        for words in ("", "bulk_modulus 1e6", "coupling implicit", "output 10 flow.pvd"):
            memory = self.resident(words)
            rises = [after - before for before, after in itertools.pairwise(memory[1:])]
            self.assertLess(statistics.median(rises), 50, (words, memory))
            self.assertLess(max(memory) - memory[SAMPLES // 2 - 1], 8192, (words, memory))
            if "PFV_RECORD" in os.environ:  # for doc/extremes.py
                with open(os.environ["PFV_RECORD"], "a", encoding="utf-8") as record:
                    record.write(json.dumps({"words": words, "memory": memory}) + "\n")


if __name__ == "__main__":
    unittest.main()

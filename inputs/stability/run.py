#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the explicit coupling of LIGGGHTS with the fluid becomes unstable, and how far the staged
and the implicit one go: the tables of doc/stability.md, each by the module of its name.

    run.py [TABLE...]         called by ./run.sh stability; prints the tables (all unless some are named)
    run.py write [TABLE...]   puts them into doc/stability.md as well
"""
import sys

import accuracy
import beyond
import compressible
import consolidations
import convergence
import costs
import jumps
import limits
import long_lids
import long_steps
import maps
import regions
import sheared
import speed
import spins
import stiffness
import thesis
from tables import write_page

TABLES = {"limits": limits.table, "beyond": beyond.table, "long_steps": long_steps.table,
          "longer": long_steps.longer, "sheared": sheared.table, "sheared_accuracy": sheared.accuracy, "long_lids": long_lids.table, "convergence": convergence.table,
          "accuracy": accuracy.table, "consolidations": consolidations.table, "spins": spins.table,
          "terzaghi": compressible.terzaghi, "jumps": jumps.table, "speed": speed.table,
          "costs": costs.table, "maps": maps.table, "stiffness": stiffness.table,
          "regions": regions.table, "thesis": thesis.table, "compressible": compressible.table,
          "conservation": compressible.conservation}


def main(words):
    write = words[:1] == ["write"]
    names = words[write:] or list(TABLES)
    unknown = [name for name in names if name not in TABLES]
    if unknown:
        raise SystemExit(f"stability: there is no table '{unknown[0]}'; use `run.py [write] [TABLE...]` "
                         f"with {', '.join(TABLES)}")
    for name in names:
        print(f"{name}:", flush=True)
        table = TABLES[name]()
        if write:
            write_page(name, table)


if __name__ == "__main__":
    main(sys.argv[1:])

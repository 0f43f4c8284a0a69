#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaks of ours in the reports of coupled runs:  leaks.py LOG...

LIGGGHTS, Open MPI and its plugins (closed before the check, hence without names that a suppressions file
could match) keep memory until the process ends: what counts is a stack with a function of this project.
Prints those stacks; status 1 if there are any, 2 without a report."""
import pathlib
import re
import sys

OURS = re.compile(r"pfv::|LAMMPS_NS::(Fix)?Pfv|libliggghts_pfv")
# a plugin's address may be that of another library by the time of the check
OTHERS = re.compile(r"PMPI_Init|<unknown module>")


def main():
    reports = [pathlib.Path(name).read_text(errors="replace") for name in sys.argv[1:]]
    stacks = [stack for report in reports for stack in report.split("\n\n") if "leak of" in stack]
    if not stacks:
        print("leaks.py: no leak report; LIGGGHTS' own leaks should be there", file=sys.stderr)
        return 2
    ours = [stack for stack in stacks if OURS.search(stack) and not OTHERS.search(stack)]
    print("\n\n".join(ours))
    print(f"{len(stacks)} leaks in {len(reports)} runs, {len(ours)} of them ours")
    return 1 if ours else 0


if __name__ == "__main__":
    sys.exit(main())

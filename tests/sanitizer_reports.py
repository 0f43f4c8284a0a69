#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is ours in the sanitizers' reports of coupled runs:  sanitizer_reports.py LOG...

Leaks: LIGGGHTS, Open MPI and its plugins (closed before the check, hence without names that a suppressions
file could match) keep memory until the process ends: what counts is a stack with a function of this project.
Invalid accesses count whoever makes them, but for LIGGGHTS' tip of the day, which it prints after one of its
own errors in five from memory that it has freed. (The exit status cannot tell: where leaks alone must not
change it, the sanitizer leaves it alone for accesses, too.)
Prints what counts; status 1 if there is any, 2 without a report."""
import pathlib
import re
import sys

OURS = re.compile(r"pfv::|LAMMPS_NS::(Fix)?Pfv|libliggghts_pfv")
# a plugin's address may be that of another library by the time of the check
OTHERS = re.compile(r"PMPI_Init|<unknown module>")
TIP = re.compile(r"freed by thread.*\n.*operator delete.*\n.*LAMMPS_NS::Error::")


def main():
    reports = [pathlib.Path(name).read_text(errors="replace") for name in sys.argv[1:]]
    leaks = [stack for report in reports for stack in report.split("\n\n") if "leak of" in stack]
    if not leaks:
        print("sanitizer_reports.py: no leak report; LIGGGHTS' own leaks should be there",
              file=sys.stderr)
        return 2
    ours = [stack for stack in leaks if OURS.search(stack) and not OTHERS.search(stack)]
    accesses = [report for report in reports
                if re.search(r"ERROR: AddressSanitizer|runtime error:", report) and not TIP.search(report)]
    print("\n\n".join(ours + accesses))
    print(f"{len(leaks)} leaks in {len(reports)} runs, {len(ours)} of them ours; "
          f"{len(accesses)} invalid accesses or undefined operations")
    return 1 if ours or accesses else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of the build and the words they are called with: one place for scenes and tests."""
import os
from pathlib import Path

BIN = Path(os.environ.get("PFV_BIN", Path(__file__).resolve().parents[2] / "build" / "bin"))


def text_of(value):
    return f"{value:.17g}" if isinstance(value, float) else str(value)


def liggghts_words(script, variables=None, log=None, ranks=1, program=BIN / "liggghts-pfv"):
    """LIGGGHTS with the fix on an input script; variables: {name: value} of -var; log: its file, or "none"."""
    words = [str(program), "-in", script] + (["-log", log] if log else [])
    for name, value in (variables or {}).items():
        words += ["-var", name, text_of(value)]
    if ranks > 1:
        words = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--mca", "mpi_yield_when_idle", "1",
                 "--mca", "orte_create_session_dirs", "1",  # single runs of tests have none
                 "-np", str(ranks)] + words
    return words


def one_thread():
    """The environment of a run beside others."""
    return {**os.environ, "OMP_NUM_THREADS": "1"}


def error_of(screen):
    """The line of a screen output in which LIGGGHTS says why it stopped, or None."""
    return next((line for line in screen.splitlines() if "ERROR" in line), None)


def solve_words(packing, room, viscosity, *words):
    """`pfv solve` on a file; room: the six numbers of a box, or the name of a container's file."""
    held = ["--container", room] if isinstance(room, str) else ["--box", *[text_of(float(number)) for number in room]]
    return [str(BIN / "pfv"), "solve", "--packing", str(packing), *held, "--viscosity", text_of(float(viscosity)), *words]

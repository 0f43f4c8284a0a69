# SPDX-License-Identifier: GPL-3.0-or-later
"""What the module raises and warns of."""
import sys


class Error(Exception):
    """Base of the errors of the library. The message is one line: what is wrong, where, what to do.

    spheres: ids of the spheres that it is about (a tuple, empty where it is about none)
    places: their like for points in space, m (a tuple of (x, y, z))
    """

    spheres = ()
    places = ()


class InputError(Error, ValueError):
    """The input cannot be used; the caller can mend it."""


class SolverError(Error, RuntimeError):
    """A linear solver failed."""


class FileError(Error, OSError):
    """A file could not be written."""


class AccuracyWarning(UserWarning):
    """The estimated error of a permeability may not hold."""


class PackingWarning(UserWarning):
    """Something was assumed in reading a file of spheres."""


def lacking(name, sentence, missing):
    """Ends a module that runs as a program (`name` is its __name__) with a sentence, else raises ImportError."""
    if name == "__main__":
        print(f"pfv: {sentence}", file=sys.stderr)
        sys.exit(2)
    raise ImportError(sentence) from missing


for _class in (Error, InputError, SolverError, FileError, AccuracyWarning, PackingWarning):
    _class.__module__ = "pfv"
del _class

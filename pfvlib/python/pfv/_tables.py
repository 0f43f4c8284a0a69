# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables with a header, as fix pfv and pfv solve write them."""
import csv

import numpy as np

from ._errors import InputError


class Table:
    """Columns by their names; an empty field is NaN."""

    def __init__(self, path):
        self.path = str(path)
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        except (OSError, UnicodeDecodeError, csv.Error) as problem:
            raise InputError(f"cannot read {path}: {problem}: give a table of fix pfv or pfv solve") from None
        if len(rows) < 2:
            raise InputError(f"{path}: has no row below its header: there is nothing to draw")
        self.names = rows[0]
        for number, row in enumerate(rows, 1):
            if len(row) != len(self.names):
                raise InputError(f"{path}:{number}: has {len(row)} fields and its first line {len(self.names)}: give a table of "
                                 "fix pfv or pfv solve, written to its end")
        try:
            values = np.array([[float(word) if word else np.nan for word in row] for row in rows[1:]])
        except ValueError as problem:
            raise InputError(f"{path}: is no table of numbers with a header ({problem})") from None
        self.columns = dict(zip(self.names, values.T))

    def __contains__(self, name):
        return name in self.columns

    def __getitem__(self, name):
        return self.columns[name]

    def has_values(self, name):
        """Whether a column is there and holds something beside zeros."""
        return name in self and bool(np.nan_to_num(self[name]).any())

    def ending_in(self, ending):
        """Names without this ending."""
        return [name[:-len(ending)] for name in self.names if name.endswith(ending)]

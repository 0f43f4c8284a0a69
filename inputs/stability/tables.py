# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the tables and figures of doc/stability.md go."""
import sys

from samples import SCENE

sys.path.insert(0, str(SCENE.parent / "common"))
from page_table import Table, put_into  # noqa: E402, F401: Table for those who write them

PAGE = SCENE.parents[1] / "doc" / "stability.md"
FIGURES = PAGE.parent / "figures"


def write_page(name, table):
    put_into(PAGE, name, table.lines)

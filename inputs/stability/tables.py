# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of doc/stability.md: printed row by row, put between their markers in the page."""
from samples import SCENE

PAGE = SCENE.parents[1] / "doc" / "stability.md"
FIGURES = PAGE.parent / "figures"


class Table:
    def __init__(self, *columns):
        self.lines = []
        self.row(*columns)
        self.lines.append("|" + "---|" * len(columns))

    def row(self, *cells):
        self.lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
        print(self.lines[-1], flush=True)


def write_page(name, table):
    text = PAGE.read_text()
    begin, end = f"<!-- table {name} -->\n", "<!-- end of table -->"
    start = text.index(begin) + len(begin)
    PAGE.write_text(text[:start] + "\n".join(table.lines) + "\n" + text[text.index(end, start):])

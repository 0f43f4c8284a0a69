# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the pages of doc/: printed row by row, put between their markers in a page."""


class Table:
    def __init__(self, *columns):
        self.lines = []
        self.row(*columns)
        self.lines.append("|" + "---|" * len(columns))

    def row(self, *cells):
        self.lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
        print(self.lines[-1], flush=True)


def put_into(page, name, lines):
    """Between `<!-- table NAME -->` and the next `<!-- end of table -->`."""
    text = page.read_text()
    begin, end = f"<!-- table {name} -->\n", "<!-- end of table -->"
    start = text.index(begin) + len(begin)
    page.write_text(text[:start] + "\n".join(lines) + "\n" + text[text.index(end, start):])

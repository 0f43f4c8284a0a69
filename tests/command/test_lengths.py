# SPDX-License-Identifier: GPL-3.0-or-later
"""No function of the sources is longer than 40 lines, and no file than 500, but those named here."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_LINES, MOST_LINES_OF_A_FILE = 40, 500
LONGER = {"pfvlib/src/physics/facet_shapes.cpp: measure": "one loop, which becomes vector instructions as a whole"}
OTHER_BLOCK = re.compile(r" *(if|for|while|switch|else|do|try|catch|namespace|struct|class|enum|union|return|\})\b")


def functions(text):
    """(name, number of lines) of each function of a source whose functions begin at most two columns in and end
    with a brace in the column in which they begin."""
    lines, found, at = text.splitlines(), [], 0
    while at < len(lines):
        first = at
        if lines[at].endswith("{"):
            open_ones = lines[at].count("(") - lines[at].count(")")
            while open_ones < 0 and first > 0:  # arguments that began in a line above
                first -= 1
                open_ones += lines[first].count("(") - lines[first].count(")")
            indent = len(lines[first]) - len(lines[first].lstrip())
            name = re.search(r"([\w~]+|operator\W+)\s*\(", lines[first])
            if indent <= 2 and name and not OTHER_BLOCK.match(lines[first]):
                end = at
                while not lines[end].startswith(" " * indent + "}"):
                    end += 1
                found.append((name[1], end - first + 1))
                at = end
        at += 1
    return found


class Lengths(unittest.TestCase):
    def sources(self):
        for folder in ("pfvlib", "liggghts_fix"):
            for file in sorted((ROOT / folder).rglob("*")):
                if file.suffix in (".cpp", ".hpp", ".h"):
                    yield str(file.relative_to(ROOT)), file.read_text()

    def test_functions_are_found_with_their_lines(self):
        text = ("namespace a {\nint one(int x,\n        int y) {\n  if (x) {\n  }\n  return y;\n}\nclass B {\n"
                "  void two() const {\n    for (;;) {\n    }\n  }\n};\n}\n")
        self.assertEqual(functions(text), [("one", 6), ("two", 4)])

    def test_no_function_is_too_long(self):
        found = [(f"{file}: {name}", lines) for file, text in self.sources() for name, lines in functions(text)]
        self.assertGreater(len(found), 1000)
        self.assertEqual({name for name, lines in found if lines > MOST_LINES}, set(LONGER))

    def test_no_file_is_too_long(self):
        self.assertEqual([file for file, text in self.sources() if len(text.splitlines()) > MOST_LINES_OF_A_FILE], [])


if __name__ == "__main__":
    unittest.main()

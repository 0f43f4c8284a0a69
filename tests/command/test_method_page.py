# SPDX-License-Identifier: GPL-3.0-or-later
"""doc/method.md leads from each equation to its function: each one named there is in that file."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROW = re.compile(r"^\|.*\| `([\w:]+)` \| `([\w/]+\.cpp)` \|$")


def rows():
    text = (ROOT / "doc/method.md").read_text()
    return [match.groups() for match in map(ROW.match, text.splitlines()) if match]


class MethodPage(unittest.TestCase):
    def test_each_function_is_defined_where_the_page_says(self):
        found = rows()
        self.assertGreaterEqual(len(found), 20)
        for function, path in found:
            with self.subTest(function=function, file=path):
                source = (ROOT / "pfvlib/src" / path).read_text()
                defined = rf"^[\w:<>,&* ]*\b{re.escape(function)}\("
                self.assertRegex(source, re.compile(defined, re.MULTILINE))


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""doc/method.md leads from each equation to its function, and the function's comment to the equation."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROW = re.compile(r"^\| (.*) \| `([\w:]+)` \| `([\w/]+\.cpp)` \|$")
REFERENCE = re.compile(r"(?:eqs?\.|thesis) (\d[\d., -]*)")
HEADERS = [file for folder in ("pfvlib", "liggghts_fix") for file in sorted((ROOT / folder).rglob("*.h*"))
           if file.suffix in (".hpp", ".h")]


def rows():
    """(equation, function, file) of each row of the table."""
    text = (ROOT / "doc/method.md").read_text()
    return [match.groups() for match in map(ROW.match, text.splitlines()) if match]


def path_of(file):
    return ROOT / file if file.startswith("liggghts_fix/") else ROOT / "pfvlib/src" / file


def comments_above(text, name):
    """The comment above each line that declares or defines a function or class of that name; "" where there is none."""
    lines = text.splitlines()
    begins = rf"(?!\s*(?:return|//|#))[\w:<>,&*\s]*\b(?:{re.escape(name)}\(|(?:class|struct) {re.escape(name)}\b[^;]*$)"
    for number, line in enumerate(lines):
        if not re.match(begins, line):
            continue
        first = number
        while first > 0 and re.match(r"\s*template\b", lines[first - 1]):
            first -= 1
        last = first
        while first > 0 and lines[first - 1].lstrip().startswith("//"):
            first -= 1
        yield "\n".join(lines[first:last])


def comment_of(function, file):
    """What stands above the function, or its class, in its source and in the headers."""
    sources = [path_of(file), *HEADERS]
    names = [function.split("::")[-1], function] + ([function.split("::")[0]] if "::" in function else [])
    texts = [source.read_text() for source in sources]
    if "::" in function:  # methods of other classes may have that name
        own = re.compile(rf"\b(?:class|struct) {function.split('::')[0]}\b[^;]*\{{")
        texts = [texts[0]] + [text for text in texts[1:] if own.search(text)]
    return "\n".join(comment for text in texts for name in names for comment in comments_above(text, name))


class MethodPage(unittest.TestCase):
    def test_each_function_is_defined_where_the_page_says(self):
        found = rows()
        self.assertGreaterEqual(len(found), 45)
        for _, function, file in found:
            with self.subTest(function=function, file=file):
                defined = rf"^[\w:<>,&* ]*\b{re.escape(function)}\("
                self.assertRegex(path_of(file).read_text(), re.compile(defined, re.MULTILINE))

    def test_every_row_of_the_table_is_read(self):
        table = re.search(r"\n\| equation \|.*\n\|[-|]*\n((?:\|.*\n)+)", (ROOT / "doc/method.md").read_text())[1]
        self.assertEqual([line for line in table.splitlines() if not ROW.match(line)], [])

    def test_each_function_says_what_it_does_and_which_equation_it_is(self):
        for equation, function, file in rows():
            with self.subTest(function=function, file=file):
                comment = comment_of(function, file)
                self.assertIn("///", comment)
                numbers = re.findall(r"\d+(?:\.\d+)?", " ".join(REFERENCE.findall(equation)))
                missing = [number for number in numbers if not re.search(rf"\b{re.escape(number)}\b", comment)]
                self.assertEqual(missing, [], f"no such equation in:\n{comment}")

    def test_a_comment_is_found(self):
        text = "/// eq. 3\ntemplate <class T>\nint f(int x);\n\nint g();\n  return f(1);\n/// other\nclass A : B {\n"
        self.assertEqual(list(comments_above(text, "f")), ["/// eq. 3"])
        self.assertEqual(list(comments_above(text, "g")), [""])
        self.assertEqual(list(comments_above(text, "A")), ["/// other"])


if __name__ == "__main__":
    unittest.main()

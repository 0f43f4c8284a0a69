# SPDX-License-Identifier: GPL-3.0-or-later
"""No class holds more than 15 data members; records of settings and results, which are nothing but members, may."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST = 15
HEAD = re.compile(r"\b(?:class|struct)\s+([\w:]+)(?:\s+final)?\s*(?::[^:;{}()][^;{}()]*)?\{")


def bare(text):
    """A source without comments, preprocessor lines and what strings hold."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r'"(\\.|[^"\\\n])*"', '""', text)
    text = re.sub(r"'(\\.|[^'\\\n])'", "0", text)
    return re.sub(r"^\s*#.*$", "", text, flags=re.M)


def end_of_block(text, at):
    depth = 0
    for place in range(at, len(text)):
        depth += {"{": 1, "}": -1}.get(text[place], 0)
        if depth == 0:
            return place
    raise ValueError("a block without an end: " + text[at:at + 60])


def without_templates(text):
    while (shorter := re.sub(r"<[^<>;]*>", "", text)) != text:
        text = shorter
    return text


def statements(body):
    """Those of a class, blocks emptied; the body of a function ends one."""
    found, now, at = [], "", 0
    while at < len(body):
        if body[at] == "{":
            at = end_of_block(body, at) + 1
            is_value = re.search(r"[=,]\s*$", now) or body[at:].lstrip().startswith((";", ",", "{"))
            now += "{}"
            if "(" in without_templates(now) and not is_value:
                found.append(now)
                now = ""
            continue
        if body[at] == ";":
            found.append(now)
            now = ""
        else:
            now += body[at]
        at += 1
    return found


def members(body):
    """(names of the data members, number of functions) of a class."""
    names, functions = [], 0
    for statement in statements(re.sub(r"\b(public|private|protected)\s*:(?!:)", "", body)):
        text = " ".join(without_templates(statement).split())
        if not text or re.match(r"(using|friend|typedef|template|static|enum)\b|(class|struct) \w+$", text):
            continue
        text = re.sub(r"^(class|struct|union)\b[^{]*\{\}", "type", text)
        text = re.sub(r"\{\}", "", re.sub(r"= ?[^,(]*(\([^()]*\))?[^,]*", "", text))
        if "(" in text or re.search(r"\boperator\b", text):
            functions += 1
        elif text != "type":
            names += [re.search(r"(\w+)(\[[^]]*\])*$", one.strip())[1] for one in text.split(",")]
    return names, functions


def classes(text):
    """(name, data members, number of functions) of each class and struct."""
    text = bare(text)
    for head in HEAD.finditer(text):
        if not text[:head.start()].rstrip().endswith("enum"):
            yield head[1], *members(text[head.end():end_of_block(text, head.end() - 1)])


class Classes(unittest.TestCase):
    def sources(self):
        for folder in ("pfvlib", "liggghts_fix"):
            for file in sorted((ROOT / folder).rglob("*")):
                if file.suffix in (".cpp", ".hpp", ".h"):
                    yield str(file.relative_to(ROOT)), file.read_text()

    def test_members_are_found(self):
        text = ("class A final : public B<int, C> {\n public:\n  explicit A(int x) : x_(x), y_{1} {}\n"
                "  std::function<int(int)> call_;\n  int f() const { return x_; }\n  static constexpr int s = 1;\n"
                "  struct Own {\n    int a, b;\n  } own_;\n  A(const A&) = delete;\n  using T = int;\n private:\n"
                "  int x_ = 0, y_{2};  // more, words\n  Map<const Vector> z_{nullptr, 0};\n  double w_[3] = {1, 2, 3};\n"
                "};\nenum class E { a, b };\n")
        found = {name: (names, functions) for name, names, functions in classes(text)}
        self.assertEqual(found, {"A": (["call_", "own_", "x_", "y_", "z_", "w_"], 3), "Own": (["a", "b"], 0)})

    def test_no_class_holds_too_much(self):
        found = [(file, name, len(names), functions) for file, text in self.sources()
                 for name, names, functions in classes(text)]
        self.assertGreater(len(found), 300)
        self.assertGreater(max(count for _, _, count, functions in found if not functions), MOST)
        self.assertEqual([(file, name, count) for file, name, count, functions in found
                          if functions and count > MOST], [])


if __name__ == "__main__":
    unittest.main()

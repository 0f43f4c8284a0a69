# SPDX-License-Identifier: GPL-3.0-or-later
"""The module's docstrings in the site: as they are printed, line by line, with the signatures of the type stubs."""
import ast
import importlib.util
import pathlib
import re


def stub_signatures():
    """{name: (arguments, result)} of the functions and methods of __init__.pyi."""
    stub = pathlib.Path(importlib.util.find_spec("pfv").origin).with_suffix(".pyi")
    found, aliases = {}, {}

    def text_of(node):
        """With what the stub's own names of types stand for."""
        return re.sub(r"\b_[A-Z]\w+", lambda name: aliases.get(name[0], name[0]), ast.unparse(node))

    def add(prefix, body):
        for node in body:
            if isinstance(node, ast.Assign):
                aliases[node.targets[0].id] = text_of(node.value).replace("numpy.", "")
            elif isinstance(node, ast.ClassDef):
                add(prefix + node.name + ".", node.body)
            elif isinstance(node, ast.FunctionDef):
                arguments = node.args
                if "." in prefix:
                    arguments.args = arguments.args[1:]  # self
                result = text_of(node.returns) if node.returns else None
                name = prefix[:-1] if node.name == "__init__" else prefix + node.name
                found[name] = (f"({text_of(arguments)})", None if name == prefix[:-1] else result)
    add("", ast.parse(stub.read_text()).body)
    return found


def take_signature(app, what, name, obj, options, signature, result):
    if not hasattr(app, "pfv_signatures"):
        app.pfv_signatures = stub_signatures()
    return app.pfv_signatures.get(name.partition(".")[2], (signature, result))


def escaped(text):
    """As it stands, but for `code`."""
    parts = re.split(r"`([^`]+)`", text)
    return "".join(f"``{part}``" if k % 2 else re.sub(r"([\\*_|`])", r"\\\1", part) for k, part in enumerate(parts))


def keep_lines(app, what, name, obj, options, lines):
    """Indented lines are code; the others keep their ends, and their signs mean nothing."""
    made = []
    for line in lines:
        code = line.startswith("    ")
        if code and (not made or not made[-1].startswith("    ")):
            made += ["", "::", ""]
        elif not code and line and made and made[-1].startswith("    "):
            made.append("")
        made.append(line if code else "| " + escaped(line) if line else "")
    lines[:] = made + [""]


def setup(app):
    app.connect("autodoc-process-signature", take_signature)
    app.connect("autodoc-process-docstring", keep_lines)
    return {"parallel_read_safe": True}

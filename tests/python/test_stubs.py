# SPDX-License-Identifier: GPL-3.0-or-later
"""The type stubs name what the module has, and no more; all of it has a docstring."""
import ast
import inspect
import pathlib
import re
import unittest

import pfv

STUB = ast.parse((pathlib.Path(pfv.__file__).parent / "__init__.pyi").read_text())
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}
TYPED_DICTS = {name for name, node in CLASSES.items() if [ast.unparse(base) for base in node.bases] == ["TypedDict"]}


def members(node):
    return {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}


def arguments(node):
    """Their names, in order."""
    every = [each.arg for each in node.args.posonlyargs + node.args.args + node.args.kwonlyargs]
    return [name for name in every if name != "self"]


BOUNDARIES = arguments(members(CLASSES["Box"])["patch"])[2:]  # behind name and rectangle
CONDITIONS = BOUNDARIES + ["wall", "velocity", "sliding", "spin", "pivot", "angular_velocity", "may_bound_nothing"]


def arguments_of(function):
    """By the first line of a docstring of pybind11."""
    signature = function.__doc__.splitlines()[0]
    inside = signature[signature.index("(") + 1:signature.rindex(") ->")]
    names = re.findall(r"(?:^|, )(\*{0,2}\w+)(?=:|,|$)", re.sub(r"\[[^]]*\]|\([^)]*\)", "", inside))
    return [name for name in names if name not in ("self", "**kwargs")]


class Stubs(unittest.TestCase):
    def test_they_name_the_module(self):
        self.assertEqual((set(CLASSES) - TYPED_DICTS) | set(FUNCTIONS), set(pfv.__all__))
        self.assertTrue((pathlib.Path(pfv.__file__).parent / "py.typed").exists())

    def test_they_name_the_members_of_each_class(self):
        for name in ("Box", "Container", "Fluid", "Packing", "Network", "Flow"):
            real = {member for member in vars(getattr(pfv, name)) if not member.startswith("_")}
            stub = {member for member in members(CLASSES[name]) if not member.startswith("_")}
            self.assertEqual(real, stub, name)
            for member in real:
                is_property = isinstance(vars(getattr(pfv, name))[member], property)
                decorated = bool(members(CLASSES[name])[member].decorator_list)
                self.assertEqual(is_property, decorated, member)

    def test_they_name_the_arguments(self):
        functions = [(vars(getattr(pfv, name))[member], node) for name in ("Box", "Container", "Flow")
                     for member, node in members(CLASSES[name]).items()
                     if not member.startswith("__") and not node.decorator_list]
        functions += [(getattr(pfv, name), node) for name, node in FUNCTIONS.items()]
        settings = [row["name"] for row in pfv.settings()]
        for function, node in functions:
            real, stub = arguments_of(function), arguments(node)
            if "**kwargs" in function.__doc__.splitlines()[0]:
                stub = [name for name in stub if name in real or name not in settings + CONDITIONS]
            self.assertEqual(real, stub, function.__name__)

    def test_their_keywords_are_the_settings(self):
        names = [row["name"] for row in pfv.settings()]
        for node in (members(CLASSES["Flow"])["__init__"], FUNCTIONS["permeability"]):
            self.assertEqual([name for name in arguments(node) if name not in
                              ("box", "fluid", "positions", "radii", "axis", "periodic", "wall", "ids")], names)
            types = {each.arg: ast.unparse(each.annotation) for each in node.args.kwonlyargs}
            for row in pfv.settings():
                choices = row["values"].split("|")
                if len(choices) > 1 and row["name"] != "retriangulate":
                    expected = "bool" if choices == ["yes", "no"] else "Literal"
                    self.assertTrue(types[row["name"]].startswith(expected), row["name"])
                    words = [choice for choice in choices if not choice.isupper()]  # T: a number
                    for choice in words if expected == "Literal" else []:
                        self.assertIn(repr(choice), types[row["name"]])
        fluid = arguments(members(CLASSES["Fluid"])["__init__"])
        self.assertTrue(set(fluid) < set(names))

    def test_their_types_of_numbers(self):
        node = members(CLASSES["Flow"])["__init__"]
        types = {each.arg: ast.unparse(each.annotation) for each in node.args.kwonlyargs}
        self.assertEqual([types[name] for name in ("viscosity", "threads", "cells", "gravity", "bulk_modulus", "retriangulate")],
                         ["float", "int", "Sequence[int]", "ArrayLike", "float | None", "float | str"])
        fluid = members(CLASSES["Fluid"])["__init__"].args.kwonlyargs
        self.assertEqual({each.arg: ast.unparse(each.annotation) for each in fluid},
                         {each.arg: types[each.arg] for each in fluid})

    def test_boundaries_are_those_of_a_face(self):
        self.assertGreaterEqual(len(BOUNDARIES), 3)
        for kind in BOUNDARIES:
            box = pfv.Box([[0, 1]] * 3).face("zlo", **{kind: 1.0})
            self.assertIn(kind, box.faces["zlo"])
        with self.assertRaisesRegex(pfv.InputError, "give one of " + ", ".join(BOUNDARIES)):
            box.face("zlo", **{kind: 1.0 for kind in BOUNDARIES})
        for name in ("Box", "Container"):
            for member in ("face", "patch", "region"):
                node = members(CLASSES[name])[member]
                self.assertTrue(set(BOUNDARIES) <= set(arguments(node)), f"{name}.{member}")

    def test_everything_has_a_docstring(self):
        for name in pfv.__all__:
            thing = getattr(pfv, name)
            self.assertTrue(thing.__doc__, name)
            self.assertEqual(thing.__module__, "pfv", name)
            if inspect.isclass(thing) and not issubclass(thing, (Exception, Warning)):
                for member, value in vars(thing).items():
                    if not member.startswith("_"):
                        self.assertTrue((value.__doc__ or "").strip(), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()

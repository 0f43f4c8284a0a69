# SPDX-License-Identifier: GPL-3.0-or-later
"""The notebooks of doc/: stored without outputs; their cells run one after the other, and say what they should.

With `--nbclient` as a notebook's own kernel runs them (./test.sh long), where python3-nbclient and python3-ipykernel
are installed.
"""
import contextlib
import io
import json
import os
import pathlib
import re
import sys
import unittest

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "doc/notebooks"
BIN = pathlib.Path(os.environ["PFV_COMMAND"]).parent
os.environ.setdefault("PFV_BIN", str(BIN))


def cells_of(name):
    return json.loads((FOLDER / name).read_text())["cells"]


def run(name):
    """(what it prints, its names)"""
    import matplotlib
    matplotlib.use("Agg")
    names, printed, home = {}, io.StringIO(), os.getcwd()
    os.chdir(FOLDER)
    try:
        with contextlib.redirect_stdout(printed):
            for number, cell in enumerate(cells_of(name)):
                if cell["cell_type"] == "code":
                    exec(compile("".join(cell["source"]), f"{name}, cell {number}", "exec"), names)
    finally:
        os.chdir(home)
    return printed.getvalue(), names


class Notebooks(unittest.TestCase):
    def test_they_are_stored_without_outputs(self):
        self.assertEqual(len(list(FOLDER.glob("*.ipynb"))), 4)
        for path in FOLDER.glob("*.ipynb"):
            for cell in cells_of(path.name):
                self.assertFalse(cell.get("outputs") or cell.get("execution_count"), path.name)

    def test_permeability(self):
        printed, names = run("permeability.ipynb")
        self.assertRegex(printed, r"K = \S+ m2, Stokes flow between")
        self.assertAlmostEqual(names["k"] / names["permeability"]["z"], 1, delta=1e-9)
        self.assertAlmostEqual(names["middle"][1] / names["middle"][0], 1, delta=0.01)
        self.assertLess(names["middle"][0], names["k"])

    def test_consolidation(self):
        _, names = run("consolidation.ipynb")
        self.assertLess(names["error"], 0.02)
        self.assertAlmostEqual(names["left_the_layer"] / names["stored"], 1, delta=0.06)
        self.assertEqual(names["report"]["counts"]["triangulate"], 1)

    @unittest.skipUnless((BIN / "liggghts-pfv").exists(), "liggghts-pfv is not built")
    def test_liggghts_run(self):
        printed, names = run("liggghts_run.ipynb")
        self.assertEqual(len(names["last"]), 150)
        self.assertGreater(names["report"]["permeability"], 0)
        self.assertIn("of its weight in water", printed)

    def test_trust(self):
        printed, names = run("trust.ipynb")
        shares = [float(share) for share in re.findall(r"open_throat (\S+) of Stokes flow", printed)]
        self.assertEqual(len(shares), 3)
        for share in shares:
            self.assertAlmostEqual(share, 1, delta=0.09)
        self.assertIn("AccuracyWarning", printed)
        spread = [values.std() / values.mean() for values in names["scatter"].values()]
        self.assertGreater(spread[0], spread[-1])


def run_by_nbclient():
    try:
        import nbformat
        from nbclient import NotebookClient
        import ipykernel  # noqa: F401
    except ImportError as missing:
        print(f"notebooks: skipped, {missing.name} is not installed (python3-nbclient, python3-ipykernel)")
        return
    for path in sorted(FOLDER.glob("*.ipynb")):
        NotebookClient(nbformat.read(path, as_version=4), timeout=None, resources={"metadata": {"path": str(FOLDER)}}).execute()
        print(f"notebooks: {path.name} runs")


if __name__ == "__main__":
    run_by_nbclient() if sys.argv[1:] == ["--nbclient"] else unittest.main()

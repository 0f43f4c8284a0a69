# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of doc/python.md run, and do what the page says."""
import contextlib
import io
import os
import pathlib
import re
import shutil
import tempfile
import unittest

import numpy as np
from case import DATA

PAGE = pathlib.Path(__file__).resolve().parents[2] / "doc/python.md"


class Page(unittest.TestCase):
    def test_its_examples(self):
        programs = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
        self.assertEqual(len(programs), 2)
        names = {}
        home = os.getcwd()
        printed = io.StringIO()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(printed):
            shutil.copy(DATA / "packing_100.csv", pathlib.Path(folder, "packing.csv"))
            os.chdir(folder)
            try:
                for program in programs:
                    exec(compile(program, str(PAGE), "exec"), names)
            finally:
                os.chdir(home)
        self.assertRegex(printed.getvalue(), r"^\d\S* m2\n$")
        self.assert_consolidated(np.array(names["settlement"]), np.array(names["pressure"]), names["load"])

    def assert_consolidated(self, settlement, pressure, load):
        self.assertAlmostEqual(pressure.max(), load, delta=0.05 * load)  # measured: 0.964
        self.assertLess(pressure[-1], 0.02 * load)
        late = np.argmax(pressure)
        self.assertTrue((np.diff(settlement[late:]) > -1e-6 * settlement[-1]).all())
        self.assertLess(settlement[late], 0.5 * settlement[-1])


if __name__ == "__main__":
    unittest.main()

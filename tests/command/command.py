# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the pfv command share."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

DATA = pathlib.Path(__file__).resolve().parent.parent / "data"
DENSE = DATA / "packing_100.csv"
UNIT_BOX = ["--box", "0", "1", "0", "1", "0", "1"]
THROUGH_FLOW = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=1", "--viscosity", "1"]


class CommandTest(unittest.TestCase):
    """Runs the command in an empty folder of its own."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_pfv(self, *arguments, **options):
        options.setdefault("stdout", subprocess.PIPE)
        return subprocess.run([os.environ["PFV_COMMAND"], *map(str, arguments)],
                              stderr=subprocess.PIPE, text=True, cwd=self.folder, **options)

    def solve(self, *arguments, packing=DENSE, box=UNIT_BOX):
        """Solves and expects success."""
        result = self.run_pfv("solve", "--packing", packing, *box, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def report(self, *arguments, **options):
        self.solve("--report", "report.json", *arguments, **options)
        return self.json("report.json")

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def read(self, name):
        return (self.folder / name).read_bytes()

    def json(self, name):
        def refuse(constant):
            self.fail(f"{constant} in {name}")
        return json.loads(self.read(name), parse_constant=refuse)

    def forces(self, name):
        """Rows of a forces file: {id: [nine numbers]}, in the order of the file."""
        rows = list(csv.reader(self.read(name).decode().splitlines()))
        self.assertEqual(rows[0], "id,fx,fy,fz,fpx,fpy,fpz,fvx,fvy,fvz".split(","))
        return {int(row[0]): [float(value) for value in row[1:]] for row in rows[1:]}

    def assert_one_line(self, text):
        self.assertEqual(text.count("\n"), 1, text)
        self.assertTrue(text.endswith("\n"), text)

    def assert_refused(self, result, *parts, status=2):
        """One line that holds every part, the status, nothing printed and no file made."""
        self.assertEqual(result.returncode, status, result.stderr)
        self.assert_one_line(result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertFalse(result.stdout)


def dense_rows():
    """Header and rows of the dense packing, as text fields."""
    rows = list(csv.reader(DENSE.read_text().splitlines()))
    return rows[0], rows[1:]


def with_velocities(velocity):
    """The dense packing as CSV with velocities: velocity(x, y, z) -> (vx, vy, vz)."""
    header, rows = dense_rows()
    lines = [",".join(header + ["vx", "vy", "vz"])]
    for row in rows:
        moving = velocity(*map(float, row[1:4]))
        lines.append(",".join(row + [repr(float(component)) for component in moving]))
    return "\n".join(lines) + "\n"

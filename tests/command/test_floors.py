# SPDX-License-Identifier: GPL-3.0-or-later
"""The rooms of the library stand one above the other: nothing includes from a floor above its own."""
import pathlib
import re
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2] / "pfvlib/src"
FLOORS = ["text", "geometry", "problem", "work", "parallel", "network", "distributed", "physics", "sparse", "solve", "step",
          "results", "flow", "darcy_grid", "io"]
INCLUDE = re.compile(r'^#include "(\w+)/', re.MULTILINE)
PUBLIC = "pfv"


class Floors(unittest.TestCase):
    def test_every_room_has_its_floor(self):
        self.assertEqual({room.name for room in SOURCE.iterdir() if room.is_dir()} - set(FLOORS), set())

    def test_nothing_includes_from_above(self):
        arrows = set()
        for file in sorted(SOURCE.glob("*/*.?pp")):
            for room in INCLUDE.findall(file.read_text()):
                if room != PUBLIC and FLOORS.index(room) > FLOORS.index(file.parent.name):
                    arrows.add(f"{file.relative_to(SOURCE)} -> {room}")
        self.assertEqual(sorted(arrows), [])

    def test_libraries_are_included_in_one_room_each(self):
        for library, rooms in (("CGAL/", {"network"}), ("Amesos2", {"solve"}), ("Tpetra", {"solve"}),
                               ("HYPRE", {"solve"}), ("dmumps", {"solve"}), ("mpi.h", {"parallel"})):
            found = {file.parent.name for file in SOURCE.glob("*/*.?pp")
                     if f"#include <{library}" in file.read_text()}
            self.assertTrue(found, library)
            self.assertLessEqual(found, rooms, library)


if __name__ == "__main__":
    unittest.main()

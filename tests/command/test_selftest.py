# SPDX-License-Identifier: GPL-3.0-or-later
"""`pfv selftest` passes on this machine and says so line by line."""
import unittest

from command import CommandTest


class Selftest(CommandTest):
    def test_every_line_passes(self):
        result = self.run_pfv("selftest")
        self.assertEqual(result.returncode, 0, result.stdout)
        rows = result.stdout.splitlines()[1:]
        self.assertGreaterEqual(len(rows), 12)
        self.assertEqual([row.split()[-1] for row in rows], ["pass"] * len(rows))

    def test_the_same_bytes_twice(self):
        self.assertEqual(self.run_pfv("selftest").stdout, self.run_pfv("selftest").stdout)


if __name__ == "__main__":
    unittest.main()

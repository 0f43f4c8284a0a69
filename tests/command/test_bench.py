# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv bench: what it measures, fits and refuses. Never how long something took."""
import math
import unittest

from command import CommandTest

PHASES = {"triangulate", "throats", "assemble", "order", "factor", "solve", "forces", "rebuild", "first",
          "step"}


class Bench(CommandTest):
    def bench(self, *arguments):
        result = self.run_pfv("bench", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_every_phase_of_each_size_is_in_the_report(self):
        self.bench("--spheres", "50,200", "--repeat", "3", "--report", "bench.json")
        report = self.json("bench.json")
        self.assertEqual([row["spheres"] for row in report["rows"]], [50, 200])
        for row in report["rows"]:
            self.assertGreater(row["pores"], row["unknowns"])
            self.assertLess(row["residual"], 1e-12)
            self.assertEqual(set(row["cpu_seconds"]), PHASES)
            for times in row["cpu_seconds"].values():
                self.assertEqual(len(times["repeats"]), 3)
                self.assertEqual(times["median"], sorted(times["repeats"])[1])
            self.assertEqual(set(row["wall_seconds"]), {"rebuild", "first", "step"})
        self.assertIn("load_before", report["machine"])
        self.assertEqual(report["conductance"], "open_throat")

    def test_memory_is_not_that_of_the_program_which_started_it(self):
        large = bytearray(b"x") * 300_000_000
        self.bench("--spheres", "2000", "--repeat", "1", "--report", "bench.json")
        self.assertGreater(self.json("bench.json")["rows"][0]["memory_bytes"], 1_000_000)
        self.assertEqual(self.json("bench.json")["rows"][0]["solver"], "supernodal")  # of all networks
        self.solve("--face", "zlo:pressure=0", "--face", "zhi:pressure=1", "--viscosity", "1", "--report", "report.json")
        self.assertLess(self.json("report.json")["peak_memory_bytes"], len(large))

    def test_precision_and_threads_reach_the_solver(self):
        self.bench("--spheres", "200", "--repeat", "1", "--precision", "mixed", "--threads", "2",
                   "--report", "bench.json")
        report = self.json("bench.json")
        self.assertEqual((report["precision"], report["threads"]), ("mixed", 2))
        self.assertLess(report["rows"][0]["residual"], 1e-9)
        self.assertGreater(report["rows"][0]["residual"], 1e-14)

    def test_a_fit_through_two_sizes_gives_their_medians(self):
        self.bench("--spheres", "50,200", "--repeat", "1", "--report", "bench.json")
        report = self.json("bench.json")
        for phase in PHASES:
            law = report["fits"]["supernodal"][phase]
            for row in report["rows"]:
                fitted = law["factor"] * row["spheres"] ** law["exponent"]
                self.assertTrue(
                    math.isclose(fitted, row["cpu_seconds"][phase]["median"], rel_tol=1e-9))

    def test_a_prediction_names_the_solver_to_take(self):
        text = self.bench("--spheres", "50,200", "--repeat", "1", "--solver", "supernodal,klu2",
                          "--predict", "300", "--steps", "1000", "--steps-per-network", "100")
        self.assertIn("300 grains, 1000 steps, 10 networks", text)
        self.assertRegex(text, "take --solver (supernodal|klu2)")

    def test_what_cannot_be_measured_is_refused(self):
        for arguments, word in ((["--spheres", "5"], "--spheres"),
                                (["--spheres", "200,100"], "not above"),
                                (["--steps", "10"], "--predict"),
                                (["--spheres", "100", "--predict", "10"], "two sizes"),
                                (["--repeat", "0"], "--repeat"),
                                (["--solver", "none"], "supernodal"),
                                (["--precision", "half"], "mixed"),
                                (["--threads", "0"], "--threads"),
                                (["--report", "no/such/file.json"], "no/such")):
            result = self.run_pfv("bench", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertEqual(len(result.stderr.splitlines()), 1)
            self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()

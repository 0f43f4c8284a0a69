# SPDX-License-Identifier: GPL-3.0-or-later
"""Forces and report: form, agreement with each other, same bytes from the same input, and that
only what is asked is computed."""
import numbers
import unittest

from command import DENSE, THROUGH_FLOW, CommandTest, dense_rows, with_velocities

INTEGERS = "spheres hidden outside pores unknowns threads ranks peak_memory_bytes".split()
NUMBERS = ("porosity pore_volume solid_area inflow outflow volume_rate_sum storage_rate mass_error "
           "fluid_volume fluid_came_in fluid_balance_error force_balance_error residual").split()
COUNTS = ("triangulate order factor solve correction_solve limit_solve query_solve background force_matrix "
          "volume_rate degenerate_throats merged_pores pinned_pores open_water "
          "enclosed_pores joined_pores").split()
SECONDS = "read triangulate throats assemble order factor solve forces total".split()
FACES = "xlo xhi ylo yhi zlo zhi".split()
SINKING = ["--face", "zhi:pressure=0,velocity=-1", "--viscosity", "1"]


def without_costs(report):
    return {key: value for key, value in report.items()
            if key not in ("seconds", "wall_seconds", "peak_memory_bytes")}


class Outputs(CommandTest):
    def assert_number(self, value):
        self.assertIsInstance(value, numbers.Real)
        self.assertNotIsInstance(value, bool)

    def assert_vector(self, value):
        self.assertEqual(len(value), 3)
        for component in value:
            self.assert_number(component)

    def test_a_flow_with_inertia_is_warned_of_where_the_density_is_given(self):
        fast = ["--face", "zlo:pressure=0", "--face", "zhi:pressure=1e6", "--viscosity", "1e-3"]
        self.assertEqual(self.solve(*fast).stderr, "")
        warned = self.solve(*fast, "--density", "1000").stderr
        self.assert_one_line(warned)
        self.assertIn("the Reynolds number of the throats reaches", warned)

    def test_report_has_the_documented_keys_and_types(self):
        report = self.report(*THROUGH_FLOW)
        self.assertEqual(set(report), {*INTEGERS, *NUMBERS, "version", "model", "permeability",
                                       "permeability_tensor", "permeability_error",
                                       "degenerate_share", "outside_range", "reynolds_largest", "reynolds_mean",
                                       "force_sum", "solver",
                                       "ordering", "solver_made_of",
                                       "conductance", "faces", "openings", "obstacles", "counts", "seconds", "wall_seconds"})
        self.assertIsNone(report["permeability_tensor"])  # periodic axes only
        for key in INTEGERS:
            self.assertIs(type(report[key]), int, key)
        self.assertEqual(report["outside_range"], [])
        for key in (*NUMBERS, "permeability", "permeability_error", "degenerate_share", "reynolds_largest", "reynolds_mean"):
            self.assert_number(report[key])
        for key in ("solver", "ordering", "solver_made_of", "conductance", "version", "model"):
            self.assertTrue(report[key])
        self.assert_vector(report["force_sum"])
        self.assertEqual(list(report["faces"]), FACES)
        for face in report["faces"].values():
            self.assertEqual(list(face), ["flux", "force_pressure", "force_viscous", "moment"])
            self.assertIsNone(face["moment"])  # with `torques yes` only
            self.assert_number(face["flux"])
            self.assert_vector(face["force_pressure"])
            self.assert_vector(face["force_viscous"])
        self.assertEqual(list(report["counts"]), COUNTS)
        self.assertTrue(all(type(count) is int for count in report["counts"].values()))
        self.assertEqual(list(report["seconds"]), [*SECONDS, "step"])
        for key in SECONDS:
            self.assert_number(report["seconds"][key])
        self.assertIsNone(report["seconds"]["step"])
        self.assertEqual(list(report["wall_seconds"]), ["total", "waited", "step"])
        self.assertIsNone(report["wall_seconds"]["step"])

    def test_report_of_a_through_flow_balances(self):
        report = self.report(*THROUGH_FLOW)
        self.assertEqual(report["spheres"], 100)
        fluxes = [report["faces"][face]["flux"] for face in FACES]
        self.assertGreater(report["faces"]["zhi"]["flux"], 0)
        self.assertLess(report["faces"]["zlo"]["flux"], 0)
        self.assertAlmostEqual(report["inflow"], sum(q for q in fluxes if q > 0), delta=1e-18)
        self.assertAlmostEqual(report["outflow"], -sum(q for q in fluxes if q < 0), delta=1e-18)
        self.assertLess(abs(report["mass_error"]), 1e-10)
        self.assertLess(report["force_balance_error"], 1e-12)
        self.assertLess(report["residual"], 1e-10)
        # permeability = mu Q L / (dP S), all but Q equal to 1
        mean = 0.5 * (report["inflow"] + report["outflow"])
        self.assertAlmostEqual(report["permeability"] / mean, 1, delta=1e-12)

    def test_permeability_is_null_where_it_has_no_meaning(self):
        for faces in (["--face", "zlo:pressure=0", "--face", "xhi:pressure=1"],
                      ["--face", "zlo:pressure=0"],
                      ["--face", "zlo:pressure=0", "--face", "zhi:pressure=1",
                       "--patch", "xlo:0,.5,0,.5:pressure=0"]):
            with self.subTest(faces=faces):
                self.assertIsNone(self.report(*faces)["permeability"])

    def test_forces_keep_ids_and_order_and_their_sum_is_that_of_the_report(self):
        header, rows = dense_rows()
        rows = [[str(3 * int(row[0]) + 1000), *row[1:]] for row in reversed(rows)]
        packing = self.write("packing.csv", "\n".join(map(",".join, [header, *rows])) + "\n")
        report = self.report("--forces", "forces.csv", *THROUGH_FLOW, packing=packing)
        forces = self.forces("forces.csv")
        self.assertEqual(list(forces), [int(row[0]) for row in rows])
        largest = max(abs(value) for force in forces.values() for value in force)
        for axis in range(3):
            for force in forces.values():
                self.assertAlmostEqual(force[axis], force[axis + 3] + force[axis + 6],
                                       delta=1e-13 * largest)
            self.assertAlmostEqual(sum(force[axis] for force in forces.values()),
                                   report["force_sum"][axis], delta=1e-11 * largest)

    def test_buoyancy_comes_with_gravity_into_the_pressure_part(self):
        at_rest = ["--face", "zlo:pressure=0", "--forces", "forces.csv"]
        self.solve(*at_rest, "--gravity", "0", "0", "-9.81", "--density", "1.2e3")
        volume_factor = 4 / 3 * 3.141592653589793 * 1200 * 9.81
        forces = self.forces("forces.csv")
        for row in dense_rows()[1]:
            weight = volume_factor * float(row[4]) ** 3
            for column in (2, 5):
                self.assertAlmostEqual(forces[int(row[0])][column] / weight, 1, delta=1e-12)

    def test_same_input_gives_the_same_bytes(self):
        self.write("moving.csv", with_velocities(lambda x, y, z: (0, 0, -z)))
        for case, packing, faces in (("still", DENSE, THROUGH_FLOW),
                                     ("moving", self.folder / "moving.csv", SINKING)):
            for run in ("1", "2"):
                self.solve(*faces, "--forces", case + run + ".csv", "--vtk", case + run + ".vtu",
                           "--report", case + run + ".json", packing=packing)
            self.assertEqual(self.read(case + "1.csv"), self.read(case + "2.csv"))
            self.assertEqual(self.read(case + "1.vtu"), self.read(case + "2.vtu"))
            self.assertEqual(without_costs(self.json(case + "1.json")),
                             without_costs(self.json(case + "2.json")))

    def test_a_dump_and_a_csv_of_the_same_grains_give_the_same_bytes(self):
        rows = dense_rows()[1]
        head = ("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n"
                "0 1\n0 1\n0 1\nITEM: ATOMS radius id type z y x \n")
        atoms = "".join(f"{r} {k} 1 {z} {y} {x} \n" for k, x, y, z, r in rows)
        dump = self.write("dump.liggghts", head.format(0, 1) + "0.1 1 1 0.5 0.5 0.5 \n"
                          + head.format(1000, len(rows)) + atoms)
        self.solve("--forces", "csv.csv", *THROUGH_FLOW)
        self.solve("--forces", "dump.csv", *THROUGH_FLOW, packing=dump)
        self.assertEqual(self.read("csv.csv"), self.read("dump.csv"))

    def test_a_still_scene_pays_for_nothing_else(self):
        counts = self.report(*THROUGH_FLOW)["counts"]
        self.assertEqual([counts[key] for key in ("triangulate", "order", "factor", "solve",
                                                  "force_matrix", "volume_rate")],
                         [1, 1, 1, 1, 1, 0])

    def test_velocities_that_are_all_zero_are_as_good_as_none(self):
        still = self.write("still.csv", with_velocities(lambda x, y, z: (0, -0.0, 0)))
        report = self.report("--forces", "zero.csv", *THROUGH_FLOW, packing=still)
        self.assertEqual(report["counts"]["volume_rate"], 0)
        self.solve("--forces", "none.csv", *THROUGH_FLOW)
        self.assertEqual(self.read("zero.csv"), self.read("none.csv"))

    def test_repeated_steps_keep_the_network_and_are_timed(self):
        packing = self.write("moving.csv", with_velocities(lambda x, y, z: (0, 0, -z)))
        report = self.report("--repeat", "4", *SINKING, packing=packing)
        counts = report["counts"]
        for key in ("triangulate", "order", "factor", "force_matrix"):
            self.assertEqual(counts[key], 1, key)
        self.assertEqual(counts["solve"], 5)
        for seconds in (report["seconds"], report["wall_seconds"]):
            self.assertGreater(seconds["step"], 0)

    def test_repeating_changes_no_result(self):
        self.solve("--forces", "once.csv", *THROUGH_FLOW)
        self.solve("--forces", "thrice.csv", "--repeat", "2", *THROUGH_FLOW)
        self.assertEqual(self.read("once.csv"), self.read("thrice.csv"))

    def test_without_outputs_a_summary_is_printed(self):
        result = self.solve(*THROUGH_FLOW)
        for word in ("permeability", "estimated error", "flux", "unknowns", " s\n"):
            self.assertIn(word, result.stdout)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_with_outputs_the_summary_has_three_lines_and_nothing_is_left_beside(self):
        result = self.solve("--forces", "f.csv", "--report", "r.json", "--vtk", "n.vtu",
                            *THROUGH_FLOW)
        self.assertEqual(result.stdout.count("\n"), 3)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["f.csv", "n.vtu", "n_walls.vtu", "r.json"])

    def test_an_output_may_go_to_standard_output_alone(self):
        result = self.solve("--forces", "/dev/stdout", *THROUGH_FLOW)
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), 101)
        self.assertTrue(all(line.count(",") == 9 for line in lines))

    def test_a_full_disk_is_a_failure_that_leaves_no_half_file(self):
        for broken, whole in (("--report", "--forces"), ("--forces", "--report"),
                              ("--vtk", "--report")):
            with self.subTest(broken=broken):
                result = self.run_pfv("solve", "--packing", DENSE, "--box", 0, 1, 0, 1, 0, 1,
                                      *THROUGH_FLOW, whole, "whole", broken, "/dev/full")
                self.assert_refused(result, "/dev/full", "No space left", status=1)
                self.assertFalse(list(self.folder.glob(".*")))

    def test_a_flow_that_nothing_drives_is_said(self):
        for faces, said in (([], "no pressure anywhere, no flux and grains at rest: p is 0"),
                            (["--face", "zlo:pressure=2"], "nothing drives a flow: p is 2 Pa everywhere; give the opposite"),
                            (["--face", "zlo:pressure=2", "--patch", "zhi:0,0.5,0,0.5:pressure=2"], "nothing drives a flow"),
                            (["--face", "zlo:pressure=2", "--face", "xhi:pressure=1"], ""),
                            (["--face", "zlo:pressure=2", "--face", "xhi:flux=1"], "")):
            with self.subTest(faces=faces):
                result = self.solve(*faces)
                lines = [line for line in result.stderr.splitlines() if "p is" in line]
                self.assertEqual(len(lines), 1 if said else 0, result.stderr)
                self.assertIn(said, result.stderr)

    def test_walls_in_another_unit_than_the_spheres_are_asked_about(self):
        asked = "the walls are in m, whatever unit the packing is in"
        far = ["--box", *"0 1000 0 1000 0 1000".split()]
        self.assertIn(asked, self.solve(*THROUGH_FLOW, box=far).stderr)
        self.assertNotIn(asked, self.solve(*THROUGH_FLOW, box=["--box", *"-4 4 -4 4 -4 4".split()]).stderr)

    def test_hidden_spheres_are_named_counted_and_keep_their_row(self):
        header, rows = dense_rows()
        x, y, z = map(float, rows[0][1:4])
        inside = [["501", repr(x + 0.01), rows[0][2], rows[0][3], "0.001"],
                  ["502", rows[0][1], repr(y - 0.01), rows[0][3], "0.002"]]
        packing = self.write("hidden.csv", "\n".join(map(",".join, [header, *rows, *inside])) + "\n")
        result = self.solve("--report", "report.json", "--forces", "forces.csv", *THROUGH_FLOW,
                            packing=packing)
        warnings = [line for line in result.stderr.splitlines() if "hidden" in line]
        self.assertEqual(len(warnings), 1)
        for part in ("2 hidden", "501", "502"):
            self.assertIn(part, warnings[0])
        self.assertEqual(self.json("report.json")["hidden"], 2)
        self.assertEqual(list(self.forces("forces.csv"))[-2:], [501, 502])


if __name__ == "__main__":
    unittest.main()

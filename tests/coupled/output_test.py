# SPDX-License-Identifier: GPL-3.0-or-later
"""What the fix writes itself: fields for ParaView, pressure profiles, its closing report."""
import csv
import re
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree

import numpy

from coupled import BIN, EDGE, FLOW, WATER, CoupledTest, dump, packing, random_velocities, read_dump
from coupled import read_thermo, restarted_head, write_data

HEAD = "include in.packing\n"


class Output(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4), random_velocities(packing(4)))
        (self.folder / "post").mkdir()

    def collection(self, name="post/flow.pvd"):
        """[(time, part, file)] of a .pvd file."""
        root = ElementTree.parse(self.folder / name).getroot()
        return [(float(entry.get("timestep")), entry.get("part"), entry.get("file"))
                for entry in root.iter("DataSet")]

    def profile(self, name="p.csv"):
        lines = (self.folder / name).read_text().splitlines()
        return lines[0], [[float(value) for value in line.split(",")] for line in lines[1:]]

    def test_fields_every_n_steps_with_their_time(self):
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} output 10 post/flow.pvd\nrun 25\nrun 5\n")
        entries = self.collection()
        self.assertEqual([(part, file) for _, part, file in entries], [
            (str(part), f"flow_{what}_{step}.vtu") for step in (0, 10, 20, 30)
            for part, what in enumerate(("pores", "grains", "walls"))])
        for (time, _, file), step in zip(entries[::3], (0, 10, 20, 30)):
            self.assertAlmostEqual(time, step * 1e-5, delta=1e-15)
        for _, _, file in entries:
            self.assertGreater((self.folder / "post" / file).stat().st_size, 1000)

    def test_a_step_that_comes_again_gets_files_of_its_own(self):
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} output 10 post/flow.pvd\nrun 10\nreset_timestep 0\nrun 10\n"
                      "write_restart file.restart\n")
        self.liggghts(restarted_head() + f"fix flow all pfv {FLOW} output 10 post/flow.pvd\nrun 10\n")
        pores = [(round(time / 1e-5), file) for time, part, file in self.collection() if part == "0"]
        self.assertEqual(pores, [(0, "flow_pores_0.vtu"), (10, "flow_pores_10.vtu"), (10, "flow_pores_0_2.vtu"),
                                 (20, "flow_pores_10_2.vtu"), (30, "flow_pores_20.vtu")])
        for _, file in pores:
            self.assertTrue((self.folder / "post" / file).exists())

    def test_two_records_in_one_file_are_refused(self):
        self.refused(HEAD + f"fix flow all pfv {FLOW} history 1 h.csv sensors 1 post/../h.csv 0 0 0\nrun 0\n",
                     "sensors and history write to one file")

    def test_grains_hold_the_forces_of_the_run(self):
        """Read back with VTK's own reader."""
        try:
            from vtkmodules.util.numpy_support import vtk_to_numpy
            from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        except ImportError:
            self.skipTest("VTK's Python module is not installed")
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} output 10 post/flow.pvd\n" +
                      dump("d.dump") + "run 10\n")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "post" / "flow_grains_10.vtu"))
        reader.Update()
        data = reader.GetOutput().GetPointData()
        ids, force = (vtk_to_numpy(data.GetArray(name)) for name in ("id", "force"))
        rows = read_dump(self.folder / "d.dump")[10]
        self.assertEqual(len(ids), len(rows))
        for number, vector in zip(ids, force):
            self.assertEqual(list(vector), rows[int(number)][7:10])

    def test_profile_rows(self):
        """Pressures fall from the face at 10 Pa to the one at 0 Pa."""
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} profile z 4 5 p.csv\nrun 12\nrun 3\n")
        header, rows = self.profile()
        self.assertEqual(header, "time,0.125,0.375,0.625,0.875")
        self.assertEqual([round(row[0] / 1e-5) for row in rows], [0, 5, 10, 15])
        for row in rows:
            self.assertTrue(10 >= row[1] > row[2] > row[3] > row[4] >= 0)

    def test_profile_along_x_is_level(self):
        """Across the flow the pressure is the mean one, up to the disorder of the packing."""
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} profile x 3 1 p.csv\nrun 0\n")
        _, rows = self.profile()
        for pressure in rows[0][1:]:
            self.assertAlmostEqual(pressure, 5.0, delta=1.0)

    def test_files_with_a_flow_step_every_few_steps(self):
        """Written after the first flow step that reaches each multiple."""
        self.liggghts(HEAD + f"fix flow all pfv {WATER} couple_every 4 profile z 2 5 p.csv\n"
                      "run 16\n")
        _, rows = self.profile()
        self.assertEqual([round(row[0] / 1e-5) for row in rows], [0, 8, 12, 16])

    def test_new_run_begins_its_files_anew(self):
        (self.folder / "p.csv").write_text("old\n1\n2\n")
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} profile z 2 5 p.csv\nrun 5\n")
        header, rows = self.profile()
        self.assertEqual((header, len(rows)), ("time,0.25,0.75", 2))

    def test_restarted_run_goes_on_with_its_files(self):
        """Also when the first run went on beyond the restart file."""
        fix = f"fix flow all pfv {FLOW} profile z 2 5 p.csv output 5 post/flow.pvd\n"
        self.liggghts(HEAD + fix + "run 10\nwrite_restart file.restart\nrun 10\n")
        whole = (self.folder / "p.csv").read_bytes()
        entries = self.collection()
        self.assertEqual(len(entries), 15)
        self.liggghts(restarted_head() + fix + "run 10\n")
        self.assertEqual((self.folder / "p.csv").read_bytes(), whole)
        self.assertEqual(self.collection(), entries)

    def test_restarted_run_starts_a_profile_of_another_kind_anew(self):
        fix = f"fix flow all pfv {FLOW} profile z 2 5 p.csv\n"
        self.liggghts(HEAD + fix + "run 10\nwrite_restart file.restart\n")
        self.liggghts(restarted_head() + fix.replace("z 2 5", "z 3 5") + "run 10\n")
        header, rows = self.profile()
        self.assertEqual(len(header.split(",")), 4)
        self.assertEqual([round(row[0] / 1e-5) for row in rows], [15, 20])

    def history(self, name="h.csv"):
        """Rows as dictionaries of texts."""
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_history_holds_what_thermo_prints(self):
        """Each row is that of LIGGGHTS' own output; forces on grains and faces add up to nothing."""
        self.liggghts(HEAD + f"fix flow all pfv {FLOW} history 5 h.csv\n"
                      "thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[7] f_flow[11] f_flow[12] f_flow[13] f_flow[14]\n"
                      "thermo_modify format float %.15g norm no\nthermo 5\nrun 10\n")
        rows, printed = self.history(), read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual([int(row["step"]) for row in rows], [0, 5, 10])
        for row, line in zip(rows, printed):
            for name, word in (("strain", "flow"), ("inflow", "flow[1]"), ("outflow", "flow[2]"),
                               ("mean_pressure", "flow[7]"), ("reynolds_largest", "flow[11]"),
                               ("reynolds_mean", "flow[12]"), ("stokes_largest", "flow[13]"),
                               ("stokes_mean", "flow[14]")):
                self.assertAlmostEqual(float(row[name]), line[word], delta=1e-11 * abs(line[word]))
            self.assertEqual(row["permeability"], "")  # of grains that move there is none
            self.assertLess(abs(float(row["mass_error"])), 1e-12)
            pushed = [float(row["zlo_force_z"]), float(row["zhi_force_z"]), float(row["force_z"])]
            pushed += [float(row[f"{face}_force_z"]) for face in ("xlo", "xhi", "ylo", "yhi")]
            self.assertLess(abs(sum(pushed)), 1e-11 * max(map(abs, pushed)))
            self.assertEqual(float(row["zhi_position"]), EDGE)
            self.assertAlmostEqual(float(row["zlo_flux"]) / float(row["inflow"]), 1, delta=0.2)
        self.assertAlmostEqual(float(rows[-1]["time"]), 1e-4, delta=1e-15)

    def test_history_counts_steps_that_were_solved_and_that_were_saved(self):
        flow = WATER + " couple_every 4"
        self.liggghts(HEAD + f"fix flow all pfv {flow} history 1 h.csv patch xlo 0 0.1 0 0.1 pressure 5\nrun 8\nrun 8\n")
        rows = self.history()
        self.assertEqual([(int(row["steps"]), int(row["solves"])) for row in rows],
                         [(0, 0), (4, 1), (8, 2), (12, 3), (16, 4)])
        self.assertEqual(float(rows[-1]["patch 1 on face xlo pressure"]), 5.0)

    def drawn(self, name):
        """[(name, force along z) of each wall] of a file."""
        try:
            from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        except ImportError:
            self.skipTest("VTK's Python module is not installed")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / name))
        reader.Update()
        data = reader.GetOutput().GetCellData()
        names, forces = data.GetAbstractArray("name"), data.GetArray("force")
        return [(names.GetValue(k), forces.GetTuple(k)[2]) for k in range(names.GetNumberOfValues())]

    def test_history_and_drawn_walls_of_a_container_have_its_names(self):
        faces = " ".join(f"face {name} plane {place} {normal} {more}" for name, place, normal, more in (
            ("left", "0 0 0", "1 0 0", ""), ("right", "0.1 0 0", "-1 0 0", ""), ("front", "0 0 0", "0 1 0", ""),
            ("back", "0 0.1 0", "0 -1 0", ""), ("under,ground", "0 0 0", "0 0 1", "pressure 10"),
            ("lid", "0 0 0.1", "0 0 -1", "pressure 0")))
        self.liggghts(HEAD + f"fix flow all pfv viscosity 0.01 container {faces} history 1 h.csv output 1 f.pvd\nrun 0\n")
        row, = self.history()
        walls = self.drawn("f_walls_0.vtu")
        self.assertEqual([name for name, _ in walls], ["left", "right", "front", "back", "under,ground", "lid"])
        for name, force in walls:
            self.assertAlmostEqual(float(row[f"{name}_force_z"]), force, delta=1e-11 * max(abs(force), 1e-3))
        self.assertEqual((float(row["lid_position"]), float(row["under,ground_position"])), (0.1, 0.0))
        self.assertGreater(float(row["under,ground_flux"]), 0.0)

    def test_restarted_run_goes_on_with_its_history(self):
        """To the same bytes, with the counts of all runs; what a run that was killed has left of its last row goes."""
        for words in (FLOW, WATER + " couple_every 4"):
            fix = f"fix flow all pfv {words} history 5 h.csv\n"
            self.liggghts(HEAD + fix + "run 10\nwrite_restart file.restart\nrun 10\n")
            whole = (self.folder / "h.csv").read_bytes()
            self.assertEqual(whole.count(b"\n"), 6)
            (self.folder / "h.csv").write_bytes(whole.rstrip(b"\n") + b"\n25,0.00")
            self.liggghts(restarted_head() + fix + "run 10\n")
            self.assertEqual((self.folder / "h.csv").read_bytes(), whole)

    def test_liggghts_reads_what_pfv_convert_writes(self):
        """The same bytes come out of a run on the data file and on one that went through a dump."""
        run = HEAD + f"fix flow all pfv {FLOW}\n" + dump("d.dump") + "run 2\n"
        self.liggghts(run)
        first = (self.folder / "d.dump").read_bytes()
        for names in (["packing.data", "a.dump"], ["a.dump", "packing.data", "--density", "2600"]):
            subprocess.run([BIN / "pfv", "convert", *names], cwd=self.folder, check=True, capture_output=True)
        self.liggghts(run)
        self.assertEqual((self.folder / "d.dump").read_bytes(), first)

    def test_file_that_cannot_be_written_stops_the_run(self):
        (self.folder / "post" / "flow_pores_0.vtu" / "in_the_way").mkdir(parents=True)
        script = HEAD + f"fix flow all pfv {FLOW} output 10 post/flow.pvd\nrun 5\n"
        for ranks in (1, 2):
            self.refused(script, "flow_pores_0.vtu", ranks=ranks)

    def test_sensors_read_the_pressure_where_they_are(self):
        """Each row holds what profile planes and neighbours bracket; outside the box the nearest
        place is read."""
        said = self.liggghts(HEAD + f"fix flow all pfv {FLOW} sensors 5 s.csv 0.05 0.05 0.02 "
                             "0.05 0.05 0.08 0.05 0.05 -1 0.05 0.05 9\nrun 10\n")
        self.assertEqual(re.findall(r"the sensor at \((.*?)\) m is outside the room of the fluid", said),
                         ["0.05, 0.05, -1", "0.05, 0.05, 9"])
        header, rows = self.profile("s.csv")
        self.assertEqual(header, "time,0.05 0.05 0.02,0.05 0.05 0.08,0.05 0.05 -1,0.05 0.05 9")
        self.assertEqual([round(row[0] / 1e-5) for row in rows], [0, 5, 10])
        for row in rows:
            self.assertTrue(10 > row[1] > row[2] > 0)
            self.assertEqual(row[3:], [10, 0])

    def test_sensors_need_three_coordinates_each(self):
        self.refused(HEAD + f"fix flow all pfv {FLOW} sensors 5 s.csv 0.05 0.05\nrun 0\n",
                     "keyword 'sensors'", "coordinate")

    def test_displacement_is_counted_from_the_first_file(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        self.liggghts(HEAD + "fix integr all nve/sphere\n" +
                      f"fix flow all pfv {FLOW} output 10 post/flow.pvd\nrun 10\n")
        places = {}
        for step in (0, 10):
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.folder / "post" / f"flow_grains_{step}.vtu"))
            reader.Update()
            grid = reader.GetOutput()
            places[step] = vtk_to_numpy(grid.GetPoints().GetData())
        moved = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
        self.assertGreater(abs(moved).max(), 1e-9)
        self.assertTrue((moved == places[10] - places[0]).all())

    def test_strain_of_grains_that_move_affinely(self):
        """They pass through each other without a force; one comes later and has no strain."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        grains = packing(4)
        write_data(self.folder, grains, {grain[0]: (2 * grain[2], 0.0, -30 * grain[3]) for grain in grains})
        self.liggghts(HEAD + "neigh_modify exclude type 1 1\nunfix integr\nfix integr all nve/noforce\n" +
                      f"fix flow all pfv {FLOW} output 10 flow.pvd\nrun 10\n"
                      "create_atoms 1 single 0.051 0.049 0.052\nset atom 65 diameter 0.004 density 2600\nrun 90\n")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "flow_grains_100.vtu"))
        reader.Update()
        data = reader.GetOutput().GetPointData()
        ids, strain, deviator = (vtk_to_numpy(data.GetArray(name)) for name in ("id", "strain", "strain_deviator"))
        time = 100 * 1e-5
        exact = numpy.array([0, 0, -30, 1, 0, 0]) * time  # xx yy zz xy yz xz
        numpy.testing.assert_allclose(strain[ids <= 64], numpy.tile(exact, (64, 1)), atol=1e-9)
        numpy.testing.assert_allclose(deviator[ids <= 64], time * (2 / 3 * (600 + 2)) ** 0.5, atol=1e-9)
        self.assertEqual(list(ids[ids > 64]), [65])
        self.assertFalse(strain[ids > 64].any())

    def closing_permeability(self, screen):
        """(m2, estimated error %, share of the dissipation in degenerate throats %) as printed."""
        lines = re.findall(r"^permeability (\S+) m2  estimated error (\S+) %  "
                           r"in degenerate throats (\S+) %$", screen, re.MULTILINE)
        self.assertEqual(len(lines), 1, screen[-2000:])
        return [float(word) for word in lines[0]]

    def test_permeability_of_grains_at_rest_is_told_with_its_error(self):
        write_data(self.folder, packing(4))
        for law in ("open_throat", "hydraulic_radius"):
            screen = self.liggghts(HEAD + f"fix flow all pfv {FLOW} conductance {law}\n" +
                                   dump("d.dump") + "run 0\n")
            told, error, degenerate = self.closing_permeability(screen)
            report = self.pfv_solve("d.dump", "--face", "zlo:pressure=10", "--face",
                                    "zhi:pressure=0", "--conductance", law)[0]
            self.assertAlmostEqual(told / report["permeability"], 1, delta=1e-5)
            self.assertAlmostEqual(error / (100 * report["permeability_error"]), 1, delta=0.05)
            self.assertEqual(degenerate, 0)
            self.assertNotIn("WARNING: the permeability", screen)

    def test_permeability_outside_what_was_compared_warns(self):
        write_data(self.folder, [(1, EDGE / 2, EDGE / 2, EDGE / 2, EDGE / 25)])
        screen = self.liggghts(HEAD + f"fix flow all pfv {FLOW}\nrun 0\n")
        self.closing_permeability(screen)
        self.assertIn("WARNING: the permeability's estimated error may not hold: the solid "
                      "fraction is 0.000268", screen)

    def test_moving_grains_have_no_permeability_to_tell(self):
        screen = self.liggghts(HEAD + f"fix flow all pfv {FLOW}\nrun 2\n")
        self.assertNotIn("estimated error", screen)

    def test_asking_for_more_does_not_change_the_run(self):
        plain = HEAD + f"fix flow all pfv {FLOW}\n" + dump("d.dump") + "run 10\n"
        self.liggghts(plain)
        first = (self.folder / "d.dump").read_bytes()
        full = plain.replace(FLOW, FLOW + " output 2 post/flow.pvd profile z 3 2 p.csv")
        self.liggghts(full.replace("run 10", "thermo_style custom step f_flow[1] f_flow[6]\n"
                                   "thermo 1\nrun 10"))
        self.assertEqual((self.folder / "d.dump").read_bytes(), first)
        self.assertEqual(len(read_thermo((self.folder / "log.liggghts").read_text())), 11)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The flow on all ranks: what one rank finds, however the grains are spread, dealt and carried about."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest
from typing import NamedTuple

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

from coupled import EDGE, HANG, HERE, LONG, CoupledTest, dump, each_of, faces, forces, in_long, largest_difference
from coupled import liggghts_words, one_after_the_other, one_thread, packing, random_velocities, read_dump, read_thermo
from coupled import restarted_head, share_one_core, write_data
from coupled_runs import Runs
from plates import square, write_plate

SHARED = "solver amg tolerance 1e-11 ranks all"
ALONE = SHARED.replace("all", "one")
SEEPAGE = "viscosity 0.01 " + faces(zlo="pressure 10", zhi="pressure 0")
THERMO = ("thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[4] f_flow[5] "
          "f_flow[7] f_flow[8] f_flow[10] f_flow[11] f_flow[12] f_flow[13] f_flow[14]{}\n"
          "thermo_modify norm no format float %.15g\nthermo 1\n")
HEAD = "include in.packing\n"
ALONG = "neigh_modify exclude type 1 1\n"  # grains pass through each other


class Case(NamedTuple):
    fix: str
    commands: str
    head: str = HEAD
    within: float = 1e-8  # that the forces are those of one rank


class SharedFlow(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(5), random_velocities(packing(5)))

    def run_on(self, ranks, cases, limit=False):
        """Of each case, with the flow on these ranks: (rows of thermo, {step: grains}). `limit`: the rows have that of the
        time step, which takes longer to find than all else."""
        words = SHARED if ranks > 1 else ALONE
        thermo = THERMO.format(" f_flow[6]" if limit else "")
        self.liggghts(one_after_the_other(
            f"{case.head}fix flow all pfv {case.fix} {words}\n{thermo}" + dump(f"{n}.dump") + case.commands
            for n, case in enumerate(cases)), ranks=ranks)
        return [(read_thermo(log), read_dump(self.folder / f"{n}.dump")) for n, log in enumerate(each_of(self.log()))]

    def log(self):
        return (self.folder / "log.liggghts").read_text()

    def compare(self, *cases, ranks=(2,), limit=LONG):
        """Runs the cases on one rank and on several; returns, of each, the rows and the grains of one rank."""
        alone = self.run_on(1, cases, limit)
        for count in ranks:
            for case, one, several in zip(cases, alone, self.run_on(count, cases, limit), strict=True):
                with self.subTest(fix=case.fix, ranks=count):
                    self.compare_runs(one, several, case.within, limit)
        return alone

    def compare_runs(self, one, several, within, limit):
        (rows, steps), (others, grains) = one, several
        for row, other in zip(rows, others, strict=True):
            for name in ("flow", "flow[1]", "flow[2]", "flow[7]"):
                self.assertAlmostEqual(other[name], row[name], delta=within * max(1e-6, abs(row[name])), msg=name)
            for name in ("flow[11]", "flow[12]", "flow[13]", "flow[14]"):  # Reynolds and Stokes numbers
                self.assertAlmostEqual(other[name], row[name], delta=1e-6 * abs(row[name]), msg=name)
            for name in ("Step", "flow[5]", "flow[8]", "flow[10]"):
                self.assertEqual(other[name], row[name], name)
            self.assertLess(abs(other["flow[3]"]), 1e-9)
            self.assertLess(other["flow[4]"], 1e-12)
            if limit:
                self.assertAlmostEqual(other["flow[6]"], row["flow[6]"], delta=5e-3 * row["flow[6]"])
        self.assertEqual(grains.keys(), steps.keys())
        for step, of_step in grains.items():
            self.assertLess(largest_difference(forces(of_step), forces(steps[step])), within)

    def times_dealt(self):
        """How often each run of the last script has dealt grains to the ranks."""
        return [int(times) for times in re.findall("grains dealt to the ranks (.*) times", self.log())]

    def test_forces_pressures_and_torques_of_a_bed_in_motion(self):
        case = Case(SEEPAGE + " torques yes couple_every 1", "run 5\n")
        (_, steps), = self.compare(case, ranks=in_long((2, 4), (3,)), limit=True)
        for step, of_step in read_dump(self.folder / "0.dump").items():  # of several ranks
            largest = max(abs(value) for row in steps[step].values() for value in row[13:16])
            for tag, row in of_step.items():
                self.assertAlmostEqual(row[10], steps[step][tag][10], delta=1e-8)
                for found, expected in zip(row[13:16], steps[step][tag][13:16]):
                    self.assertAlmostEqual(found, expected, delta=1e-7 * largest)

    def test_grains_that_migrate_at_each_step(self):
        """They fall as one body through the sub-domains of the ranks, which are cut along the way, and the box with
        them; at the end most are on another rank than the one that has them in the flow."""
        grains = packing(in_long(5, 4))
        steps = in_long(60, 30)
        write_data(self.folder, grains, {grain[0]: (0.0, 0.0, 2400.0 / steps) for grain in grains})
        head = (HEAD.replace("include in.packing\n", "processors 1 1 *\ninclude in.packing\n") +
                "neigh_modify delay 0 every 1\n")
        box = SEEPAGE.replace("face zhi plane 0.1", "face zhi extent").replace("face zlo plane 0.0", "face zlo extent")
        (_, dumped), = self.compare(Case(box + " couple_every 1", f"run {steps}\n", head), ranks=(in_long(4, 3),))
        self.assertGreater(min(row[2] for row in dumped[steps].values()), 0.02)

    def test_intervals_and_networks(self):
        """Mean velocities over several steps, intervals of its own, networks made anew; those of a compressible fluid take
        its pressures along."""
        interval, anew = "couple_every {}", "{} couple_every 1 retriangulate 2e-4"
        cases = [Case(f"{SEEPAGE} {words}", "run 20\n") for words in (interval.format(4), interval.format("auto error 0.1"),
                                                                      anew.format(""), anew.format("bulk_modulus 1e4"))]
        _, (own, _), (plain, _), (compressible, _) = self.compare(*cases, ranks=in_long((3, 4), (2,)))
        self.assertIn(0, {row["flow[10]"] for row in own})
        for rows in (plain, compressible):
            self.assertGreater(rows[-1]["flow[5]"], 3)
        self.assertLess(compressible[5]["flow[2]"], 0.9 * compressible[5]["flow[1]"])  # not yet a steady flow

    def test_what_changes_between_runs(self):
        """An interval; places, which begins anew; grains that are deleted and inserted."""
        _, (moved, _), (_, steps) = self.compare(
            Case(SEEPAGE + " couple_every auto error 0.1", "run 6\nfix_modify flow couple_every 2\nrun 6\n"),
            Case(SEEPAGE + " couple_every 1", "run 3\nrun 0\ndisplace_atoms all move 0.0005 0 0\nrun 3\n"),
            Case(SEEPAGE + " couple_every 2", "run 3\ngroup some id 7 60 61\ndelete_atoms group some compress no\nrun 3\n"
                 "create_atoms 1 single 0.05 0.05 0.099\nset atom 126 diameter 0.004 density 2600\nrun 3\n"),
            ranks=(in_long(3, 2),))
        self.assertEqual(moved[-1]["flow[5]"], 1)
        self.assertEqual(len(steps[9]), 123)

    def test_staged_steps_far_above_the_limit(self):
        head = HEAD + "fix g all gravity 9.81 vector 0 0 -1\n"
        fix = SEEPAGE.replace("viscosity 0.01", "viscosity 50000") + " density 1000 coupling staged"
        (rows, steps), = self.compare(Case(fix, f"run {in_long(4, 2)}\n", head), ranks=(in_long(3, 2),), limit=True)
        self.assertLess(rows[0]["flow[6]"], 1e-5 / 10)
        for step, of_step in read_dump(self.folder / "0.dump").items():  # of several ranks
            for tag, row in of_step.items():
                for value, expected in zip(row[4:7], steps[step][tag][4:7]):
                    self.assertAlmostEqual(value, expected, delta=1e-9)

    def test_strayed_grains_are_dealt_anew_within_a_run(self):
        """Half of the bed runs through the other: the parts overlap more and more."""
        grains = packing(4)
        steps = in_long(200, 24)
        speed = 1200.0 / steps
        write_data(self.folder, grains,
                   {grain[0]: (speed if grain[0] % 2 else -speed, 0.0, 0.0) for grain in grains})
        cases = [Case(f"{SEEPAGE} couple_every {words}", f"run {steps}\n", HEAD + ALONG) for words in ("5", "auto error 5")]
        alone, three = (self.run_on(ranks, cases) for ranks in (1, 3))
        self.assertGreater(min(self.times_dealt()), 1)
        for (_, one), (_, several) in zip(alone, three, strict=True):
            # to deal grains anew makes one network more, whose forces, 1 % others there, leave the grains elsewhere
            self.assertLess(largest_difference(forces(several[steps]), forces(one[steps])), 1e-6)

    def test_grains_inserted_within_a_run(self):
        head = HEAD + ("fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 2600 radius constant "
                       "0.003\nfix pdd all particledistribution/discrete 15485867 1 pts 1.0\n"
                       "region above block 0 0.1 0 0.1 0.1 0.14 units box\n"
                       "fix ins all insert/pack seed 32452843 distributiontemplate pdd insert_every 5 overlapcheck yes "
                       "all_in yes vel constant 0 0 -1.0 region above particles_in_region 6\n")
        box = SEEPAGE.replace("face zhi plane 0.1", "face zhi plane 0.14")
        (_, steps), = self.run_on(in_long(4, 2), [Case(box + " couple_every 2", "run 30\n", head)])
        self.assertGreater(len(steps[30]), 130)
        for row in steps[30].values():
            self.assertGreater(sum(abs(value) for value in row[7:10]), 0.0)

    def test_faces_that_follow_grains_and_meshes(self):
        write_plate(self.folder / "lid.stl", square(EDGE, EDGE))
        head = HEAD + ("fix lid all mesh/surface/stress file lid.stl type 1\n"
                       "fix lidw all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 "
                       "meshes lid\nfix down all move/mesh mesh lid linear 0 0 -0.01\n")
        fixes = ["viscosity 0.01 " + faces(zlo=below, zhi="mesh lid sealed") + " couple_every 1"
                 for below in ("extent pressure 0", "pressure 0")]
        follows = Case(fixes[0], "run 6\n", head)
        pushes = Case(fixes[1], "thermo_style custom step f_lid[3]\nthermo_modify norm no format float %.15g\nrun 3\n", head)
        (alone, (of_one, _)), (several, (of_all, _)) = (self.run_on(ranks, [follows, pushes]) for ranks in (1, in_long(4, 3)))
        self.compare_runs(alone, several, within=1e-8, limit=False)
        pushed = of_one[-1]["lid[3]"]
        self.assertGreater(pushed, 0.0)
        self.assertAlmostEqual(of_all[-1]["lid[3]"], pushed, delta=1e-8 * pushed)

    def test_a_container_of_walls_with_variables_and_patches(self):
        head = HEAD + ("fix side all wall/gran model hooke/stiffness tangential history primitive type 1 zcylinder 0.08 "
                       "0.05 0.05\nvariable p equal 10+step\n")
        fix = ("viscosity 0.01 container face bottom plane 0.05 0.05 0 0 0 1 pressure v_p face top plane 0.05 0.05 0.1 0 0 -1 "
               "pressure 0 face side wall side couple_every 1")
        box = "viscosity 0.01 " + faces(zlo="pressure v_p") + " patch zhi 0.04 0.06 0.04 0.06 pressure 0 couple_every 1"
        # grains in the empty corners are braked as in open water, what neighbours give each other settled to 1e-6
        self.compare(Case(fix, "run 4\n", head, within=2e-6), Case(box, "run 4\n", head))

    def test_files_have_the_same_values(self):
        fix = (SEEPAGE + " couple_every 2 profile z 8 2 p.csv flux_profile z 4 2 q.csv sensors 4 s.csv 0.05 0.05 0.03 0.02 "
               "0.01 0.2 history 2 h.csv")
        tables = {}
        for ranks in (1, 3):
            self.run_on(ranks, [Case(fix, "run 8\n")], limit=True)
            tables[ranks] = {name: (self.folder / name).read_text().splitlines() for name in
                             ("p.csv", "q.csv", "s.csv", "h.csv")}
        for name, lines in tables[1].items():
            self.assertEqual(tables[3][name][0], lines[0])
            self.assertEqual(len(tables[3][name]), len(lines))
            for found, expected in zip(tables[3][name][1:], lines[1:]):
                for a, b in zip(found.split(","), expected.split(",")):
                    if a or b:
                        self.assertAlmostEqual(float(a), float(b), delta=1e-7 * max(abs(float(b)), 1e-4), msg=name)

    def test_fields_are_written_in_pieces(self):
        """Also of grains that are dealt anew: their displacements begin where they were first written."""
        grains = packing(4)
        steps = in_long(400, 80)
        speed = 1200.0 / steps
        write_data(self.folder, grains, {grain[0]: (speed if grain[0] % 2 else -speed, 0.0, 0.0) for grain in grains})
        found = {}
        for ranks in (1, 3):
            fix = f"{SEEPAGE} couple_every {steps // 8} output {steps // 2} f.pvd"
            self.run_on(ranks, [Case(fix, f"run {steps}\n", HEAD + ALONG)])
            if ranks > 1:
                self.assertGreater(min(self.times_dealt()), 1)
            collection = (self.folder / "f.pvd").read_text()
            self.assertEqual((collection.count(".pvtu"), collection.count(".vtu")), (6, 3) if ranks > 1 else (0, 9))
            reader = vtkXMLPUnstructuredGridReader() if ranks > 1 else vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.folder / f"f_grains_{steps}.{'pvtu' if ranks > 1 else 'vtu'}"))
            reader.Update()
            data = reader.GetOutput().GetPointData()
            arrays = {name: vtk_to_numpy(data.GetArray(name)) for name in
                      ("id", "displacement", "force", "fluid_velocity", "fluid_stress", "strain", "strain_deviator")}
            order = numpy.argsort(arrays["id"])
            found[ranks] = {name: values[order] for name, values in arrays.items()}
        self.assertGreater(numpy.abs(found[1]["displacement"]).min(axis=0)[0], 0.011)
        for name, tolerance in (("id", 0), ("displacement", 1e-12), ("force", 1e-8), ("fluid_velocity", 1e-8), ("fluid_stress", 1e-8),
                                ("strain", 1e-8), ("strain_deviator", 1e-8)):
            scale = numpy.abs(found[1][name]).max()
            numpy.testing.assert_allclose(found[3][name], found[1][name], rtol=0, atol=tolerance * scale, err_msg=name)

    def test_beads_settle_as_on_one_rank(self):
        """The end of a coupled run in small; doc/scaling.py has whole ones."""
        runs = Runs(self.folder, part=0.05)
        alone = runs.observe("settling")
        for name, value in runs.observe("settling", ranks=in_long(4, 2)).items():
            self.assertAlmostEqual(value, alone[name], delta=1e-6 * abs(alone[name]), msg=name)

    def test_ranks_without_grains(self):
        """Fewer grains than ranks, too."""
        grains = [grain for grain in packing(5) if grain[1] < 0.03]
        cases = []
        for name, some in (("few", grains), ("two", grains[:2])):
            write_data(self.folder, some, random_velocities(some))
            (self.folder / "packing.data").rename(self.folder / name)
            head = (HERE / "in.packing").read_text().replace("packing.data", name)
            cases.append(Case(SEEPAGE + " couple_every 1", "run 3\n", "processors * 1 1\n" + head))
        self.compare(*cases, ranks=(in_long(4, 3),))

    def test_the_same_bytes_twice_and_for_any_sub_domains(self):
        def script(processors):
            return (f"processors {processors}\n" + HEAD + ALONG + f"fix flow all pfv {SEEPAGE} couple_every 1 {SHARED}\n" +
                    dump(f"{processors.replace(' ', '')}.dump") + "run 3\n")

        self.liggghts(script("4 1 1"), ranks=4)
        first = (self.folder / "411.dump").read_bytes()
        self.liggghts(one_after_the_other([script("4 1 1"), script("1 2 2")]), ranks=4)
        for name in ("411.dump", "122.dump"):
            self.assertEqual((self.folder / name).read_bytes(), first, name)

    def test_continued_and_restarted_runs_write_the_same_bytes(self):
        every = "couple_every 1", "couple_every 4", "couple_every auto error 1", "couple_every 1 bulk_modulus 1e4"
        run = f"run {in_long(10, 5)}\n"

        def fix(words, where=SHARED):
            return f"fix flow all pfv {SEEPAGE} {words} {where}\n"

        def restarted(name, where=SHARED):
            return one_after_the_other(restarted_head().replace("file.restart", f"{n}.restart") + fix(words, where) +
                                       dump(f"{name}{n}.dump") + run for n, words in enumerate(every))

        self.liggghts(one_after_the_other(
            HEAD + fix(words) + f"{run}write_restart {n}.restart\n" + dump(f"continued{n}.dump") + run
            for n, words in enumerate(every)), ranks=in_long(3, 2))
        self.liggghts(restarted("again"), ranks=in_long(3, 2))
        self.liggghts(restarted("one", ALONE))
        if LONG:
            self.liggghts(restarted("two"), ranks=2)
        for n, words in enumerate(every):
            continued, again = ((self.folder / f"{name}{n}.dump").read_bytes() for name in ("continued", "again"))
            self.assertEqual(continued, again, words)
            expected = read_dump(self.folder / f"continued{n}.dump")
            for name in in_long(("one", "two"), ("one",)):
                for step, rows in read_dump(self.folder / f"{name}{n}.dump").items():
                    self.assertLess(largest_difference(forces(rows), forces(expected[step])), 1e-7, (name, words))

    def test_a_file_of_one_rank_is_continued_in_mid_interval(self):
        fix, shared = (f"fix flow all pfv {SEEPAGE} couple_every 4 {words}\n" for words in (ALONE, SHARED))
        self.liggghts(HEAD + fix + "run 10\nwrite_restart file.restart\n" + dump("continued.dump") + "run 10\n")
        self.liggghts(restarted_head() + shared + dump("shared.dump") + "run 10\n", ranks=2)
        expected = read_dump(self.folder / "continued.dump")
        for step, rows in read_dump(self.folder / "shared.dump").items():
            self.assertLess(largest_difference(forces(rows), forces(expected[step])), 1e-8)

    def test_auto_shares_what_amg_is_asked_for(self):
        each = "solver amg", "", "solver amg volume_rates geometric"
        self.liggghts(one_after_the_other(f"{HEAD}fix flow all pfv {SEEPAGE} {words}\nrun 1\n" for words in each), ranks=2)
        amg, automatic, geometric = each_of(self.log())
        self.assertIn("the flow is shared by 2 ranks", amg)
        self.assertNotIn("shared by", automatic)
        self.assertIn("the flow is on one rank: volume_rates geometric needs that", geometric)

    def test_what_ranks_cannot_share_is_refused(self):
        for words, reason in (("coupling implicit", "coupling implicit"),
                              ("volume_rates geometric", "volume_rates geometric"), ("solver cholmod", "solver cholmod")):
            fix = f"fix flow all pfv {SEEPAGE} ranks all {words}\n"
            self.refused(HEAD + fix + "run 0\n", reason, "ranks one", ranks=2)
            if words.startswith("volume"):
                self.liggghts(HEAD + fix + "run 0\n")  # there is one only

    def test_an_error_of_the_library_ends_all_with_one_line(self):
        grains = packing(5)
        n, x, y, z, radius = grains[7]
        write_data(self.folder, grains + [(999, x, y, z, radius)])
        fix = f"fix flow all pfv {SEEPAGE} {SHARED} culprits c.vtu\n"
        self.refused(HEAD + fix + "run 0\n", "8", "999", "drawn in c.vtu", ranks=3)
        self.assertIn('NumberOfPoints="2"', (self.folder / "c.vtu").read_text(errors="replace"))

    def test_a_rank_that_is_killed_ends_all_and_leaves_what_was_written(self):
        script = HEAD + f"fix flow all pfv {SEEPAGE} couple_every 1 {SHARED} history 1 h.csv\nrun 1000000\n"
        (self.folder / "in.test").write_text(script)
        shutil.copy(HERE / "in.packing", self.folder)
        run = subprocess.Popen(liggghts_words("in.test", ranks=2), cwd=self.folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, env=one_thread(), preexec_fn=share_one_core)
        try:
            history, waited = self.folder / "h.csv", 0.0
            while waited < HANG and not (history.exists() and history.read_text().count("\n") > 5):
                time.sleep(0.05)
                waited += 0.05
            os.kill(children_of(run.pid)[-1], signal.SIGKILL)
            self.assertNotEqual(run.wait(timeout=HANG), 0)
        finally:
            run.kill()
        rows = history.read_text().split("\n")
        self.assertEqual(rows[-1], "")  # the last row is whole
        self.assertGreater(len(rows), 6)
        for row in rows[1:-1]:
            self.assertEqual(row.count(","), rows[0].count(","))


def children_of(parent):
    """Process numbers, ascending."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            fields = (entry / "stat").read_text().rsplit(")", 1)[1].split() if entry.name.isdigit() else []
        except OSError:  # it has ended
            continue
        if fields and int(fields[1]) == parent:
            found.append(int(entry.name))
    return sorted(found)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Full disks and killed runs: one sentence, and nothing lost that was written. Staged steps that go out
of control."""
import os
import shutil
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree

from coupled import BIN, EDGE, FLOW, HANG, HERE, CoupledTest, faces, packing, random_velocities
from coupled import read_thermo, write_data

HEAD = "include in.packing\n"
NESTED = (  # x, y, z, radius in edges of the box
    (0.6377, 0.1333, 0.7586, 0.2961), (0.6431, 0.1482, 0.7321, 0.2363),
    (0.5018, 0.1230, 0.8088, 0.0464), (0.4895, 0.1208, 0.8190, 0.0160),
    (0.4887, 0.1203, 0.8199, 0.0147), (0.4872, 0.1217, 0.8189, 0.0110),
    (0.4870, 0.1233, 0.8172, 0.0076), (0.4852, 0.1217, 0.8194, 0.0029),
    (0.2171, 0.7767, 0.8685, 0.3991), (0.1060, 0.6420, 0.9215, 0.1346),
    (0.1642, 0.5968, 0.9395, 0.0384), (0.1744, 0.6001, 0.9283, 0.0196),
    (0.1720, 0.6078, 0.9281, 0.0105), (0.1722, 0.6004, 0.9311, 0.0028),
    (0.1724, 0.6001, 0.9317, 0.0014), (0.7521, 0.7455, 0.4635, 0.2457))


class Files(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(4), random_velocities(packing(4)))

    def test_full_disk_stops_the_run_with_one_line(self):
        self.refused(HEAD + f"fix flow all pfv {FLOW} profile z 4 1 /dev/full\nrun 5\n",
                     "/dev/full", "full")

    @unittest.skipUnless(os.geteuid() == 0, "only root may mount a small disk")
    def test_disk_that_fills_up_stops_the_run_and_leaves_whole_files(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "none", str(disk)],
                                 check=False, capture_output=True)
        if mounted.returncode:
            self.skipTest("no small disk can be mounted here")
        self.addCleanup(subprocess.run, ["umount", str(disk)], check=True)
        self.refused(HEAD + f"fix flow all pfv {FLOW} output 1 disk/flow.pvd\nrun 100\n",
                     "disk/flow", "No space left")
        self.assertGreater(len(self.whole_files(disk / "flow.pvd")), 2)
        self.assertEqual([f.name for f in disk.iterdir() if f.name.endswith(".part")], [])

    def test_file_that_outgrows_its_limit_is_named_and_none_is_left_half_written(self):
        """A disk that fills up on the way. LIGGGHTS' own MPI needs files too: the library's command."""
        grains = "".join(f"{n},{x!r},{y!r},{z!r},{r!r}\n" for n, x, y, z, r in packing(4))
        (self.folder / "p.csv").write_text("id,x,y,z,radius\n" + grains)
        solve = f"{BIN}/pfv solve --packing p.csv --box 0 0.1 0 0.1 0 0.1 --vtk pores.vtu"
        done = subprocess.run(["bash", "-c", f"trap '' XFSZ; ulimit -f 8; {solve}"], check=False,
                              cwd=self.folder, capture_output=True, text=True, timeout=HANG)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("pores.vtu", done.stderr.splitlines()[-1])
        self.assertEqual(sorted(f.name for f in self.folder.iterdir()), ["p.csv", "packing.data"])

    def test_killed_run_loses_nothing_that_was_written(self):
        script = HEAD + f"fix flow all pfv {FLOW} output 2 flow.pvd profile z 4 1 p.csv\nrun 1000000\n"
        (self.folder / "in.test").write_text(script)
        shutil.copy(HERE / "in.packing", self.folder)
        run = subprocess.Popen([str(BIN / "liggghts-pfv"), "-in", "in.test"], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            collection, waited = self.folder / "flow.pvd", 0.0
            while waited < HANG and self.entries(collection) < 20:
                time.sleep(0.05)
                waited += 0.05
        finally:
            run.send_signal(signal.SIGKILL)
            run.wait()
        self.assertGreaterEqual(len(self.whole_files(collection)), 20)
        rows = (self.folder / "p.csv").read_text().split("\n")
        self.assertEqual(rows[-1], "")  # the last row is whole
        for row in rows[:-1]:
            self.assertEqual(len(row.split(",")), 5)

    def whole_files(self, collection):
        """The files of a collection; raw data make them no XML, but what is whole has its end."""
        files = [entry.get("file") for entry in
                 ElementTree.parse(collection).getroot().iter("DataSet")]
        for name in files:
            content = (collection.parent / name).read_bytes()
            self.assertTrue(content.rstrip().endswith(b"</VTKFile>"), name)
        return files

    @staticmethod
    def entries(collection):
        return collection.read_text().count("<DataSet") if collection.exists() else 0


class FeedingFluid(CoupledTest):
    """Grains that overlap by most of their radii: the papers' S feeds energy to them, whatever the
    time step (doc/stability.md, growth)."""
    STEP = 1e-6

    def setUp(self):
        super().setUp()
        write_data(self.folder, [(n, *(EDGE * value for value in sphere))
                                 for n, sphere in enumerate(NESTED, 1)],
                   {n: (0.0, 0.0, -sphere[2]) for n, sphere in enumerate(NESTED, 1)})
        limit = self.rows(1.0, "", "run 0\n")[0]["flow[6]"]
        self.viscosity = 23 * limit / self.STEP  # R = 23: stages with the whole of S

    def script(self, viscosity, words, run):
        return (HEAD + f"fix flow all pfv viscosity {viscosity!r} "
                f"{faces(zlo='pressure 1', zhi='pressure 0')} {words}\ntimestep {self.STEP}\n"
                "thermo_style custom step ke f_flow[6] f_flow[7] f_flow[9]\n"
                "thermo_modify norm no format float %.15g\nthermo 1\n" + run)

    def rows(self, *words):
        self.screen = self.liggghts(self.script(*words))
        return read_thermo((self.folder / "log.liggghts").read_text())

    def test_staged_coupling_refuses_the_step(self):
        self.refused(self.script(self.viscosity, "coupling staged culprits seventh.vtu", "run 20\n"),
                     "out of control", "sphere 7", "implicit", "drawn in seventh.vtu")
        self.assertIn(b'NumberOfPoints="1"', (self.folder / "seventh.vtu").read_bytes())

    def test_auto_goes_on_with_the_implicit_coupling(self):
        energy = [row["KinEng"] for row in self.rows(self.viscosity, "coupling auto", "run 10\n")]
        said = [line for line in self.screen.splitlines() if "implicit coupling from step" in line]
        self.assertEqual(len(said), 1, self.screen)
        self.assertIn("sphere 7", said[0])
        alone = [row["KinEng"] for row in
                 self.rows(self.viscosity, "coupling implicit", "run 10\n")]
        for one, other in zip(energy, alone):
            self.assertAlmostEqual(one, other, delta=1e-2 * max(alone))


if __name__ == "__main__":
    unittest.main()

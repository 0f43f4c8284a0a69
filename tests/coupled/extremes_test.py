# SPDX-License-Identifier: GPL-3.0-or-later
"""Full disks and killed runs: one sentence, and nothing lost that was written."""
import os
import shutil
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree

from coupled import BIN, FLOW, HANG, HERE, CoupledTest, liggghts_words, packing, random_velocities, write_data

HEAD = "include in.packing\n"


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
        run = subprocess.Popen(liggghts_words("in.test"), cwd=self.folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
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


if __name__ == "__main__":
    unittest.main()

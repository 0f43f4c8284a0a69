# SPDX-License-Identifier: GPL-3.0-or-later
"""`model darcy_grid` of the fix: forces, renewals of the porosity, files, restart, refusals."""
import unittest

from coupled import FLOW, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo, restarted_head, write_data

HEAD = "include in.packing\n"
GRID = "fix flow all pfv " + FLOW + " model darcy_grid 2 2 3"
PRESSURES = ("--face", "zlo:pressure=10", "--face", "zhi:pressure=0")
THERMO = ("thermo_style custom step f_flow[1] f_flow[2] f_flow[3] f_flow[5] f_flow[6]\n"
          "thermo 1\nthermo_modify norm no format float %.15g\n")


class DarcyGrid(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(), random_velocities(packing()))

    def rows(self):
        return read_thermo((self.folder / "log.liggghts").read_text())

    def test_grains_get_the_forces_of_pfv_solve(self):
        for drag in ("di_felice", "kozeny_carman"):
            with self.subTest(drag=drag):
                self.liggghts(f"{HEAD}{GRID} drag {drag}\n{dump('d.dump')}run 0\n")
                found = forces(read_dump(self.folder / "d.dump")[0])
                wanted = self.pfv_forces("d.dump", *PRESSURES, "--model", "darcy_grid",
                                         "--cells", "2", "2", "3", "--drag", drag)
                self.assertLess(largest_difference(found, wanted), 1e-10)  # 17 digits in the dump

    def test_grain_motion_no_leaves_the_flow_as_it_is_at_rest(self):
        self.liggghts(f"{HEAD}{GRID} grain_motion no\n{THERMO}run 5\n")
        still = self.rows()
        self.liggghts(f"{HEAD}velocity all set 0 0 0\n{GRID}\n{THERMO}run 0\n")
        self.assertEqual(still[0]["flow[1]"], self.rows()[0]["flow[1]"])
        self.liggghts(f"{HEAD}{GRID}\n{THERMO}run 0\n")
        self.assertNotEqual(still[0]["flow[1]"], self.rows()[0]["flow[1]"])

    def test_the_porosity_is_renewed_every_n_steps_and_the_balance_holds(self):
        self.liggghts(f"{HEAD}{GRID} every 4\n{THERMO}run 12\n")
        rows = self.rows()
        # the setup takes no step: steps 1-4, 5-8 and 9-12 see one porosity each
        self.assertEqual([row["flow[5]"] for row in rows], [0] * 5 + [1] * 4 + [2] * 4)
        for row in rows:
            self.assertLess(abs(row["flow[3]"]), 1e-12)
            self.assertGreater(row["flow[6]"], 0.0)

    def test_continued_and_restarted_run_write_the_same_bytes(self):
        fix = f"{GRID} every 3\n"
        self.liggghts(f"{HEAD}{fix}run 7\nwrite_restart file.restart\n{THERMO}"
                      f"{dump('continued.dump')}run 7\n")
        continued = [row for row in self.rows() if "flow[6]" in row]
        self.liggghts(f"{restarted_head()}{fix}{THERMO}{dump('restarted.dump')}run 7\n")
        self.assertEqual(self.rows(), continued)
        self.assertEqual((self.folder / "continued.dump").read_bytes(),
                         (self.folder / "restarted.dump").read_bytes())

    def test_files_have_cells_in_the_place_of_pores(self):
        self.liggghts(f"{HEAD}{GRID} output 2 flow.pvd\nrun 4\n")
        collection = (self.folder / "flow.pvd").read_text()
        for step in (0, 2, 4):
            self.assertIn(f"flow_cells_{step}.vtu", collection)
            self.assertTrue((self.folder / f"flow_cells_{step}.vtu").exists())

    def test_what_it_refuses(self):
        fix = "fix flow all pfv " + FLOW + " "
        for words, parts in (("model darcy_grid 2 2", ["'model'", "missing"]),
                             ("model darcy_grid 2 0 2", ["'model'", "whole number"]),
                             ("model lattice", ["'model'", "pfv, darcy_grid"]),
                             ("model darcy_grid 1 1 1 drag stokes", ["drag law", "di_felice"]),
                             ("model darcy_grid 1 1 1 coupling staged", ["no staged coupling"]),
                             ("model darcy_grid 1 1 1 retriangulate 0.02", ["no retriang"]),
                             ("model darcy_grid 1 1 1 bulk_modulus 1e9", ["no bulk modulus"]),
                             ("model darcy_grid 1 1 1 shear_viscous yes", ["no shear viscous"]),
                             ("model darcy_grid 1 1 1 conductance open_throat", ["no conductance law"]),
                             ("model darcy_grid", ["cells", "NX NY NZ"])):
            with self.subTest(words=words):
                self.refused(HEAD + fix + words + "\n", *parts)
        self.refused(f"{HEAD}{GRID}\nfix_modify flow retriangulate 0.02\n", "no retriang")


if __name__ == "__main__":
    unittest.main()

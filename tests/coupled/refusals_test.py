# SPDX-License-Identifier: GPL-3.0-or-later
"""What fix pfv cannot do it refuses, with one line that says what is wrong."""
import unittest

from coupled import EDGE, FLOW, WATER, CoupledTest, faces, packing, write_data
from plates import square, write_plate

WALL = ("fix {0} all wall/gran model hooke/stiffness tangential history primitive type 1 {1}\n")


class Refusals(CoupledTest):
    def setUp(self):
        super().setUp()
        write_data(self.folder, packing(3))

    def refuse(self, flow, *parts, before="", after="run 0\n"):
        self.refused(f"include in.packing\n{before}fix flow all pfv {flow}\n{after}", *parts)

    def test_superquadrics(self):
        """By name; a LIGGGHTS that is built without them says so before the fix can."""
        script = ("units si\natom_style superquadric\natom_modify map array\nboundary f f f\nnewton off\n"
                  "communicate single vel yes\nregion b block 0 0.1 0 0.1 0 0.1 units box\ncreate_box 1 b\n"
                  f"fix flow all pfv {WATER}\n")
        done = self.launch(script)
        self.assertNotEqual(done.returncode, 0)
        self.assertRegex(done.stdout, "superquadric atoms have no pore network|Invalid atom style")

    # the command

    def test_unknown_keyword(self):
        self.refuse(FLOW + " colour blue", "unknown keyword 'colour'", "conductance", "behind a face no_slip, symmetry, sealed, pressure P",
                    after="")

    def test_a_keyword_that_is_nearly_right(self):
        self.refuse("viscocity 0.01 " + faces(), "unknown keyword 'viscocity'; is viscosity meant?", after="")
        self.refuse(FLOW, "knows no keyword 'presure'; is pressure meant?", after="fix_modify flow presure zlo 1\n")

    def test_one_wall_for_both_sides(self):
        wall = WALL.format("side", "xplane 0.1")
        both = "wall side"
        self.refuse("viscosity 0.01 " + faces(xlo=both, xhi=both), "along x its faces leave no room between them: xlo is at 0.1 m, "
                    "xhi at 0.1 m; give each the wall on its side", before=wall)

    def test_a_variable_that_is_not_there(self):
        self.refuse("viscosity 0.01 " + faces(zlo="plane 0 pressure v_p"), "there is no variable 'p' for v_p",
                    "`variable p equal")

    def test_an_extent_without_its_axis(self):
        self.refuse("viscosity 0.01 container face top extent pressure 0", "extent z hi", after="")

    def test_no_number(self):
        self.refuse("viscosity high " + faces(), "viscosity", "'high'", after="")

    def test_its_forces_are_removed(self):
        self.refuse(FLOW, "fix 'flow_prop', which has been removed", after="unfix flow_prop\nrun 0\n")

    def test_number_with_a_tail(self):
        self.refuse("viscosity 0.01Pa " + faces(), "viscosity", "'0.01Pa'", after="")

    def test_word_missing_at_the_end(self):
        self.refuse(FLOW + " density", "density", "missing", after="")

    def test_viscosity_not_positive(self):
        self.refuse("viscosity 0 " + faces(), "viscosity", after="")
        self.refuse("viscosity -1 " + faces(), "viscosity", after="")

    def test_viscosity_missing(self):
        self.refuse(faces(), "viscosity", "missing", after="")

    def test_faces_missing_are_named(self):
        self.refuse("viscosity 0.01 face xlo plane 0 face yhi extent", "face xhi, ylo, zlo, zhi",
                    after="")

    def test_face_given_twice(self):
        self.refuse(FLOW + " face zlo plane 0", "zlo", "twice", after="")

    def test_keyword_given_twice(self):
        for twice in ("viscosity 1", "density 900 density 1000", "coupling staged coupling staged",
                      "threads 1 threads 2", "output 1 a.pvd output 2 b.pvd",
                      "model pfv model darcy_grid 1 1 1"):
            with self.subTest(twice):
                self.refuse(FLOW + " " + twice, twice.split()[0], "twice", after="")
        self.refuse(FLOW + " model darcy_grid 1 1 1 every 2 every 3", "every", "twice", after="")
        profile = " pressure_profile zlo cosine x 0 1 0.1"
        self.refuse(FLOW + 2 * profile, "pressure_profile", "zlo", "twice", after="")

    def test_unknown_face(self):
        self.refuse("viscosity 0.01 face top plane 0", "top", after="")

    def test_face_without_a_source(self):
        self.refuse("viscosity 0.01 face zlo pressure 1", "plane X", after="")

    def test_two_boundaries_on_one_face(self):
        self.refuse(faces(zlo="sealed pressure 1") + " viscosity 1", "once", after="")

    def test_flux_and_profile_on_one_face(self):
        self.refuse("viscosity 0.01 " + faces(zlo="flux 1e-6", zhi="pressure 0") +
                    " pressure_profile zlo cosine x 0 1 0.1", "zlo", "flux", after="")

    def test_unknown_law_and_solver(self):
        self.refuse(FLOW + " conductance darcy", "darcy", "hydraulic_radius", after="")
        self.refuse(FLOW + " solver guess", "guess", "supernodal", after="")

    def test_strain_and_interval_not_positive(self):
        self.refuse(FLOW + " retriangulate 0", "strain", after="")
        self.refuse(FLOW + " rebuild_lag -1", "flow steps", ">= 0", after="")
        self.refuse(FLOW + " rebuild_lag 5 coupling implicit", "rebuild_lag", "staged", after="")
        self.refuse(FLOW + " rebuild_lag 5 coupling auto", "rebuild_lag", "staged", after="")
        self.refuse(FLOW + " rebuild_lag 5 model darcy_grid 1 1 1", "no rebuild lag", after="")
        self.refuse(WATER + " couple_every 0", "couple_every", "'0'", after="")

    def test_what_is_not_read_is_refused_at_its_default_too(self):
        self.refuse(FLOW + " tolerance 1e-10", "no tolerance", "cg", after="")
        self.refuse(FLOW + " solver cg precision double", "no choice of precision", "supernodal", after="")
        self.refuse(WATER + " couple_every auto coupling staged", "couple_every auto", "each step", after="")
        self.refuse(WATER + " couple_every auto rebuild_lag 5", "couple_every auto", "rebuild_lag", after="")

    def test_what_implicit_steps_have_not(self):
        self.refuse(FLOW + " coupling implicit solver cholmod", "cholmod", "solver supernodal", "staged", after="")
        self.refuse(FLOW + " volume_rates geometric coupling implicit", "volume_rates", "explicit", after="")

    def test_ordering(self):
        self.refuse(FLOW + " ordering random", "ordering", "'random'", "geometric, metis, amd", after="")
        self.refuse(FLOW + " solver klu2 ordering metis", "klu2", "metis", after="")

    def test_output_without_its_folder(self):
        self.refuse(FLOW + " output 10 nowhere/flow.pvd", "nowhere", after="")
        self.refuse(FLOW + " profile z 5 10 nowhere/p.csv", "nowhere", after="")

    def test_output_of_another_kind(self):
        self.refuse(FLOW + " output 10 flow.vtk", ".pvd", after="")

    def test_unknown_fix_modify_keyword(self):
        self.refuse(FLOW, "fix_modify", "'colour'", after="fix_modify flow colour blue\n")

    def test_fix_modify_to_bad_values(self):
        self.refuse(FLOW, "viscosity", after="fix_modify flow viscosity 0\n")
        self.refuse(FLOW, "'x'", after="fix_modify flow pressure zlo x\n")
        self.refuse(FLOW, "number of steps", after="fix_modify flow couple_every auto\n")

    # variables

    def test_variable_missing(self):
        self.refuse(FLOW.replace("pressure 10", "pressure v_p"), "no variable 'p'")

    def test_variable_of_another_style(self):
        self.refuse(FLOW.replace("pressure 10", "pressure v_p"), "'p'", "equal style",
                    before="variable p atom x\n")

    def test_variable_that_is_no_number(self):
        self.refuse(FLOW.replace("pressure 10", "pressure v_p"), "zlo", before=(
            "variable huge equal 1e200\nvariable p equal v_huge*v_huge\n"))

    # walls and meshes

    def test_wall_missing(self):
        self.refuse("viscosity 0.01 " + faces(zlo="wall floor"), "zlo", "no fix 'floor'")
        self.refuse("viscosity 0.01 " + faces(zlo="mesh floor"), "zlo", "no fix 'floor'")

    def test_wall_that_is_something_else(self):
        self.refuse("viscosity 0.01 " + faces(zlo="wall integr"), "zlo", "'integr'", "wall/gran")
        self.refuse("viscosity 0.01 " + faces(zlo="mesh integr"), "zlo", "'integr'", "mesh")

    def test_wall_normal_to_another_axis(self):
        self.refuse("viscosity 0.01 " + faces(zlo="wall side"), "zlo", "'side'", "z axis",
                    before=WALL.format("side", "xplane 0.0"))

    def test_cylinder(self):
        self.refuse("viscosity 0.01 " + faces(zlo="wall pipe"), "zlo", "'pipe'", "cylinder",
                    before=WALL.format("pipe", "zcylinder 0.2 0.05 0.05"))

    def test_mesh_wall_given_as_wall(self):
        write_plate(self.folder / "plate.stl", square(EDGE))
        self.refuse("viscosity 0.01 " + faces(zlo="wall floor"), "zlo", "'floor'", "mesh", before=(
            "fix plate all mesh/surface file plate.stl type 1\n"
            "fix floor all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 "
            "meshes plate\n"))

    def test_tilted_mesh(self):
        write_plate(self.folder / "plate.stl", square(EDGE, tilt=0.01))
        self.refuse("viscosity 0.01 " + faces(zlo="mesh plate"), "zlo", "'plate'", "z axis",
                    before="fix plate all mesh/surface file plate.stl type 1\n")

    def test_faces_in_the_wrong_order(self):
        self.refuse("viscosity 0.01 " + faces(zlo="plane 0.2 sealed"), "z")

    # the simulation

    def test_units(self):
        script = (f"units real\natom_style granular\nboundary f f f\nregion r block 0 1 0 1 0 1\n"
                  f"create_box 1 r\nfix flow all pfv {FLOW}\n")
        self.refused(script, "units real", "si, cgs, micro, nano")

    def test_atoms_without_a_radius(self):
        script = (f"units si\natom_style atomic\nboundary f f f\nregion r block 0 1 0 1 0 1\n"
                  f"create_box 1 r\nfix flow all pfv {FLOW}\n")
        self.refused(script, "atom_style granular")

    def test_periodic_box(self):
        script = (f"units si\natom_style granular\nboundary f p f\nregion r block 0 1 0 1 0 1\n"
                  f"create_box 1 r\nfix flow all pfv {FLOW}\n")
        self.refused(script, "periodic")

    def test_run_style(self):
        self.refuse(FLOW, "verlet", before="run_style respa 2 2 pair 1\n")

    def test_two_flows_on_the_same_grains(self):
        self.refuse(FLOW, "other", "'flow'", before=f"fix other all pfv {FLOW}\n")
        self.refuse(FLOW, "part", "'flow'", before=(
            f"region half block -1 1 -1 1 -1 0.05 units box\ngroup half region half\n"
            f"fix part half pfv {FLOW}\n"))

    def test_buoyancy_twice(self):
        self.refuse(FLOW, "fix buoyancy", "buoyancy no", before=(
            "fix g all gravity 9.81 vector 0 0 -1\n"
            "fix b all buoyancy density 1000 dim z level 0.2\n"))

    def test_gravity_that_changes_in_a_run(self):
        self.refuse(FLOW, "gravity", before=(
            "variable g equal 9.81*(1+step)\nfix g all gravity v_g vector 0 0 -1\n"),
            after="run 2\n")


if __name__ == "__main__":
    unittest.main()

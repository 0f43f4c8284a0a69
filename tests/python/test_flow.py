# SPDX-License-Identifier: GPL-3.0-or-later
"""pfv.Flow gives the numbers of the command, to the last digit."""
import json
import unittest

import numpy as np
import pfv
from case import DATA, UNIT, VISCOSITY, CommandCase, grains, rotation, through_flow, without_times

FALL = ["--face", "zlo:pressure=1", "--face", "zhi:pressure=0"]


class SameAsTheCommand(CommandCase):
    def assert_same(self, flow, report, forces):
        self.assertEqual(without_times(flow.report()), without_times(report))
        found = np.hstack([flow.forces, flow.pressure_forces, flow.viscous_forces])
        np.testing.assert_array_equal(found, forces[:, 1:])

    def test_steady_flow_forces_report_and_fields(self):
        bed = grains("packing_500.csv")
        report, forces = self.solve(DATA / "packing_500.csv", *FALL, "--vtk", "command.vtu")
        flow = pfv.Flow(through_flow(), pfv.Fluid(viscosity=VISCOSITY), split_forces=True)
        flow.evaluate(bed.positions, bed.radii, ids=bed.ids)
        self.assert_same(flow, report, forces)
        flow.write_fields(self.folder / "module.vtu")
        for end in (".vtu", "_walls.vtu"):
            self.assertEqual((self.folder / f"module{end}").read_bytes(), (self.folder / f"command{end}").read_bytes())

    def test_moving_grains_gravity_patch_well_and_piston(self):
        bed = grains()
        velocities = rotation(bed.positions)
        path = self.folder / "moving.csv"
        rows = np.column_stack([bed.ids, bed.positions, bed.radii, velocities])
        path.write_text("id,x,y,z,radius,vx,vy,vz\n" + "".join(
            ",".join([str(int(row[0])), *map(repr, row[1:].tolist())]) + "\n" for row in rows))
        report, forces = self.solve(
            path, "--gravity", "0", "0", "-9.81", "--face", "zlo:pressure=3,velocity=0.01", "--face",
            "xlo:wall=symmetry", "--patch", "yhi:0.2,0.6,0.1,0.7:pressure=0", "--point", "0.5,0.5,0.5:flux=1e-3")
        box = pfv.Box(UNIT).face("zlo", pressure=3, velocity=0.01).face("xlo", wall="symmetry")
        box.patch("yhi", [[0.2, 0.6], [0.1, 0.7]], pressure=0).region([0.5] * 3, [0.5] * 3, flux=1e-3)
        flow = pfv.Flow(box, viscosity=VISCOSITY, gravity=[0, 0, -9.81], split_forces=True)
        flow.evaluate(bed.positions, bed.radii, velocities, ids=bed.ids)
        self.assert_same(flow, report, forces)

    def test_compressible_fluid_and_the_darcy_grid(self):
        bed = grains()
        report, forces = self.solve(DATA / "packing_100.csv", *FALL, "--bulk-modulus", "1e4", "--time-step", "1e-4")
        flow = pfv.Flow(through_flow(), pfv.Fluid(viscosity=VISCOSITY, bulk_modulus=1e4), split_forces=True)
        flow.evaluate(bed.positions, bed.radii, dt=1e-4)
        self.assert_same(flow, report, forces)
        report, forces = self.solve(DATA / "packing_100.csv", *FALL, "--model", "darcy_grid", "--cells", "2", "2", "3")
        flow = pfv.Flow(through_flow(), viscosity=VISCOSITY, model="darcy_grid", cells=(2, 2, 3), split_forces=True)
        flow.evaluate(bed.positions, bed.radii)
        self.assert_same(flow, report, forces)

    def test_the_report_as_a_file(self):
        bed = grains()
        flow = pfv.Flow(through_flow())
        flow.evaluate(bed.positions, bed.radii)
        flow.write_report(self.folder / "module.json")
        self.assertEqual(without_times(json.loads((self.folder / "module.json").read_text())),
                         without_times(flow.report()))


class Answers(unittest.TestCase):
    """What the flow says of its last step is consistent."""

    @classmethod
    def setUpClass(cls):
        cls.bed = grains("packing_500.csv")
        cls.flow = pfv.Flow(through_flow(wall="symmetry"), viscosity=VISCOSITY, sphere_pressure=True)
        cls.flow.evaluate(cls.bed.positions, cls.bed.radii)

    def test_network_arrays_have_a_row_for_each(self):
        network, flow = self.flow.network(), self.flow
        self.assertEqual(network.cell_vertices.shape, (network.cells, 4))
        self.assertEqual(network.pore_centres.shape, (network.pores, 3))
        self.assertEqual(network.throat_pores.shape, (network.throats, 2))
        for array in (flow.pressures, flow.pore_volumes()):
            self.assertEqual(array.shape, (network.pores,))
        for array in (flow.throat_conductances(), flow.throat_fluxes()):
            self.assertEqual(array.shape, (network.throats,))
        self.assertEqual(network.walls, ["xlo", "xhi", "ylo", "yhi", "zlo", "zhi"])
        self.assertTrue(-len(network.walls) <= network.cell_vertices.min() < 0)
        self.assertLess(network.cell_vertices.max(), len(self.bed))

    def test_throat_fluxes_are_conductance_times_fall_of_pressure(self):
        first, second = self.flow.network().throat_pores.T
        fall = self.flow.pressures[first] - self.flow.pressures[second]
        expected = self.flow.throat_conductances() * fall
        np.testing.assert_allclose(self.flow.throat_fluxes(), expected, rtol=0, atol=1e-15)

    def test_centres_are_places_in_the_box(self):
        bed = grains()
        shift = np.array([3.0, -2.0, 10.0])
        flow = pfv.Flow(pfv.Box(np.add(UNIT, shift[:, None])).face("zlo", pressure=0))
        flow.evaluate(bed.positions + shift, bed.radii)
        centres = flow.network().pore_centres
        np.testing.assert_allclose(centres.mean(axis=0), shift + 0.5, atol=0.1)

    def test_pressures_at_places_planes_and_on_average(self):
        flow = self.flow
        places = np.array([[0.5, 0.5, 0.2], [0.5, 0.5, 0.8]])
        low, high = flow.pressure_at(places)
        self.assertEqual(low, flow.pressure_at(places[0]))
        self.assertGreater(low, high)
        self.assertEqual(flow.plane_pressure("z", 0.5), flow.plane_pressure(2, 0.5))
        self.assertAlmostEqual(flow.mean_pressure(), 0.5, delta=0.05)
        np.testing.assert_allclose(flow.sphere_pressures, 1 - self.bed.positions[:, 2], atol=0.2)

    def test_what_enters_flows_through_every_plane(self):
        faces = self.flow.faces()
        through = self.flow.plane_flux("z", 0.4)
        self.assertAlmostEqual(faces["zlo"]["flux"], through, delta=1e-12 * through)
        self.assertAlmostEqual(faces["zhi"]["flux"], -through, delta=1e-12 * through)
        self.assertGreater(self.flow.slice_means("z", 0.3, 0.6)["velocity"][2], 0)

    def test_forces_on_spheres_and_faces_add_up_to_nothing(self):
        total = self.flow.forces.sum(axis=0) + sum(self.flow.face_forces().values())
        np.testing.assert_allclose(total, 0, atol=1e-12)

    def test_velocities_stresses_and_drag_have_a_row_for_each_sphere(self):
        count = len(self.bed)
        self.assertEqual(self.flow.sphere_velocities().shape, (count, 3))
        self.assertEqual(self.flow.sphere_stresses().shape, (count, 6))
        fields = self.flow.sphere_fields()
        np.testing.assert_array_equal(fields["fluid_velocity"], self.flow.sphere_velocities())
        np.testing.assert_array_equal(fields["fluid_stress"], self.flow.sphere_stresses()[:, [0, 1, 2, 3, 5, 4]])
        self.assertEqual(self.flow.pore_velocities().shape, (self.flow.network().pores, 3))
        drag = self.flow.viscosity_matrices([3, 7])
        np.testing.assert_allclose(drag, drag.transpose(0, 2, 1), rtol=1e-9)
        self.assertTrue((np.linalg.eigvalsh(drag) > 0).all())

    def test_stresses_of_contacts_and_of_motion(self):
        """A sphere between two plates; and spheres of one velocity, which have no stress but in another frame."""
        radius, force = 0.5, np.array([[0.0, 0.3, 4.0], [0.0, -0.3, -4.0]])
        points = np.array([[1.0, 2.0, 2.5], [1.0, 2.0, 3.5]])
        stress = pfv.contact_stresses([[1.0, 2.0, 3.0], [5.0, 5.0, 5.0]], [radius, radius], [0, 0], points, force)
        volume = np.pi / 6
        np.testing.assert_allclose(stress[0], np.array([0, 0, -4.0, 0, 0, -0.15]) / volume, atol=1e-14)
        np.testing.assert_array_equal(stress[1], np.zeros(6))
        with self.assertRaises(pfv.InputError):
            pfv.contact_stresses([[1.0, 2.0, 3.0]], [radius], [1, 0], points, force)
        places, moving, masses = np.zeros((2, 3)), np.tile([2.0, 0.0, -1.0], (2, 1)), [1.0, 3.0]
        np.testing.assert_array_equal(pfv.inertial_stresses(places, [radius] * 2, moving, masses), np.zeros((2, 6)))
        found = pfv.inertial_stresses(places, [radius] * 2, moving, masses, frame=[0, 0, 0])
        np.testing.assert_allclose(found[1], -3.0 / volume * np.array([4.0, 0, 1.0, 0, -2.0, 0]), rtol=1e-14)

    def test_strains_of_an_affine_motion(self):
        stretch = np.array([[-0.1, 0.02, 0], [0, 0.05, 0.04], [0.06, 0, -0.2]])
        now = self.bed.positions
        strains = self.flow.sphere_strains(now, now @ np.linalg.inv(np.eye(3) + stretch).T)
        exact = (stretch + stretch.T) / 2
        np.testing.assert_allclose(strains, np.tile(exact[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]], (len(now), 1)), atol=1e-12)
        with self.assertRaisesRegex(pfv.InputError, "one for each sphere"):
            self.flow.sphere_strains(now, now[1:])

    def test_fields_hold_the_pressures(self):
        fields = self.flow.fields()
        pores = self.flow.network().pores
        pressures = {**fields["of_points"], **fields["of_cells"]}["pressure"]
        np.testing.assert_array_equal(pressures[:pores], self.flow.pressures)
        self.assertEqual(fields["points"].shape[1], 3)
        self.assertEqual(len(fields["types"]), len(fields["ends"]))


class AgainstFiniteElements(unittest.TestCase):
    def test_pressures_at_points(self):
        """Of 25 spheres (doc/pore_scale.md): rms differences, parts of the fall; 0.127 for a straight one."""
        found = np.genfromtxt(DATA / "stokes_bed_25_points.csv", delimiter=",", names=True)
        places, bed = np.column_stack([found[k] for k in "xyz"]), grains("bed_25.csv")
        for law, limit in (("hydraulic_radius", 0.065), ("open_throat", 0.054)):
            flow = pfv.Flow(through_flow(wall="symmetry"), pfv.Fluid(viscosity=1.0), conductance=law)
            flow.evaluate(bed.positions, bed.radii)
            self.assertLess(np.sqrt(((flow.pressure_at(places) - found["pressure"])**2).mean()), limit)


if __name__ == "__main__":
    unittest.main()

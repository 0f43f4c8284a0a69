# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of moving grains: couplings, pistons, changes of the box, restarts."""
import pickle
import unittest

import numpy as np
import pfv
from case import UNIT, grains, rotation, through_flow

DT = 1e-4


class Steps(unittest.TestCase):
    def setUp(self):
        bed = grains()
        self.positions, self.radii = np.array(bed.positions), np.array(bed.radii)
        self.velocities = rotation(self.positions)
        self.masses = 2600 * 4 / 3 * np.pi * self.radii**3

    def drained(self, **settings):
        return pfv.Flow(pfv.Box(UNIT).face("zhi", pressure=0.0), viscosity=100.0, **settings)

    def test_time_advances_with_committed_steps_alone(self):
        flow = self.drained()
        flow.evaluate(self.positions, self.radii, self.velocities)
        flow.advance(self.positions, self.radii, self.velocities, DT, commit=False)
        self.assertEqual(flow.time, 0)
        flow.advance(self.positions, self.radii, self.velocities, DT)
        flow.advance(self.positions, self.radii, self.velocities, dt=DT)
        self.assertEqual(flow.time, 2 * DT)

    def test_a_time_step_must_be_given(self):
        with self.assertRaises(TypeError):
            self.drained().advance(self.positions, self.radii, self.velocities)

    def test_couplings_agree_far_below_the_limit_and_differ_above(self):
        flow = self.drained()
        flow.evaluate(self.positions, self.radii)
        limit = flow.time_step_limit(self.masses)
        forces = {}
        for coupling in ("explicit", "staged", "implicit"):
            for dt in (1e-4 * limit, 50 * limit):
                flow = self.drained(coupling=coupling)
                forces[coupling, dt] = flow.advance(self.positions, self.radii, self.velocities, dt, masses=self.masses)
                self.assertEqual(flow.coupling, coupling)
        for coupling in ("staged", "implicit"):
            explicit = forces["explicit", 1e-4 * limit]
            np.testing.assert_allclose(forces[coupling, 1e-4 * limit], explicit, atol=1e-2 * abs(explicit).max())
            self.assertLess(abs(forces[coupling, 50 * limit]).max(), 0.5 * abs(explicit).max())

    def test_the_call_may_choose_the_coupling(self):
        flow = self.drained()
        flow.advance(self.positions, self.radii, self.velocities, DT, "implicit", masses=self.masses,
                     other_forces=np.zeros((100, 3)))
        self.assertEqual(flow.coupling, "implicit")
        with self.assertRaisesRegex(pfv.InputError, "give masses"):
            flow.advance(self.positions, self.radii, self.velocities, DT, coupling="staged")
        with self.assertRaisesRegex(pfv.InputError, "auto"):
            flow.advance(self.positions, self.radii, self.velocities, DT, coupling="semi")
        with self.assertRaisesRegex(pfv.InputError, "other_forces.*100 spheres"):
            flow.advance(self.positions, self.radii, self.velocities, DT, "staged", masses=self.masses,
                         other_forces=np.zeros((99, 3)))

    def test_a_light_piston_lowers_the_limit(self):
        flow = pfv.Flow(pfv.Box(UNIT).face("zlo", pressure=0.0), viscosity=100.0)
        flow.evaluate(self.positions, self.radii)
        held = flow.time_step_limit(self.masses)
        self.assertLess(flow.time_step_limit(self.masses, {"zhi": 1e-3}), held)
        self.assertEqual(flow.time_step_limit(self.masses, {"zhi": np.inf}), held)
        forces = [flow.advance(self.positions, self.radii, self.velocities, 100 * held, "implicit",
                               masses=self.masses, pistons={"zhi": (1.0, load)}) for load in (0.0, -1e3)]
        self.assertGreater(abs(forces[1] - forces[0]).max(), 1.0)
        with self.assertRaisesRegex(pfv.InputError, "there is no face 'top'"):
            flow.time_step_limit(self.masses, {"top": 1.0})
        with self.assertRaises(TypeError):
            flow.time_step_limit(self.masses, {"zhi": "heavy"})

    def test_torques_and_spins(self):
        flow = self.drained(torques=True)
        flow.evaluate(self.positions, self.radii, 0 * self.velocities)
        np.testing.assert_array_equal(flow.torques, 0)
        flow.evaluate(self.positions, self.radii, 0 * self.velocities, angular_velocities=np.ones((100, 3)))
        self.assertGreater(abs(flow.torques).max(), 0)

    def test_a_box_is_changed_by_handing_it_over(self):
        flow = pfv.Flow(through_flow())
        once = np.array(flow.evaluate(self.positions, self.radii))
        box = flow.box.face("zlo", pressure=2.0)
        np.testing.assert_array_equal(flow.evaluate(self.positions, self.radii), once)
        flow.set_box(box)
        np.testing.assert_allclose(flow.evaluate(self.positions, self.radii), 2 * once, atol=1e-12)
        self.assertEqual(flow.report()["counts"]["triangulate"], 1)
        flow.rebuild()
        flow.evaluate(self.positions, self.radii)
        self.assertEqual(flow.report()["counts"]["triangulate"], 2)

    def test_a_flow_goes_on_from_a_stored_state(self):
        def make():
            return self.drained(bulk_modulus=1e5)
        flow = make()
        for _ in range(3):
            flow.advance(self.positions, self.radii, self.velocities, DT)
        state = pickle.loads(pickle.dumps(flow.state()))
        self.assertEqual(state["time"], 3 * DT)
        again = make()
        again.restore(state)
        for _ in range(2):
            np.testing.assert_array_equal(again.advance(self.positions, self.radii, self.velocities, DT),
                                          flow.advance(self.positions, self.radii, self.velocities, DT))
        self.assertEqual(again.time, flow.time)

    def test_a_network_that_is_built_in_the_background(self):
        flow = self.drained(rebuild_lag=3, retriangulate=1e-4)
        positions = self.positions
        for _ in range(20):
            positions = positions + 1e-3 * self.velocities
            flow.advance(positions, self.radii, self.velocities, 1e-3)
        self.assertGreater(flow.report()["counts"]["background"], 0)
        self.assertEqual(flow.retriangulations, flow.report()["counts"]["triangulate"] - 1)

    def test_a_pressure_that_is_a_function_of_place_and_time(self):
        def wave(place, time):
            return 5.0 * place[0] + time
        flow = pfv.Flow(pfv.Box(UNIT).face("zhi", pressure=wave))
        flow.advance(self.positions, self.radii, dt=0.25)
        self.assertAlmostEqual(flow.pressure_at([0.5, 0.5, 0.99]), 2.75, delta=1)
        flow.set_box(pfv.Box(UNIT).face("zhi", pressure=lambda place, time: 1 / 0))
        with self.assertRaises(ZeroDivisionError):
            flow.advance(self.positions, self.radii, dt=0.25)
        for pressure in (float("nan"), "high", None):
            flow.set_box(pfv.Box(UNIT).face("zhi", pressure=lambda place, time: pressure))
            with self.assertRaises((pfv.InputError, TypeError)):
                flow.advance(self.positions, self.radii, dt=0.25)

    def test_grains_outside_may_be_left_out(self):
        self.positions[4] = [0.5, 0.5, 3.0]
        flow = pfv.Flow(through_flow(), outside="leave_out")
        forces = flow.evaluate(self.positions, self.radii)
        np.testing.assert_array_equal(forces[4], 0)
        self.assertEqual(flow.hidden_or_outside, 1)
        self.assertEqual(len(flow.hidden), 0)


class RigidBodies(unittest.TestCase):
    """Pairs of spheres that overlap, of the grains of a bed with every other one beside its neighbour."""

    def setUp(self):
        bed = grains()
        centres, radii = np.array(bed.positions)[:40], np.array(bed.radii)[:40]
        away = np.array([[0, 0, 0.5]]) * radii[:, None]
        self.positions = np.stack([centres - away / 2, centres + away / 2], axis=1).reshape(-1, 3)
        self.radii = np.repeat(0.6 * radii, 2)
        self.held = np.repeat(np.arange(40), 2)
        self.velocities = 1e-3 * rotation(np.repeat(centres, 2, axis=0))
        mass = 2600 * 4 / 3 * np.pi * (0.6 * radii)**3
        self.masses = np.repeat(mass, 2)
        self.rigid = [pfv.RigidBody([-one / 2, one / 2], masses=m, inertias=np.full(3, m * 0.1 * r**2))
                      for one, m, r in zip(away, mass, radii)]

    def flow(self, **settings):
        return pfv.Flow(pfv.Box(UNIT).face("zhi", pressure=0.0), viscosity=100.0, **settings)

    def test_their_spheres_move_together_in_long_steps(self):
        """Far above the limit drag nearly stops a body, as it does a grain: m v / dt is what it takes."""
        flow = self.flow()
        flow.evaluate(self.positions, self.radii, bodies=self.held)
        limit = flow.time_step_limit(self.masses, rigid_bodies=self.rigid)
        self.assertLess(abs(limit / flow.time_step_limit(self.masses, None, self.rigid) - 1), 1e-12)
        for coupling in ("staged", "implicit"):
            dt = 100 * limit
            forces = self.flow().advance(self.positions, self.radii, self.velocities, dt, coupling, masses=self.masses,
                                         bodies=self.held, rigid_bodies=self.rigid)
            on_bodies = np.add.reduceat(forces, range(0, 80, 2))
            stop = -np.array([one.masses[0] for one in self.rigid])[:, None] * self.velocities[::2] / dt
            self.assertLess(abs(on_bodies).max(), 3 * abs(stop).max())
            self.assertGreater(abs(on_bodies).max(), 0.3 * abs(stop).max())

    def test_pores_within_a_body_are_no_fluid(self):
        """Four spheres that close a pore between them: as grains that approach they press its fluid."""
        corners = 0.6 * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
        radii = np.repeat(0.35 * self.radii[::2], 4)
        positions = (self.positions[::2, None, :] + corners * radii[::4, None, None]).reshape(-1, 3)
        velocities = rotation(positions)
        for bodies in (None, np.full(160, -1)):
            with self.assertRaisesRegex(pfv.InputError, "cut off"):
                self.flow().evaluate(positions, radii, velocities, bodies=bodies)
        flow = self.flow()
        flow.evaluate(positions, radii, velocities, bodies=np.repeat(np.arange(40), 4))
        self.assertLess(abs(flow.report()["mass_error"]), 1e-9)

    def test_a_body_that_is_held_takes_no_part(self):
        flow = self.flow()
        flow.evaluate(self.positions, self.radii, bodies=self.held)
        fixed = [pfv.RigidBody(one.arms, masses=np.inf, inertias=np.full(3, np.inf)) for one in self.rigid]
        self.assertEqual(flow.time_step_limit(self.masses, rigid_bodies=fixed), np.inf)

    def test_what_does_not_fit_is_refused(self):
        call = {"masses": self.masses, "bodies": self.held}
        one = self.rigid[0]
        wrong = [pfv.RigidBody(one.arms[:1], masses=one.masses, inertias=one.inertias),
                 pfv.RigidBody(one.arms, masses=-1.0, inertias=one.inertias),
                 pfv.RigidBody(one.arms, masses=1.0, inertias=one.inertias, axes=2 * np.eye(3))]
        for bodies, part in [(self.rigid[:-1], "39 bodies"), *zip(([each, *self.rigid[1:]] for each in wrong),
                                                                 ("1 arms for 2", "mass or inertia", "axes"))]:
            with self.assertRaisesRegex(pfv.InputError, part):
                self.flow().advance(self.positions, self.radii, self.velocities, DT, "staged", rigid_bodies=bodies,
                                    **call)
        for bodies in (np.full(80, 80), np.full(80, -2), self.held[:-1]):
            with self.assertRaisesRegex(pfv.InputError, "bodies"):
                self.flow().evaluate(self.positions, self.radii, bodies=bodies)
        with self.assertRaisesRegex(TypeError, "bodies"):
            self.flow().evaluate(self.positions, self.radii, bodies=np.full(80, 0.5))


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies (fix multisphere, fix rigid) in every coupling: forces, torques, long steps, rest, ranks, restart."""
import math
import unittest

from coupled import CoupledTest, read_dump, read_thermo

R = 0.01
VOLUME = 2 * 4 / 3 * math.pi * R**3 - 2 * math.pi * (R / 2)**2 * (3 * R - R / 2) / 3  # of the union of a pair, m3
INERTIA = (2.8e-7, 4.0e-7, 4.0e-7)  # kg m2, as the template is told
HEAD = """units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
{start}
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep {step}
"""
CREATE = """region all block -0.05 0.15 -0.05 0.15 -0.05 0.15 units box
create_box 1 all"""
INSERT = """region place block 0.03 0.07 0.03 0.07 0.03 0.07 units box
fix shape all particletemplate/multisphere 15485863 atom_type 1 density constant 1000 &
    nspheres 2 ntry 10000 spheres file body.txt scale 1.0 mass {mass!r} &
    inertia_tensor 2.8e-7 0 0 4.0e-7 0 4.0e-7 use_density type 1
fix sizes all particledistribution/discrete 15485867 1 shape 1.0
fix drop all insert/pack seed 32452843 distributiontemplate sizes maxattempt 100 &
    insert_every once overlapcheck yes orientation random vel constant 0. 0. {speed} region place &
    particles_in_region 1 ntry_mc 10000
"""
CLOSE = ("face xlo plane 0.02 face xhi plane 0.09 face ylo plane 0.02 face yhi plane 0.09 "
         "face zlo plane 0.02 face zhi plane 0.09 pressure 0")
WIDE = " ".join(f"face {a}{end} plane {0.1 * (end == 'hi')} symmetry" for a in "xyz" for end in ("lo", "hi")) + " pressure 0"
GRAVITY = "fix weight all gravity 10.0 vector 0 0 -1\n"
DUMP = ("dump d all custom 1 d.dump id x y z radius vx vy vz omegax omegay omegaz f_flow[1] f_flow[2] "
        "f_flow[3] f_flow[5] f_flow[6] f_flow[7]\ndump_modify d sort id format \"%d" + " %.17g" * 16 + "\"\n")


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Pair:
    """One frame of a dump of a single pair: motion of its centre, force and moment of the fluid about it."""

    def __init__(self, rows):
        first, second = rows[1], rows[2]
        self.axis = [(b - a) / R for a, b in zip(first[:3], second[:3])]
        self.velocity = [(a + b) / 2 for a, b in zip(first[4:7], second[4:7])]
        self.spin = first[7:10]
        self.force = [a + b for a, b in zip(first[10:13], second[10:13])]
        couple = cross([0.5 * R * x for x in self.axis], [b - a for a, b in zip(first[10:13], second[10:13])])
        self.moment = [a + b + c for a, b, c in zip(couple, first[13:16], second[13:16])]
        self.own_moments = [a + b for a, b in zip(first[13:16], second[13:16])]


class Bodies(CoupledTest):
    def head(self, speed=0.0, step=1e-5, mass=1000 * VOLUME, mover="fix move all multisphere\n", flow=""):
        (self.folder / "body.txt").write_text("-0.005 0 0 0.01\n0.005 0 0 0.01\n")
        head = HEAD.format(start=CREATE, step=step) + INSERT.format(mass=mass, speed=speed)
        return head + flow + mover + "run 1\n"

    def pairs(self):
        return {step: Pair(rows) for step, rows in read_dump(self.folder / "d.dump").items()}

    # rest

    def test_one_as_dense_as_the_fluid_stays(self):
        for coupling in ("explicit", "staged", "implicit"):
            for shear in ("no", "yes"):
                with self.subTest(coupling=coupling, shear=shear):
                    script = self.head() + GRAVITY + (
                        f"fix flow all pfv viscosity 1e-3 density 1000 {WIDE} coupling {coupling} shear_viscous {shear}\n")
                    self.liggghts(script + DUMP + "run 200\n")
                    last = self.pairs()[201]
                    fall = 10.0 * 200e-5
                    self.assertLess(max(map(abs, last.velocity)), 1e-12 * fall)
                    self.assertLess(R * max(map(abs, last.spin)), 1e-12 * fall)

    # what the body gets

    def test_force_and_torque_arrive(self):
        """Two steps of the body against what the fix shows of force, torque and spheres' own torques."""
        step = 1e-5
        script = self.head(speed=1e-3, step=step) + (
            f"fix flow all pfv viscosity 200 {CLOSE}\n") + DUMP + "run 40\n"
        self.liggghts(script)
        frames = self.pairs()
        self.assertGreater(max(map(abs, frames[20].own_moments)), 1e-3 * max(map(abs, frames[20].moment)))
        for n in range(10, 30):
            now, next_one = frames[n], frames[n + 1]
            mean = [(a + b) / 2 for a, b in zip(now.force, next_one.force)]
            gained = [(b - a) * 1000 * VOLUME / step for a, b in zip(now.velocity, next_one.velocity)]
            self.assertLess(math.dist(mean, gained), 1e-6 * math.hypot(*mean))
            torque = [(a + b) / 2 for a, b in zip(now.moment, next_one.moment)]
            turned = [(b - a) / step for a, b in zip(now.spin, next_one.spin)]
            axis = now.axis
            along = dot(turned, axis)
            angular = [INERTIA[1] * (t - along * x) + INERTIA[0] * along * x for t, x in zip(turned, axis)]
            self.assertLess(math.dist(torque, angular), 1e-3 * math.hypot(*torque))

    # long steps

    def slowed(self, coupling, step, shear="no", mover="fix move all multisphere\n", ranks=1, viscosity=500, more=""):
        """A pair that the fluid brakes, 2e-4 s after it had 1 mm/s, under its weight."""
        steps = round(2e-4 / step)
        script = self.head(speed=1e-3, step=step, mover=mover) + GRAVITY.replace("10.0", "0.5") + (
            f"fix flow all pfv viscosity {viscosity} density 100 {CLOSE} coupling {coupling} shear_viscous {shear}\n") + more
        screen = self.liggghts(script + DUMP + f"run {steps}\n", ranks=ranks)
        return self.pairs()[steps + 1], screen

    def test_long_steps_follow_short_ones(self):
        for shear in ("no", "yes"):
            exact = self.slowed("explicit", 1e-6, shear)[0]
            speed = math.hypot(*exact.velocity)
            for coupling in ("staged", "implicit", "auto"):
                with self.subTest(coupling=coupling, shear=shear):
                    found, screen = self.slowed(coupling, 5e-5, shear, viscosity=500)
                    self.assertLess(math.dist(found.velocity, exact.velocity), 0.25 * speed)
                    near, _ = self.slowed(coupling, 1e-5, shear)
                    self.assertLess(math.dist(near.velocity, exact.velocity), 0.06 * speed)

    def test_a_hundred_limits_in_a_step(self):
        limit = float(self.slowed("explicit", 1e-6, viscosity=500)[1].split("limit of the explicit coupling")[1].split()[0])
        for coupling in ("staged", "implicit"):
            for shear in ("no", "yes"):
                with self.subTest(coupling=coupling, shear=shear):
                    found, screen = self.slowed(coupling, 1e-5, shear, viscosity=500 * 100 * limit / 1e-5)
                    self.assertGreater(float(screen.split("ratio")[1].split(",")[0]), 90)
                    # what is left sinks with its weight, some 1e-7 m/s
                    self.assertLess(math.hypot(*found.velocity), 2e-6)

    def test_two_ranks_are_one(self):
        for coupling in ("explicit", "staged", "implicit"):
            with self.subTest(coupling=coupling):
                one = self.slowed(coupling, 1e-6 if coupling == "explicit" else 1e-5)[0]
                two = self.slowed(coupling, 1e-6 if coupling == "explicit" else 1e-5, ranks=2,
                                  more="")[0]
                # LIGGGHTS inserts the body elsewhere on two ranks: what both feel along the shared axis is alike
                self.assertTrue(all(map(math.isfinite, two.velocity)))
                self.assertLess(math.hypot(*two.velocity), 1e-3)
                self.assertLess(math.hypot(*one.velocity), 1e-3)


if __name__ == "__main__":
    unittest.main()

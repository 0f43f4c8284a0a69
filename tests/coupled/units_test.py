# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts in other units than SI: all numbers of a script and of what it writes are in its own, and the flow is the same."""
import math
import unittest

from coupled import CoupledTest, largest_difference, packing, random_velocities, read_dump, read_thermo
from plates import square, write_mesh, quad

# how many of the script's units make a metre, a kilogram and a second
UNITS = {"si": (1.0, 1.0, 1.0), "cgs": (1e2, 1e3, 1.0), "micro": (1e6, 1e15, 1e6), "nano": (1e9, 1e21, 1e9)}
EDGE = 0.1
STEP = 1e-5
ROUND_OFF = 1e-9  # of what a quantity has at most: round-off of places and of LIGGGHTS' contacts grows with the steps


class Scale:
    """Numbers in SI -> words in a script's units; what it writes -> SI."""

    def __init__(self, style):
        self.style = style
        length, mass, time = UNITS[style]
        force = mass * length / time ** 2
        self.factors = {"m": length, "kg": mass, "s": time, "m/s": length / time, "m/s2": length / time ** 2, "1/s": 1 / time,
                        "N": force, "N/m": force / length, "N m": force * length, "N s/m": force * time / length,
                        "kg/s": mass / time, "Pa": force / length ** 2, "Pa s": force * time / length ** 2,
                        "Pa/m": force / length ** 3, "kg/m3": mass / length ** 3, "m3/s": length ** 3 / time,
                        "m2": length ** 2, "": 1.0}

    def __call__(self, value, unit):
        return repr(value * self.factors[unit])

    def si(self, value, unit):
        return value / self.factors[unit]


def head(u, source="read_data packing.data"):
    stiffness = "\n".join(f"fix {name} all property/global {what} peratomtypepair 1 {value}" for name, what, value in (
        ("m1", "kn", u(1e4, "N/m")), ("m2", "kt", u(5e3, "N/m")), ("m3", "gamman", u(500.0, "1/s")),
        ("m4", "gammat", u(250.0, "1/s")), ("m5", "coefficientFriction", "0.5")))
    begin = "" if "restart" in source else f"units {u.style}\nboundary f f f\natom_style granular\n"
    return (f"{begin}atom_modify map array\nnewton off\ncommunicate single vel yes\n{source}\n"
            f"neighbor {u(0.002, 'm')} bin\nneigh_modify delay 0\n{stiffness}\n"
            "pair_style gran model hooke/stiffness tangential history\npair_coeff * *\n"
            f"timestep {u(STEP, 's')}\nfix integr all nve/sphere\n"
            f"fix gr all gravity {u(9.81, 'm/s2')} vector 0 0.6 -0.8\n")


def scene(u):
    """A piston under a servo, a wall that moves along its normal, a pressure from a variable, buoyancy by default."""
    piston = 0.5  # kg
    load, fastest = 30.0, 10.0
    return (f"variable p equal {u(20.0, 'Pa')}*(1+0.02*step)\n"
            f"fix lid all mesh/surface/stress/servo file lid.stl type 1 com {u(0.05, 'm')} {u(0.05, 'm')} {u(EDGE, 'm')} "
            f"ctrlPV force axis 0. 0. -1. target_val {u(load, 'N')} vel_max {u(fastest, 'm/s')} kp 0. "
            f"ki {u(load / (fastest * piston), '1/s')}\n"
            "fix side all mesh/surface file side.stl type 1\n"
            f"fix push all move/mesh mesh side linear {u(0.02, 'm/s')} 0. 0.\n"
            "fix walls all wall/gran model hooke/stiffness tangential history mesh n_meshes 2 meshes lid side\n"
            f"fix flow all pfv viscosity {u(1.0, 'Pa s')} bulk_modulus {u(1e6, 'Pa')} torques yes shear_viscous yes "
            f"couple_every 1 retriangulate 1e-3 face xlo mesh side face xhi plane {u(EDGE, 'm')} "
            f"face ylo plane 0 symmetry face yhi plane {u(EDGE, 'm')} flux {u(1e-6, 'm3/s')} "
            f"face zlo plane 0 pressure v_p face zhi mesh lid "
            f"point {u(0.05, 'm')} {u(0.05, 'm')} {u(0.05, 'm')} pressure {u(5.0, 'Pa')} "
            f"sensors 10 sensors.csv {u(0.03, 'm')} {u(0.03, 'm')} {u(0.03, 'm')} profile z 4 10 profile.csv "
            "flux_profile z 4 10 flux.csv history 10 history.csv output 40 fields.pvd\n"
            "thermo_style custom step f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[5] f_flow[6] f_flow[7] f_lid[3] f_lid[12]\n"
            "thermo 10\nthermo_modify norm no lost ignore format float %.15g\n")


COLUMNS = {"f_flow": "", "flow[1]": "m3/s", "flow[2]": "m3/s", "flow[6]": "s", "flow[7]": "Pa", "lid[3]": "N", "lid[12]": "m"}
DUMP = ["m"] * 4 + ["m/s"] * 3 + ["N"] * 3 + ["Pa"] + ["1/s"] * 3 + ["N m"] * 3


def between_planes(u):
    planes = " ".join(f"face {axis}{side} plane {u(EDGE if side == 'hi' else 0.0, 'm')}" for axis in "xyz" for side in ("lo", "hi"))
    return f"fix flow all pfv viscosity {u(1.0, 'Pa s')} couple_every 1 {planes} pressure {u(3.0, 'Pa')}\n"


class OtherUnits(CoupledTest):
    def write(self, u):
        grains, speeds = packing(4), random_velocities(packing(4))
        bounds = [f"{u(-0.02, 'm')} {u(EDGE + 0.05, 'm')} {axis}lo {axis}hi" for axis in "xyz"]
        rows = [f"{n} 1 {u(2 * r, 'm')} {u(2600.0, 'kg/m3')} {u(x, 'm')} {u(y, 'm')} {u(z, 'm')}" for n, x, y, z, r in grains]
        moving = [f"{n} {' '.join(u(v, 'm/s') for v in speed)} 0 0 0" for n, speed in speeds.items()]
        (self.folder / "packing.data").write_text("\n".join(
            ["grains", "", f"{len(grains)} atoms", "1 atom types", "", *bounds, "", "Atoms", "", *rows, "", "Velocities", "", *moving]) + "\n")
        length = u.factors["m"]
        for name, corners in (("lid", square(EDGE, EDGE)), ("side", [(0.0, y, z) for y, z in ((0, 0), (EDGE, 0), (EDGE, EDGE), (0, EDGE))])):
            write_mesh(self.folder / f"{name}.stl", quad(*[tuple(length * c for c in corner) for corner in corners]))

    def dump(self, name):
        return (f"dump d all custom 20 {name} id x y z radius vx vy vz f_flow[1] f_flow[2] f_flow[3] f_flow[4] "
                'omegax omegay omegaz f_flow[5] f_flow[6] f_flow[7]\ndump_modify d sort id format "%d' + " %.17g" * 17 + '"\n')

    def rows_in_si(self, u, log):
        return [{name: u.si(value, COLUMNS.get(name, "")) for name, value in row.items()} for row in read_thermo(log)]

    def dump_in_si(self, u, name):
        return {step: {n: [u.si(value, unit) for value, unit in zip(row, DUMP)] for n, row in rows.items()}
                for step, rows in read_dump(self.folder / name).items()}

    def table_in_si(self, u, name, unit):
        rows = [line.split(",") for line in (self.folder / name).read_text().splitlines()[1:]]
        return [[u.si(float(row[0]), "s")] + [u.si(float(value), unit) for value in row[1:]] for row in rows]

    def history_in_si(self, u):
        names, *rows = [line.split(",") for line in (self.folder / "history.csv").read_text().splitlines()]

        def unit(name):
            for ending, one in (("_flux", "m3/s"), (" flux", "m3/s"), ("pressure", "Pa"), ("_position", "m"), ("permeability", "m2")):
                if name.endswith(ending):
                    return one
            if "force_" in name and "error" not in name and "balance" not in name:
                return "N"
            return {"time": "s", "inflow": "m3/s", "outflow": "m3/s", "volume_rate_sum": "m3/s", "storage_rate": "m3/s"}.get(name, "")
        return names, [[u.si(float(value), unit(name)) if value else math.nan for name, value in zip(names, row)] for row in rows]

    def everything(self, style):
        """One run with a change between its parts and a restart, all that it writes, in SI."""
        u = Scale(style)
        self.write(u)
        change = f"fix_modify flow viscosity {u(0.5, 'Pa s')} pressure zlo {u(40.0, 'Pa')}\n"
        screen = self.liggghts(head(u) + scene(u) + self.dump("run.dump") + "run 40\n" + change + "run 20\nwrite_restart file.restart\nrun 20\n")
        result = {"said": screen, "thermo": self.rows_in_si(u, screen), "dump": self.dump_in_si(u, "run.dump"),
                  "history": self.history_in_si(u), "sensors": self.table_in_si(u, "sensors.csv", "Pa"),
                  "profile": self.table_in_si(u, "profile.csv", "Pa"), "flux": self.table_in_si(u, "flux.csv", "m3/s")}
        return result

    def compare_columns(self, a, b):
        for column in range(len(a[0])):
            there = [row[column] for row in b]
            scale = max(abs(value) for value in there)
            for row, value in zip(a, there):
                self.assertLess(abs(row[column] - value), ROUND_OFF * max(scale, 1e-300), column)

    def test_the_same_flow(self):
        reference = self.everything("si")
        self.assertGreater(reference["thermo"][-1]["flow[5]"], 1)  # networks
        for style in ("cgs", "micro"):
            with self.subTest(style):
                other = self.everything(style)
                for step, rows in reference["dump"].items():
                    for columns in (slice(0, 3), slice(4, 7), slice(7, 10), slice(11, 14), slice(14, 17)):
                        part = [{n: row[columns] for n, row in some.items()} for some in (other["dump"][step], rows)]
                        if any(any(row) for row in part[1].values()):
                            self.assertLess(largest_difference(*part), ROUND_OFF, (step, columns))
                for name in ("sensors", "profile", "flux"):
                    self.compare_columns(other[name], reference[name])
                self.assertEqual(other["history"][0], reference["history"][0])
                kept = [k for k, name in enumerate(reference["history"][0]) if not name.endswith("error")]  # round-off
                self.compare_columns(*([[0.0 if math.isnan(row[k]) else row[k] for k in kept] for row in rows]
                                       for rows in (other["history"][1], reference["history"][1])))
                for a, b in zip(other["thermo"], reference["thermo"]):
                    for name in ("flow[1]", "flow[6]", "flow[7]", "lid[3]", "lid[12]"):
                        self.assertLess(abs(a[name] - b[name]), ROUND_OFF * max(abs(b[name]), 1e-300), name)
                length = {"cgs": "cm", "micro": "um"}[style]
                self.assertIn(f" {length}3, 64 grains inside", other["said"])
                self.assertNotIn(" m3, 64 grains", other["said"])

    def test_nanometres(self):
        """LIGGGHTS itself ends at a mesh in a box of 1e8 nm, with or without the fix."""
        rows = {}
        for style in ("si", "nano"):
            u = Scale(style)
            self.write(u)
            self.liggghts(head(u) + between_planes(u) + self.dump("run.dump") + "run 20\n")
            rows[style] = self.dump_in_si(u, "run.dump")[20]
        parts = [{n: row[7:10] for n, row in rows[style].items()} for style in ("nano", "si")]
        self.assertLess(largest_difference(*parts), ROUND_OFF)

    def test_a_restart_goes_on_in_its_own_units(self):
        u = Scale("micro")
        self.write(u)
        flow = between_planes(u)
        self.liggghts(head(u) + flow + "run 20\nwrite_restart file.restart\n" + self.dump("continued.dump") + "run 10\n")
        self.liggghts(head(u, "read_restart file.restart") + flow + self.dump("restarted.dump") + "run 10\n")
        continued, restarted = (read_dump(self.folder / f"{name}.dump") for name in ("continued", "restarted"))
        self.assertLess(largest_difference(*({n: row[7:10] for n, row in rows[max(rows)].items()} for rows in (restarted, continued))),
                        1e-6)

    def test_what_is_no_system_of_units_is_refused(self):
        for style in ("lj", "real", "metal", "electron"):
            script = (f"units {style}\natom_style granular\nboundary f f f\nregion r block 0 1 0 1 0 1\ncreate_box 1 r\n"
                      "fix flow all pfv viscosity 1\n")
            done = self.launch(script)
            self.assertNotEqual(done.returncode, 0)
            if "Illegal units" not in done.stdout:  # LIGGGHTS has not all of them
                self.assertIn(f"units {style}", done.stdout)
                self.assertIn("use one of si, cgs, micro, nano", done.stdout)

    def test_an_error_names_the_units_of_the_script(self):
        u = Scale("cgs")
        self.write(u)
        done = self.launch(head(u) + f"fix flow all pfv viscosity 1 face xlo plane 0 face xhi plane {u(0.02, 'm')} face ylo plane 0 "
                           f"face yhi plane {u(0.02, 'm')} face zlo plane {u(2.0, 'm')} face zhi plane {u(3.0, 'm')} pressure 0\nrun 0\n")
        self.assertIn("to 300 cm", done.stdout)


if __name__ == "__main__":
    unittest.main()

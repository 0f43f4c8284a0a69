# SPDX-License-Identifier: GPL-3.0-or-later
"""`boundary p` on some or all axes: the library's periodic cell under LIGGGHTS, also one that changes its lengths."""
import math
import struct
import unittest

from coupled import EDGE, HERE, CoupledTest, dump, forces, largest_difference, packing
from coupled import random_velocities, read_dump, read_thermo

GRADIENT = (12.0, -7.0, 3.0)
SPHERES = [4 / 3 * math.pi * grain[4] ** 3 for grain in packing()]
SOLID = sum(SPHERES)
FLUID = EDGE ** 3 - SOLID
BULK = 1e4
THERMO = ("thermo_style custom step xlo xhi ylo yhi zlo zhi f_flow f_flow[1] f_flow[2] f_flow[3] f_flow[4] "
          "f_flow[5] f_flow[7]\nthermo 1\nthermo_modify norm no format float %.15g\n")
ALL = "gradient 12 -7 3"
EACH = "couple_every 1"
DRIVEN = f"viscosity 0.01 {EACH} {ALL}"


class PeriodicTest(CoupledTest):
    def write(self, boundary="p p p", velocities=None, grains=None):
        """packing.data with a box that ends where the cell does along periodic axes."""
        grains = grains or packing()
        lines = ["grains of a coupled test", "", f"{len(grains)} atoms", "1 atom types", ""]
        for axis, kind in zip("xyz", boundary.split()):
            low, high = (0.0, EDGE) if kind == "p" else (-0.02, EDGE + 0.05)
            lines.append(f"{low} {high} {axis}lo {axis}hi")
        lines += ["", "Atoms", ""]
        lines += [f"{n} 1 {2 * r!r} 2600.0 {x!r} {y!r} {z!r}" for n, x, y, z, r in grains]
        if velocities:
            lines += ["", "Velocities", ""]
            lines += [f"{n} {v[0]!r} {v[1]!r} {v[2]!r} 0 0 0" for n, v in sorted(velocities.items())]
        (self.folder / "packing.data").write_text("\n".join(lines) + "\n")

    def head(self, boundary="p p p"):
        return (HERE / "in.packing").read_text().replace("boundary        f f f", f"boundary {boundary}")

    def cell(self, flow, run, boundary="p p p", before="", **options):
        """A run with the fix; rows of its thermo output."""
        self.liggghts(f"{self.head(boundary)}{before}fix flow all pfv {flow}\n{THERMO}{run}", **options)
        return read_thermo((self.folder / "log.liggghts").read_text())


class StillCell(PeriodicTest):
    def test_the_fix_gives_the_commands_forces_and_permeability(self):
        self.write()
        self.cell(DRIVEN, dump("flow.dump") + "dump pack all custom 1 pack.dump id type x y z radius\n"
                  'dump_modify pack format "%d %d %.17g %.17g %.17g %.17g"\nrun 0\n')
        of_fix = forces(read_dump(self.folder / "flow.dump")[0])
        gradient = [repr(g) for g in GRADIENT]
        report, of_command = self.pfv_solve("pack.dump", "--periodic", "x,y,z", "--gradient", *gradient)
        self.assertLess(largest_difference(of_fix, of_command), 1e-12)
        # what drives the fluid is carried by the grains, all of it
        for axis in range(3):
            total = sum(force[axis] for force in of_fix.values())
            self.assertAlmostEqual(total / (-GRADIENT[axis] * EDGE ** 3), 1.0, delta=1e-12)
        self.assertGreater(report["permeability"], 0.0)

    def test_pressures_across_and_periods_along(self):
        self.write("p p f")
        flow = ("viscosity 0.01 face zlo plane 0 pressure 10 face zhi plane 0.1 pressure 0 gradient 12 0 0")
        rows = self.cell(flow, dump("flow.dump") + "run 0\n", "p p f")
        self.write_csv()
        report, of_command = self.pfv_solve("packing.csv", "--periodic", "x,y", "--gradient", "12", "0", "0",
                                            "--face", "zlo:pressure=10", "--face", "zhi:pressure=0")
        of_fix = forces(read_dump(self.folder / "flow.dump")[0])
        self.assertLess(largest_difference(of_fix, of_command), 1e-12)
        self.assertAlmostEqual(rows[0]["flow[1]"] / report["inflow"], 1.0, delta=1e-10)
        self.assertLess(abs(rows[0]["flow[3]"]), 1e-10)
        self.assertLess(rows[0]["flow[4]"], 1e-10)

    def write_csv(self):
        rows = [f"{n},{x!r},{y!r},{z!r},{r!r}\n" for n, x, y, z, r in packing()]
        (self.folder / "packing.csv").write_text("id,x,y,z,radius\n" + "".join(rows))

    def test_a_gradient_from_a_variable(self):
        self.write()
        ramp = "variable g equal 12*step\n"
        self.cell(f"viscosity 0.01 {EACH} gradient v_g 0 0", dump("ramp.dump") + "unfix integr\nrun 2\n", before=ramp)
        self.cell(f"viscosity 0.01 {EACH} gradient 12 0 0", dump("held.dump") + "unfix integr\nrun 0\n"
                  "fix_modify flow gradient 24 0 0\nrun 1\n")
        ramped, held = (read_dump(self.folder / name) for name in ("ramp.dump", "held.dump"))
        self.assertTrue(all(f == 0.0 for force in forces(ramped[0]).values() for f in force))
        self.assertLess(largest_difference(forces(ramped[1]), forces(held[0])), 1e-12)
        self.assertLess(largest_difference(forces(ramped[2]), forces(held[1])), 1e-12)

    def test_a_sensor_in_the_next_cell_reads_the_image(self):
        """An image one period on, of the pressure without the gradient's part of that period."""
        self.write()
        self.cell(f"viscosity 0.01 {EACH} gradient 12 0 0 sensors 1 p.csv 0.03 0.05 0.05 0.13 -0.05 0.05", "run 1\n")
        row = (self.folder / "p.csv").read_text().splitlines()[-1].split(",")
        self.assertEqual(row[1], row[2])

    def test_two_ranks(self):
        self.write(velocities=random_velocities(packing()))
        for ranks in (1, 2):
            self.cell(DRIVEN, dump(f"{ranks}.dump") + "run 20\n", ranks=ranks)
        one, two = (read_dump(self.folder / f"{ranks}.dump") for ranks in (1, 2))
        for step in (0, 20):
            self.assertLess(largest_difference(forces(one[step]), forces(two[step])), 1e-9)


class CrossingGrains(PeriodicTest):
    """All grains drift through the cell: more than one grain in five is wrapped on the way."""
    DRIFT = (40.0, -30.0, 20.0)  # m/s: 4 mm in 10 steps, of a cell of 100

    def drifting(self, flow, run="run 40\n", **options):
        self.write(velocities={grain[0]: self.DRIFT for grain in packing()})
        return self.cell(flow, dump("flow.dump") + run, **options)

    def test_forces_do_not_jump(self):
        """The packing does not change, but for the frame, and neither do the forces. A compressible fluid first
        finds the pressures of the gradient, in three steps; a new network that has them in other images of the
        pores goes on with those pressures."""
        for words, first in (("", 0), (" bulk_modulus 1e4", 3)):
            rows = self.drifting(f"viscosity 1e-7 {EACH} gradient 1e-3 0 0{words}")
            steps = read_dump(self.folder / "flow.dump")
            wrapped = sum(abs(steps[40][n][0] - steps[0][n][0]) > EDGE / 2 for n in steps[0])
            self.assertGreater(wrapped, len(steps[0]) / 6)
            self.assertGreater(rows[-1]["flow[5]"], 0)
            for step in range(first, 41):
                self.assertLess(largest_difference(forces(steps[step]), forces(steps[first])), 1e-8)
            self.assertLess(max(row["flow"] for row in rows), 1e-11)

    def test_mean_velocities_over_an_interval(self):
        """Wrapped grains have the mean velocity of their image: the pressures stay what they are."""
        for words in ("couple_every 4", "couple_every auto error 5"):
            rows = self.drifting(f"viscosity 1e-7 bulk_modulus 1e4 {words}")
            self.assertLess(max(abs(row["flow[7]"]) for row in rows), 1e-6)
            self.assertLess(max(row["flow"] for row in rows), 1e-6)

    def test_displacements_are_those_of_the_grains(self):
        self.drifting(f"viscosity 1e-7 {EACH} gradient 1e-3 0 0 output 40 out.pvd")
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "out_grains_40.vtu"))
        reader.Update()
        places = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
        self.assertLess(places.max() - places.min(), 1.02 * EDGE)  # they are shown where LIGGGHTS has them
        moved = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("displacement"))
        for axis in range(3):
            self.assertLess(abs(moved[:, axis] - 40e-5 * self.DRIFT[axis]).max(), 1e-6)

    def test_runs_in_a_row_are_one_run(self):
        """A grain beyond the border at the end of a run is wrapped before the next: it has not been moved."""
        flow = f"viscosity 1e-7 {EACH} gradient 1e-3 0 0 bulk_modulus 1e4"
        one = self.drifting(flow)
        first = forces(read_dump(self.folder / "flow.dump")[40])
        rows = self.drifting(flow, run=("run 1\n" * 40))
        self.assertEqual(rows[-1]["flow[5]"], one[-1]["flow[5]"])
        self.assertLess(largest_difference(forces(read_dump(self.folder / "flow.dump")[40]), first), 1e-6)


class Restart(PeriodicTest):
    def compare(self, flow, boundary="p p p", deform="", drift=40.0, ranks=1, by_hand="", anew="", head=None,
                older=False):
        """`by_hand`: what changes between the two runs; `anew`: what the run from the file does before that; `older`: the
        file is one of form 8."""
        head = head or self.head(boundary)
        self.write(boundary, {n: [drift * c for c in v] for n, v in random_velocities(packing()).items()})
        fix = f"{deform}fix flow all pfv {flow}\n"
        self.liggghts(head + fix + "run 10\nwrite_restart file.restart\n" + by_hand + THERMO +
                      dump("continued.dump") + "run 10\n", ranks=ranks)
        continued = read_thermo((self.folder / "log.liggghts").read_text())
        if older:
            self.make_older(self.folder / "file.restart")
        skipped = ("units", "boundary", "read_data", "atom_style")
        head = "".join(line + "\n" for line in head.splitlines() if not line.startswith(skipped))
        head = head.replace("newton          off", "newton off\nread_restart file.restart")
        self.liggghts(head + fix + anew + by_hand + THERMO + dump("restarted.dump") + "run 10\n", ranks=ranks)
        restarted = read_thermo((self.folder / "log.liggghts").read_text())
        self.assertEqual([row for row in restarted if "flow[7]" in row], [row for row in continued if "flow[7]" in row])
        self.assertEqual((self.folder / "continued.dump").read_bytes(), (self.folder / "restarted.dump").read_bytes())

    def make_older(self, file):
        """The record of step 10 in form 8, which is read as far as that goes."""
        forms = [struct.pack("2d", form, 10.0) for form in (11.0, 8.0)]
        self.assertIn(forms[0], file.read_bytes())
        file.write_bytes(file.read_bytes().replace(*forms, 1))

    def test_files_without_a_fingerprint_are_read(self):
        self.compare(f"{DRIVEN} bulk_modulus 1e4", older=True)
        self.compare("viscosity 0.01 bulk_modulus 1e4 couple_every 2", deform="fix shrink all deform 1 x vel -2\n",
                     drift=1.0, older=True)

    def test_a_continued_run_writes_the_same_bytes(self):
        self.compare(f"{DRIVEN} bulk_modulus 1e4")
        self.compare(f"viscosity 0.01 {EACH} face zlo plane 0 pressure 10 face zhi plane 0.1 pressure 0", "p p f")
        self.compare(f"viscosity 0.01 {ALL} bulk_modulus 1e4 couple_every 4")
        self.compare(f"viscosity 0.01 {ALL} bulk_modulus 1e4")

    def test_two_ranks_too(self):
        self.compare(f"{DRIVEN} bulk_modulus 1e4", ranks=2)

    def test_and_in_a_cell_that_changes(self):
        """`vel` and not `erate`: that begins anew from the length that a run finds."""
        for remap in ("x", "none"):
            self.compare("viscosity 0.01 bulk_modulus 1e4 couple_every 2",
                         deform=f"fix shrink all deform 1 x vel -2 remap {remap}\n", drift=1.0)

    # LIGGGHTS changes no box before a first run while a file's contacts wait for their history
    CHANGED = "change_box all x scale 0.98 remap\n"
    FORGETFUL = ("tangential history", "tangential no_history")

    def test_a_box_that_is_changed_before_the_first_run(self):
        """As one that is changed between two runs: what it has leapt by is no motion of this one."""
        shrinking = "fix shrink all deform 1 x vel -2 remap x\n"
        well = "point 0.05 0.05 0.05 pressure 0"
        for words, deform in ((DRIVEN, ""), (f"viscosity 0.01 {ALL} couple_every 4", ""),
                              (f"viscosity 0.01 {ALL}", ""), (f"viscosity 0.01 {well} couple_every 4", shrinking),
                              (f"viscosity 0.01 {well} {EACH}", shrinking)):
            with self.subTest(words=words, deform=deform):
                self.compare(words, deform=deform, drift=1.0, by_hand=self.CHANGED,
                             head=self.head().replace(*self.FORGETFUL))

    def test_pressures_of_a_compressible_fluid_need_the_pores_that_they_belong_to(self):
        flow = f"viscosity 0.01 {EACH} bulk_modulus 1e4"
        with self.assertRaisesRegex(AssertionError, "periodic sides are not where the restart file has them.*run 0"):
            self.compare(flow, by_hand=self.CHANGED, head=self.head().replace(*self.FORGETFUL))
        self.compare(flow, by_hand=self.CHANGED, anew=THERMO.replace("f_flow[7]", "") + "run 0\n")


class ChangingCell(PeriodicTest):
    """fix deform: the cell's lengths change, and with them the images.

    It changes the box at the end of a step, after the flow's: the flow of step n has the box of the row n - 1.
    """
    RATES = "x erate -5 z erate 2"  # 1/s, for 2e-4 s: one network

    def strained(self, flow, deform=RATES, steps=20, boundary="p p p", velocities=None, **options):
        self.write(boundary, velocities=velocities)
        before = f"fix strain all deform 1 {deform}\n"
        return self.cell(flow, dump("flow.dump") + f"run {steps}\n", boundary, before=before, **options)

    @staticmethod
    def volume(row):
        return math.prod(row[hi] - row[lo] for lo, hi in (("Xlo", "Xhi"), ("Ylo", "Yhi"), ("Zlo", "Zhi")))

    def expect_undrained(self, rows, within):
        """p = K_f (V_0 - V) / V_0 of the fluid's volume V, V_0 that of the network."""
        now = self.volume(rows[-2]) - SOLID
        self.assertLess(now, 0.9995 * FLUID)
        self.assertAlmostEqual(rows[-1]["flow[7]"] / (BULK * (FLUID - now) / FLUID), 1.0, delta=within)
        for row in rows:
            self.assertLess(abs(row["flow[3]"]), 1e-9)

    def test_undrained_pressure_is_the_bulk_modulus_times_the_change_of_the_fluid(self):
        """Staged and implicit steps take the cell's areas half a step on: 7e-5 of this change."""
        for remap, words in (("none", "couple_every 1"), ("v", "couple_every 1"), ("x", "couple_every 1"),
                             ("x", "couple_every 5"), ("x", "couple_every auto"),
                             ("x", "couple_every 1 coupling staged"), ("x", "couple_every 1 coupling implicit")):
            with self.subTest(remap=remap, words=words):
                self.expect_undrained(self.strained(f"viscosity 1e-4 bulk_modulus {BULK} {words}",
                                                    f"{self.RATES} remap {remap}"),
                                      1e-4 if "coupling" in words else 1e-9)

    def test_contacts_have_the_same_box(self):
        """Two grains that touch across a side: the force of their contact at step n and the pressure are those of the
        box of row n - 1, and of no other."""
        grains, stiffness = packing(), 1e4  # kn of in.packing, N/m
        one, other = (next(g for g in grains if g[0] == 1 + 25 * i + 5 * 2 + 2) for i in (0, 4))
        touch = {one[0]: 0.99 * one[4], other[0]: EDGE - 0.99 * other[4]}
        grains = [(n, touch.get(n, x), one[2] if n in touch else y, one[3] if n in touch else z, r)
                  for n, x, y, z, r in grains]
        self.write(grains=grains)
        force = f"variable push equal fx[{one[0]}]-f_flow[{one[0]}][1]\nunfix integr\n"
        rows = self.cell(f"viscosity 1e-4 {EACH} bulk_modulus {BULK}",
                         force + THERMO.replace("f_flow[7]", "f_flow[7] v_push") + "run 20\n",
                         before="fix strain all deform 1 x erate -5 remap x\n")
        lost = [self.volume(rows[0]) - self.volume(row) for row in rows]
        for before, row in list(zip(rows, rows[1:]))[1:]:
            length = before["Xhi"] - before["Xlo"]
            overlap = (one[4] + other[4]) * (1 - 0.99 * length / EDGE)
            self.assertAlmostEqual(row["push"] / (stiffness * overlap), 1.0, delta=1e-9)
            self.assertAlmostEqual(row["flow[7]"] / rows[-1]["flow[7]"] / (lost[int(before["Step"])] / lost[-2]), 1.0,
                                   delta=1e-9)

    def test_one_step_late_is_what_a_step_strains(self):
        """Held against the box of its own row, which fix deform makes after it: an undrained pressure lacks what the
        last step has pressed together, an outflow is off by no more than the strains of a step together."""
        for rates in (self.RATES, "x erate -500 y erate -200 z erate -300"):
            rows = self.strained(f"viscosity 1e-4 bulk_modulus {BULK} {EACH} retriangulate 0.9", f"{rates} remap x")
            step = BULK * (self.volume(rows[-2]) - self.volume(rows[-1])) / FLUID
            lacks = BULK * (EDGE ** 3 - self.volume(rows[-1])) / FLUID - rows[-1]["flow[7]"]
            self.assertAlmostEqual(lacks / step, 1.0, delta=1e-6)
            rows = self.strained(f"viscosity 1e-4 {EACH} point 0.05 0.05 0.05 pressure 0", f"{rates} remap x")
            for two, one, row in zip(rows, rows[1:], rows[2:]):
                strain = sum(abs(math.log((row[f"{a}hi"] - row[f"{a}lo"]) / (one[f"{a}hi"] - one[f"{a}lo"])))
                             for a in "XYZ")
                out = 1e-5 * (row["flow[2]"] - row["flow[1]"])
                self.assertAlmostEqual(out / (self.volume(two) - self.volume(one)), 1.0, delta=1e-9)
                self.assertLess(abs(out / (self.volume(one) - self.volume(row)) - 1.0), strain)

    def test_runs_in_a_row_are_one_run(self):
        for words in ("couple_every 1", "couple_every 5"):
            flow, deform = f"viscosity 1e-4 bulk_modulus {BULK} {words}", "x vel -2 remap x"
            one = self.strained(flow, deform)[-1]["flow[7]"]
            self.write()
            rows = self.cell(flow, "run 10\n" * 2, before=f"fix strain all deform 1 {deform}\n")
            self.assertAlmostEqual(rows[-1]["flow[7]"] / one, 1.0, delta=1e-4)

    def test_one_and_two_ranks(self):
        flow = f"viscosity 0.01 {EACH} bulk_modulus {BULK}"
        volume_kept = "z erate -20 x volume y volume remap x"
        for deform in (f"{self.RATES} remap x", volume_kept):
            results = []
            for ranks in (1, 2):
                rows = self.strained(flow, deform, velocities=random_velocities(packing()), ranks=ranks)
                results.append((rows[-1]["flow[7]"], forces(read_dump(self.folder / "flow.dump")[20])))
            self.assertLess(largest_difference(results[0][1], results[1][1]), 1e-9)
            self.assertAlmostEqual(results[0][0], results[1][0], delta=1e-9 * abs(results[0][0]) + 1e-9)

    def test_a_cell_of_kept_volume_needs_no_bulk_modulus(self):
        rows = self.strained(f"viscosity 0.01 {EACH}", "z erate -20 x volume y volume remap x")
        self.assertGreater(rows[-1]["flow"], 0.0)
        self.assertAlmostEqual(self.volume(rows[-1]) / EDGE ** 3, 1.0, delta=1e-12)

    def test_drained_outflow_is_the_change_of_volume(self):
        """Through the top of `boundary p p f`, and through a well in a cell that is periodic all around."""
        open_top = "face zlo plane 0 face zhi plane 0.1 pressure 0"
        well = "point 0.05 0.05 0.05 pressure 0"
        for flow, deform, boundary in ((open_top, "x erate -20 y erate 8", "p p f"), (well, self.RATES, "p p p")):
            for words in ("couple_every 1", "couple_every 4"):
                with self.subTest(boundary=boundary, words=words):
                    rows = self.strained(f"viscosity 1e-4 {words} {flow}", f"{deform} remap x", boundary=boundary)
                    interval = int(words.split()[1])
                    out = sum(row["flow[2]"] - row["flow[1]"] for row in rows[interval::interval]) * interval * 1e-5
                    sides = {"p p f": lambda row: (row["Xhi"] - row["Xlo"]) * (row["Yhi"] - row["Ylo"]) * EDGE,
                             "p p p": self.volume}[boundary]
                    self.assertAlmostEqual(out / (sides(rows[0]) - sides(rows[-2])), 1.0, delta=1e-10)
                    self.assertLess(max(abs(row["flow[3]"]) for row in rows), 1e-9)

    def test_drained_over_many_networks(self):
        """The cell loses 72 % of its volume, the grains overlap in the end."""
        rows = self.strained(f"viscosity 1e-4 {EACH} point 0.05 0.05 0.05 pressure 0",
                             "x erate -500 y erate -200 z erate -300 remap x", steps=100)
        out = sum(row["flow[2]"] - row["flow[1]"] for row in rows[1:]) * 1e-5
        self.assertGreater(rows[-1]["flow[5]"], 50)
        self.assertAlmostEqual(out / (self.volume(rows[0]) - self.volume(rows[-2])), 1.0, delta=1e-10)

    def test_grains_that_stream_with_the_cell_feel_what_grains_feel_that_move_so_themselves(self):
        """remap x moves them beside their own velocities, remap none with them: the same fluid, the same forces."""
        rate, flow = -20.0, f"viscosity 0.01 {EACH} point 0.05 0.05 0.05 pressure 0"
        self.strained(flow, "x erate -20 remap x", steps=2)
        streaming = forces(read_dump(self.folder / "flow.dump")[2])
        # of a cell that shrinks about its middle
        velocities = {n: [rate * (x - EDGE / 2), 0.0, 0.0] for n, x, *_ in packing()}
        self.strained(flow, "x erate -20 remap none", steps=2, velocities=velocities)
        moving = forces(read_dump(self.folder / "flow.dump")[2])
        self.assertLess(largest_difference(streaming, moving), 1e-3)

    def test_change_box_between_runs(self):
        """As a wall that is moved between runs: the flow begins anew with the fluid that is there."""
        self.write()
        rows = self.cell(f"viscosity 0.01 {EACH} bulk_modulus {BULK}", "run 5\nchange_box all x scale 0.98 remap\nrun 5\n")
        self.assertAlmostEqual(rows[-1]["Xhi"] - rows[-1]["Xlo"], 0.98 * EDGE, delta=1e-12)
        self.assertEqual(rows[-1]["flow[5]"], 1)
        self.assertLess(abs(rows[-1]["flow[7]"]), 1e-9 * BULK)


class Refusals(PeriodicTest):
    def refuse(self, flow, *parts, boundary="p p p", before="", after="run 1\n"):
        self.write(boundary)
        self.refused(f"{self.head(boundary)}{before}fix flow all pfv {flow}\n{after}", *parts)

    def test_faces_of_periodic_axes(self):
        self.refuse("viscosity 0.01 face xlo plane 0", "periodic along x", "boundary f", after="")
        self.refuse("viscosity 0.01 face zlo plane 0", "face zhi", boundary="p p f", after="")
        self.refuse("viscosity 0.01 gradient 0 0 1 face zlo plane 0 face zhi plane 0.1", "not periodic along z",
                    boundary="p p f", after="")
        self.refuse("viscosity 0.01 container", "boundary f f f", after="")
        self.refuse(DRIVEN, "gradient", after="fix_modify flow pressure xlo 1\n")

    def test_tilted_cell(self):
        self.write()
        self.refused(self.head() + f"change_box all triclinic\nfix flow all pfv {DRIVEN}\nrun 1\n", "tilted", "ghosts")

    def test_a_closed_cell_that_loses_volume(self):
        self.refuse(f"viscosity 0.01 {EACH}", "bulk modulus", before="fix s all deform 1 x erate -20 remap x\n",
                    after="run 2\n")

    def test_deform_between_flow_steps_and_along_walls(self):
        self.refuse(f"viscosity 0.01 {EACH} bulk_modulus 1e4", "fix deform 's'", "couple_every",
                    before="fix s all deform 5 x erate -20 remap x\n")
        self.refuse(f"viscosity 0.01 {EACH} face zlo plane 0 face zhi plane 0.1 pressure 0", "fix deform 's'",
                    "along z", boundary="p p f", before="fix s all deform 1 z erate -20 remap x\n")

    def test_sides_that_change(self):
        self.refuse(DRIVEN, "periodic sides", "anew", after="run 0\nchange_box all boundary p p f\nrun 0\n")

    def test_couple_cfd(self):
        cfd = "fix cfd all couple/cfd couple_every 100 mpi\n"
        for before, after in ((cfd, ""), ("", cfd + "run 0\n")):
            self.refuse(DRIVEN, "couple/cfd", "take out", "viscosity and density", before=before, after=after)


class Interval(PeriodicTest):
    def test_a_gradient_that_changes_is_solved_at_the_same_steps_on_1_and_2_ranks(self):
        """Pressures and gradient are weighed by the cell's length, which the flow's rank alone knows."""
        self.write("p p f")
        wave = "variable grad equal 100*sin(2*PI*step*dt/0.01)\n"
        flow = f"viscosity 1e-3 face zlo plane 0 pressure 0 face zhi plane {EDGE} pressure 100 gradient v_grad 0 0"
        run = "unfix integr\nthermo_style custom step f_flow[10]\nrun 40\n"
        alone, together = (self.cell(flow, run, "p p f", wave, ranks=ranks) for ranks in (1, 2))
        self.assertEqual(together, alone)

    def test_each_step_and_then_each_fourth_takes_means_since_the_last_solve(self):
        """The places of the first run's beginning are not those of its last solve."""
        self.write(velocities=random_velocities(packing()))
        self.cell(f"viscosity 1e-3 {EACH} gradient 0 0 -1",
                  dump("flow.dump") + "run 40\nfix_modify flow couple_every 4\nrun 4\n")
        steps = read_dump(self.folder / "flow.dump")
        self.assertLess(largest_difference(forces(steps[44]), forces(steps[40])), 0.02)


if __name__ == "__main__":
    unittest.main()

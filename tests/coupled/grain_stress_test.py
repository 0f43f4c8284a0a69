# SPDX-License-Identifier: GPL-3.0-or-later
"""Stresses of single grains that files of the fix tell of: against the forces of the walls and of all contacts."""
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from coupled import EDGE, FLOW, HERE, CoupledTest, packing, read_thermo, write_data
from plates import write_plate

SIDES = ["xlo", "xhi", "ylo", "yhi", "zlo"]
GRAN = "wall/gran model hooke/stiffness tangential history"
PRIMITIVE = "".join(f"fix w{side} all {GRAN} primitive type 1 {side[0]}plane {EDGE if side.endswith('hi') else 0.0} "
                    "store_force yes store_force_contact_stress yes\n" for side in SIDES)
LID = ("fix lid all mesh/surface file lid.stl type 1\n"
       f"fix wzhi all {GRAN} mesh n_meshes 1 meshes lid store_force yes store_force_contact_stress yes\n")
GRAVITY = 10.0
WEIGHT = f"fix g all gravity {GRAVITY} vector 0 0 -1\n"
FIX = f"fix flow all pfv {FLOW} output 100 f.pvd contact_stress\n"
NAMES = ("contact_stress", "inertial_stress", "fluid_stress")


def tensors(rows):
    """From VTK's order."""
    xx, yy, zz, xy, yz, xz = rows.T
    return numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)


class GrainStresses(CoupledTest):
    def setUp(self):
        super().setUp()
        grains = [(*grain[:4], 1.3 * grain[4]) for grain in packing(4)]  # press each other and the walls
        velocities = {grain[0]: (0.3 * grain[3], -0.2 * grain[2], 0.1 + 0.2 * grain[1]) for grain in grains}
        write_data(self.folder, grains, velocities)
        low, high = -0.02, EDGE + 0.02
        write_plate(self.folder / "lid.stl",
                    [(x, y, EDGE) for x, y in ((low, low), (high, low), (high, high), (low, high))])

    def fields(self, step):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / f"f_grains_{step}.vtu"))
        reader.Update()
        data = reader.GetOutput().GetPointData()
        names = ["id", "radius", *NAMES, *(f"{name}_deviator" for name in NAMES)]
        arrays = {name: vtk_to_numpy(data.GetArray(name)) for name in names}
        order = numpy.argsort(arrays["id"])
        return {name: values[order] for name, values in arrays.items()}

    def run_pressed(self, head="include in.packing\n", **options):
        """Grains that press, slide and swim; the fields of step 200, and of the same moment: ids, masses, places,
        velocities, forces, the fluid's, those of the six walls."""
        walls = " ".join(f"f_force_w{side}[{k}]" for side in [*SIDES, "zhi"] for k in (1, 2, 3))
        self.liggghts(head + PRIMITIVE + LID + WEIGHT + FIX + "run 199\n"
                      "dump d all custom 1 d.dump id mass x y z vx vy vz fx fy fz f_flow[1] f_flow[2] f_flow[3] "
                      f"{walls}\n"
                      'dump_modify d sort id format "%d' + " %.17g" * 31 + '"\nrun 1\n', **options)
        lines = (self.folder / "d.dump").read_text().splitlines()
        count = int(lines[3])
        return self.fields(200), numpy.array([[float(word) for word in line.split()] for line in lines[-count:]])

    def check_sums(self, fields, rows):
        """What the grains have in sum is the moment of the walls' forces on the six planes, less that of the forces
        by which the contacts accelerate the grains or carry them in the water."""
        masses, places = rows[:, 1], rows[:, 2:5]
        contacts = rows[:, 8:11] - rows[:, 11:14] - masses[:, None] * numpy.array([0.0, 0.0, -GRAVITY])
        moments = -numpy.einsum("ki,kj->ij", places, contacts)
        of_walls = numpy.zeros((3, 3))
        for w, side in enumerate([*SIDES, "zhi"]):
            points = places.copy()
            points[:, "xyz".index(side[0])] = EDGE if side.endswith("hi") else 0.0
            of_walls += numpy.einsum("ki,kj->ij", points, rows[:, 14 + 3 * w:17 + 3 * w])
        expected = (moments + of_walls + (moments + of_walls).T) / 2
        volumes = 4 / 3 * numpy.pi * fields["radius"]**3
        found = numpy.einsum("k,kij->ij", volumes, tensors(fields["contact_stress"]))
        self.assertLess(numpy.abs(found - expected).max(), 1e-10 * numpy.abs(expected).max())
        self.assertTrue((numpy.diag(of_walls) < 0).all())  # they do press
        return volumes

    def test_add_up_to_the_walls_forces(self):
        """Of contacts that press, slide and are let go, with both kinds of walls."""
        fields, rows = self.run_pressed()
        self.check_sums(fields, rows)
        # to the mean of the grains
        masses, velocities = rows[:, 1], rows[:, 5:8]
        apart = velocities - masses @ velocities / masses.sum()
        kinetic = -numpy.einsum("k,ki,kj->kij", masses / (4 / 3 * numpy.pi * fields["radius"]**3), apart, apart)
        # the files have them half a step before the dump
        numpy.testing.assert_allclose(tensors(fields["inertial_stress"]), kinetic, atol=0.02 * numpy.abs(kinetic).max())
        for name in NAMES:
            tensor = tensors(fields[name])
            rest = tensor - numpy.trace(tensor, axis1=1, axis2=2)[:, None, None] / 3 * numpy.eye(3)
            numpy.testing.assert_allclose(fields[name + "_deviator"], numpy.sqrt(1.5 * (rest**2).sum(axis=(1, 2))),
                                          rtol=1e-12)

    def test_of_single_grains(self):
        """Without friction and dashpots each contact has the force of its spring: overlap times 1e4 N/m."""
        head = (HERE / "in.packing").read_text()
        for kept, without in (("500.", "0."), ("250.", "0."), ("peratomtypepair 1 0.5", "peratomtypepair 1 0.0")):
            self.assertIn(kept, head)
            head = head.replace(kept, without)
        fields, rows = self.run_pressed(head)
        places, radii = rows[:, 2:5], fields["radius"]
        moments = numpy.zeros((len(radii), 3, 3))
        for i, here in enumerate(places):
            for j, there in enumerate(places):
                apart = numpy.linalg.norm(there - here)
                overlap = radii[i] + radii[j] - apart
                if i != j and overlap > 0:
                    normal = (there - here) / apart
                    moments[i] -= (radii[i] - overlap / 2) * 1e4 * overlap * numpy.outer(normal, normal)
            for axis in range(3):
                for depth in (radii[i] - here[axis], radii[i] - (EDGE - here[axis])):
                    if depth > 0:
                        moments[i][axis, axis] -= (radii[i] - depth) * 1e4 * depth
        stresses = moments / (4 / 3 * numpy.pi * radii**3)[:, None, None]
        self.assertGreater(numpy.count_nonzero(numpy.trace(stresses, axis1=1, axis2=2)), 60)
        numpy.testing.assert_allclose(tensors(fields["contact_stress"]), stresses, rtol=0,
                                      atol=1e-10 * numpy.abs(stresses).max())

    def test_of_grains_on_several_ranks(self):
        """Contacts between ranks count once for each grain."""
        fields, rows = self.run_pressed(ranks=2)
        self.check_sums(fields, rows)

    def test_in_a_periodic_cell_add_up_to_the_virial(self):
        """Of LIGGGHTS, which knows it of the pairs alone; contacts across the sides among them."""
        grains = [(*grain[:4], 1.3 * grain[4]) for grain in packing(4)]
        lines = ["grains", "", f"{len(grains)} atoms", "1 atom types", ""]
        lines += [f"0 {EDGE} {axis}lo {axis}hi" for axis in "xyz"] + ["", "Atoms", ""]
        lines += [f"{n} 1 {2 * r!r} 2600.0 {x!r} {y!r} {z!r}" for n, x, y, z, r in grains]
        (self.folder / "packing.data").write_text("\n".join(lines) + "\n")
        head = (HERE / "in.packing").read_text().replace("boundary        f f f", "boundary p p p")
        self.liggghts(head + "fix flow all pfv viscosity 0.01 couple_every 1 gradient 12 -7 3 output 100 f.pvd "
                      "contact_stress\ncompute t all temp\ncompute v all pressure t virial\n"
                      "thermo_style custom step c_v[1] c_v[2] c_v[3]\nthermo 100\n"
                      "thermo_modify norm no format float %.17g\nrun 200\n")
        row = read_thermo((self.folder / "log.liggghts").read_text())[-1]
        fields = self.fields(200)
        sums = (4 / 3 * numpy.pi * fields["radius"]**3) @ fields["contact_stress"] / EDGE**3
        virial = numpy.array([row[f"v[{k}]"] for k in (1, 2, 3)])  # LIGGGHTS has no symmetric part of the others
        numpy.testing.assert_allclose(sums[:3], -virial, rtol=0, atol=1e-10 * numpy.abs(virial).max())
        self.assertLess(sums[:3].max(), 0.0)

    def test_are_not_there_unasked(self):
        self.liggghts("include in.packing\n" + FIX.replace(" contact_stress", "") + "run 0\n")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "f_grains_0.vtu"))
        reader.Update()
        self.assertIsNone(reader.GetOutput().GetPointData().GetArray("contact_stress"))

    def test_need_walls_that_keep_forces_and_come_first(self):
        self.refused("include in.packing\n" + PRIMITIVE.replace("store_force_contact_stress yes", "") + FIX + "run 0\n",
                     "contact_stress", "store_force_contact_stress yes", "wxlo")
        self.refused("include in.packing\n" + FIX + PRIMITIVE + "run 0\n", "contact_stress", "before this fix", "wxlo")


if __name__ == "__main__":
    unittest.main()

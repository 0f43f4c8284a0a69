// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the spheres of a packing as grains.vtu, with forces of known values and one time step of a
// collection, into a folder, for test_fields.py to read with VTK.
#include "pfv/io.hpp"

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const std::string folder = arguments[2];
  const pfv::PackingArrays arrays = pfv::read_packing(arguments[1]);
  const pfv::Packing packing = arrays.view();
  pfv::Forces forces;
  forces.total = 2.0 * packing.positions;
  forces.sphere_pressure = 3.0 * packing.radii;
  pfv::write_spheres(folder + "/grains.vtu", packing, forces);
  pfv::write_collection(folder + "/grains.pvd", {{0.25, 1, "grains.vtu"}});
}

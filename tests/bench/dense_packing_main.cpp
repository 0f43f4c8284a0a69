// SPDX-License-Identifier: GPL-3.0-or-later
// Prints a dense random packing of the unit cube as CSV:  pfv_dense_packing SPHERES [SEED]
#include "pfv/dense_packing.hpp"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  const int spheres = argc > 1 ? std::atoi(argv[1]) : 0;
  if (spheres < 1) {
    std::fprintf(stderr, "usage: pfv_dense_packing SPHERES [SEED]\n");
    return 2;
  }
  const auto seed = static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 1);
  const pfv::PackingArrays packing =
      pfv::dense_packing(spheres, 0.6, 0.2, seed);
  std::printf("id,x,y,z,radius\n");
  for (int k = 0; k < spheres; ++k)
    std::printf("%d,%.17g,%.17g,%.17g,%.17g\n", k + 1, packing.positions(0, k),
                packing.positions(1, k), packing.positions(2, k), packing.radii[k]);
}

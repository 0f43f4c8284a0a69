// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the random beds that doc/accuracy.py solves as CSV:  pfv_random_beds FOLDER
#include "support/random_beds.hpp"

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: pfv_random_beds FOLDER\n");
    return 2;
  }
  for (const support::NamedBed& bed : support::random_beds()) {
    const std::string path = std::string(argv[1]) + "/" + bed.name + ".csv";
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file) {
      std::fprintf(stderr, "pfv_random_beds: %s cannot be written\n", path.c_str());
      return 1;
    }
    std::fprintf(file, "id,x,y,z,radius\n");
    for (int k = 0; k < bed.packing.radii.size(); ++k)
      std::fprintf(file, "%d,%.9f,%.9f,%.9f,%.9f\n", k + 1, bed.packing.positions(0, k),
                   bed.packing.positions(1, k), bed.packing.positions(2, k),
                   bed.packing.radii[k]);
    std::fclose(file);
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Walls and meshes that grains touch and that stand where the fluid is, unseen by it.
#ifndef LMP_PFV_UNSEEN_WALLS_H
#define LMP_PFV_UNSEEN_WALLS_H

#include "flow_ranks.h"
#include "found_walls.h"

#include "pfv/container.hpp"
#include "pfv/mesh_walls.hpp"
#include "pfv/packing.hpp"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// A wall that is no face of the flow: a primitive one, or a mesh by its triangles.
struct PfvUnseenWall {
  std::string id;
  std::vector<pfv::Surface> surface;  ///< one, of a primitive wall
  std::vector<pfv::Triangle> triangles;
};

/// The walls of the script that are no faces. Collective; the same on all ranks.
std::vector<PfvUnseenWall> walls_beside_the_faces(class LAMMPS* lmp, int groupbit, const PfvSettings& settings);

/// A warning for each wall that takes room from the fluid in the container, which the fluid does not know: by a part of
/// its volume, or a mesh by how deep it reaches into it. `packing`: the grains, which are on the fluid's side of a
/// primitive wall; `ranks`: those that have some.
std::vector<std::string> warnings_of_unseen_walls(const std::vector<PfvUnseenWall>& walls,
                                                  const pfv::Container& container, const pfv::Packing& packing,
                                                  const PfvFlowRanks& ranks);

}  // namespace LAMMPS_NS

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
// Which of a script's walls hold the fluid: `container walls`, and meshes that are several walls.
#ifndef LMP_PFV_FOUND_WALLS_H
#define LMP_PFV_FOUND_WALLS_H

#include "arguments.h"

#include "pointers.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// A wall that grains touch: a primitive one or a mesh.
struct PfvWall {
  std::string id;  ///< of the fix
  class FixWallGran* primitive = nullptr;
  class FixMeshSurface* mesh = nullptr;
};

class PfvFoundWalls : protected Pointers {
 public:
  /// `groupbit`: of the flow's grains.
  PfvFoundWalls(class LAMMPS* lmp, int groupbit) : Pointers(lmp), groupbit_(groupbit) {}

  /// The primitive walls and the meshes of all fixes wall/gran, in their order.
  std::vector<PfvWall> walls() const;

  /// Completes the faces of a container: with the walls of the script where the words say so, and with the walls
  /// that a mesh has in place of the mesh. Returns a line about each wall that was left out. Throws
  /// pfv::InputError, the same on all ranks. Collective.
  std::vector<std::string> complete(PfvSettings& settings) const;

 private:
  using Surfaces = std::vector<pfv::Surface>;

  void add_walls(PfvSettings& settings, std::vector<std::string>& left_out) const;
  void drop_walls_that_bound_nothing(PfvSettings& settings, std::vector<Surfaces>& surfaces, std::size_t named,
                                     std::vector<std::string>& left_out) const;
  void split_walls(PfvSettings& settings, const std::vector<Surfaces>& surfaces, std::vector<std::string>& left_out) const;
  std::vector<std::size_t> kept_parts(const PfvSettings& settings, std::size_t face, const std::vector<Surfaces>& surfaces,
                                      std::vector<std::string>& left_out) const;
  void make_cell(PfvSettings& settings, const std::vector<Surfaces>& surfaces, std::size_t named,
                 std::vector<std::string>& left_out) const;
  void leave_out_walls_across(PfvSettings& settings, std::vector<Surfaces>& surfaces, std::size_t named,
                              std::vector<std::string>& left_out) const;
  bool is_cell(const PfvSettings& settings, const std::vector<Surfaces>& surfaces) const;
  void add_periods(PfvSettings& settings, std::vector<Surfaces>& surfaces) const;
  void remove_periods(PfvSettings& settings, std::vector<Surfaces>& surfaces) const;
  std::vector<Surfaces> surfaces_of_faces(PfvSettings& settings, pfv::RoundMeshes round) const;
  Surfaces surfaces_of(const PfvFaceSource& source, const std::string& face) const;
  std::string reason_to_leave_out(const PfvWall& wall) const;
  std::pair<long, long> grains_on_both_sides(const Surfaces& surfaces) const;
  std::optional<Eigen::Vector3d> mean_of_grains() const;
  Eigen::Vector3d middle_of_grains() const;
  bool grains_lie_aside(const std::vector<Surfaces>& surfaces) const;
  double extreme_of_grains(int axis, bool upper) const;
  class Fix* fix_named(const std::string& id) const;

  int groupbit_;
};

}  // namespace LAMMPS_NS

#endif

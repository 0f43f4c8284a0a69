// SPDX-License-Identifier: GPL-3.0-or-later
// The grains where the flow has them, on rank 0 or dealt out to all, sorted by tag, and the results back to where
// LIGGGHTS has them.
#ifndef LMP_PFV_GRAIN_EXCHANGE_H
#define LMP_PFV_GRAIN_EXCHANGE_H

#include "flow_ranks.h"
#include "other_fixes.h"
#include "periodic_cell.h"
#include "rank_rows.h"

#include "pfv/flow_model.hpp"
#include "pfv/obstacle.hpp"
#include "pfv/packing.hpp"
#include "pfv/solve_interval.hpp"

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/// The grains of a rank at one instant, by tag: what mean velocities are reckoned from.
struct PfvSnapshot {
  std::vector<std::int64_t> tags;  ///< ascending
  std::vector<double> places;      ///< three a grain, m

  /// For grains that are dealt anew: a column each, whether it was there then and its place; and back.
  static constexpr int width = 4;
  Eigen::MatrixXd columns(const pfv::Packing::Ids& ids) const;
  static PfvSnapshot of_columns(const pfv::Packing::Ids& ids, const Eigen::MatrixXd& columns);
};

/// Those of all ranks that hold the flow, on rank 0; collective among these.
PfvSnapshot gathered(const PfvSnapshot& own, const PfvFlowRanks& ranks);

/// The rank that has each atom in the flow. It goes with the atom from rank to rank, in a column of its own of the
/// fix's per-atom array, where it stands as 1 + rank: LIGGGHTS gives new atoms 0.
struct PfvHomes {
  double** per_atom = nullptr;  ///< null: rank 0 has all
  int column = 0;

  bool is_known(int atom) const { return !per_atom || per_atom[atom][column] > 0.0; }
  int of(int atom) const { return per_atom ? static_cast<int>(per_atom[atom][column]) - 1 : 0; }
};

class PfvGrainExchange : protected Pointers {
 public:
  explicit PfvGrainExchange(class LAMMPS* lmp) : Pointers(lmp), rows_(lmp) {}

  /// Collects tag, place, velocity, radius, mass and spin of the flow's grains at their homes, on demand with
  /// the force and torque that act on them so far; collective. They are sorted by tag there, so that the flow
  /// sees the same packing however LIGGGHTS has spread and sorted its atoms. A grain without a home stays where it is.
  /// `streaming`: what the host moves grains by beside their velocities, which then hold it.
  void gather(const PfvGroups& groups, bool with_forces, const PfvStreaming& streaming = {},
              const PfvHomes& homes = {});
  /// Gives each gathered grain the home that it has in a part by place. Returns those of `others`, places that this rank
  /// adds to them, m; collective.
  std::vector<int> deal(const PfvHomes& homes, const pfv::Ranks& ranks, const Eigen::Matrix3Xd& others);

  /// Values of the gathered grains, a column each, as rows of the atoms, and the other way round; collective.
  std::vector<double> at_atoms(const Eigen::MatrixXd& at_homes) const;
  Eigen::MatrixXd at_homes(const std::vector<double>& at_atoms, int width) const;

  // where the flow has grains: none elsewhere

  /// Replaces the velocities by mean ones since `then`, `elapsed` seconds ago. Grains that
  /// were not there then keep their own. Along periodic axes from the image that is nearest: a grain that has
  /// been wrapped has the velocity of that image, where `lengths` are those of the cell then (0: not periodic).
  void use_mean_velocities(const PfvSnapshot& then, double elapsed, const Eigen::Vector3d& lengths);

  pfv::Packing packing() const { return grains_.view(); }    ///< as gathered, with what was added
  /// The spheres of an obstacle behind those that are there.
  void add(const pfv::Obstacle& obstacle, const pfv::ObstaclePart& part, const pfv::ObstacleMotion& motion,
           std::int64_t first_id, const pfv::Container& container);
  /// The gathered grains alone.
  Eigen::Index grain_count() const { return static_cast<Eigen::Index>(order_.size()); }
  pfv::Packing grains() const;
  /// Positions without the wrapping of periodic axes, m.
  const Eigen::Matrix3Xd& unwrapped() const { return unwrapped_.cols() > 0 ? unwrapped_ : grains_.positions; }
  /// kg, infinite for a grain that no force moves.
  const Eigen::VectorXd& masses() const { return masses_; }
  /// Masses and forces of the last gathering with forces, and these pistons and bodies.
  pfv::GrainDynamics dynamics(const std::vector<pfv::Piston>& pistons,
                              const std::vector<pfv::RigidBody>& bodies) const {
    return {{masses_.data(), masses_.size()},
            {forces_.data(), 3, forces_.cols()},
            pistons,
            {torques_.data(), 3, torques_.cols()},
            {inertias_.data(), inertias_.size()},
            bodies};
  }
  /// What rigid bodies make of the gathered grains: masses (kg), displaced volumes (m³) and the number of the body of
  /// each, -1 for none.
  void stand_for_bodies(const Eigen::VectorXd& masses, const Eigen::VectorXd& displaced,
                        const Eigen::VectorXi& bodies) {
    masses_ = masses;
    grains_.displaced_volumes = displaced;
    grains_.bodies = bodies;
  }
  PfvSnapshot snapshot() const;

  /// Hands force (columns 0-2, N), pressure (3, Pa) and torque (4-6, N m) to the atoms as they were gathered
  /// and zeros to those outside the group; collective, with no change of atoms since `gather`.
  /// With slopes: also how force (7-9, N a step) and torque (10-12) are expected to change; `held` may be null, and
  /// where the flow has no grains both are empty.
  void scatter(const pfv::Forces& forces, const pfv::HeldLoads* held, double** per_atom,
               bool with_slopes);
  static constexpr int returned_width = 7, width_with_slopes = 13;

  double memory_usage() const { return sizeof(double) * static_cast<double>(received_.capacity()); }

 private:
  int width() const;
  const double* received(int k) const { return &received_[std::size_t(width()) * k]; }
  std::vector<double> packed(const PfvGroups& groups, const PfvStreaming& streaming) const;
  void sort_by_tag();
  void unpack();

  int groupbit_ = 0;
  bool with_forces_ = false, periodic_ = false;
  PfvRankRows rows_;
  std::vector<double> received_;
  std::vector<int> order_;  // received row of each sorted grain

  pfv::PackingArrays grains_;
  Eigen::VectorXd masses_, inertias_;
  Eigen::Matrix3Xd forces_, torques_;
  Eigen::Matrix3Xd unwrapped_;  // no columns without periodic axes
};

}  // namespace LAMMPS_NS

#endif

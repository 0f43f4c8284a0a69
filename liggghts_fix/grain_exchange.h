// SPDX-License-Identifier: GPL-3.0-or-later
// The grains of all ranks on rank 0, sorted by tag, and the results back to their owners.
#ifndef LMP_PFV_GRAIN_EXCHANGE_H
#define LMP_PFV_GRAIN_EXCHANGE_H

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

/// The grains at one instant, by tag: what mean velocities are reckoned from.
struct PfvSnapshot {
  std::vector<std::int64_t> tags;  ///< ascending
  std::vector<double> places;      ///< three a grain, m
};

class PfvGrainExchange : protected Pointers {
 public:
  explicit PfvGrainExchange(class LAMMPS* lmp) : Pointers(lmp), rows_(lmp) {}

  /// Collects tag, place, velocity, radius, mass and spin of the flow's grains on rank 0, on demand with
  /// the force and torque that act on them so far; collective. They are sorted by tag there, so that the flow
  /// sees the same packing however LIGGGHTS has spread and sorted its atoms.
  /// `streaming`: what the host moves grains by beside their velocities, which then hold it.
  void gather(const PfvGroups& groups, bool with_forces, const PfvStreaming& streaming = {});

  /// Replaces the velocities by mean ones since `then`, `elapsed` seconds ago; rank 0. Grains that
  /// were not there then keep their own. Along periodic axes from the image that is nearest: a grain that has
  /// been wrapped has the velocity of that image, where `lengths` are those of the cell then (0: not periodic).
  void use_mean_velocities(const PfvSnapshot& then, double elapsed, const Eigen::Vector3d& lengths);

  pfv::Packing packing() const { return grains_.view(); }    ///< as gathered, with what was added; rank 0
  /// The spheres of an obstacle behind those that are there: rank 0.
  void add(const pfv::Obstacle& obstacle, const pfv::ObstacleMotion& motion, std::int64_t first_id,
           const pfv::Container& container);
  /// The gathered grains alone; rank 0.
  Eigen::Index grain_count() const { return static_cast<Eigen::Index>(order_.size()); }
  pfv::Packing grains() const;
  /// Positions without the wrapping of periodic axes, m; rank 0.
  const Eigen::Matrix3Xd& unwrapped() const { return unwrapped_.cols() > 0 ? unwrapped_ : grains_.positions; }
  /// kg, infinite for a grain that no force moves; rank 0.
  const Eigen::VectorXd& masses() const { return masses_; }
  /// Masses and forces of the last gathering with forces, and these pistons and bodies; rank 0.
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
  /// each, -1 for none; rank 0.
  void stand_for_bodies(const Eigen::VectorXd& masses, const Eigen::VectorXd& displaced,
                        const Eigen::VectorXi& bodies) {
    masses_ = masses;
    grains_.displaced_volumes = displaced;
    grains_.bodies = bodies;
  }
  PfvSnapshot snapshot() const;                              ///< rank 0

  /// Hands force (columns 0-2, N), pressure (3, Pa) and torque (4-6, N m) to the atoms as they were gathered
  /// and zeros to those outside the group; collective, with no change of atoms since `gather`.
  /// With slopes: also how force (7-9, N a step) and torque (10-12) are expected to change; `held` may be null.
  void scatter(const pfv::Forces& forces, const pfv::HeldLoads* held, double** per_atom,
               bool with_slopes);
  static constexpr int returned_width = 7, width_with_slopes = 13;

  double memory_usage() const { return rows_.memory_usage(); }

 private:
  void pack_mine(const PfvGroups& groups, const PfvStreaming& streaming);
  void sort_by_tag();
  void unpack();

  int groupbit_ = 0;
  bool with_forces_ = false, periodic_ = false;
  PfvRankRows rows_;
  std::vector<int> order_;  // received row of each sorted grain

  pfv::PackingArrays grains_;
  Eigen::VectorXd masses_, inertias_;
  Eigen::Matrix3Xd forces_, torques_;
  Eigen::Matrix3Xd unwrapped_;  // no columns without periodic axes
};

}  // namespace LAMMPS_NS

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
// The periodic axes of LIGGGHTS' simulation box: where the cell's faces are, how fast they move, where images are.
#ifndef LMP_PFV_PERIODIC_CELL_H
#define LMP_PFV_PERIODIC_CELL_H

#include "pointers.h"

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What fix deform with `remap x` moves grains by beside their own velocities: rate (x - origin) + drift.
struct PfvStreaming {
  int groupbit = 0;  ///< of the grains that are moved so; 0: none are
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), drift = Eigen::Vector3d::Zero();  ///< m, m/s
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                                     ///< 1/s
};

/// Velocities of the cell's six faces, m/s; zeros along axes that are not periodic.
using PfvCellRates = std::array<double, 6>;

class PfvPeriodicCell : protected Pointers {
 public:
  explicit PfvPeriodicCell(class LAMMPS* lmp) : Pointers(lmp) {}

  /// m, along periodic axes; 0 along the others.
  Eigen::Vector3d lengths() const;

  /// Which axes are periodic.
  std::array<bool, 3> axes() const;
  bool any() const;
  /// Whether a fix changes its lengths.
  bool changes() const { return deforming() != nullptr; }
  /// m, of face xlo ... zhi of the simulation box.
  double position(int face) const;

  /// What keeps the flow from following the simulation box, or nothing: a tilted box, a box that something else
  /// than fix deform changes, or that is changed along an axis that is not periodic or between two flow steps.
  /// `couple_every`: 0 where the flow chooses.
  std::string obstacle(int couple_every, bool rigid_bodies) const;

  /// From where the faces were `elapsed` seconds ago.
  PfvCellRates rates_since(const std::vector<double>& positions, double elapsed) const;
  /// Of a cell whose faces move at these rates.
  PfvStreaming streaming(const PfvCellRates& rates) const;

  /// Positions as LIGGGHTS wraps them, bit by bit, before it begins a run.
  void wrap(Eigen::Matrix3Xd& positions) const;
  /// The image of a place that is nearest to another.
  Eigen::Vector3d image_near(const Eigen::Vector3d& place, const Eigen::Vector3d& other) const;
  /// How many lengths of the cell an atom has been wrapped by.
  Eigen::Vector3d periods(int atom) const;

 private:
  const class FixDeform* deforming() const;
};

}  // namespace LAMMPS_NS

#endif

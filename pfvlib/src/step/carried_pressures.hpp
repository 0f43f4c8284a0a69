// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/built_network.hpp"

#include <limits>
#include <optional>

namespace pfv {

// The pressures of a compressible fluid on a new network.

/// Those of the network before.
struct FormerPressures {
  const BuiltNetwork* network;    ///< null on a rank that had none
  const Eigen::VectorXd& values;  ///< one a pore, Pa
};

/// A cell that survives keeps its own, others take what is found at their place; all are shifted so that the sum of
/// V^f p is conserved.
Eigen::VectorXd carried_pressures(const FormerPressures& old, const BuiltNetwork& now);

/// Where a cell is, m: its dual vertex.
inline Eigen::Vector3d centre_of_cell(const BuiltNetwork& built, int cell) {
  return built.network.origin + built.network.cell_centres.col(cell);
}

/// A cell of the new network among those of its name before, which images may have: the one that has moved least. Where
/// grains have carried it across the border of a periodic cell, the new network has another image of it at home, which the
/// macroscopic gradient raises: that of the step to come, which raises the new pressures of the image alike, so that what
/// the pore stores does not depend on where it is at home.
class SurvivingCell {
 public:
  SurvivingCell(const Eigen::Vector3d& place, const BuiltNetwork& now)
      : place_(place), lattice_(now.grains.spheres.lattice()), gradient_(now.container.pressure_gradient) {}
  /// One of its name.
  void meet(const Eigen::Vector3d& place, double pressure);
  /// As it is now, Pa; none where it was not there.
  const std::optional<double>& pressure() const { return pressure_; }

 private:
  Eigen::Vector3d place_;
  Lattice lattice_;
  Eigen::Vector3d gradient_;
  double least_ = std::numeric_limits<double>::infinity();
  std::optional<double> pressure_;
};

/// Finds pressures of the network before at places.
class FormerPlaces {
 public:
  /// `gradient`: the macroscopic one of the step to come, Pa/m.
  FormerPlaces(const FormerPressures& old, const Eigen::Vector3d& gradient);

  struct Found {
    double outside;   ///< how far the place lies outside the nearest cell, m; infinite where none is near
    double pressure;  ///< Pa
  };
  /// `absolute`: m. In a periodic cell an image of the place may lie in a cell.
  Found at(const Eigen::Vector3d& absolute);

 private:
  /// What a cell lies in.
  struct Block {
    Eigen::Vector3d lower, upper;
    int cell;
  };
  Block block_of(int cell) const;
  void list_blocks();
  void look_in(int cell, const Eigen::Vector3d& place, Found& best) const;
  Found at_home(const Eigen::Vector3d& place);

  FormerPressures old_;
  Eigen::Vector3d gradient_;
  Lattice lattice_;
  Eigen::Vector3d lower_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), upper_ = -lower_;
  int cell_ = 0;  ///< where the last walk has ended
  std::vector<Block> blocks_;  ///< by their lower bounds along x; where a walk came to nothing
  double widest_ = 0.0;        ///< of these along x, m
};

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "support/stages.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace support {

/// The unit cell in the middle of a lattice of `n` (odd) cells a side in the unit cube: its pores
/// and the flow through its periodic continuation, without any wall.
class PeriodicCell {
 public:
  PeriodicCell(const Stages& s, const std::vector<double>& conductances, int n)
      : stages_(s), conductances_(conductances), edge_(1.0 / n) {
    // shifted by irregular fractions, so that no pore lies on the border
    lower_ = Eigen::Vector3d::Constant((n / 2) * edge_) +
             edge_ * Eigen::Vector3d(0.0137, 0.0071, 0.0193);
    unknown_.assign(s.network.pores(), -1);
    for (int p = 0; p < s.network.pores(); ++p) {
      const Eigen::Array3d place = (s.network.pore_centres.col(p) - lower_).array();
      if ((place >= 0.0).all() && (place < edge_).all()) {
        unknown_[p] = static_cast<int>(pores_.size());
        pores_.push_back(p);
      }
    }
  }

  int pores() const { return static_cast<int>(pores_.size()); }

  /// mu k of the cell: mean flow per unit area for p = -x_axis + periodic, viscosity 1.
  double permeability(int axis) const {
    const int n = pores();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for_each_throat([&](int i, int j, double conductance, double drop, const auto&) {
      matrix(i, i) += conductance;
      matrix(i, j) -= conductance;
      b[i] -= conductance * drop;
    }, axis);
    matrix.row(0).setZero();
    matrix(0, 0) = 1.0;
    b[0] = 0.0;
    const Eigen::VectorXd p = matrix.partialPivLu().solve(b);
    double flow = 0.0;  // each throat is met from both of its pores
    for_each_throat([&](int i, int j, double conductance, double drop, const auto& length) {
      flow += 0.5 * conductance * (p[i] - p[j] + drop) * length[axis];
    }, axis);
    return flow / std::pow(edge_, 3);
  }

 private:
  /// Visits (pore, neighbour, conductance, drop of -x_axis to it, way to it) from each pore.
  template <class Visit>
  void for_each_throat(Visit&& visit, int axis) const {
    const pfv::PoreNetwork& network = stages_.network;
    for (int t = 0; t < network.throats(); ++t)
      for (const int side : {0, 1}) {
        const int from = network.throat_pores[t][side], to = network.throat_pores[t][1 - side];
        if (unknown_[from] < 0) continue;
        const Eigen::Vector3d way =
            network.pore_centres.col(to) - network.pore_centres.col(from);
        visit(unknown_[from], image_of(to), conductances_[t], way[axis], way);
      }
  }

  /// The pore of the cell of which pore p is a periodic image.
  int image_of(int p) const {
    Eigen::Vector3d place = stages_.network.pore_centres.col(p);
    for (int axis = 0; axis < 3; ++axis)
      place[axis] -= edge_ * std::floor((place[axis] - lower_[axis]) / edge_);
    for (std::size_t i = 0; i < pores_.size(); ++i)
      if ((stages_.network.pore_centres.col(pores_[i]) - place).norm() < 1e-6 * edge_)
        return static_cast<int>(i);
    throw std::logic_error("PeriodicCell: the network is not periodic");
  }

  const Stages& stages_;
  const std::vector<double>& conductances_;
  double edge_;
  Eigen::Vector3d lower_;
  std::vector<int> unknown_, pores_;
};

}  // namespace support

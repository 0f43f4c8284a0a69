// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/dense_packing.hpp"

#include "geometry/pi.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace pfv {
namespace {

/// Cells of the unit cube, each with the spheres whose centre it holds.
class CellList {
 public:
  CellList(const Eigen::Matrix3Xd& centres, double cell_size)
      : per_edge_(std::max(1, static_cast<int>(1.0 / cell_size))),
        first_(static_cast<std::size_t>(per_edge_) * per_edge_ * per_edge_, -1),
        next_(static_cast<std::size_t>(centres.cols()), -1) {
    for (int k = static_cast<int>(centres.cols()) - 1; k >= 0; --k) {
      int& head = first_[index(cell(centres.col(k)))];
      next_[k] = head;
      head = k;
    }
  }

  template <class Visit>
  void for_each_near(const Eigen::Vector3d& place, Visit&& visit) const {
    const Eigen::Vector3i middle = cell(place);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const Eigen::Vector3i c = middle + Eigen::Vector3i(dx, dy, dz);
          if ((c.array() < 0).any() || (c.array() >= per_edge_).any()) continue;
          for (int k = first_[index(c)]; k >= 0; k = next_[k]) visit(k);
        }
  }

 private:
  Eigen::Vector3i cell(const Eigen::Vector3d& place) const {
    return (place * per_edge_).cast<int>().cwiseMax(0).cwiseMin(per_edge_ - 1);
  }
  std::size_t index(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c[0]) * per_edge_ + c[1]) * per_edge_ + c[2];
  }
  int per_edge_;
  std::vector<int> first_, next_;
};

/// Each sphere in turn is pushed away from those that it overlaps, and back into the unit cube.
void push_apart(PackingArrays& packing) {
  Eigen::Matrix3Xd& x = packing.positions;
  const CellList cells(x, 1.3 * (2.0 * packing.radii.maxCoeff()));
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    const double r = packing.radii[k];
    const Eigen::Vector3d place = x.col(k);
    cells.for_each_near(place, [&](int l) {
      if (l == k) return;
      const Eigen::Vector3d apart = x.col(k) - x.col(l);
      const double distance = apart.norm(), overlap = r + packing.radii[l] - distance;
      if (overlap <= 0.0 || distance == 0.0) return;
      const Eigen::Vector3d push = 0.5 * overlap / distance * apart;
      x.col(k) += push;
      x.col(l) -= push;
    });
    x.col(k) = x.col(k).cwiseMax(r).cwiseMin(1.0 - r);
  }
}

}  // namespace

PackingArrays dense_packing(int spheres, double solid_fraction, double spread, unsigned seed,
                            int sweeps) {
  if (spheres < 1 || !(solid_fraction > 0.0) || !(solid_fraction <= 0.66) || !(spread >= 0.0) ||
      !(spread < 1.0) || sweeps < 0)
    throw InputError("a packing of " + std::to_string(spheres) + " spheres, solid fraction " +
                     detail::number_text(solid_fraction) + " and spread " + detail::number_text(spread) +
                     " cannot be made: give at least one sphere, a fraction in (0, 0.66] and a "
                     "spread in [0, 1)");
  std::mt19937_64 generator(seed);
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  PackingArrays packing;
  packing.ids = Packing::Ids::LinSpaced(spheres, 1, spheres);
  packing.positions.resize(3, spheres);
  packing.radii.resize(spheres);
  for (int k = 0; k < spheres; ++k) {
    packing.radii[k] = 1.0 + spread * (2.0 * uniform() - 1.0);
    for (int axis = 0; axis < 3; ++axis) packing.positions(axis, k) = uniform();
  }
  constexpr double ball = 4.0 / 3.0 * pi;
  packing.radii *= std::cbrt(solid_fraction / (ball * packing.radii.array().cube().sum()));
  for (int sweep = 0; sweep < sweeps; ++sweep) push_apart(packing);
  return packing;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/balance_terms.hpp"

#include "network/pore_boundaries.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

namespace pfv {

Totals totals_of(const Box& box, const std::vector<BoundaryPart>& parts) {
  std::vector<double> of_boundary(boundary_count(box), 0.0);
  Totals totals;
  for (const BoundaryPart& part : parts) {
    of_boundary[part.boundary] += part.inflow;
    totals.gross += std::abs(part.inflow);
  }
  for (const double q : of_boundary) (q > 0.0 ? totals.inflow : totals.outflow) += std::abs(q);
  return totals;
}

std::vector<OpeningResult> openings_of(const Box& box, const std::vector<BoundaryPart>& parts) {
  const auto faces = static_cast<int>(all_faces.size());
  std::vector<OpeningResult> openings(boundary_count(box) - faces);
  std::vector<double> sums(openings.size(), 0.0);
  for (const BoundaryPart& part : parts) {
    if (part.boundary < faces) continue;
    OpeningResult& opening = openings[part.boundary - faces];
    ++opening.pores;
    opening.flux += part.inflow;
    sums[part.boundary - faces] += part.pressure;
  }
  for (std::size_t i = 0; i < openings.size(); ++i) {
    openings[i].name = boundary_name(box, faces + static_cast<int>(i));
    if (openings[i].pores > 0)
      openings[i].pressure = sums[i] / static_cast<double>(openings[i].pores);
  }
  return openings;
}

double mass_error(const Totals& totals, double volume_rate, double storage_rate, double could) {
  const double largest =
      std::max({totals.inflow, totals.outflow, std::abs(volume_rate), std::abs(storage_rate)});
  const double scale = largest > 1e-9 * totals.gross ? largest : totals.gross;
  const double net = totals.inflow - totals.outflow - volume_rate - storage_rate;
  if (scale <= 1e-15 * could) return could > 0.0 ? net / could : 0.0;
  return scale > 0.0 ? net / scale : 0.0;
}

std::optional<int> axis_of_flow(const Box& box) {
  if (!box.patches.empty() || !box.regions.empty()) return {};
  int axis = -1, open = 0;
  for (const Face face : all_faces) {
    const Boundary& boundary = box[face].boundary;
    if (!boundary.is_open()) continue;
    if (boundary.profile) return {};
    ++open;
    if (open == 1) axis = axis_of(face);
    if (axis_of(face) != axis) return {};
  }
  if (open != 2 || box.periodic[axis]) return {};
  return axis;
}

std::optional<double> permeability_of(const Box& box, int axis, double viscosity,
                                      const Totals& totals, double difference) {
  if (!(difference > 0.0)) return {};
  const double length = box.upper[axis] - box.lower[axis];
  const double area = box.area(static_cast<Face>(2 * axis));
  const double rate = 0.5 * (totals.inflow + totals.outflow);
  return viscosity * rate * length / (difference * area);
}

double force_balance_error(const Eigen::Vector3d& sum, double largest_pressure, const Box& box,
                           double driven) {
  double largest_area = 0.0;
  for (const Face face : all_faces) largest_area = std::max(largest_area, box.area(face));
  const double scale = std::max(largest_pressure * largest_area, driven);
  return scale > 0.0 ? sum.norm() / scale : 0.0;
}

double relative_residual(const SymmetricMatrix& matrix, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& b) {
  const double scale = b.norm();
  if (b.size() == 0 || scale == 0.0) return 0.0;
  return (b - multiply(matrix, x)).norm() / scale;
}

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace pfv

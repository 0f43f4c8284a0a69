// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/balance_terms.hpp"

#include "network/pore_boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pfv {

BoundarySums sums_of(const Container& container, const std::vector<BoundaryPart>& parts) {
  BoundarySums sums;
  sums.inflow.setZero(boundary_count(container));
  sums.pressure = sums.parts = sums.inflow;
  for (const BoundaryPart& part : parts) {
    sums.inflow[part.boundary] += part.inflow;
    sums.pressure[part.boundary] += part.pressure;
    ++sums.parts[part.boundary];
    sums.gross += std::abs(part.inflow);
  }
  return sums;
}

Totals totals_of(const BoundarySums& sums) {
  Totals totals;
  totals.gross = sums.gross;
  for (const double q : sums.inflow) (q > 0.0 ? totals.inflow : totals.outflow) += std::abs(q);
  return totals;
}

std::vector<OpeningResult> openings_of(const Container& container, const BoundarySums& sums) {
  std::vector<OpeningResult> openings;
  for (int b = container.face_count(); b < boundary_count(container); ++b) {
    OpeningResult opening;
    opening.name = boundary_name(container, b);
    opening.pores = static_cast<std::int64_t>(sums.parts[b]);
    opening.flux = sums.inflow[b];
    if (opening.pores > 0) opening.pressure = sums.pressure[b] / sums.parts[b];
    openings.push_back(std::move(opening));
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

std::optional<std::array<int, 2>> faces_of_flow(const Container& container) {
  constexpr double parallel = 1e-9;
  if (!container.patches.empty() || !container.regions.empty()) return {};
  std::vector<int> open;
  for (int f = 0; f < container.face_count(); ++f) {
    const ContainerFace& face = container.faces[f];
    if (!face.boundary.is_open()) continue;
    if (face.boundary.profile || !face.surface.is_plane()) return {};
    open.push_back(f);
  }
  if (open.size() != 2) return {};
  const auto normal = [&](int i) { return container.faces[open[i]].surface.normal; };
  if (!((normal(0) + normal(1)).norm() < parallel)) return {};
  for (int axis = 0; axis < 3; ++axis)
    if (container.periodic[axis] && normal(0)[axis] != 0.0) return {};
  return std::array<int, 2>{open[0], open[1]};
}

std::optional<double> permeability_of(const Container& container, const std::array<int, 2>& faces,
                                      double viscosity, const Totals& totals,
                                      const std::array<double, 2>& pressures) {
  const double difference = std::abs(pressures[0] - pressures[1]);
  if (!(difference > 0.0)) return {};
  const double length =
      container.faces[faces[1]].surface.offset + container.faces[faces[0]].surface.offset;
  const double area = face_areas(container)[faces[pressures[0] >= pressures[1] ? 0 : 1]];
  if (!(area > 0.0)) return {};
  const double rate = 0.5 * (totals.inflow + totals.outflow);
  return viscosity * rate * length / (difference * area);
}

double force_balance_error(const Eigen::Vector3d& sum, double largest_pressure, const Container& container,
                           double driven) {
  const std::vector<double> areas = face_areas(container);
  const double scale = std::max(largest_pressure * *std::max_element(areas.begin(), areas.end()), driven);
  return scale > 0.0 ? sum.norm() / scale : 0.0;
}

}  // namespace pfv

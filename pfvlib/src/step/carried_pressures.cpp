// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/carried_pressures.hpp"

#include "network/canonical_order.hpp"
#include "network/pore_network.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

void SurvivingCell::meet(const Eigen::Vector3d& place, double pressure) {
  const Eigen::Vector3d way = place_ - place, periods = lattice_.displacement(lattice_.nearest(way));
  const double length = (way - periods).norm();
  if (!(length < least_)) return;
  least_ = length;
  pressure_ = pressure + gradient_.dot(periods);
}

FormerPlaces::FormerPlaces(const FormerPressures& old, const Eigen::Vector3d& gradient)
    : old_(old), gradient_(gradient) {
  if (!old_.network) return;
  lattice_ = old_.network->grains.spheres.lattice();
  for (int c = 0; c < old_.network->network.cells(); ++c) {
    const Block block = block_of(c);
    lower_ = lower_.cwiseMin(block.lower);
    upper_ = upper_.cwiseMax(block.upper);
  }
}

/// Between its spheres and as far as its walls stand, and a little wider than that.
FormerPlaces::Block FormerPlaces::block_of(int cell) const {
  const Spheres& vertices = old_.network->vertices;
  const Eigen::Vector3d& edges = vertices.edges;
  Block block{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), {}, cell};
  block.upper = -block.lower;
  for (const Vertex v : old_.network->network.cell_vertices[cell]) {
    if (!is_wall(v)) {
      block.lower = block.lower.cwiseMin(vertices.centres.col(v));
      block.upper = block.upper.cwiseMax(vertices.centres.col(v));
      continue;
    }
    const WallSurface& wall = vertices.wall(v);
    for (int axis = 0; axis < 3; ++axis) {
      if (wall.axis >= 0 && wall.axis != axis) continue;
      if (wall.axis < 0 || wall.surface.normal[axis] < 0.0) block.lower[axis] = std::min(block.lower[axis], 0.0);
      if (wall.axis < 0 || wall.surface.normal[axis] > 0.0) block.upper[axis] = std::max(block.upper[axis], edges[axis]);
    }
  }
  const double round_off = 1e-9 * edges.maxCoeff();
  block.lower.array() -= round_off;
  block.upper.array() += round_off;
  return block;
}

void FormerPlaces::list_blocks() {
  for (int c = 0; c < old_.network->network.cells(); ++c) {
    if (!old_.network->share.has_whole(old_.network->network.cell_pore[c])) continue;
    blocks_.push_back(block_of(c));
    widest_ = std::max(widest_, blocks_.back().upper[0] - blocks_.back().lower[0]);
  }
  std::sort(blocks_.begin(), blocks_.end(), [](const Block& a, const Block& b) { return a.lower[0] < b.lower[0]; });
}

void FormerPlaces::look_in(int cell, const Eigen::Vector3d& place, Found& best) const {
  const PoreNetwork& network = old_.network->network;
  const double outside = std::max(0.0, distance_outside(network, old_.network->vertices, place, cell));
  if (outside < best.outside) best = {outside, old_.values[network.cell_pore[cell]]};
}

/// In a cell, but for rounding, whose image it is not.
FormerPlaces::Found FormerPlaces::at_home(const Eigen::Vector3d& place) {
  const BuiltNetwork& built = *old_.network;
  Found best{std::numeric_limits<double>::infinity(), 0.0};
  if (const int cell = walk_to(built.network, built.vertices, place, cell_); cell >= 0) {
    cell_ = cell;
    if (built.share.has_whole(built.network.cell_pore[cell])) look_in(cell, place, best);
    return best;
  }
  if (blocks_.empty()) list_blocks();
  const auto begins_before = [](double x) { return [x](const Block& block) { return block.lower[0] < x; }; };
  auto block = std::partition_point(blocks_.begin(), blocks_.end(), begins_before(place[0] - widest_));
  for (; block != blocks_.end() && block->lower[0] <= place[0]; ++block)
    if ((place.array() >= block->lower.array()).all() && (place.array() <= block->upper.array()).all())
      look_in(block->cell, place, best);
  return best;
}

FormerPlaces::Found FormerPlaces::at(const Eigen::Vector3d& absolute) {
  Found best{std::numeric_limits<double>::infinity(), 0.0};
  if (!(lower_.array() <= upper_.array()).all()) return best;
  Eigen::Vector3d place = absolute - old_.network->network.origin;
  for (int axis = 0; axis < 3; ++axis)
    if (!lattice_.periodic[axis]) place[axis] = std::clamp(place[axis], 0.0, old_.network->vertices.edges[axis]);
  std::vector<Lattice::Shift> shifts = lattice_.between(lower_ - place, upper_ - place);
  std::stable_partition(shifts.begin(), shifts.end(), [](const auto& shift) { return shift == Lattice::here; });
  for (const Lattice::Shift& shift : shifts) {
    const Eigen::Vector3d way = lattice_.displacement(shift);
    const Found found = at_home(place + way);
    if (found.outside < best.outside) best = {found.outside, found.pressure - gradient_.dot(way)};
    if (best.outside == 0.0) break;
  }
  const BuiltNetwork& built = *old_.network;
  if (!built.share.ranks && !std::isfinite(best.outside))  // by rounding; nobody else has it
    look_in(locate(built.network, built.vertices, place, cell_), place, best);
  return best;
}

namespace {

/// The name of each cell with its number, by the names.
std::vector<std::pair<CellName, int>> named_cells(const BuiltNetwork& built) {
  std::vector<std::pair<CellName, int>> names(built.network.cells());
  for (int c = 0; c < built.network.cells(); ++c) names[c] = {cell_name(built.network.cell_vertices[c], built.vertices), c};
  std::sort(names.begin(), names.end());
  return names;
}

/// Of each pore of `now` the sum of the pressures of its cells that were there before, and how many there are.
void add_survivors(const FormerPressures& old, const BuiltNetwork& now, Eigen::VectorXd& sum, Eigen::VectorXi& count) {
  const auto before = named_cells(*old.network);
  std::vector<std::optional<double>> survivors(now.network.cells());
  auto next = before.begin();
  for (const auto& [name, cell] : named_cells(now)) {
    while (next != before.end() && next->first < name) ++next;
    SurvivingCell survivor(centre_of_cell(now, cell), now);
    for (auto same = next; same != before.end() && same->first == name; ++same)
      survivor.meet(centre_of_cell(*old.network, same->second), old.values[old.network->network.cell_pore[same->second]]);
    survivors[cell] = survivor.pressure();
  }
  for (int c = 0; c < now.network.cells(); ++c) {
    if (!survivors[c]) continue;
    sum[now.network.cell_pore[c]] += *survivors[c];
    ++count[now.network.cell_pore[c]];
  }
}

}  // namespace

Eigen::VectorXd carried_pressures(const FormerPressures& old, const BuiltNetwork& now) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(now.network.pores());
  if (old.network->network.cells() == 0 || now.network.pores() == 0) return values;
  // a cell that survives keeps its pressure: its dual vertex need not lie in it, so its place is no
  // guide to it
  Eigen::VectorXi count = Eigen::VectorXi::Zero(now.network.pores());
  add_survivors(old, now, values, count);
  FormerPlaces places(old, now.container.pressure_gradient);
  for (int p = 0; p < now.network.pores(); ++p)
    values[p] = count[p] > 0 ? values[p] / count[p]
                             : places.at(now.network.origin + now.network.pore_centres.col(p)).pressure;
  // the sum of V^f p is what the storage term conserves (thesis eq. 4.8 with compressibility)
  const Eigen::VectorXd before = storage_volumes(old.network->throats);
  const Eigen::VectorXd after = storage_volumes(now.throats);
  values.array() += (before.dot(old.values) - after.dot(values)) / after.sum();
  return values;
}

}  // namespace pfv

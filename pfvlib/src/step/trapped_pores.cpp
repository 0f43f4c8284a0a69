// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/trapped_pores.hpp"

#include "network/disjoint_sets.hpp"
#include "physics/macroscopic_gradient.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

constexpr int untrapped = -1;  // in no trapped set

/// A closed throat between a trapped set and another, or what is no set.
struct Side {
  int set, other;
  double area;     ///< m²
  double surplus;  ///< area times what the pressure in `set` is above that behind the throat, N
};

/// The set of each pore, ghosts included.
std::vector<int> sets_of_pores(const BuiltNetwork& built, const std::vector<Isolated>& isolated) {
  Eigen::VectorXd set = Eigen::VectorXd::Constant(built.network.pores(), untrapped);
  for (std::size_t i = 0; i < isolated.size(); ++i)
    if (!isolated[i].main)
      for (const int pore : isolated[i].pores) set[pore] = static_cast<double>(i);
  if (built.share.ranks) built.share.pores.refresh(*built.share.ranks, set);
  std::vector<int> sets(built.network.pores());
  for (int pore = 0; pore < built.network.pores(); ++pore) sets[pore] = static_cast<int>(set[pore]);
  return sets;
}

std::vector<Side> closed_sides(const BuiltNetwork& built, const std::vector<int>& sets, const Solution& solution) {
  const PoreNetwork& network = built.network;
  std::vector<char> solid(network.pores(), 0);
  for (const int pore : built.unknowns.enclosed_pores) solid[pore] = 1;
  std::vector<Side> sides;
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    if (sets[i] == sets[j] || !built.share.owns_pore(i) || solid[i] || solid[j]) continue;
    const double area = std::abs(built.throats.area[t]);
    const double surplus = area * driving_pressure(network, t, solution.relative_pressures,
                                                   solution.container.pressure_gradient);
    if (sets[i] != untrapped) sides.push_back({sets[i], sets[j], area, surplus});
    else sides.push_back({sets[j], untrapped, area, -surplus});
  }
  return sides;
}

/// Those of all ranks, in the order of the ranks.
std::vector<Side> sides_of_all(std::vector<Side> sides, const Share& share) {
  if (!share.ranks) return sides;
  Ranks::Bytes bytes;
  append(bytes, sides.data(), sides.size());
  sides.clear();
  for (const Ranks::Bytes& part : share.ranks->gather(bytes))
    for (const Side& side : values_in<Side>(part)) sides.push_back(side);
  return sides;
}

/// Sets that no way over closed throats leads from to what is no set: the first of them stays as it is.
std::vector<char> kept_as_they_are(const std::vector<Side>& sides, int count) {
  DisjointSets joined(count + 1);  // the last: what is no set
  for (const Side& side : sides)
    if (side.area > 0.0) joined.join(side.set, side.other == untrapped ? count : side.other);
  std::vector<char> kept(count, 0), known(count + 1, 0);
  known[joined.find(count)] = 1;
  for (int set = 0; set < count; ++set) {
    char& is_known = known[joined.find(set)];
    kept[set] = !is_known;
    is_known = 1;
  }
  return kept;
}

/// What to add to the pressures of each set, Pa.
Eigen::VectorXd shifts_of(const std::vector<Side>& sides, int count) {
  const std::vector<char> kept = kept_as_they_are(sides, count);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(count), right = diagonal;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Side& side : sides) {
    diagonal[side.set] += side.area;
    right[side.set] -= side.surplus;
    if (side.other == untrapped) continue;
    diagonal[side.other] += side.area;
    right[side.other] += side.surplus;
    if (kept[side.set] || kept[side.other]) continue;
    entries.emplace_back(side.set, side.other, -side.area);
    entries.emplace_back(side.other, side.set, -side.area);
  }
  for (int set = 0; set < count; ++set) {
    if (kept[set]) right[set] = 0.0;
    entries.emplace_back(set, set, kept[set] ? 1.0 : diagonal[set]);
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  return factor.solve(right);
}

bool any_trapped(const std::vector<Isolated>& isolated) {
  return std::any_of(isolated.begin(), isolated.end(), [](const Isolated& set) { return !set.main; });
}

}  // namespace

void mark_main_fluid(BuiltNetwork& built) {
  std::vector<Isolated>& isolated = built.kept.system.isolated;
  if (isolated.empty() || built.share.any(!built.unknowns.imposed_pores.empty())) return;
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(isolated.size()));
  for (std::size_t i = 0; i < isolated.size(); ++i)
    for (const int pore : isolated[i].pores)
      volumes[static_cast<Eigen::Index>(i)] += built.throats.pore_fluid_volume[pore];
  built.share.add(volumes);
  Eigen::Index largest;
  volumes.maxCoeff(&largest);
  isolated[static_cast<std::size_t>(largest)].main = true;
}

std::int64_t trapped_pores(const BuiltNetwork& built) {
  double count = 0.0;
  for (const Isolated& set : built.kept.system.isolated)
    if (!set.main) count += static_cast<double>(set.pores.size());
  return static_cast<std::int64_t>(built.share.sum(count));
}

void level_trapped_pores(const BuiltNetwork& built, const std::vector<Isolated>& isolated, Solution& solution) {
  if (!any_trapped(isolated)) return;
  const std::vector<int> sets = sets_of_pores(built, isolated);
  const std::vector<Side> sides = sides_of_all(closed_sides(built, sets, solution), built.share);
  const Eigen::VectorXd shifts = shifts_of(sides, static_cast<int>(isolated.size()));
  for (std::size_t pore = 0; pore < sets.size(); ++pore)
    if (sets[pore] != untrapped)
      solution.relative_pressures[static_cast<Eigen::Index>(pore)] += shifts[sets[pore]];
}

}  // namespace pfv

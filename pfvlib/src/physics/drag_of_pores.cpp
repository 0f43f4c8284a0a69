// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/drag_of_pores.hpp"

#include <Eigen/Cholesky>

namespace pfv {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ThroatLists::ThroatLists(const PoreNetwork& network) : begin(network.pores() + 1, 0), throat(2 * network.throats()) {
  for (const auto& pores : network.throat_pores)
    for (const int pore : pores) ++begin[pore + 1];
  for (int p = 0; p < network.pores(); ++p) begin[p + 1] += begin[p];
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int t = 0; t < network.throats(); ++t)
    for (const int pore : network.throat_pores[t]) throat[next[pore]++] = t;
}

void PoreSources::add(int sphere, PoresAround& around) const {
  for (int e = matrix.row_begin[sphere]; e < matrix.row_begin[sphere + 1]; ++e) {
    const int pore = matrix.pore[e];
    if (imposed[pore]) continue;
    const auto [found, is_new] = around.sources.emplace(names[pore], Vector3d::Zero());
    found->second += matrix.value.col(e).head<3>();
    for (int l = lists.begin[pore]; l < lists.begin[pore + 1] && is_new; ++l) {
      const auto& [first, second] = network.throat_pores[lists.throat[l]];
      around.throats.push_back(
          {names[pore], names[first == pore ? second : first], conductances.value[lists.throat[l]]});
    }
  }
}

Matrix3d drag_of(const PoresAround& around) {
  const auto count = static_cast<Eigen::Index>(around.sources.size());
  if (count == 0) return Matrix3d::Zero();
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixX3d s(count, 3);
  std::map<std::int64_t, Eigen::Index> place;
  for (const auto& [pore, source] : around.sources) {
    s.row(static_cast<Eigen::Index>(place.size())) = source;
    place.emplace(pore, static_cast<Eigen::Index>(place.size()));
  }
  for (const PoresAround::Throat& throat : around.throats) {
    const Eigen::Index i = place.at(throat.pore);
    const auto other = place.find(throat.other);
    g(i, i) += throat.conductance;
    if (other != place.end()) g(i, other->second) -= throat.conductance;
  }
  for (Eigen::Index i = 0; i < count; ++i)
    if (g(i, i) == 0.0) s.row(i).setZero();  // closed: its pressure is that of another pore
  // a set without an imposed pressure is free to shift: the sources of a sphere add up to 0 in it
  g.diagonal().array() += 1e-10 * g.diagonal().maxCoeff();
  const Matrix3d drag = s.transpose() * g.ldlt().solve(s);
  return 0.5 * (drag + drag.transpose());
}

std::vector<std::int64_t> pore_names(const PoreNetwork& network, const Share& share) {
  std::vector<std::int64_t> names(network.pores());
  Eigen::VectorXd numbers(network.pores());  // exact up to 2^53
  double first = 0.0;
  if (share.ranks) {
    Eigen::VectorXd pores = Eigen::VectorXd::Zero(share.ranks->count());
    pores[share.ranks->own()] = network.pores();
    share.add(pores);
    first = pores.head(share.ranks->own()).sum();
  }
  for (int pore = 0; pore < network.pores(); ++pore) numbers[pore] = first + pore;
  if (share.ranks) share.pores.refresh(*share.ranks, numbers);
  for (int pore = 0; pore < network.pores(); ++pore) names[pore] = static_cast<std::int64_t>(numbers[pore]);
  return names;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/pore_strain.hpp"

#include "pfv/network.hpp"
#include "physics/conductances.hpp"
#include "physics/macroscopic_gradient.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

double sum_over_own(const std::vector<double>& volumes, const Share& share) {
  if (!share.ranks) return Eigen::Map<const Eigen::VectorXd>(volumes.data(), static_cast<Eigen::Index>(volumes.size())).sum();
  double sum = 0.0;
  for (std::size_t pore = 0; pore < volumes.size(); ++pore)
    if (share.own_pores[pore]) sum += volumes[pore];
  return sum;
}

}  // namespace

double mean_pore_strain(const PoreNetwork& network, const Conductances& conductances,
                        const Eigen::VectorXd& pressures, const Eigen::Vector3d& gradient,
                        const Eigen::VectorXd& changes, const std::vector<double>& volumes, const Share& share) {
  Eigen::VectorXd with_ghosts;
  if (share.ranks) {
    with_ghosts = changes;
    share.pores.refresh(*share.ranks, with_ghosts);
  }
  const Eigen::VectorXd& all = share.ranks ? with_ghosts : changes;
  const auto strain_of = [&](int pore) { return std::abs(all[pore]) / volumes[pore]; };
  double strained = 0.0, power = 0.0;
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    if (!share.owns_pore(i)) continue;
    const double pressure = driving_pressure(network, t, pressures, gradient);
    const double lost = conductances.value[t] * pressure * pressure;
    power += lost;
    strained += 0.5 * lost * (strain_of(i) + strain_of(j));
  }
  Eigen::Vector4d sums(strained, power, changes.cwiseAbs().sum(), sum_over_own(volumes, share));
  if (share.ranks) share.ranks->add(sums.data(), 4);
  const double of_space = sums[2] / sums[3];
  return std::max(of_space, sums[1] > 0.0 ? sums[0] / sums[1] : 0.0);
}

}  // namespace pfv

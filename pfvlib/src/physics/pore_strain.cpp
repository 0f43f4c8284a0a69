// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/pore_strain.hpp"

#include "pfv/network.hpp"
#include "physics/conductances.hpp"
#include "physics/macroscopic_gradient.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

double mean_pore_strain(const PoreNetwork& network, const Conductances& conductances,
                        const Eigen::VectorXd& pressures, const Eigen::Vector3d& gradient,
                        const Eigen::VectorXd& changes, const std::vector<double>& volumes) {
  const auto strain_of = [&](int pore) { return std::abs(changes[pore]) / volumes[pore]; };
  double strained = 0.0, power = 0.0;
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    const double pressure = driving_pressure(network, t, pressures, gradient);
    const double lost = conductances.value[t] * pressure * pressure;
    power += lost;
    strained += 0.5 * lost * (strain_of(i) + strain_of(j));
  }
  const Eigen::Map<const Eigen::VectorXd> volume(volumes.data(), changes.size());
  const double of_space = changes.cwiseAbs().sum() / volume.sum();
  return std::max(of_space, power > 0.0 ? strained / power : 0.0);
}

}  // namespace pfv

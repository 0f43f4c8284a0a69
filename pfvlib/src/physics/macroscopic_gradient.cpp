// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/macroscopic_gradient.hpp"

namespace pfv {

double driving_pressure(const PoreNetwork& network, int throat, const Eigen::VectorXd& pressures,
                        const Eigen::Vector3d& gradient) {
  const auto [i, j] = network.throat_pores[throat];
  double difference = pressures[i] - pressures[j];
  if (network.throat_offsets.cols() > 0)
    difference -= gradient.dot(network.throat_offsets.col(throat));
  return difference;
}

Eigen::VectorXd gradient_sources(const PoreNetwork& network,
                                 const std::vector<double>& conductances,
                                 const Eigen::Vector3d& gradient) {
  Eigen::VectorXd sources = Eigen::VectorXd::Zero(network.pores());
  for (int t = 0; t < network.throats(); ++t) {
    const auto [i, j] = network.throat_pores[t];
    if (i == j) continue;  // what goes out to its own image comes in from it
    const double rate = conductances[t] * gradient.dot(network.throat_offset(t));
    sources[i] += rate;
    sources[j] -= rate;
  }
  return sources;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/time_step_limit.hpp"

#include <cmath>
#include <random>

namespace pfv {

double largest_eigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& drag,
                          Eigen::Index size) {
  constexpr int fewest = 10, most = 60;
  constexpr double settled = 1e-3, from_below = 1.03;
  std::mt19937_64 generator(20120101);
  Eigen::VectorXd v(size);
  for (Eigen::Index i = 0; i < size; ++i)
    v[i] = static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5;
  double eigenvalue = 0.0;
  for (int iteration = 0; iteration < most; ++iteration) {
    const double norm = v.norm(), before = eigenvalue;
    if (norm == 0.0) return 0.0;
    v = drag(v / norm);
    eigenvalue = v.norm();
    if (iteration >= fewest && std::abs(eigenvalue - before) < settled * eigenvalue) break;
  }
  return from_below * eigenvalue;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/time_step_limit.hpp"

#include <cmath>
#include <random>

namespace pfv {

double largest_eigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& drag,
                          Eigen::Index size) {
  constexpr int iterations = 20;
  constexpr double from_below = 1.1;
  std::mt19937_64 generator(20120101);
  Eigen::VectorXd v(size);
  for (Eigen::Index i = 0; i < size; ++i)
    v[i] = static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5;
  double eigenvalue = 0.0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const double norm = v.norm();
    if (norm == 0.0) return 0.0;
    v = drag(v / norm);
    eigenvalue = v.norm();
  }
  return from_below * eigenvalue;
}

}  // namespace pfv

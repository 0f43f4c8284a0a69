// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/time_step_limit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace pfv {

namespace {

/// The largest eigenpair of a symmetric tridiagonal matrix: its value and the last entry of its vector.
std::pair<double, double> largest_of(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const auto size = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), size),
                                Eigen::Map<const Eigen::VectorXd>(beside.data(), size - 1));
  return {solver.eigenvalues()[size - 1], solver.eigenvectors()(size - 1, size - 1)};
}

}  // namespace

Eigen::VectorXd pseudo_random(Eigen::Index size) {
  std::mt19937_64 generator(20120101);
  Eigen::VectorXd v(size);
  for (Eigen::Index i = 0; i < size; ++i)
    v[i] = static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5;
  return v;
}

double largest_eigenvalue(const VectorMap& symmetric, const Eigen::VectorXd& start, const Product& product) {
  constexpr int most = 100;
  constexpr double settled = 1e-3, nothing = 1e-14;
  Eigen::VectorXd before = Eigen::VectorXd::Zero(start.size()), v = start;
  std::vector<double> diagonal, beside;
  double length = std::sqrt(product(v, v)), eigenvalue = 0.0, residual = 0.0;
  if (length == 0.0) return 0.0;
  v /= length;
  while (static_cast<int>(diagonal.size()) < most) {
    Eigen::VectorXd next = symmetric(v);
    if (!beside.empty()) next -= beside.back() * before;
    diagonal.push_back(product(next, v));
    next -= diagonal.back() * v;
    length = std::sqrt(product(next, next));
    const auto [value, last] = largest_of(diagonal, beside);
    eigenvalue = std::max(value, 0.0);
    residual = length * std::abs(last);
    if (residual <= settled * eigenvalue || length <= nothing * eigenvalue || length == 0.0) break;
    beside.push_back(length);
    before = std::move(v);
    v = next / length;
  }
  return eigenvalue + residual;
}

double largest_eigenvalue_of_any(const VectorMap& drag, Eigen::Index size) {
  constexpr int fewest = 10, most = 60;
  constexpr double settled = 1e-3, from_below = 1.03;
  Eigen::VectorXd v = pseudo_random(size);
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

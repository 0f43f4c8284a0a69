// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/last_solutions.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace pfv {
namespace {

/// The shortest c with P c = s, without the directions in which P is nothing but rounding.
Eigen::VectorXd combination(const Eigen::MatrixXd& products, const Eigen::VectorXd& sums) {
  constexpr double rounding = 1e-12;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(products);
  const Eigen::ArrayXd values = parts.eigenvalues();
  const Eigen::ArrayXd along = parts.eigenvectors().transpose() * sums;
  return parts.eigenvectors() * (values > rounding * values.maxCoeff()).select(along / values, 0.0).matrix();
}

}  // namespace

void LastSolutions::forget() {
  last_.resize(0);
  changes_.clear();
  products_.resize(0, 0);
}

void LastSolutions::add(Eigen::VectorXd change, const Eigen::VectorXd& product) {
  if (changes_.size() == most_) {
    changes_.pop_front();
    const Eigen::Index left = products_.rows() - 1;
    products_ = products_.bottomRightCorner(left, left).eval();
  }
  changes_.push_back(std::move(change));
  const Eigen::Index count = products_.rows() + 1;
  products_.conservativeResize(count, count);
  for (Eigen::Index k = 0; k < count; ++k)
    products_(k, count - 1) = products_(count - 1, k) = changes_[static_cast<std::size_t>(k)].dot(product);
}

void LastSolutions::remember(const SymmetricMatrix& matrix, const Eigen::VectorXd& x) {
  if (most_ == 0) return;
  if (last_.size() != x.size()) last_.setZero(x.size());
  const Eigen::VectorXd change = x - last_, product = multiply(matrix, change);
  const double length = std::sqrt(change.dot(product));
  if (length > 0.0) add(change / length, product / length);
  last_ = x;
}

void LastSolutions::begin(const SymmetricMatrix& matrix, const Eigen::VectorXd& r, Eigen::VectorXd& x) {
  remember(matrix, x);
  if (changes_.empty()) return;
  Eigen::VectorXd sums(products_.rows());
  for (Eigen::Index k = 0; k < sums.size(); ++k) sums[k] = changes_[static_cast<std::size_t>(k)].dot(r);
  const Eigen::VectorXd parts = combination(products_, sums);
  for (Eigen::Index k = 0; k < parts.size(); ++k) x += parts[k] * changes_[static_cast<std::size_t>(k)];
}

}  // namespace pfv

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

void LastSolutions::forget(const Ranks* ranks) {
  ranks_ = ranks;
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
  products_.col(count - 1) = products_with(product);
  products_.row(count - 1) = products_.col(count - 1).transpose();
}

/// Of each change, over all ranks.
Eigen::VectorXd LastSolutions::products_with(const Eigen::VectorXd& r) const {
  Eigen::VectorXd sums(static_cast<Eigen::Index>(changes_.size()));
  for (Eigen::Index k = 0; k < sums.size(); ++k) sums[k] = changes_[static_cast<std::size_t>(k)].dot(r);
  if (ranks_) ranks_->add(sums.data(), changes_.size());
  return sums;
}

void LastSolutions::remember(const SymmetricMatrix& matrix, const Eigen::VectorXd& x) {
  if (most_ == 0) return;
  if (last_.size() != x.size()) last_.setZero(x.size());
  const Eigen::VectorXd change = x - last_, product = multiply(matrix, change);
  const double square = change.dot(product), length = std::sqrt(ranks_ ? ranks_->sum(square) : square);
  if (length > 0.0) add(change / length, product / length);
  last_ = x;
}

void LastSolutions::begin(const SymmetricMatrix& matrix, const Eigen::VectorXd& r, Eigen::VectorXd& x) {
  remember(matrix, x);
  if (changes_.empty()) return;
  const Eigen::VectorXd parts = combination(products_, products_with(r));
  for (Eigen::Index k = 0; k < parts.size(); ++k) x += parts[k] * changes_[static_cast<std::size_t>(k)];
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

namespace pfv {

using VectorMap = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
using Product = std::function<double(const Eigen::VectorXd&, const Eigen::VectorXd&)>;

/// A pseudo-random start of an iteration, always the same: entries from -0.5 to 0.5.
Eigen::VectorXd pseudo_random(Eigen::Index size);

/// Largest eigenvalue of a symmetric operator without negative ones (1/s of the drag M^-1/2 S G^-1 S^T M^-1/2), by
/// Lanczos' iteration from `start` until the residual of its pair is below 0.1 % of it, which is added: a limit made of
/// it is rather short than long (Parlett 1998, sec. 13.2). Cost: some 15 to 35 applications, at most 100. `product`: inner product of two vectors; several ranks each have a part of them, and the product of all.
double largest_eigenvalue(
    const VectorMap& symmetric, const Eigen::VectorXd& start,
    const Product& product = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return a.dot(b); });

/// The same of one that is not quite symmetric (geometric volume rates, the Darcy grid), by power iteration from a
/// pseudo-random start, until an iteration changes it by less than 0.1 % (at most 60 of them). It comes from below and
/// is 1 to 2 % short then, more where many are nearly as large; 3 % are added.
double largest_eigenvalue_of_any(const VectorMap& drag, Eigen::Index size);

}  // namespace pfv

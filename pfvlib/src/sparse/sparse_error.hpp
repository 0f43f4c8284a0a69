// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace pfv {

/// What orderings and factorisations throw; `what()` is one line.
class SparseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Elimination has left a pivot that is not positive or nothing but rounding.
class NotPositiveDefinite : public SparseError {
 public:
  explicit NotPositiveDefinite(int row)
      : SparseError("the matrix is not positive definite at row " + std::to_string(row)) {}
};

}  // namespace pfv

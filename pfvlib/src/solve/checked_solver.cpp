// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/checked_solver.hpp"

#include "pfv/error.hpp"
#include "sparse/sparse_error.hpp"

#include <cmath>

namespace pfv {
namespace {

/// Trilinos' messages run over several lines; what went wrong is in the last one.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of("\n ") + 1);
  return text.substr(text.find_last_of('\n') + 1);
}

}  // namespace

void CheckedSolver::fail(const std::string& message) const {
  throw SolverError(name() + ": " + message);
}

void CheckedSolver::require(bool condition, const char* message) const {
  if (!condition) fail(message);
}

void CheckedSolver::require_finite_values(const SymmetricMatrix& matrix) const {
  for (int row = 0; row < matrix.size(); ++row) {
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      if (std::isfinite(matrix.value[k])) continue;
      fail("the matrix entry in row " + std::to_string(row) + ", column " +
           std::to_string(matrix.column[k]) +
           " is not finite; look for a throat with a conductance that is not");
    }
  }
}

/// Runs a phase; whatever Trilinos or the memory allocator throws becomes a SolverError.
template <class Phase>
void CheckedSolver::guarded(const char* phase_name, const Phase& phase) const {
  const auto what = [&] {
    return std::string(phase_name) + " of " + std::to_string(size_) + " unknowns ";
  };
  try {
    phase();
  } catch (const Error&) {
    throw;
  } catch (const NotPositiveDefinite& error) {
    fail(std::string(error.what()) + ": nothing determines the pressure of a group of pores, or a "
         "conductance is negative; impose a pressure on a face or patch that the group reaches");
  } catch (const SparseError& error) {
    fail(error.what());
  } catch (const std::bad_alloc&) {
    fail(what() + "ran out of memory; use fewer spheres or more memory");
  } catch (const std::exception& error) {
    fail(what() + "failed: " + last_line(error.what()));
  }
}

void CheckedSolver::together(const std::function<void()>& check) const {
  if (ranks()) ranks()->together(check);
  else check();
}

void CheckedSolver::order(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) {
  is_ordered_ = is_factored_ = false;
  size_ = matrix.size();
  if (!is_idle()) guarded("ordering", [&] { analyze_pattern(matrix, coordinates); });
  is_ordered_ = true;
}

void CheckedSolver::factor(const SymmetricMatrix& matrix) {
  is_factored_ = false;
  require(is_ordered_, "factor was called before order");
  require(matrix.size() == size_, "factor was given a matrix of another size than order");
  if (!is_idle()) {
    together([&] {
      require(has_pattern_of(matrix), "factor was given another pattern than order");
      require_finite_values(matrix);
    });
    guarded("factorisation", [&] { factor_values(matrix); });
  }
  is_factored_ = true;
}

void CheckedSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  require(is_factored_, "solve was called without a factor");
  require(b.size() == size_, "the right-hand side has another length than the matrix");
  if (x.size() != size_) x.setZero(size_);
  if (is_idle()) return;
  guarded("solve", [&] { solve_system(b, x); });
  together([&] {
    require(x.allFinite(), "the solution is not finite; look at the boundary pressures, fluxes and "
                           "velocities and at the scale of the conductances");
  });
}

}  // namespace pfv

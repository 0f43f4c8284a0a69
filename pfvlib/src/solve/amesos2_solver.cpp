// SPDX-License-Identifier: GPL-3.0-or-later
// With tacho_cholesky.cpp the only translation unit that includes Trilinos.
#include "solve/amesos2_cholesky.hpp"
#include "solve/checked_solver.hpp"
#include "solve/fill_reducing_ordering.hpp"
#include "problem/solver_abilities.hpp"
#include "sparse/sparse_error.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

namespace pfv {
namespace {

using Matrix = Tpetra::CrsMatrix<double>;
using Vector = Tpetra::MultiVector<double>;
using Map = Tpetra::Map<>;
using LocalMatrix = Matrix::local_matrix_device_type;

/// Kokkos from the first solver to the last one or to the end of the program, whichever is later;
/// that of the host program, where it has started one.
class KokkosSession {
 public:
  static std::shared_ptr<KokkosSession> shared() {
    static const auto session = std::make_shared<KokkosSession>();
    return session;
  }
  KokkosSession() {
    if (Kokkos::is_initialized()) return;
    Kokkos::InitArguments arguments;
    arguments.num_threads = 1;
    arguments.disable_warnings = true;
    Kokkos::initialize(arguments);
    is_ours_ = true;
  }
  ~KokkosSession() {
    if (is_ours_ && Kokkos::is_initialized()) Kokkos::finalize();
  }
  KokkosSession(const KokkosSession&) = delete;
  KokkosSession& operator=(const KokkosSession&) = delete;

 private:
  bool is_ours_ = false;
};

/// Room for the values of a matrix with the given pattern.
Teuchos::RCP<Matrix> tpetra_pattern(const SymmetricMatrix& matrix) {
  const Teuchos::RCP<const Teuchos::Comm<int>> alone = Teuchos::rcp(new Teuchos::SerialComm<int>());
  const auto map = Teuchos::rcp(new Map(matrix.size(), 0, alone));
  LocalMatrix::row_map_type::non_const_type row_begin("row_begin", matrix.row_begin.size());
  LocalMatrix::index_type column("column", matrix.column.size());
  LocalMatrix::values_type value("value", matrix.column.size());
  std::copy(matrix.row_begin.begin(), matrix.row_begin.end(), row_begin.data());
  std::copy(matrix.column.begin(), matrix.column.end(), column.data());
  const LocalMatrix local("pressure system", matrix.size(), matrix.size(), matrix.column.size(),
                          value, row_begin, column);
  return Teuchos::rcp(new Matrix(local, map, map, map, map));
}

class Amesos2Solver final : public CheckedSolver {
 public:
  Amesos2Solver(SolverKind solver, const Options& options, std::shared_ptr<CholeskyFactor> factor,
                std::shared_ptr<Team> team)
      : CheckedSolver(solver),
        ordering_(options.ordering == OrderingKind::automatic && solver == SolverKind::tacho
                      ? resolved(solver, options.ordering)
                      : options.ordering),
        is_mixed_(options.precision == Precision::mixed),
        team_(std::move(team)),
        factor_(std::move(factor)) {}
  ~Amesos2Solver() override {
    const Turn turn(libraries_mutex);
    amesos2_ = {};
    solution_ = right_side_ = {};
    matrix_ = {};
  }
  void share_with(std::shared_ptr<Team> team) override {
    team_ = std::move(team);
    const Turn turn(libraries_mutex);
    if (factor_ && !amesos2_.is_null())
      Teuchos::rcp_dynamic_cast<Amesos2Cholesky<Matrix, Vector>>(amesos2_)->share_with(team_);
  }
  Amesos2Solver(const Amesos2Solver&) = delete;
  Amesos2Solver& operator=(const Amesos2Solver&) = delete;

 private:
  using Turn = std::lock_guard<std::mutex>;

  void analyze_pattern(const SymmetricMatrix& matrix,
                       const Eigen::Matrix3Xd& coordinates) override {
    std::vector<int> permutation;
    if (factor_)
      permutation = fill_reducing_ordering(ordering_, matrix, coordinates, *team_);
    const Turn turn(libraries_mutex);
    amesos2_ = {};
    matrix_ = tpetra_pattern(matrix);
    right_side_ = Teuchos::rcp(new Vector(matrix_->getRangeMap(), 1));
    solution_ = Teuchos::rcp(new Vector(matrix_->getDomainMap(), 1));
    if (kind() == SolverKind::klu2) {
      amesos2_ = Amesos2::create<Matrix, Vector>("KLU2", matrix_);
    } else {
      amesos2_ = Teuchos::rcp(new Amesos2Cholesky<Matrix, Vector>(
          matrix_, std::move(permutation), factor_, team_));
      if (is_mixed_) row_begin_ = matrix.row_begin;
    }
    amesos2_->symbolicFactorization();
  }

  bool has_pattern_of(const SymmetricMatrix& matrix) const override {
    const Turn turn(libraries_mutex);
    const auto graph = matrix_->getLocalMatrixDevice().graph;
    return matrix.column.size() == graph.entries.size() &&
           std::equal(matrix.column.begin(), matrix.column.end(), graph.entries.data()) &&
           std::equal(matrix.row_begin.begin(), matrix.row_begin.end(), graph.row_map.data(),
                      [](int a, std::size_t b) { return static_cast<std::size_t>(a) == b; });
  }

  void factor_values(const SymmetricMatrix& matrix) override {
    const Turn turn(libraries_mutex);
    std::copy(matrix.value.begin(), matrix.value.end(),
              matrix_->getLocalMatrixDevice().values.data());
    amesos2_->numericFactorization();
    if (kind() == SolverKind::klu2 || kind() == SolverKind::tacho) refuse_lost_pressures(matrix);
  }

  /// These solvers stop at a pivot that is 0 (or negative), and do not tell one that is nothing but
  /// rounding. Pressures that nothing determines are equal in each group of pores: then the solution of
  /// A x = A 1 is not 1.
  void refuse_lost_pressures(const SymmetricMatrix& matrix) {
    constexpr double lost_digits = 1e-3;
    Eigen::VectorXd x(size());
    solve_once(multiply(matrix, Eigen::VectorXd::Ones(size())), x);
    Eigen::Index row = 0;
    const double error = (x.array() - 1.0).abs().maxCoeff(&row);
    if (!(error < lost_digits)) throw NotPositiveDefinite(static_cast<int>(row));
  }

  void solve_system(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    const Turn turn(libraries_mutex);
    if (is_mixed_)
      refine(b, x);
    else
      solve_once(b, x);
  }

  void solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    std::copy(b.begin(), b.end(), right_side_->getDataNonConst(0).begin());
    amesos2_->solve(solution_.get(), right_side_.get());
    const auto solution = solution_->getData(0);
    std::copy(solution.begin(), solution.end(), x.begin());
  }

  /// Each solve takes some seven digits off the residual (Wilkinson's refinement).
  void refine(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    constexpr double tolerance = 1e-9;
    constexpr int most_solves = 8;
    const double target = tolerance * b.norm();
    if (target == 0.0) {
      x.setZero();
      return;
    }
    for (int solves = 0;; ++solves) {
      subtract_product(b, x);
      const double left = residual_.norm();
      if (left <= target) return;
      if (solves == most_solves || !std::isfinite(left))
        fail("mixed precision stops at a residual of " + std::to_string(left / b.norm()) +
             " of the right-hand side; the conductances span too many orders of magnitude for it: "
             "use the precision double");
      solve_once(residual_, correction_);
      x += correction_;
    }
  }

  /// residual = b - A x.
  void subtract_product(const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
    residual_.resize(size());
    correction_.resize(size());
    const auto local = matrix_->getLocalMatrixDevice();
    const int* column = local.graph.entries.data();
    const double* value = local.values.data();
    team_->run_rows(row_begin_.data(), size(), [&](int first, int last) {
      for (int row = first; row < last; ++row) {
        double sum = b[row];
        for (int k = row_begin_[row]; k < row_begin_[row + 1]; ++k) sum -= value[k] * x[column[k]];
        residual_[row] = sum;
      }
    });
  }

  // First, so that Kokkos outlives what it allocated.
  std::shared_ptr<KokkosSession> kokkos_ = KokkosSession::shared();
  OrderingKind ordering_;
  bool is_mixed_;
  std::shared_ptr<Team> team_;
  std::shared_ptr<CholeskyFactor> factor_;  // or null; its memory serves one matrix after the other
  std::vector<int> row_begin_;  // of mixed precision, as is what follows
  Eigen::VectorXd residual_, correction_;
  Teuchos::RCP<Matrix> matrix_;
  Teuchos::RCP<Vector> right_side_;
  Teuchos::RCP<Vector> solution_;
  Teuchos::RCP<Amesos2::Solver<Matrix, Vector>> amesos2_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_amesos2_solver(const Options& options, std::shared_ptr<CholeskyFactor> factor,
                                                  std::shared_ptr<Team> team) {
  return std::make_unique<Amesos2Solver>(resolved(options.solver), options, std::move(factor), std::move(team));
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// The only translation unit that includes Trilinos.
#include "solve/amesos2_solver.hpp"

#include "pfv/error.hpp"
#include "solve/amesos2_cholmod.hpp"
#include "solve/ordering.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>

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
  const auto communicator = Teuchos::rcp(new Teuchos::SerialComm<int>());
  const auto map = Teuchos::rcp(new Map(matrix.size(), 0, communicator));
  LocalMatrix::row_map_type::non_const_type row_begin("row_begin", matrix.row_begin.size());
  LocalMatrix::index_type column("column", matrix.column.size());
  LocalMatrix::values_type value("value", matrix.column.size());
  std::copy(matrix.row_begin.begin(), matrix.row_begin.end(), row_begin.data());
  std::copy(matrix.column.begin(), matrix.column.end(), column.data());
  const LocalMatrix local("pressure system", matrix.size(), matrix.size(), matrix.column.size(),
                          value, row_begin, column);
  return Teuchos::rcp(new Matrix(local, map, map, map, map));
}

bool has_pattern_of(const LocalMatrix& local, const SymmetricMatrix& matrix) {
  const auto& graph = local.graph;
  return matrix.column.size() == graph.entries.size() &&
         std::equal(matrix.column.begin(), matrix.column.end(), graph.entries.data()) &&
         std::equal(matrix.row_begin.begin(), matrix.row_begin.end(), graph.row_map.data(),
                    [](int a, std::size_t b) { return static_cast<std::size_t>(a) == b; });
}

void require_finite_values(const SymmetricMatrix& matrix, const std::string& solver) {
  for (int row = 0; row < matrix.size(); ++row) {
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      if (std::isfinite(matrix.value[k])) continue;
      throw SolverError(solver + ": the matrix entry in row " + std::to_string(row) + ", column " +
                        std::to_string(matrix.column[k]) +
                        " is not finite; look for a throat with a conductance that is not");
    }
  }
}

/// Trilinos' messages run over several lines; what went wrong is in the last one.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of("\n ") + 1);
  return text.substr(text.find_last_of('\n') + 1);
}

class Amesos2Solver final : public LinearSolver {
 public:
  Amesos2Solver(SolverKind solver, OrderingKind ordering) : solver_(solver), ordering_(ordering) {}

  std::string name() const override { return name_of(solver_); }

  void order(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) override {
    is_ordered_ = is_factored_ = false;
    size_ = matrix.size();
    if (size_ > 0) guarded("ordering", [&] { build(matrix, coordinates); });
    is_ordered_ = true;
  }

  void factor(const SymmetricMatrix& matrix) override {
    is_factored_ = false;
    require(is_ordered_, "factor was called before order");
    require(matrix.size() == size_, "factor was given a matrix of another size than order");
    if (size_ > 0) {
      const LocalMatrix local = matrix_->getLocalMatrixDevice();
      require(has_pattern_of(local, matrix), "factor was given another pattern than order");
      require_finite_values(matrix, name());
      std::copy(matrix.value.begin(), matrix.value.end(), local.values.data());
      guarded("factorisation", [&] { amesos2_->numericFactorization(); });
    }
    is_factored_ = true;
  }

  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) override {
    require(is_factored_, "solve was called without a factor");
    require(b.size() == size_, "the right-hand side has another length than the matrix");
    x.resize(size_);
    if (size_ == 0) return;
    std::copy(b.begin(), b.end(), right_side_->getDataNonConst(0).begin());
    guarded("solve", [&] { amesos2_->solve(solution_.get(), right_side_.get()); });
    const auto solution = solution_->getData(0);
    std::copy(solution.begin(), solution.end(), x.begin());
    require(x.allFinite(), "the solution is not finite; look at the boundary pressures, fluxes and "
                           "velocities and at the scale of the conductances");
  }

 private:
  void build(const SymmetricMatrix& matrix, const Eigen::Matrix3Xd& coordinates) {
    matrix_ = tpetra_pattern(matrix);
    right_side_ = Teuchos::rcp(new Vector(matrix_->getRangeMap(), 1));
    solution_ = Teuchos::rcp(new Vector(matrix_->getDomainMap(), 1));
    if (solver_ == SolverKind::klu2) {
      amesos2_ = Amesos2::create<Matrix, Vector>("KLU2", matrix_);
    } else {
      amesos2_ = Teuchos::rcp(new CholmodSupernodal<Matrix, Vector>(
          matrix_, fill_reducing_ordering(ordering_, matrix, coordinates)));
    }
    amesos2_->symbolicFactorization();
  }

  void require(bool condition, const char* message) const {
    if (!condition) throw SolverError(name() + ": " + message);
  }

  /// Runs a phase; whatever Trilinos or the memory allocator throws becomes a SolverError.
  template <class Phase>
  void guarded(const char* phase_name, const Phase& phase) const {
    try {
      phase();
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw SolverError(name() + ": " + phase_name + " of " + std::to_string(size_) +
                        " unknowns ran out of memory; use fewer spheres or more memory");
    } catch (const std::exception& error) {
      throw SolverError(name() + ": " + phase_name + " of " + std::to_string(size_) +
                        " unknowns failed: " + last_line(error.what()));
    }
  }

  // First, so that Kokkos outlives what it allocated.
  std::shared_ptr<KokkosSession> kokkos_ = KokkosSession::shared();
  SolverKind solver_;
  OrderingKind ordering_;
  int size_ = 0;
  bool is_ordered_ = false;
  bool is_factored_ = false;
  Teuchos::RCP<Matrix> matrix_;
  Teuchos::RCP<Vector> right_side_;
  Teuchos::RCP<Vector> solution_;
  Teuchos::RCP<Amesos2::Solver<Matrix, Vector>> amesos2_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_amesos2_solver(SolverKind solver, OrderingKind ordering) {
  return std::make_unique<Amesos2Solver>(solver, ordering);
}

}  // namespace pfv

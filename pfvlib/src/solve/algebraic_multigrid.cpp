// SPDX-License-Identifier: GPL-3.0-or-later
// The only translation unit that includes hypre. Rows are numbered globally from `first_row`, and the communicator
// stands in one place: for several ranks each hands in its own rows.
#include "solve/algebraic_multigrid.hpp"

#include "solve/mpi_session.hpp"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <HYPRE_utilities.h>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pfv {
namespace {

constexpr HYPRE_BigInt first_row = 0;

MPI_Comm communicator() {
  MpiSession::start();
  static const bool is_started = HYPRE_Init() == 0;  // does nothing where the host program has done so
  if (!is_started) throw std::runtime_error("hypre did not start");
  return MPI_COMM_SELF;
}

/// hypre collects its errors in a flag, which may be one of the host program before.
void throw_error(const char* what) {
  const HYPRE_Int error = HYPRE_GetError();
  if (error == 0) return;
  char text[512] = "";  // descriptions are shorter than 200
  HYPRE_DescribeError(error, text);
  HYPRE_ClearAllErrors();
  throw std::runtime_error(what + std::string(" by hypre: ") + text);
}

class HypreVector {
 public:
  explicit HypreVector(HYPRE_Int size) : size_(size) {
    HYPRE_IJVectorCreate(communicator(), first_row, first_row + size - 1, &vector_);
    HYPRE_IJVectorSetObjectType(vector_, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(vector_);
    HYPRE_IJVectorAssemble(vector_);
  }
  ~HypreVector() { HYPRE_IJVectorDestroy(vector_); }
  HypreVector(const HypreVector&) = delete;
  HypreVector& operator=(const HypreVector&) = delete;

  HYPRE_ParVector get() const {
    void* object = nullptr;
    HYPRE_IJVectorGetObject(vector_, &object);
    return static_cast<HYPRE_ParVector>(object);
  }
  void set(const Eigen::VectorXd& values) { HYPRE_IJVectorSetValues(vector_, size_, nullptr, values.data()); }
  void copy_to(Eigen::VectorXd& values) const {
    values.resize(size_);
    HYPRE_IJVectorGetValues(vector_, size_, nullptr, values.data());
  }

 private:
  HYPRE_Int size_;
  HYPRE_IJVector vector_ = nullptr;
};

class HypreMatrix {
 public:
  explicit HypreMatrix(const SymmetricMatrix& matrix) {
    const HYPRE_Int size = matrix.size();
    HYPRE_IJMatrixCreate(communicator(), first_row, first_row + size - 1, first_row, first_row + size - 1, &matrix_);
    HYPRE_IJMatrixSetObjectType(matrix_, HYPRE_PARCSR);
    std::vector<HYPRE_Int> entries(matrix.row_begin.size());
    std::adjacent_difference(matrix.row_begin.begin(), matrix.row_begin.end(), entries.begin());
    std::vector<HYPRE_BigInt> rows(static_cast<std::size_t>(size));
    std::iota(rows.begin(), rows.end(), first_row);
    const std::vector<HYPRE_BigInt> columns(matrix.column.begin(), matrix.column.end());  // first_row is 0
    HYPRE_IJMatrixSetRowSizes(matrix_, entries.data() + 1);
    HYPRE_IJMatrixInitialize(matrix_);
    HYPRE_IJMatrixSetValues(matrix_, size, entries.data() + 1, rows.data(), columns.data(), matrix.value.data());
    HYPRE_IJMatrixAssemble(matrix_);
  }
  ~HypreMatrix() { HYPRE_IJMatrixDestroy(matrix_); }
  HypreMatrix(const HypreMatrix&) = delete;
  HypreMatrix& operator=(const HypreMatrix&) = delete;

  HYPRE_ParCSRMatrix get() const {
    void* object = nullptr;
    HYPRE_IJMatrixGetObject(matrix_, &object);
    return static_cast<HYPRE_ParCSRMatrix>(object);
  }

 private:
  HYPRE_IJMatrix matrix_ = nullptr;
};

/// Measured on the matrices of packings from 5000 to 900 000 grains (doc/solvers.md, amg).
void choose_method(HYPRE_Solver amg) {
  constexpr HYPRE_Int hmis = 10, extended_i = 6, down = 1, up = 2, coarsest = 3;
  constexpr HYPRE_Int l1_gauss_seidel_forward = 13, l1_gauss_seidel_backward = 14, gauss_elimination = 9;
  HYPRE_BoomerAMGSetCoarsenType(amg, hmis);
  HYPRE_BoomerAMGSetInterpType(amg, extended_i);
  HYPRE_BoomerAMGSetPMaxElmts(amg, 4);
  HYPRE_BoomerAMGSetStrongThreshold(amg, 0.4);
  HYPRE_BoomerAMGSetMaxRowSum(amg, 0.9);
  HYPRE_BoomerAMGSetAggNumLevels(amg, 0);
  // backward what was forward: a symmetric cycle, which conjugate gradients need
  HYPRE_BoomerAMGSetCycleRelaxType(amg, l1_gauss_seidel_forward, down);
  HYPRE_BoomerAMGSetCycleRelaxType(amg, l1_gauss_seidel_backward, up);
  HYPRE_BoomerAMGSetCycleRelaxType(amg, gauss_elimination, coarsest);
  HYPRE_BoomerAMGSetRelaxOrder(amg, 0);
  HYPRE_BoomerAMGSetNumSweeps(amg, 1);
  HYPRE_BoomerAMGSetCycleNumSweeps(amg, 1, coarsest);
  HYPRE_BoomerAMGSetMaxCoarseSize(amg, 9);
  HYPRE_BoomerAMGSetMaxLevels(amg, 25);
  HYPRE_BoomerAMGSetCycleType(amg, 1);
  HYPRE_BoomerAMGSetMaxIter(amg, 1);
  HYPRE_BoomerAMGSetTol(amg, 0.0);
  HYPRE_BoomerAMGSetPrintLevel(amg, 0);
}

}  // namespace

struct AlgebraicMultigrid::Hierarchy {
  explicit Hierarchy(const SymmetricMatrix& rows) : matrix(rows), right_side(rows.size()), solution(rows.size()) {
    HYPRE_BoomerAMGCreate(&amg);
    choose_method(amg);
    HYPRE_BoomerAMGSetup(amg, matrix.get(), right_side.get(), solution.get());
  }
  ~Hierarchy() { HYPRE_BoomerAMGDestroy(amg); }
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;

  HypreMatrix matrix;
  HypreVector right_side, solution;
  HYPRE_Solver amg = nullptr;
};

AlgebraicMultigrid::AlgebraicMultigrid() = default;
AlgebraicMultigrid::~AlgebraicMultigrid() = default;

void AlgebraicMultigrid::clear() { hierarchy_.reset(); }

void AlgebraicMultigrid::build(const SymmetricMatrix& matrix) {
  clear();  // its memory is the new one's
  HYPRE_ClearAllErrors();
  auto fresh = std::make_unique<Hierarchy>(matrix);
  throw_error("the hierarchy was not built");
  hierarchy_ = std::move(fresh);
}

void AlgebraicMultigrid::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  Hierarchy& h = *hierarchy_;
  HYPRE_ClearAllErrors();
  h.right_side.set(r);
  HYPRE_ParVectorSetConstantValues(h.solution.get(), 0.0);
  HYPRE_BoomerAMGSolve(h.amg, h.matrix.get(), h.right_side.get(), h.solution.get());
  throw_error("a cycle was not finished");
  h.solution.copy_to(z);
}

}  // namespace pfv

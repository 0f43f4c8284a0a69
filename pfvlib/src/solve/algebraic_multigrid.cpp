// SPDX-License-Identifier: GPL-3.0-or-later
// The only translation unit that includes hypre.
#include "solve/algebraic_multigrid.hpp"

#include "parallel/mpi_ranks.hpp"
#include "parallel/mpi_session.hpp"
#include "solve/libraries_mutex.hpp"
#include "solve/row_share.hpp"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <HYPRE_utilities.h>
#include <limits>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pfv {
namespace {

void start() {
  MpiSession::start();
  static const bool is_started = HYPRE_Init() == 0;  // does nothing where the host program has done so
  if (!is_started) throw std::runtime_error("hypre did not start");
}

/// Where this rank's rows are in the whole matrix, and who has the others.
struct Rows {
  Rows(const SymmetricMatrix& matrix, const RowShare* shared) {
    start();
    if (!shared) {
      whole = true;
      here.resize(static_cast<std::size_t>(matrix.size()));
      std::iota(here.begin(), here.end(), 0);
      number.assign(here.begin(), here.end());
      return;
    }
    communicator = dynamic_cast<const MpiRanks&>(*shared->ranks).communicator();
    first = static_cast<HYPRE_BigInt>(shared->first);
    number.assign(shared->number.begin(), shared->number.end());
    for (int row = 0; row < matrix.size(); ++row)
      if (shared->own[static_cast<std::size_t>(row)]) here.push_back(row);
  }
  HYPRE_Int size() const { return static_cast<HYPRE_Int>(here.size()); }
  HYPRE_BigInt last() const { return first + size() - 1; }

  bool whole = false;  ///< this rank has all rows
  MPI_Comm communicator = MPI_COMM_SELF;
  HYPRE_BigInt first = 0;
  std::vector<int> here;             ///< own rows among those of the matrix that is given
  std::vector<HYPRE_BigInt> number;  ///< of each of those; -1: left out
};

/// hypre collects its errors in a flag, which may be one of the host program before or of a hierarchy that another thread
/// builds; a cycle that clears it then leaves a hierarchy whose solutions the solver refuses.
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
  explicit HypreVector(const Rows& rows) : size_(rows.size()) {
    HYPRE_IJVectorCreate(rows.communicator, rows.first, rows.last(), &vector_);
    HYPRE_IJVectorSetObjectType(vector_, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(vector_);
    HYPRE_IJVectorAssemble(vector_);
  }
  ~HypreVector() { HYPRE_IJVectorDestroy(vector_); }
  HypreVector(const HypreVector&) = delete;
  HypreVector& operator=(const HypreVector&) = delete;

  HYPRE_ParVector object() const {
    void* object = nullptr;
    HYPRE_IJVectorGetObject(vector_, &object);
    return static_cast<HYPRE_ParVector>(object);
  }
  void set(const Eigen::VectorXd& values) { HYPRE_IJVectorSetValues(vector_, size_, nullptr, values.data()); }
  void get(Eigen::VectorXd& values) const {
    values.resize(size_);
    HYPRE_IJVectorGetValues(vector_, size_, nullptr, values.data());
  }

 private:
  HYPRE_Int size_;
  HYPRE_IJVector vector_ = nullptr;
};

class HypreMatrix {
 public:
  HypreMatrix(const SymmetricMatrix& matrix, const Rows& rows) {
    std::vector<HYPRE_Int> entries;
    std::vector<HYPRE_BigInt> numbers, columns;
    std::vector<double> values;
    columns.reserve(matrix.column.size());
    values.reserve(matrix.column.size());
    for (const int row : rows.here) {
      const std::size_t before = columns.size();
      for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
        if (rows.number[matrix.column[k]] < 0) continue;
        columns.push_back(rows.number[matrix.column[k]]);
        values.push_back(matrix.value[k]);
      }
      numbers.push_back(rows.number[row]);
      entries.push_back(static_cast<HYPRE_Int>(columns.size() - before));
    }
    HYPRE_IJMatrixCreate(rows.communicator, rows.first, rows.last(), rows.first, rows.last(), &matrix_);
    HYPRE_IJMatrixSetObjectType(matrix_, HYPRE_PARCSR);
    HYPRE_IJMatrixSetRowSizes(matrix_, entries.data());
    HYPRE_IJMatrixInitialize(matrix_);
    HYPRE_IJMatrixSetValues(matrix_, rows.size(), entries.data(), numbers.data(), columns.data(), values.data());
    HYPRE_IJMatrixAssemble(matrix_);
  }
  ~HypreMatrix() { HYPRE_IJMatrixDestroy(matrix_); }
  HypreMatrix(const HypreMatrix&) = delete;
  HypreMatrix& operator=(const HypreMatrix&) = delete;

  HYPRE_ParCSRMatrix object() const {
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

/// In hypre, alone of this process' threads: where hierarchies are built (its random numbers are those of the process), and
/// in cycles where MPI takes one thread at a time. Not where ranks share the rows: ranks that waited for others' turns could
/// wait for ever; there a step that builds one waits for that in the background.
class Turn {
 public:
  explicit Turn(bool is_needed) : lock_(libraries_mutex, std::defer_lock) {
    if (is_needed) lock_.lock();
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace

struct AlgebraicMultigrid::Hierarchy {
  Hierarchy(const SymmetricMatrix& given, const RowShare* shared)
      : is_shared(shared != nullptr), rows(given, shared), takes_threads(MpiSession::takes_threads()), matrix(given, rows), right_side(rows), solution(rows) {
    HYPRE_BoomerAMGCreate(&amg);
    choose_method(amg);
    HYPRE_BoomerAMGSetup(amg, matrix.object(), right_side.object(), solution.object());
  }
  ~Hierarchy() { HYPRE_BoomerAMGDestroy(amg); }
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;

  bool is_shared;  ///< by ranks
  Rows rows;
  bool takes_threads;  ///< of MPI
  HypreMatrix matrix;
  HypreVector right_side, solution;
  HYPRE_Solver amg = nullptr;
  Eigen::VectorXd own;  ///< entries of own rows, on their way
};

AlgebraicMultigrid::AlgebraicMultigrid() = default;
AlgebraicMultigrid::~AlgebraicMultigrid() { clear(); }

void AlgebraicMultigrid::clear() {
  if (!hierarchy_) return;
  const Turn turn(!hierarchy_->is_shared);
  hierarchy_.reset();
}

void AlgebraicMultigrid::build(const SymmetricMatrix& matrix, const RowShare* rows) {
  clear();  // its memory is the new one's
  const Turn turn(rows == nullptr);
  HYPRE_ClearAllErrors();
  auto fresh = std::make_unique<Hierarchy>(matrix, rows);
  throw_error("the hierarchy was not built");
  hierarchy_ = std::move(fresh);
}

void AlgebraicMultigrid::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  Hierarchy& h = *hierarchy_;
  const Turn turn(!h.is_shared && !h.takes_threads);
  HYPRE_ClearAllErrors();
  if (h.rows.whole) {
    h.right_side.set(r);
  } else {
    h.own = r(h.rows.here);
    h.right_side.set(h.own);
  }
  HYPRE_ParVectorSetConstantValues(h.solution.object(), 0.0);
  HYPRE_BoomerAMGSolve(h.amg, h.matrix.object(), h.right_side.object(), h.solution.object());
  if (h.rows.whole) {
    throw_error("a cycle was not finished");
    h.solution.get(z);
    return;
  }
  h.solution.get(h.own);
  // what goes wrong on one rank the next sum tells all of them
  if (HYPRE_GetError() != 0) h.own.setConstant(std::numeric_limits<double>::quiet_NaN());
  z.setZero(r.size());
  z(h.rows.here) = h.own;
}

}  // namespace pfv

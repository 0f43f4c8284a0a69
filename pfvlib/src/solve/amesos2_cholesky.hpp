// SPDX-License-Identifier: GPL-3.0-or-later
// Included by amesos2_solver.cpp alone: it draws in Trilinos.
#pragma once

#include "solve/cholesky_factor.hpp"
#include "solve/libraries_mutex.hpp"

#include <Amesos2.hpp>
#include <Amesos2_SolverCore_def.hpp>  // the library instantiates it for its own solvers only
#include <memory>
#include <utility>
#include <vector>

namespace pfv {

/// Lets others in while this thread does work of its own.
class OutsideLibraries {
 public:
  OutsideLibraries() { libraries_mutex.unlock(); }
  ~OutsideLibraries() { libraries_mutex.lock(); }
  OutsideLibraries(const OutsideLibraries&) = delete;
  OutsideLibraries& operator=(const OutsideLibraries&) = delete;
};

/// A Cholesky factorisation of another code as an Amesos2 solver. For one rank, where matrix and vectors
/// are used where they lie, without a copy. Its callers hold `libraries_mutex`.
template <class Matrix, class Vector>
class Amesos2Cholesky : public Amesos2::SolverCore<Amesos2Cholesky, Matrix, Vector> {
  using Base = Amesos2::SolverCore<pfv::Amesos2Cholesky, Matrix, Vector>;
  friend Base;

 public:
  static constexpr const char* name = "Cholesky";

  /// `permutation`: see CholeskyFactor::analyze.
  Amesos2Cholesky(Teuchos::RCP<const Matrix> matrix, std::vector<int> permutation,
                  std::shared_ptr<CholeskyFactor> factor, std::shared_ptr<Team> team)
      : Base(matrix, Teuchos::null, Teuchos::null),
        permutation_(std::move(permutation)),
        team_(std::move(team)),
        factor_(std::move(factor)) {}

  void share_with(std::shared_ptr<Team> team) { team_ = std::move(team); }

 private:
  using Vectors = Amesos2::MultiVecAdapter<Vector>;
  using Pointer = Amesos2::Util::vector_pointer_helper<Vectors, Vector>;
  using HostSpace = Kokkos::DefaultHostExecutionSpace;

  int preOrdering_impl() { return 0; }  // the permutation is given

  int symbolicFactorization_impl() {
    const SymmetricRows matrix = rows();
    work([&] { factor_->analyze(matrix, permutation_); });
    return 0;
  }

  int numericFactorization_impl() {
    const SymmetricRows matrix = rows();
    work([&] { factor_->factorize(matrix, *team_); });
    this->setNnzLU(2 * factor_->entries());
    return 0;
  }

  int solve_impl(const Teuchos::Ptr<Vectors> x, const Teuchos::Ptr<const Vectors> b) const {
    const double* from = Pointer::get_pointer_to_vector(b);
    double* to = Pointer::get_pointer_to_vector(x);
    work([&] { factor_->solve(from, to, *team_); });
    return 0;
  }

  bool matrixShapeOK_impl() const {
    return this->matrixA_->getComm()->getSize() == 1 &&
           this->matrixA_->getGlobalNumRows() == this->matrixA_->getGlobalNumCols();
  }

  void setParameters_impl(const Teuchos::RCP<Teuchos::ParameterList>&) {}

  Teuchos::RCP<const Teuchos::ParameterList> getValidParameters_impl() const {
    return Teuchos::parameterList();
  }

  bool loadA_impl(Amesos2::EPhase phase) {
    if (phase == Amesos2::SOLVE) return false;
    if (phase != Amesos2::NUMFACT) {
      this->matrixA_->returnRowPtr_kokkos_view(row_begin_);
      this->matrixA_->returnColInd_kokkos_view(column_);
    }
    this->matrixA_->returnValues_kokkos_view(value_);
    return true;
  }

  template <class Task>
  void work(const Task& task) const {
    if (!factor_->bears_other_threads()) return task();
    const OutsideLibraries outside;
    task();
  }

  SymmetricRows rows() const {
    return {static_cast<int>(this->globalNumRows_), row_begin_.data(), column_.data(),
            value_.data()};
  }

  std::vector<int> permutation_;
  std::shared_ptr<Team> team_;
  Kokkos::View<int*, HostSpace> row_begin_;
  Kokkos::View<int*, HostSpace> column_;
  Kokkos::View<double*, HostSpace> value_;
  std::shared_ptr<CholeskyFactor> factor_;
};

}  // namespace pfv

namespace Amesos2 {
template <>
struct solver_traits<pfv::Amesos2Cholesky> {
  using supported_scalars = Meta::make_list1<double>;
};
}  // namespace Amesos2

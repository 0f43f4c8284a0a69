// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholesky_factor.hpp"
#include "sparse/symbolic_factor.hpp"

#include <Kokkos_Core.hpp>
#include <Tacho.hpp>
#include <Tacho_Driver.hpp>
#include <algorithm>
#include <cstdio>

namespace pfv {
namespace {

/// Keeps Tacho from writing to standard error beside its exceptions. It prints by stdio.
class QuietStandardError {
 public:
  QuietStandardError() : nowhere_(std::fopen("/dev/null", "w")), kept_(stderr) {
    if (nowhere_) stderr = nowhere_;
  }
  ~QuietStandardError() {
    stderr = kept_;
    if (nowhere_) std::fclose(nowhere_);
  }
  QuietStandardError(const QuietStandardError&) = delete;
  QuietStandardError& operator=(const QuietStandardError&) = delete;

 private:
  std::FILE* nowhere_;
  std::FILE* kept_;
};

/// Tacho called as its authors do. Debian's Amesos2 leaves out `initialize`, without which it has no
/// numeric tools from 1024 unknowns on and crashes, and hands it no ordering: this build has none of its
/// own.
class TachoCholesky final : public CholeskyFactor {
 public:
  TachoCholesky() = default;
  TachoCholesky(const TachoCholesky&) = delete;
  TachoCholesky& operator=(const TachoCholesky&) = delete;
  ~TachoCholesky() override { release(); }

  void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) override {
    release();
    const int n = matrix.size, entries = matrix.row_begin[n];
    row_begin_ = RowBegins("row_begin", n + 1);
    column_ = Indices("column", entries);
    order_ = Indices("order", n);
    place_ = Indices("place", n);
    std::copy_n(matrix.row_begin, n + 1, row_begin_.data());
    std::copy_n(matrix.column, entries, column_.data());
    if (permutation.empty()) {
      SymbolicFactor minimum_degree;
      minimum_degree.analyze(matrix, {});
      std::copy_n(minimum_degree.permutation(), n, order_.data());
    } else {
      std::copy_n(permutation.data(), n, order_.data());
    }
    for (int k = 0; k < n; ++k) place_(order_(k)) = k;
    start();
  }

  void factorize(const SymmetricRows& matrix, Team&) override {
    const QuietStandardError quiet;
    driver_->factorize(Values(const_cast<double*>(matrix.value), matrix.row_begin[matrix.size]));
  }

  void solve(const double* b, double* x, Team&) override {
    const auto n = order_.extent(0);
    driver_->solve(Vectors(x, n, 1), Vectors(const_cast<double*>(b), n, 1), work_);
  }

  std::size_t entries() const override { return 0; }
  bool bears_other_threads() const override { return false; }

 private:
  using Device = Tacho::UseThisDevice<Kokkos::DefaultHostExecutionSpace>::type;
  using Driver = Tacho::Driver<double, Device>;
  using RowBegins = Driver::size_type_array;
  using Indices = Driver::ordinal_type_array;
  using Values = Driver::value_type_array;
  using Vectors = Driver::value_type_matrix;

  void start() {
    driver_ = std::make_unique<Driver>();
    driver_->setMatrixType(2, true);          // symmetric, positive definite
    driver_->setSmallProblemThresholdsize(0);  // below it, Tacho takes LAPACK on a dense matrix
    const auto n = static_cast<int>(order_.extent(0));
    driver_->analyze(n, row_begin_, column_, order_, place_);
    driver_->initialize();
    work_ = Vectors("work", n, 1);
  }

  void release() {
    if (driver_) driver_->release();
    driver_.reset();
  }

  std::unique_ptr<Driver> driver_;
  RowBegins row_begin_;
  Indices column_, order_, place_;
  Vectors work_;
};

}  // namespace

std::shared_ptr<CholeskyFactor> make_tacho_cholesky() { return std::make_shared<TachoCholesky>(); }

}  // namespace pfv

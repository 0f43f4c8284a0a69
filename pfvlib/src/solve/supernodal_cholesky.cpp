// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholesky_factor.hpp"
#include "sparse/cholesky.hpp"

namespace pfv {
namespace {

class SupernodalCholesky final : public CholeskyFactor {
 public:
  explicit SupernodalCholesky(bool single) : factor_(single) {}
  void analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) override {
    factor_.analyze(matrix, permutation);
  }
  void factorize(const SymmetricRows& matrix, Team& team) override {
    factor_.factorize(matrix, team);
  }
  void solve(const double* b, double* x, Team& team) override { factor_.solve(b, x, team); }
  std::size_t entries() const override { return factor_.entries(); }
  bool bears_other_threads() const override { return true; }

 private:
  SparseCholesky factor_;
};

}  // namespace

std::shared_ptr<CholeskyFactor> make_supernodal_cholesky(Precision precision) {
  return std::make_shared<SupernodalCholesky>(precision == Precision::mixed);
}

}  // namespace pfv

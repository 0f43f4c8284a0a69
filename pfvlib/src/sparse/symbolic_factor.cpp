// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/symbolic_factor.hpp"

#include "sparse/cholmod_session.hpp"

namespace pfv {

struct SymbolicFactor::Cholmod {
  Cholmod() {
    // Small supernodes merge where less than these parts of the result are zeros: less than CHOLMOD's
    // own (0.8, 0.1, 0.05), because solves read the zeros too. Measured at 20000 spheres: 6 % less to
    // read, the factorisation as fast.
    session->zrelax[0] = 0.5;
    session->zrelax[1] = 0.05;
    session->zrelax[2] = 0.02;
  }
  ~Cholmod() { cholmod_free_factor(&factor, session); }
  CholmodSession session;
  cholmod_factor* factor = nullptr;
};

SymbolicFactor::SymbolicFactor() : cholmod_(std::make_unique<Cholmod>()) {}
SymbolicFactor::~SymbolicFactor() = default;

void SymbolicFactor::analyze(const SymmetricRows& matrix, const std::vector<int>& permutation) {
  cholmod_free_factor(&cholmod_->factor, cholmod_->session);
  cholmod_->factor = cholmod_->session.analyze(matrix, permutation);
  const cholmod_factor& factor = *cholmod_->factor;
  supernodes_.count = static_cast<int>(factor.nsuper);
  supernodes_.columns = static_cast<int>(factor.n);
  supernodes_.first_column = static_cast<const int*>(factor.super);
  supernodes_.rows_begin = static_cast<const int*>(factor.pi);
  supernodes_.rows = static_cast<const int*>(factor.s);
  permutation_ = static_cast<const int*>(factor.Perm);
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/ranks.hpp"

#include <mpi.h>

namespace pfv {

/// The ranks of a communicator, in one of their own.
class MpiRanks final : public Ranks {
 public:
  explicit MpiRanks(MPI_Comm communicator);
  ~MpiRanks() override;
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int count() const override { return count_; }
  int own() const override { return own_; }
  void add(double* values, std::size_t size) const override;
  void take_largest(double* values, std::size_t size) const override;
  std::vector<Bytes> hand_over(const std::vector<Bytes>& to) const override;
  void exchange(const std::vector<std::vector<double>>& to, std::vector<std::vector<double>>& from) const override;
  std::shared_ptr<const Ranks> beside() const override;

  MPI_Comm communicator() const { return communicator_; }

 private:
  MPI_Comm communicator_;
  int count_ = 1, own_ = 0;
};

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// The only translation unit that includes MUMPS.
#ifdef PFV_WITH_MUMPS
#include "solve/mumps_factor.hpp"

#include "parallel/mpi_ranks.hpp"
#include "parallel/mpi_session.hpp"
#include "solve/libraries_mutex.hpp"
#include "sparse/sparse_error.hpp"

#include <dmumps_c.h>
#include <algorithm>
#include <mutex>
#include <new>
#include <string>

namespace pfv {
namespace {

// JOB and INFOG(1) of the MUMPS 5.5 users' guide
enum Job { begin = -1, end = -2, analysis = 1, factorisation = 2, solution = 3 };
enum Code { little_real_room = -9, little_integer_room = -8, singular = -10, not_positive = -40 };

bool lacks_memory(int code) {
  for (const int one : {-5, -7, -13, -17, -20})
    if (code == one) return true;
  return false;
}

MPI_Comm communicator_of(const Ranks* ranks) {
  MpiSession::start();
  return ranks ? dynamic_cast<const MpiRanks&>(*ranks).communicator() : MPI_COMM_SELF;
}

}  // namespace

struct MumpsFactor::Instance {
  explicit Instance(const Ranks* all) : ranks(all) {
    id.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(communicator_of(all)));
    id.par = 1;
    id.sym = 1;  // positive definite
    call(begin);
    for (int stream = 1; stream <= 3; ++stream) control(stream) = -1;  // no word
    control(4) = 0;
    if (ranks) control(18) = 3;  // entries where they are
  }
  ~Instance() { call(end); }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  MUMPS_INT& control(int number) { return id.icntl[number - 1]; }  // as the users' guide counts
  int code() const { return id.infog[0]; }
  void call(Job job) {
    // ranks that waited for others' turns could wait for ever
    const std::unique_lock turn = ranks ? std::unique_lock<std::mutex>() : std::unique_lock(libraries_mutex);
    id.job = job;
    dmumps_c(&id);
  }
  /// Of what was called last.
  void check() const {
    const auto refuse = [this] {
      if (lacks_memory(code())) throw std::bad_alloc();
      if (code() == singular || code() == not_positive) throw NotPositiveDefinite(0);
      if (code() < 0)
        throw SparseError("MUMPS ended with INFOG(1) = " + std::to_string(code()) + ", INFOG(2) = " + std::to_string(id.infog[1]));
    };
    if (ranks) ranks->together(refuse);
    else refuse();
  }
  void give(const HalfEntries& entries) {
    const auto from_one = [](const std::vector<int>& numbers) {
      std::vector<MUMPS_INT> shifted(numbers.size());
      std::transform(numbers.begin(), numbers.end(), shifted.begin(), [](int number) { return number + 1; });
      return shifted;
    };
    rows = from_one(entries.row);
    columns = from_one(entries.column);
    (ranks ? id.irn_loc : id.irn) = rows.data();
    (ranks ? id.jcn_loc : id.jcn) = columns.data();
    (ranks ? id.nnz_loc : id.nnz) = static_cast<MUMPS_INT8>(rows.size());
  }

  const Ranks* ranks;
  DMUMPS_STRUC_C id{};
  std::vector<MUMPS_INT> rows, columns;  ///< from 1 on
  std::vector<double> values;
};

MumpsFactor::MumpsFactor(const Ranks* ranks) : instance_(std::make_unique<Instance>(ranks)) { instance_->check(); }
MumpsFactor::~MumpsFactor() = default;

void MumpsFactor::analyse(int size, const HalfEntries& entries) {
  instance_->id.n = size;
  instance_->give(entries);
  instance_->call(analysis);
  instance_->check();
}

/// More room than the analysis has estimated, where it does not do.
void MumpsFactor::factor(const HalfEntries& entries) {
  constexpr int most_room = 1000;  // per cent above the estimate
  Instance& now = *instance_;
  now.values = entries.value;
  (now.ranks ? now.id.a_loc : now.id.a) = now.values.data();
  now.call(factorisation);
  while ((now.code() == little_real_room || now.code() == little_integer_room) && now.control(14) < most_room) {
    now.control(14) *= 2;
    now.call(factorisation);
  }
  now.check();
}

void MumpsFactor::solve(std::vector<double>& b) {
  instance_->id.rhs = b.data();
  instance_->call(solution);
  instance_->check();
}

}  // namespace pfv
#endif

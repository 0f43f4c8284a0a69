// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/mpi_ranks.hpp"

#include "pfv/mpi.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace pfv {

namespace {

constexpr int tag = 0;

/// A message has no more bytes than an int counts: longer ones go in pieces.
constexpr std::size_t longest = std::size_t{1} << 30;

template <class Call>
void in_pieces(std::size_t bytes, const Call& call) {
  for (std::size_t begin = 0; begin < bytes; begin += longest)
    call(begin, static_cast<int>(std::min(longest, bytes - begin)));
}

/// All messages between ranks at once: those to this rank itself are copied.
class Messages {
 public:
  Messages(MPI_Comm communicator, int own) : communicator_(communicator), own_(own) {}
  void receive(int from, void* data, std::size_t bytes) {
    if (from == own_) return;
    in_pieces(bytes, [&](std::size_t begin, int size) {
      MPI_Irecv(static_cast<char*>(data) + begin, size, MPI_BYTE, from, tag, communicator_, &next());
    });
  }
  void send(int to, const void* data, std::size_t bytes) {
    if (to == own_) return;
    in_pieces(bytes, [&](std::size_t begin, int size) {
      MPI_Isend(static_cast<const char*>(data) + begin, size, MPI_BYTE, to, tag, communicator_, &next());
    });
  }
  void wait() { MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE); }

 private:
  MPI_Request& next() { return requests_.emplace_back(); }

  MPI_Comm communicator_;
  int own_;
  std::vector<MPI_Request> requests_;
};

}  // namespace

MpiRanks::MpiRanks(MPI_Comm communicator) {
  if (MPI_Comm_dup(communicator, &communicator_) != MPI_SUCCESS)
    throw std::runtime_error("the MPI communicator could not be duplicated");
  MPI_Comm_size(communicator_, &count_);
  MPI_Comm_rank(communicator_, &own_);
}

MpiRanks::~MpiRanks() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (!is_over) MPI_Comm_free(&communicator_);
}

void MpiRanks::add(double* values, std::size_t size) const {
  MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(size), MPI_DOUBLE, MPI_SUM, communicator_);
}

void MpiRanks::take_largest(double* values, std::size_t size) const {
  MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(size), MPI_DOUBLE, MPI_MAX, communicator_);
}

std::vector<Ranks::Bytes> MpiRanks::hand_over(const std::vector<Bytes>& to) const {
  std::vector<std::uint64_t> sent(count_), received(count_);
  for (int r = 0; r < count_; ++r) sent[r] = to[r].size();
  MPI_Alltoall(sent.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, communicator_);
  std::vector<Bytes> from(count_);
  Messages messages(communicator_, own_);
  for (int r = 0; r < count_; ++r) {
    from[r].resize(received[r]);
    messages.receive(r, from[r].data(), from[r].size());
  }
  for (int r = 0; r < count_; ++r) messages.send(r, to[r].data(), to[r].size());
  from[own_] = to[own_];
  messages.wait();
  return from;
}

void MpiRanks::exchange(const std::vector<std::vector<double>>& to, std::vector<std::vector<double>>& from) const {
  Messages messages(communicator_, own_);
  for (int r = 0; r < count_; ++r) messages.receive(r, from[r].data(), from[r].size() * sizeof(double));
  for (int r = 0; r < count_; ++r) messages.send(r, to[r].data(), to[r].size() * sizeof(double));
  messages.wait();
}

std::shared_ptr<const Ranks> MpiRanks::beside() const { return std::make_shared<MpiRanks>(communicator_); }

std::shared_ptr<const Ranks> ranks_of(MPI_Comm communicator) {
  int count = 1;
  MPI_Comm_size(communicator, &count);
  return count > 1 ? std::make_shared<MpiRanks>(communicator) : nullptr;
}

}  // namespace pfv

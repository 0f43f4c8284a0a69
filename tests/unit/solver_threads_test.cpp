// SPDX-License-Identifier: GPL-3.0-or-later
// Threads of one program that each have a flow of their own.
#include "problem/solver_abilities.hpp"
#include "solve/linear_solver.hpp"
#include "support/matrices.hpp"

#include <gtest/gtest.h>
#include <cstddef>
#include <thread>
#include <vector>

namespace pfv {
namespace solver_threads_test {
namespace {

using namespace support;

struct Choice {
  SolverKind solver;
  OrderingKind ordering;
};

std::vector<Choice> choices() {
  std::vector<Choice> found;
  for (const SolverAbilities& solver : Names<SolverKind>::all) {
    if (solver.value == SolverKind::automatic || !is_built(solver.value)) continue;
    found.push_back({solver.value, OrderingKind::automatic});
    if (solver.takes_orderings) found.push_back({solver.value, OrderingKind::metis});
  }
  return found;
}

// What the libraries below share (the BLAS' buffers, hypre's errors, METIS' random numbers, Trilinos' counts of
// references) they may not meet in: each gets, bit for bit, what it gets alone.
TEST(SolverThreads, AllSolversAtOnceGiveTheBytesThatEachGivesAlone) {
  const SymmetricMatrix matrix = lattice(12);
  const Eigen::VectorXd b = right_side(matrix.size());
  const std::vector<Choice> all = choices();
  const auto solved = [&](const Choice& choice) {
    return solution(*make_solver(choice.solver, choice.ordering), matrix, b);
  };
  std::vector<Eigen::VectorXd> alone;
  for (const Choice& choice : all) alone.push_back(solved(choice));
  constexpr std::size_t thread_count = 4;
  std::vector<std::vector<Eigen::VectorXd>> found(thread_count, std::vector<Eigen::VectorXd>(all.size()));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < thread_count; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t k = 0; k < all.size(); ++k) {
        const std::size_t choice = (t / 2 * 3 + k) % all.size();  // in twos the same one, the others another
        found[t][choice] = solved(all[choice]);
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < thread_count; ++t)
    for (std::size_t k = 0; k < all.size(); ++k)
      EXPECT_EQ(found[t][k], alone[k]) << name_of(all[k].solver) << ' ' << name_of(all[k].ordering);
}

}  // namespace
}  // namespace solver_threads_test
}  // namespace pfv

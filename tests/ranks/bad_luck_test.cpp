// SPDX-License-Identifier: GPL-3.0-or-later
// What ranks say where a solution is not found.
#include "world.hpp"

#include "pfv/error.hpp"
#include "solve/amg_solver.hpp"
#include "solve/row_share.hpp"

#include <gtest/gtest.h>
#include <string>

namespace {

/// Pairs of rows that are joined by a throat, `rows` of them on each rank; each pair leads to p = 0 by `held`.
pfv::SymmetricMatrix pairs(int rows, double throat, double held) {
  pfv::SymmetricMatrix matrix;
  for (int row = 0; row < rows; ++row) {
    const int other = row % 2 == 0 ? row + 1 : row - 1;
    for (const int column : {std::min(row, other), std::max(row, other)}) {
      matrix.column.push_back(column);
      matrix.value.push_back(column == row ? throat + held : -throat);
    }
    matrix.row_begin.push_back(static_cast<int>(matrix.column.size()));
  }
  return matrix;
}

std::shared_ptr<pfv::RowShare> own_rows(int rows) {
  const pfv::Ranks& ranks = *world();
  auto share = std::make_shared<pfv::RowShare>();
  share->ranks = world();
  share->own.assign(rows, 1);
  share->first = static_cast<std::int64_t>(rows) * ranks.own();
  share->count = rows;
  share->total = static_cast<std::int64_t>(rows) * ranks.count();
  for (int row = 0; row < rows; ++row) share->number.push_back(share->first + row);
  share->exchange.sent.resize(ranks.count());
  share->exchange.received.resize(ranks.count());
  share->shared = share->exchange;
  return share;
}

/// Solves where the last rank's rows are `odd`, those of the others as they should be.
void solve(const pfv::SymmetricMatrix& odd) {
  constexpr int rows = 40;
  const bool is_last = world()->own() == world()->count() - 1;
  const pfv::SymmetricMatrix matrix = is_last ? odd : pairs(rows, 1.0, 0.1);
  pfv::AmgSolver solver(1e-8);
  solver.share_rows(own_rows(rows));
  solver.order(matrix, Eigen::Matrix3Xd::Random(3, rows));
  solver.factor(matrix);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(rows), b = Eigen::VectorXd::LinSpaced(rows, 1.0, 2.0);
  solver.solve(b, x);
  EXPECT_LT(pfv::relative_residual(matrix, x, b, *own_rows(rows)), 1e-6);
}

}  // namespace

TEST(BadLuck, WhereNoSolutionIsFoundAllSayWhatIsLeftAndWhatToDo) {
  solve(pairs(40, 1.0, 0.1));
  try {
    solve(pairs(40, 1.0, -0.5));  // a throat that carries fluid towards the higher pressure
    FAIL() << "a solution of rows that have none";
  } catch (const pfv::SolverError& error) {
    const std::string message = error.what();
    for (const char* part : {"no solution after", "the residual is", "look for spheres that nearly coincide", "run on one rank"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_TRUE(world()->failed_together());
  }
  solve(pairs(40, 1.0, 0.1));
}

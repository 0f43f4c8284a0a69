// SPDX-License-Identifier: GPL-3.0-or-later
// The numeric factorisation: its kernels on any set of instructions, and what it makes of graphs that
// are cut into subtrees, wide or in many parts.
#include "sparse/cholesky.hpp"
#include "sparse/ordering.hpp"
#include "sparse/sparse_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

namespace supernodal_factor_test {
namespace {

using namespace pfv;
using kernels::FactorKernels;

double number(int k) { return std::sin(1.0 + 0.7 * k); }

/// A column-major array with room for what kernels read beyond.
std::vector<double> numbers(int count, int seed) {
  std::vector<double> values(count + kernels::tile_rows);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = number(static_cast<int>(k) + seed);
  return values;
}

TEST(FactorKernels, UpdatesAreProductsPutInPlace) {
  constexpr int stride = 41, depth = 13;
  const std::vector<double> a = numbers(stride * depth, 3);
  for (const FactorKernels& set : kernels::usable_factor_kernels())
    for (int vectors = 1; vectors <= set.update_vectors; ++vectors)
      for (int columns = 1; columns <= set.update_columns; ++columns)
        for (int rows = (vectors - 1) * set.lanes + 1; rows <= vectors * set.lanes; ++rows)
          for (const int step : {1, 2}) {  // rows that lie together, or not
            std::vector<double> target = numbers(60 * columns, 7), expected = target;
            std::vector<int> row(rows);
            std::vector<double*> column(columns);
            for (int i = 0; i < rows; ++i) row[i] = 1 + step * i;
            for (int j = 0; j < columns; ++j) column[j] = &target[60 * j];
            set.update[vectors - 1][columns - 1](
                {&a[5], &a[29], stride, depth, rows, row.data(), column.data()});
            for (int j = 0; j < columns; ++j)
              for (int i = 0; i < rows; ++i)
                for (int k = 0; k < depth; ++k)
                  expected[60 * j + row[i]] -= a[stride * k + 5 + i] * a[stride * k + 29 + j];
            for (std::size_t k = 0; k < target.size(); ++k)
              ASSERT_NEAR(target[k], expected[k], 1e-13) << set.lanes << " lanes, entry " << k;
          }
}

TEST(FactorKernels, EliminationsDivideByTheTriangle) {
  constexpr int stride = 50, depth = 9;
  for (const FactorKernels& set : kernels::usable_factor_kernels())
    for (int columns = 1; columns <= kernels::strip_width; ++columns)
      for (int rows = 1; rows <= set.strip_vectors * set.lanes; ++rows) {
        std::vector<double> l = numbers(stride * (depth + columns), 11);
        Eigen::Map<Eigen::MatrixXd> all(l.data(), stride, depth + columns);
        std::vector<double> inverse(columns);
        for (int j = 0; j < columns; ++j) {
          all(j, depth + j) = 2.0 + 0.1 * j;
          inverse[j] = 1.0 / all(j, depth + j);
        }
        const Eigen::MatrixXd triangle =
            all.block(0, depth, columns, columns).triangularView<Eigen::Lower>();
        const int first = columns + 3;
        Eigen::MatrixXd expected = all;
        expected.block(first, depth, rows, columns) =
            (triangle.triangularView<Eigen::Lower>()
                 .solve((all.block(first, depth, rows, columns) -
                         all.block(first, 0, rows, depth) *
                             all.block(0, 0, columns, depth).transpose())
                            .transpose()))
                .transpose();
        set.eliminate[(rows + set.lanes - 1) / set.lanes - 1][columns - 1](
            {&all(first, depth), &all(first, 0), &all(0, 0), &all(0, depth), inverse.data(), stride,
             depth, rows});
        ASSERT_LT((all - expected).cwiseAbs().maxCoeff(), 1e-12)
            << set.lanes << " lanes, " << columns << " columns, " << rows << " rows";
      }
}

/// Neighbours on a grid are joined by conductances over three decades; `ties` holds it at its corner.
SymmetricMatrix grid(int nx, int ny, int nz, double tie) {
  std::map<std::pair<int, int>, double> entries;
  const auto id = [&](int x, int y, int z) { return (z * ny + y) * nx + x; };
  int count = 0;
  const auto join = [&](int i, int j) {
    const double c = std::pow(10.0, 1.5 * number(count++));
    entries[{i, j}] -= c, entries[{j, i}] -= c, entries[{i, i}] += c, entries[{j, j}] += c;
  };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        if (x + 1 < nx) join(id(x, y, z), id(x + 1, y, z));
        if (y + 1 < ny) join(id(x, y, z), id(x, y + 1, z));
        if (z + 1 < nz) join(id(x, y, z), id(x, y, z + 1));
      }
  entries[{0, 0}] += tie;
  SymmetricMatrix matrix;
  matrix.row_begin.assign(nx * ny * nz + 1, 0);
  for (const auto& [place, value] : entries) {
    ++matrix.row_begin[place.first + 1];
    matrix.column.push_back(place.second);
    matrix.value.push_back(value);
  }
  std::partial_sum(matrix.row_begin.begin(), matrix.row_begin.end(), matrix.row_begin.begin());
  return matrix;
}

Eigen::VectorXd solution(SparseCholesky& factor, const SymmetricMatrix& matrix, Team& team,
                         const std::vector<double>& signs = {}) {
  Eigen::VectorXd b(matrix.size()), x(matrix.size());
  for (int i = 0; i < matrix.size(); ++i) b[i] = number(i);
  factor.factorize(matrix.rows(), team, signs);
  factor.solve(b.data(), x.data(), team);
  return x;
}

// The cube's factor is cut into subtrees and its last separator is wider than a block.
TEST(SupernodalFactor, SolvesTheSameForAnyNumberOfThreads) {
  const SymmetricMatrix matrix = grid(18, 18, 18, 1.0);
  const std::vector<int> order = metis_ordering(matrix);
  SparseCholesky factor;
  factor.analyze(matrix.rows(), order);
  ASSERT_GT(factor.entries(), 200000u);
  Team alone;
  const Eigen::VectorXd expected = solution(factor, matrix, alone);
  Eigen::VectorXd b(matrix.size());
  for (int i = 0; i < matrix.size(); ++i) b[i] = number(i);
  EXPECT_LT((multiply(matrix, expected) - b).norm(), 1e-10 * b.norm());
  for (const int threads : {2, 3, 5}) {
    Team team(threads);
    EXPECT_EQ(solution(factor, matrix, team), expected) << threads;
  }
}

TEST(SupernodalFactor, IsThatOfADenseMatrix) {
  Team team;
  const int shapes[][3] = {{1, 1, 1}, {7, 1, 1}, {12, 11, 1}, {6, 7, 8}};
  for (const auto& [nx, ny, nz] : shapes) {
    const SymmetricMatrix matrix = grid(nx, ny, nz, 1.0);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
    for (int i = 0; i < matrix.size(); ++i)
      for (int k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
        dense(i, matrix.column[k]) = matrix.value[k];
    Eigen::VectorXd b(matrix.size());
    for (int i = 0; i < matrix.size(); ++i) b[i] = number(i);
    const Eigen::VectorXd expected = dense.llt().solve(b);
    SparseCholesky factor;
    factor.analyze(matrix.rows(), {});
    const Eigen::VectorXd x = solution(factor, matrix, team);
    EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm()) << matrix.size();
    EXPECT_EQ(solution(factor, matrix, team), x) << "again";
  }
}

/// [H S; S^T -G] of a matrix [H S; S^T G], the unknowns of both mixed; the signs of its pivots.
std::vector<double> make_quasi_definite(SymmetricMatrix& matrix) {
  std::vector<double> signs(matrix.size());
  for (int i = 0; i < matrix.size(); ++i) signs[i] = number(i) > 0.2 ? -1.0 : 1.0;
  for (int i = 0; i < matrix.size(); ++i)
    for (int k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
      if (signs[i] < 0.0 && signs[matrix.column[k]] < 0.0) matrix.value[k] *= -1.0;
  return signs;
}

TEST(SupernodalFactor, TakesPivotsOfBothSigns) {
  for (const int width : {3, 18}) {
    SymmetricMatrix matrix = grid(width, width, width, 1.0);
    const std::vector<double> signs = make_quasi_definite(matrix);
    Eigen::VectorXd b(matrix.size());
    for (int i = 0; i < matrix.size(); ++i) b[i] = number(i);
    SparseCholesky factor;
    factor.analyze(matrix.rows(), metis_ordering(matrix));
    Team alone;
    const Eigen::VectorXd x = solution(factor, matrix, alone, signs);
    EXPECT_LT((multiply(matrix, x) - b).norm(), 1e-10 * b.norm()) << width;
    for (const int threads : {2, 3}) {
      Team team(threads);
      EXPECT_EQ(solution(factor, matrix, team, signs), x) << threads;
    }
    // a sign that a pivot has not is no pivot
    EXPECT_THROW(solution(factor, matrix, alone), NotPositiveDefinite);
  }
}

TEST(SupernodalFactor, SignsThatAreAllPositiveAreNone) {
  const SymmetricMatrix matrix = grid(18, 18, 18, 1.0);
  SparseCholesky factor;
  factor.analyze(matrix.rows(), metis_ordering(matrix));
  Team team;
  const Eigen::VectorXd x = solution(factor, matrix, team);
  EXPECT_EQ(solution(factor, matrix, team, std::vector<double>(matrix.size(), 1.0)), x);
}

TEST(SupernodalFactor, SaysWhereNoPivotIsLeft) {
  const SymmetricMatrix loose = grid(18, 18, 18, 0.0);
  for (const int threads : {1, 3}) {
    Team team(threads);
    SparseCholesky factor;
    factor.analyze(loose.rows(), metis_ordering(loose));
    try {
      factor.factorize(loose.rows(), team);
      FAIL() << "a singular matrix was factored";
    } catch (const NotPositiveDefinite& error) {
      EXPECT_NE(std::string(error.what()).find("not positive definite at row"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace supernodal_factor_test

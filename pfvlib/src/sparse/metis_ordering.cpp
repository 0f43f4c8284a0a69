// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/ordering.hpp"

#include "sparse/sparse_error.hpp"

#include <metis.h>
#include <mutex>
#include <numeric>
#include <string>

namespace pfv {
namespace {

/// The matrix without its diagonal, as METIS wants it.
struct Graph {
  std::vector<idx_t> row_begin{0};
  std::vector<idx_t> neighbour;
};

Graph graph_of(const SymmetricMatrix& matrix) {
  Graph graph;
  graph.row_begin.reserve(matrix.row_begin.size());
  graph.neighbour.reserve(matrix.column.size());
  for (int row = 0; row < matrix.size(); ++row) {
    for (int k = matrix.row_begin[row]; k < matrix.row_begin[row + 1]; ++k) {
      if (matrix.column[k] != row) graph.neighbour.push_back(matrix.column[k]);
    }
    graph.row_begin.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

}  // namespace

std::vector<int> metis_ordering(const SymmetricMatrix& matrix) {
  Graph graph = graph_of(matrix);
  std::vector<idx_t> permutation(matrix.size());
  // Nothing couples: every order is without fill, and METIS needs an edge.
  if (graph.neighbour.empty()) {
    std::iota(permutation.begin(), permutation.end(), 0);
    return {permutation.begin(), permutation.end()};
  }
  idx_t size = matrix.size();
  std::vector<idx_t> inverse(permutation.size());
  static std::mutex turn;  // all threads share METIS' random numbers, which begin anew with each ordering
  const std::lock_guard<std::mutex> lock(turn);
  const int status =
      METIS_NodeND(&size, graph.row_begin.data(), graph.neighbour.data(), nullptr, nullptr,
                   permutation.data(), inverse.data());
  if (status == METIS_ERROR_MEMORY) {
    throw SparseError("metis: out of memory while ordering " + std::to_string(matrix.size()) +
                      " unknowns; use the ordering amd, which needs less, or fewer spheres");
  }
  if (status != METIS_OK) {
    throw SparseError("metis: the ordering of " + std::to_string(matrix.size()) +
                      " unknowns failed with code " + std::to_string(status) +
                      "; use the ordering amd");
  }
  return {permutation.begin(), permutation.end()};
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops of the factorisation: products of tall and narrow pieces of L, a tile of the result
// held in registers. The order of the sums of an entry does not depend on the tile that it is in.
#pragma once

#include "sparse/instructions.hpp"

#include <cstddef>
#include <cstring>
#include <vector>

namespace pfv::kernels {

/// Columns that are eliminated together in registers.
constexpr int strip_width = 8;
/// Rows of the largest tile. Kernels read up to so many values beyond a tile that is not full.
constexpr int tile_rows = 24;

/// target(row[i], column[j]) -= a(i, :) b(j, :)^T for a tile. Columns of a and b are `stride` apart.
struct Update {
  const double* a;
  const double* b;
  std::ptrdiff_t stride;
  int depth;             ///< columns of a and b
  int rows;              ///< of the tile
  const int* row;        ///< where they go to
  double* const* column;  ///< where each column of the target begins
};

/// Rows of a strip: less the product of what lies left of them with what lies left of the strip's
/// triangle, times the inverse transposed triangle.
struct Elimination {
  double* strip;           ///< the tile
  const double* left;      ///< the tile's rows in the columns before the strip
  const double* top_left;  ///< the triangle's rows there
  const double* triangle;
  const double* inverse_pivot;
  std::ptrdiff_t stride;
  int depth;  ///< columns before the strip
  int rows;
};

/// sum(:, j) = a(:, k) b(j, k) over k. The tile below is fetched meanwhile: it comes next.
template <class Vector, int vectors, int columns>
PFV_INLINE void take_products(Vector (&sum)[columns][vectors], const double* a, const double* b,
                             std::ptrdiff_t stride, int depth) {
  constexpr int lanes = sizeof(Vector) / sizeof(double);
  for (int j = 0; j < columns; ++j)
    for (int v = 0; v < vectors; ++v) sum[j][v] = Vector{};
  for (int k = 0; k < depth; ++k, a += stride, b += stride) {
    Vector rows[vectors];
    for (int v = 0; v < vectors; ++v) {
      std::memcpy(&rows[v], a + v * lanes, sizeof rows[v]);
      if (vectors > 1) __builtin_prefetch(a + (vectors + v) * lanes);
    }
    for (int j = 0; j < columns; ++j)
      for (int v = 0; v < vectors; ++v) sum[j][v] += rows[v] * b[j];
  }
}

template <class Vector, int vectors, int columns>
PFV_INLINE void update(const Update& u) {
  Vector sum[columns][vectors];
  take_products<Vector, vectors, columns>(sum, u.a, u.b, u.stride, u.depth);
  constexpr int lanes = sizeof(Vector) / sizeof(double), height = vectors * lanes;
  if (u.rows == height && u.row[height - 1] - u.row[0] == height - 1) {
    for (int j = 0; j < columns; ++j) {
      double* target = u.column[j] + u.row[0];
      for (int v = 0; v < vectors; ++v, target += lanes) {
        Vector values;
        std::memcpy(&values, target, sizeof values);
        values -= sum[j][v];
        std::memcpy(target, &values, sizeof values);
      }
    }
    return;
  }
  for (int j = 0; j < columns; ++j) {
    double* const target = u.column[j];
    double tile[height];
    for (int v = 0; v < vectors; ++v) std::memcpy(tile + v * lanes, &sum[j][v], sizeof sum[j][v]);
    for (int i = 0; i < u.rows; ++i) target[u.row[i]] -= tile[i];
  }
}

template <class Vector, int vectors, int columns>
PFV_INLINE void eliminate(const Elimination& e) {
  constexpr int lanes = sizeof(Vector) / sizeof(double), height = vectors * lanes;
  Vector x[columns][vectors], sum[columns][vectors];
  take_products<Vector, vectors, columns>(sum, e.left, e.top_left, e.stride, e.depth);
  if (e.rows == height) {
    for (int j = 0; j < columns; ++j)
      std::memcpy(x[j], e.strip + j * e.stride, sizeof x[j]);
  } else {
    for (int j = 0; j < columns; ++j) {
      double tile[height] = {};
      for (int i = 0; i < e.rows; ++i) tile[i] = e.strip[j * e.stride + i];
      std::memcpy(x[j], tile, sizeof x[j]);
    }
  }
  for (int j = 0; j < columns; ++j)
    for (int v = 0; v < vectors; ++v) {
      x[j][v] -= sum[j][v];
      for (int i = 0; i < j; ++i) x[j][v] -= x[i][v] * e.triangle[i * e.stride + j];
      x[j][v] *= e.inverse_pivot[j];
    }
  if (e.rows == height) {
    for (int j = 0; j < columns; ++j)
      std::memcpy(e.strip + j * e.stride, x[j], sizeof x[j]);
  } else {
    for (int j = 0; j < columns; ++j) {
      double tile[height];
      std::memcpy(tile, x[j], sizeof x[j]);
      for (int i = 0; i < e.rows; ++i) e.strip[j * e.stride + i] = tile[i];
    }
  }
}

/// The kernels for one set of instructions.
struct FactorKernels {
  int lanes;
  int update_vectors, update_columns;  ///< of the largest tile
  int strip_vectors;
  void (*update[3][strip_width])(const Update&);  ///< by vectors and columns, less one
  void (*eliminate[3][strip_width])(const Elimination&);
};

/// Those that this processor has the instructions for, the fastest first.
std::vector<FactorKernels> usable_factor_kernels();
/// The first of them.
const FactorKernels& factor_kernels();

}  // namespace pfv::kernels

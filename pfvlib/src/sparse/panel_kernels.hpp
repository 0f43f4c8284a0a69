// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops of the triangular solves. They read each entry of L once, in the order in which
// it lies in memory, so that memory bandwidth is what bounds them.
#pragma once

#include "sparse/instructions.hpp"
#include "sparse/supernodal_solve.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace pfv {

/// How far ahead of its use a value is fetched, in values: the hardware stops at each page.
constexpr int fetch_ahead = 384;

namespace kernels {

using Block = double __attribute__((vector_size(block_rows * sizeof(double))));

PFV_INLINE void load(Block& values, const double* column) {
  std::memcpy(&values, column, sizeof values);
}

PFV_INLINE void load(Block& values, const float* column) {
  float __attribute__((vector_size(block_rows * sizeof(float)))) stored;
  std::memcpy(&stored, column, sizeof stored);
  values = __builtin_convertvector(stored, Block);
}

/// sum += L x for one column of a block, in double precision however L is stored. Reads past a block
/// that is not full.
template <class Value, class Factor>
PFV_INLINE void add_product(Block& sum, const Value* column, const Factor& x) {
  Block values;
  load(values, column);
  sum += values * x;
}

template <int columns, class Value>
PFV_INLINE void fetch(const Value* block) {
  constexpr int cache_line = 64 / sizeof(Value);
  for (int k = 0; k < columns * block_rows; k += cache_line) __builtin_prefetch(block + k);
}

/// z = L11^-1 y1 and y2 -= L21 z.
template <int columns, class Value>
PFV_INLINE void forward(const Value* value, const int* row, int rows, double* y1, double* y) {
  double z[columns];
  for (int j = 0; j < columns; ++j) z[j] = y1[j];
  const Value* below = value + columns;
  for (int j = 0; j < columns; ++j) {
    z[j] *= value[j];
    for (int i = j + 1; i < columns; ++i) z[i] -= *below++ * z[j];
  }
  for (int j = 0; j < columns; ++j) y1[j] = z[j];
  for (; rows > 0; rows -= block_rows, row += block_rows, below += columns * block_rows) {
    fetch<columns>(below + fetch_ahead);
    const int height = rows < block_rows ? rows : block_rows;
    Block sum{};
    for (int j = 0; j < columns; ++j) add_product(sum, below + j * height, z[j]);
    if (height == block_rows)
      for (int i = 0; i < block_rows; ++i) y[row[i]] -= sum[i];
    else
      for (int i = 0; i < height; ++i) y[row[i]] -= sum[i];
  }
}

/// x1 = L11^-T (y1 - L21^T x2), from the last block to the first.
template <int columns, class Value>
PFV_INLINE void backward(const Value* value, const int* row, int rows, double* y1,
                         const double* y) {
  const Value* const blocks = value + columns * (columns + 1) / 2;
  const int rest = rows % block_rows;
  const Value* block = blocks + static_cast<std::int64_t>(rows - rest) * columns;
  row += rows - rest;
  Block sum[columns] = {};
  if (rest > 0) {
    Block x{};  // zero where a load reads what is not the block's
    for (int i = 0; i < rest; ++i) x[i] = y[row[i]];
    for (int j = 0; j < columns; ++j) add_product(sum[j], block + j * rest, x);
  }
  while (block != blocks) {
    block -= columns * block_rows;
    row -= block_rows;
    fetch<columns>(block - fetch_ahead);
    const Block x = {y[row[0]], y[row[1]], y[row[2]], y[row[3]]};
    for (int j = 0; j < columns; ++j) add_product(sum[j], block + j * block_rows, x);
  }
  double z[columns];
  for (int j = 0; j < columns; ++j) {
    z[j] = y1[j] - ((sum[j][0] + sum[j][2]) + (sum[j][1] + sum[j][3]));
  }
  const Value* triangle = blocks;
  for (int j = columns - 1; j >= 0; --j) {
    triangle -= columns - 1 - j;
    for (int i = j + 1; i < columns; ++i) z[j] -= triangle[i - j - 1] * z[i];
    z[j] *= value[j];
  }
  for (int j = 0; j < columns; ++j) y1[j] = z[j];
}

/// Calls `kernel` with the number of columns as a type.
template <class Kernel>
PFV_INLINE void with_columns(int columns, const Kernel& kernel) {
  static_assert(panel_width == 8, "one case for each number of columns");
  switch (columns) {
    case 1: return kernel(std::integral_constant<int, 1>{});
    case 2: return kernel(std::integral_constant<int, 2>{});
    case 3: return kernel(std::integral_constant<int, 3>{});
    case 4: return kernel(std::integral_constant<int, 4>{});
    case 5: return kernel(std::integral_constant<int, 5>{});
    case 6: return kernel(std::integral_constant<int, 6>{});
    case 7: return kernel(std::integral_constant<int, 7>{});
    default: return kernel(std::integral_constant<int, 8>{});
  }
}

}  // namespace kernels
}  // namespace pfv

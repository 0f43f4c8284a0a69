// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/supernodal_solve.hpp"

#include "solve/panel_kernels.hpp"

#include <algorithm>
#include <cstring>

namespace pfv {
namespace {

inline __attribute__((always_inline)) void substitute(const std::vector<Panel>& panels,
                                                      const double* values, const int* rows,
                                                      double* y) {
  for (const Panel& panel : panels) {
    kernels::with_columns(panel.columns, [&](auto columns) __attribute__((always_inline)) {
      kernels::forward<columns>(values + panel.first_value, rows + panel.first_row, panel.rows,
                                y + panel.first_column, y);
    });
  }
  for (auto panel = panels.rbegin(); panel != panels.rend(); ++panel) {
    kernels::with_columns(panel->columns, [&](auto columns) __attribute__((always_inline)) {
      kernels::backward<columns>(values + panel->first_value, rows + panel->first_row,
                                 panel->rows, y + panel->first_column, y);
    });
  }
}

void substitute_portably(const std::vector<Panel>& panels, const double* values, const int* rows,
                         double* y) {
  substitute(panels, values, rows, y);
}

#ifdef __x86_64__
__attribute__((target("avx2,fma"))) void substitute_with_avx2(const std::vector<Panel>& panels,
                                                              const double* values,
                                                              const int* rows, double* y) {
  substitute(panels, values, rows, y);
}
#endif

/// The same code for the instructions that this processor has.
auto substitution_of_this_processor() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return substitute_with_avx2;
#endif
  return substitute_portably;
}

/// Copies columns[0 ... `panel.columns`) of height `height`, from the panel's diagonal down.
void pack_panel(const Panel& panel, const double* columns, std::ptrdiff_t height, double* value) {
  const int width = panel.columns;
  for (int j = 0; j < width; ++j) *value++ = 1.0 / columns[j * height + j];
  for (int j = 0; j < width; ++j) {
    value = std::copy(columns + j * height + j + 1, columns + j * height + width, value);
  }
  const double* below = columns + width;
  int row = 0;
  for (; row + block_rows <= panel.rows; row += block_rows) {
    for (int j = 0; j < width; ++j, value += block_rows) {
      std::memcpy(value, below + j * height + row, block_rows * sizeof(double));
    }
  }
  for (int j = 0; j < width; ++j) {
    value = std::copy(below + j * height + row, below + j * height + panel.rows, value);
  }
}

}  // namespace

// L is stored by supernodes: columns super[s] ... super[s + 1] share the pi[s + 1] - pi[s] rows of
// a dense block that starts at px[s], diagonal first.
void SupernodalSolve::analyze(const cholmod_factor& factor) {
  const auto* first_column = static_cast<const int*>(factor.super);
  const auto* rows_begin = static_cast<const int*>(factor.pi);
  rows_ = static_cast<const int*>(factor.s);
  permutation_ = static_cast<const int*>(factor.Perm);
  values_ = nullptr;
  permuted_.resize(factor.n);
  panels_.clear();
  std::int64_t value = 0;
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const int height = rows_begin[s + 1] - rows_begin[s];
    const int columns = first_column[s + 1] - first_column[s];
    const int pieces = (columns + panel_width - 1) / panel_width;
    for (int piece = 0, done = 0; piece < pieces; ++piece) {
      const int width = (columns - done) / (pieces - piece);
      const int rows = height - done - width;
      panels_.push_back({first_column[s] + done, width, rows, rows_begin[s] + done + width, value});
      value += static_cast<std::int64_t>(width) * (width + 1) / 2 +
               static_cast<std::int64_t>(width) * rows;
      done += width;
    }
  }
  entries_ = static_cast<std::size_t>(value);
}

// A panel never ends behind the columns that it is packed from, so no column is lost before its
// turn.
void SupernodalSolve::pack(cholmod_factor& factor) {
  const auto* first_column = static_cast<const int*>(factor.super);
  const auto* rows_begin = static_cast<const int*>(factor.pi);
  const auto* block_begin = static_cast<const int*>(factor.px);
  auto* values = static_cast<double*>(factor.x);
  auto panel = panels_.begin();
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const std::ptrdiff_t height = rows_begin[s + 1] - rows_begin[s];
    for (; panel != panels_.end() && panel->first_column < first_column[s + 1]; ++panel) {
      const std::ptrdiff_t done = panel->first_column - first_column[s];
      const double* source = values + block_begin[s] + done * height;
      columns_.assign(source, source + panel->columns * height);
      pack_panel(*panel, columns_.data() + done, height, values + panel->first_value);
    }
  }
  std::fill_n(values + entries_, margin, 0.0);
  values_ = values;
}

void SupernodalSolve::solve(const double* b, double* x) {
  static const auto substitution = substitution_of_this_processor();
  const std::size_t size = permuted_.size();
  for (std::size_t k = 0; k < size; ++k) permuted_[k] = b[permutation_[k]];
  substitution(panels_, values_, rows_, permuted_.data());
  for (std::size_t k = 0; k < size; ++k) x[permutation_[k]] = permuted_[k];
}

}  // namespace pfv

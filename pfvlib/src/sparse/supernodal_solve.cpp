// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/supernodal_solve.hpp"

#include "sparse/panel_kernels.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace pfv {
namespace {

/// y = L^-1 y.
template <class Value>
struct ForwardPanels {
  static PFV_INLINE void run(const std::vector<Panel>& panels, const Value* values, const int* rows,
                             double* y) {
    for (const Panel& panel : panels) {
      kernels::with_columns(panel.columns, [&](auto columns) __attribute__((always_inline)) {
        kernels::forward<columns>(values + panel.first_value, rows + panel.first_row, panel.rows,
                                  y + panel.first_column, y);
      });
    }
  }
};

/// y = L^-T y.
template <class Value>
struct BackwardPanels {
  static PFV_INLINE void run(const std::vector<Panel>& panels, const Value* values, const int* rows,
                             double* y) {
    for (auto panel = panels.rbegin(); panel != panels.rend(); ++panel) {
      kernels::with_columns(panel->columns, [&](auto columns) __attribute__((always_inline)) {
        kernels::backward<columns>(values + panel->first_value, rows + panel->first_row,
                                   panel->rows, y + panel->first_column, y);
      });
    }
  }
};

template <class Value>
struct Substitutions {
  using Function = void (*)(const std::vector<Panel>& panels, const Value* values, const int* rows,
                            double* y);
  Function forward, backward;

  template <class Set>
  struct For {
    template <template <class> class Kernel>
    static constexpr Function function =
        Set::template call<Kernel<Value>, const std::vector<Panel>&, const Value*, const int*, double*>;
    static Substitutions make() { return {function<ForwardPanels>, function<BackwardPanels>}; }
  };

  static const Substitutions& of_this_processor() {
    static const Substitutions fastest =
        kernels::usable_tables<For>(kernels::Within256Bits()).front();
    return fastest;
  }
};

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

/// Rounds numbers to single precision, packed at the front of the array.
void round_in_place(double* values, std::size_t count) {
  auto* const rounded = reinterpret_cast<unsigned char*>(values);
  for (std::size_t k = 0; k < count; ++k) {
    const auto value = static_cast<float>(values[k]);
    std::memcpy(rounded + k * sizeof value, &value, sizeof value);
  }
}

/// Visits the pieces, of at most `panel_width` columns, that a block is cut into: how many columns are
/// before each, and its own.
template <class Visit>
void for_each_piece(const FactorBlock& block, const Visit& visit) {
  const int pieces = (block.columns + panel_width - 1) / panel_width;
  for (int piece = 0, done = 0; piece < pieces; ++piece) {
    const int width = (block.columns - done) / (pieces - piece);
    visit(done, width);
    done += width;
  }
}

Panel panel_of(const FactorBlock& block, int done, int width) {
  return {block.first_column + done, width, block.height - done - width,
          block.first_row + done + width, 0};
}

std::int64_t entries_of(const Panel& panel) {
  return static_cast<std::int64_t>(panel.columns) * (panel.columns + 1) / 2 +
         static_cast<std::int64_t>(panel.columns) * panel.rows;
}

}  // namespace

void SupernodalSolve::analyze(const Supernodes& supernodes, const SubtreeCut& cut,
                              const std::vector<FactorBlock>& blocks, const int* permutation) {
  permutation_ = permutation;
  values_ = nullptr;
  entries_ = 0;
  top_columns_.clear();
  Places places{std::vector<int>(supernodes.count, -1), std::vector<int>(supernodes.columns, -1),
                std::vector<std::int64_t>(supernodes.count)};
  for (const int s : cut.above)
    for (int c = supernodes.first_column[s]; c < supernodes.first_column[s + 1]; ++c) {
      places.above[c] = static_cast<int>(top_columns_.size());
      top_columns_.push_back(c);
    }
  const auto above = static_cast<int>(top_columns_.size());
  subtrees_.assign(cut.subtrees.size(), {});
  for (std::size_t k = 0; k < subtrees_.size(); ++k) {
    const auto [first, end] = cut.subtrees[k];
    Part& part = subtrees_[k];
    part.first_column = supernodes.first_column[first];
    part.columns = supernodes.first_column[end] - part.first_column;
    part.y.assign(part.columns + above, 0.0);
    part.rows.reserve(supernodes.rows_begin[end] - supernodes.rows_begin[first]);
    for (int s = first; s < end; ++s) {
      take_rows(supernodes, s, part, places);
      places.part[s] = static_cast<int>(k);
    }
  }
  top_ = {};
  top_.y.assign(above, 0.0);
  for (const int s : cut.above) take_rows(supernodes, s, top_, places);
  take_panels(supernodes, blocks, places);
}

/// The rows of supernode s, by the numbers that its part gives them.
void SupernodalSolve::take_rows(const Supernodes& supernodes, int s, Part& part, Places& places) {
  places.rows_begin[s] = static_cast<std::int64_t>(part.rows.size());
  for (int i = supernodes.rows_begin[s]; i < supernodes.rows_begin[s + 1]; ++i) {
    const int row = supernodes.rows[i];
    part.rows.push_back(places.above[row] < 0 ? row - part.first_column : part.columns + places.above[row]);
  }
}

void SupernodalSolve::take_panels(const Supernodes& supernodes, const std::vector<FactorBlock>& blocks,
                                  const Places& places) {
  std::int64_t value = 0;
  int s = 0;
  for (const FactorBlock& block : blocks) {
    while (supernodes.first_column[s + 1] <= block.first_column) ++s;
    const bool is_above = places.part[s] < 0;
    Part& part = is_above ? top_ : subtrees_[places.part[s]];
    for_each_piece(block, [&](int done, int width) {
      Panel panel = panel_of(block, done, width);
      panel.first_column = is_above ? places.above[panel.first_column] : panel.first_column - part.first_column;
      panel.first_row += places.rows_begin[s] - supernodes.rows_begin[s];
      panel.first_value = value;
      value += entries_of(panel);
      part.panels.push_back(panel);
    });
  }
  entries_ = static_cast<std::size_t>(value);
}

// A panel never ends behind the columns that it is packed from, so no column is lost before its
// turn.
void SupernodalSolve::pack(const std::vector<FactorBlock>& blocks, double* values, std::vector<double> signs) {
  signs_ = std::move(signs);
  std::int64_t value = 0;
  for (const FactorBlock& block : blocks)
    for_each_piece(block, [&](int done, int width) {
      const Panel panel = panel_of(block, done, width);
      const double* source =
          values + block.first_value + static_cast<std::int64_t>(done) * block.height;
      columns_.assign(source, source + static_cast<std::int64_t>(width) * block.height);
      pack_panel(panel, columns_.data() + done, block.height, values + value);
      value += entries_of(panel);
    });
  columns_ = {};
  std::fill_n(values + entries_, margin, 0.0);
  values_ = values;
  if (single_) round_in_place(values, entries_ + margin);
}

void SupernodalSolve::solve(const double* b, double* x, Team& team) {
  if (single_)
    substitute(reinterpret_cast<const float*>(values_), b, x, team);
  else
    substitute(values_, b, x, team);
}

template <class Value>
void SupernodalSolve::substitute(const Value* values, const double* b, double* x, Team& team) {
  const auto [forward, backward] = Substitutions<Value>::of_this_processor();
  const auto parts = static_cast<int>(subtrees_.size());
  const auto above = static_cast<int>(top_columns_.size());
  team.run(parts, [&](int number) {
    Part& part = subtrees_[number];
    double* const y = part.y.data();
    for (int k = 0; k < part.columns; ++k) y[k] = b[permutation_[part.first_column + k]];
    std::fill_n(y + part.columns, above, 0.0);
    forward(part.panels, values, part.rows.data(), y);
    for (int k = 0; !signs_.empty() && k < part.columns; ++k) y[k] *= signs_[part.first_column + k];
  });
  for (int k = 0; k < above; ++k) {
    double sum = b[permutation_[top_columns_[k]]];
    for (const Part& part : subtrees_) sum += part.y[part.columns + k];
    top_.y[k] = sum;
  }
  forward(top_.panels, values, top_.rows.data(), top_.y.data());
  for (int k = 0; !signs_.empty() && k < above; ++k) top_.y[k] *= signs_[top_columns_[k]];
  backward(top_.panels, values, top_.rows.data(), top_.y.data());
  for (int k = 0; k < above; ++k) x[permutation_[top_columns_[k]]] = top_.y[k];
  team.run(parts, [&](int number) {
    Part& part = subtrees_[number];
    double* const y = part.y.data();
    std::copy(top_.y.begin(), top_.y.end(), y + part.columns);
    backward(part.panels, values, part.rows.data(), y);
    for (int k = 0; k < part.columns; ++k) x[permutation_[part.first_column + k]] = y[k];
  });
}

}  // namespace pfv

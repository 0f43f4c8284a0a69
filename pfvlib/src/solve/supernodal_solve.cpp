// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/supernodal_solve.hpp"

#include "solve/panel_kernels.hpp"

#include <algorithm>
#include <cstring>

namespace pfv {
namespace {

template <class Value>
using Substitution = void (*)(const std::vector<Panel>& panels, const Value* values,
                              const int* rows, double* y);

#define PFV_INLINE inline __attribute__((always_inline))

/// y = L^-1 y.
template <class Value>
PFV_INLINE void forward_panels(const std::vector<Panel>& panels, const Value* values,
                               const int* rows, double* y) {
  for (const Panel& panel : panels) {
    kernels::with_columns(panel.columns, [&](auto columns) __attribute__((always_inline)) {
      kernels::forward<columns>(values + panel.first_value, rows + panel.first_row, panel.rows,
                                y + panel.first_column, y);
    });
  }
}

/// y = L^-T y.
template <class Value>
PFV_INLINE void backward_panels(const std::vector<Panel>& panels, const Value* values,
                                const int* rows, double* y) {
  for (auto panel = panels.rbegin(); panel != panels.rend(); ++panel) {
    kernels::with_columns(panel->columns, [&](auto columns) __attribute__((always_inline)) {
      kernels::backward<columns>(values + panel->first_value, rows + panel->first_row,
                                 panel->rows, y + panel->first_column, y);
    });
  }
}

#undef PFV_INLINE

template <class Value>
void forward_portably(const std::vector<Panel>& panels, const Value* values, const int* rows,
                      double* y) {
  forward_panels(panels, values, rows, y);
}

template <class Value>
void backward_portably(const std::vector<Panel>& panels, const Value* values, const int* rows,
                       double* y) {
  backward_panels(panels, values, rows, y);
}

#ifdef __x86_64__
template <class Value>
__attribute__((target("avx2,fma"))) void forward_with_avx2(const std::vector<Panel>& panels,
                                                           const Value* values, const int* rows,
                                                           double* y) {
  forward_panels(panels, values, rows, y);
}

template <class Value>
__attribute__((target("avx2,fma"))) void backward_with_avx2(const std::vector<Panel>& panels,
                                                            const Value* values, const int* rows,
                                                            double* y) {
  backward_panels(panels, values, rows, y);
}
#endif

/// The same code for the instructions that this processor has.
template <class Value>
std::pair<Substitution<Value>, Substitution<Value>> substitutions_of_this_processor() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return {forward_with_avx2<Value>, backward_with_avx2<Value>};
#endif
  return {forward_portably<Value>, backward_portably<Value>};
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

/// Rounds numbers to single precision, packed at the front of the array.
void round_in_place(double* values, std::size_t count) {
  auto* const rounded = reinterpret_cast<unsigned char*>(values);
  for (std::size_t k = 0; k < count; ++k) {
    const auto value = static_cast<float>(values[k]);
    std::memcpy(rounded + k * sizeof value, &value, sizeof value);
  }
}

/// The supernodes below each one, ascending; those without one above it stand in the last entry.
/// `first`: where the subtree of each begins. The parent of a supernode holds the first of its rows
/// below the diagonal block.
std::vector<std::vector<int>> subtree_children(const cholmod_factor& factor,
                                               std::vector<int>& first) {
  const int count = static_cast<int>(factor.nsuper);
  const auto* first_column = static_cast<const int*>(factor.super);
  const auto* rows_begin = static_cast<const int*>(factor.pi);
  const auto* rows = static_cast<const int*>(factor.s);
  std::vector<std::vector<int>> children(count + 1);
  first.resize(count);
  for (int s = 0; s < count; ++s) {
    const int below = rows_begin[s] + first_column[s + 1] - first_column[s];
    const int parent =
        below == rows_begin[s + 1]
            ? count
            : static_cast<int>(std::upper_bound(first_column, first_column + count, rows[below]) -
                               first_column) - 1;
    first[s] = children[s].empty() ? s : first[children[s].front()];
    children[parent].push_back(s);
  }
  return children;
}

/// Replaces the largest subtree by those below its root until none has more than this part of all
/// the work: two threads are then evenly busy, and what lies above stays small.
constexpr double largest_subtree = 0.26;
/// A factor of fewer entries is one subtree: handing work over would cost more than it saves.
constexpr std::size_t worth_cutting = 200000;

/// `roots`: of all trees on entry, of the chosen subtrees on return, the largest first.
template <class Work>
void choose_subtrees(std::vector<int>& roots, const std::vector<std::vector<int>>& children,
                     const Work& work, std::size_t entries) {
  const auto smaller = [&](int a, int b) {
    return work(a) != work(b) ? work(a) < work(b) : a > b;
  };
  if (entries < worth_cutting) return;
  for (;;) {
    const auto largest = std::max_element(roots.begin(), roots.end(), smaller);
    const int root = *largest;
    if (static_cast<double>(work(root)) <= largest_subtree * static_cast<double>(entries) ||
        children[root].empty())
      break;
    roots.erase(largest);
    roots.insert(roots.end(), children[root].begin(), children[root].end());
  }
  std::sort(roots.begin(), roots.end(), [&](int a, int b) { return smaller(b, a); });
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
  panels_.clear();
  std::vector<int> supernode_panels{0};
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
    supernode_panels.push_back(static_cast<int>(panels_.size()));
  }
  entries_ = static_cast<std::size_t>(value);
  cut(factor, panels_, supernode_panels);
}

// Supernodes are postordered: those of a subtree follow one another, its root last.
void SupernodalSolve::cut(const cholmod_factor& factor, const std::vector<Panel>& panels,
                          const std::vector<int>& supernode_panels) {
  const int count = static_cast<int>(factor.nsuper);
  const auto* first_column = static_cast<const int*>(factor.super);
  const auto value_at = [&](int panel) {
    return panel < static_cast<int>(panels.size()) ? panels[panel].first_value
                                                   : static_cast<std::int64_t>(entries_);
  };
  std::vector<int> first;
  const std::vector<std::vector<int>> children = subtree_children(factor, first);
  const auto work = [&](int root) {
    return value_at(supernode_panels[root + 1]) - value_at(supernode_panels[first[root]]);
  };
  std::vector<int> roots = children[count];
  choose_subtrees(roots, children, work, entries_);

  subtrees_.clear();
  top_ = Part();
  const auto add = [&](Part& part, int begin, int end) {
    part.panels.insert(part.panels.end(), panels.begin() + supernode_panels[begin],
                       panels.begin() + supernode_panels[end]);
    part.columns.emplace_back(first_column[begin], first_column[end]);
  };
  std::vector<char> is_above(count, 1);
  for (const int root : roots) {
    subtrees_.emplace_back();
    add(subtrees_.back(), first[root], root + 1);
    std::fill(is_above.begin() + first[root], is_above.begin() + root + 1, 0);
  }
  for (int s = 0; s < count; ++s)
    if (is_above[s]) add(top_, s, s + 1);
  for (Part& part : subtrees_) part.y.assign(factor.n, 0.0);
  top_.y.assign(factor.n, 0.0);
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
  static const auto substitutions = substitutions_of_this_processor<Value>();
  const auto forward = substitutions.first, backward = substitutions.second;
  const auto each_column = [](const Part& part, const auto& visit) {
    for (const auto& [begin, end] : part.columns)
      for (int column = begin; column < end; ++column) visit(column);
  };
  const auto parts = static_cast<int>(subtrees_.size());
  team.run(parts, [&](int number) {
    Part& part = subtrees_[number];
    each_column(top_, [&](int column) { part.y[column] = 0.0; });
    each_column(part, [&](int column) { part.y[column] = b[permutation_[column]]; });
    forward(part.panels, values, rows_, part.y.data());
  });
  each_column(top_, [&](int column) {
    double sum = b[permutation_[column]];
    for (const Part& part : subtrees_) sum += part.y[column];
    top_.y[column] = sum;
  });
  forward(top_.panels, values, rows_, top_.y.data());
  backward(top_.panels, values, rows_, top_.y.data());
  each_column(top_, [&](int column) { x[permutation_[column]] = top_.y[column]; });
  team.run(parts, [&](int number) {
    Part& part = subtrees_[number];
    each_column(top_, [&](int column) { part.y[column] = top_.y[column]; });
    backward(part.panels, values, rows_, part.y.data());
    each_column(part, [&](int column) { x[permutation_[column]] = part.y[column]; });
  });
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/supernodal_factor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pfv {
namespace {

using kernels::strip_width;
using kernels::tile_rows;

/// As wide as its square and a tile of rows stay in the nearest cache; a multiple of a strip.
constexpr int block_width = 96;
/// Multiplications above which rows of a block are worth sharing among threads.
constexpr double worth_sharing = 3e5;
/// Pieces of a block's rows for each thread: their work differs.
constexpr int pieces_per_thread = 4;

constexpr int rounded_up(int number, int step) { return (number + step - 1) / step * step; }

/// L of a small triangle, column-major, in place. `inverse_pivot`: with the sign of the pivot.
int eliminate_triangle(double* triangle, std::ptrdiff_t stride, int columns, const double* signs,
                       const double* least_pivot, double* inverse_pivot) {
  for (int j = 0; j < columns; ++j) {
    double* const column = triangle + j * stride;
    for (int k = 0; k < j; ++k) {
      const double* const left = triangle + k * stride;
      const double row = signs ? signs[k] * left[j] : left[j];
      for (int i = j; i < columns; ++i) column[i] -= left[i] * row;
    }
    const double sign = signs ? signs[j] : 1.0, pivot = sign * column[j];
    if (!(pivot > least_pivot[j])) return j;
    column[j] = std::sqrt(pivot);
    inverse_pivot[j] = sign / column[j];
    for (int i = j + 1; i < columns; ++i) column[i] *= inverse_pivot[j];
  }
  return SupernodalFactor::none;
}

void add_blocks(BlockLayout& layout, const Supernodes& supernodes, int s, int room_behind) {
  const int width = supernodes.width(s), height = supernodes.height(s);
  for (int done = 0; done < width; done += block_width) {
    const FactorBlock block{supernodes.first_column[s] + done, std::min(block_width, width - done),
                            height - done, supernodes.rows_begin[s] + done,
                            static_cast<std::int64_t>(layout.size)};
    std::fill_n(layout.block_of.begin() + block.first_column, block.columns,
                static_cast<int>(layout.blocks.size()));
    layout.size += static_cast<std::size_t>(block.columns) * block.height + room_behind;
    layout.tallest = std::max(layout.tallest, block.height);
    layout.blocks.push_back(block);
  }
}

BlockLayout layout_of(const Supernodes& supernodes, const SubtreeCut& cut, const int* permutation) {
  BlockLayout layout;
  const int n = supernodes.columns;
  layout.permutation = permutation;
  layout.rows = supernodes.rows;
  layout.inverse.resize(n);
  for (int k = 0; k < n; ++k) layout.inverse[permutation[k]] = k;
  layout.block_of.resize(n);
  // What a kernel reads beyond a block must be no other thread's to write.
  std::vector<int> room_behind(supernodes.count, 0);
  for (const auto& [first, end] : cut.subtrees) room_behind[end - 1] = tile_rows;
  for (const int s : cut.above) room_behind[s] = tile_rows;
  std::vector<int> first_block{0};
  for (int s = 0; s < supernodes.count; ++s) {
    add_blocks(layout, supernodes, s, room_behind[s]);
    first_block.push_back(static_cast<int>(layout.blocks.size()));
  }
  layout.size += tile_rows;
  layout.is_above.assign(layout.blocks.size(), 0);
  for (const auto& [first, end] : cut.subtrees)
    layout.subtrees.push_back({first_block[first], first_block[end]});
  for (const int s : cut.above)
    for (int block = first_block[s]; block < first_block[s + 1]; ++block) {
      layout.above.push_back(block);
      layout.is_above[block] = 1;
    }
  return layout;
}

/// One factorisation: L as far as it has come, and which blocks wait for which.
class Factorisation {
 public:
  Factorisation(const BlockLayout& layout, const SymmetricRows& matrix, double lost_pivot, const double* signs,
                double* values)
      : layout_(layout), matrix_(matrix), lost_pivot_(lost_pivot), signs_(signs), values_(values),
        first_update_(layout.blocks.size(), none), next_update_(layout.blocks.size(), none),
        done_rows_(layout.blocks.size(), 0) {}

  /// Returns `none`, or the first column whose pivot is lost.
  int run(Team& team);

 private:
  using Range = BlockLayout::Range;
  static constexpr int none = SupernodalFactor::none;

  /// Where a thread notes which row of the block at hand each row of the matrix is.
  struct WorkSpace {
    std::vector<int> place;     ///< by rows of the matrix
    std::vector<int> rows;      ///< of a block that is to be subtracted
    std::vector<int> updating;  ///< those blocks
    std::vector<double> with_signs;  ///< rows of a block times D, in the block's own places; empty without signs
  };

  std::vector<WorkSpace> work_spaces(int threads) const;
  void begin_block(const FactorBlock& block, double* diagonal, WorkSpace& work);
  void take_updates(int block, WorkSpace& work) const;
  void subtract(const FactorBlock& from, Range columns, const FactorBlock& to, Range target_rows,
                const std::vector<int>& place, WorkSpace& own) const;
  const double* times_signs(const FactorBlock& block, Range rows, Range columns, WorkSpace& work) const;
  int eliminate_diagonal(const FactorBlock& block, const double* least_pivot, double* inverse_pivot,
                         WorkSpace& work) const;
  const double* top_of(const FactorBlock& block, const WorkSpace& work) const;
  void eliminate_rows(const FactorBlock& block, const double* inverse_pivot, const double* top, Range rows) const;
  void link(int block, bool above);
  int factor_subtree(Range blocks, WorkSpace& work);
  int factor_above(std::vector<WorkSpace>& work, Team& team);

  const BlockLayout& layout_;
  const SymmetricRows& matrix_;
  double lost_pivot_;
  const double* signs_;  ///< null: all are 1
  double* values_;
  std::vector<int> first_update_, next_update_;  ///< lists of the blocks that a block waits for
  std::vector<int> done_rows_;                   ///< of each block: rows above have been subtracted
};

/// A's entries in the block; `diagonal`: those on the diagonal.
void Factorisation::begin_block(const FactorBlock& block, double* diagonal, WorkSpace& work) {
  double* column = values_ + block.first_value;
  const int* const rows = layout_.rows_of(block);
  std::fill_n(column, static_cast<std::size_t>(block.columns) * block.height, 0.0);
  for (int i = 0; i < block.height; ++i) work.place[rows[i]] = i;
  for (int j = 0; j < block.columns; ++j, column += block.height) {
    const int row = layout_.permutation[block.first_column + j];
    diagonal[j] = 0.0;
    for (int k = matrix_.row_begin[row]; k < matrix_.row_begin[row + 1]; ++k) {
      const int i = layout_.inverse[matrix_.column[k]];
      if (i < block.first_column + j) continue;
      column[work.place[i]] = matrix_.value[k];
      if (i == block.first_column + j) diagonal[j] = matrix_.value[k];
    }
  }
}

/// The blocks that the list of `block` holds.
void Factorisation::take_updates(int block, WorkSpace& work) const {
  work.updating.clear();
  for (int from = first_update_[block]; from != none; from = next_update_[from])
    work.updating.push_back(from);
}

/// Rows of L D for some columns of a block, each at its place in a block of its own; L itself where D is 1. What
/// the other columns hold stays.
const double* Factorisation::times_signs(const FactorBlock& block, Range rows, Range columns,
                                         WorkSpace& work) const {
  const double* const values = values_ + block.first_value;
  if (!signs_) return values;
  for (int c = columns.begin; c < columns.end; ++c) {
    const std::ptrdiff_t column = static_cast<std::ptrdiff_t>(c) * block.height;
    const double sign = signs_[block.first_column + c];
    for (int i = rows.begin; i < rows.end; ++i) work.with_signs[column + i] = sign * values[column + i];
  }
  return work.with_signs.data();
}

/// Of a block whose diagonal has been eliminated last.
const double* Factorisation::top_of(const FactorBlock& block, const WorkSpace& work) const {
  return signs_ ? work.with_signs.data() : values_ + block.first_value;
}

/// to -= from(:, all) D from(columns, all)^T in some rows of `to`. `columns` counts rows of `from`.
void Factorisation::subtract(const FactorBlock& from, Range columns, const FactorBlock& to,
                             Range target_rows, const std::vector<int>& place, WorkSpace& own) const {
  const kernels::FactorKernels& k = kernels::factor_kernels();
  std::vector<int>& rows = own.rows;
  const int* const from_rows = layout_.rows_of(from);
  int begin = columns.begin, end = from.height;
  const auto above = [&](int row, int target) { return place[row] < target; };
  if (target_rows.begin > 0)
    begin = static_cast<int>(std::lower_bound(from_rows + begin, from_rows + end,
                                              target_rows.begin, above) - from_rows);
  if (target_rows.end < to.height)
    end = static_cast<int>(std::lower_bound(from_rows + begin, from_rows + end, target_rows.end,
                                            above) - from_rows);
  for (int i = begin; i < end; ++i) rows[i] = place[from_rows[i]];
  double* column[block_width];
  const int count = columns.end - columns.begin;
  for (int j = 0; j < count; ++j)
    column[j] = values_ + to.first_value +
                static_cast<std::ptrdiff_t>(from_rows[columns.begin + j] - to.first_column) *
                    to.height;
  const double* const values = values_ + from.first_value;
  const double* const top = times_signs(from, columns, {0, from.columns}, own);
  const int height = k.lanes * k.update_vectors;
  for (int i = begin; i < end; i += height) {
    const int tile = std::min(height, end - i), vectors = (tile + k.lanes - 1) / k.lanes;
    for (int j = 0; j < count && columns.begin + j < i + tile; j += k.update_columns)
      k.update[vectors - 1][std::min(k.update_columns, count - j) - 1](
          {values + i, top + columns.begin + j, from.height, from.columns, tile, &rows[i],
           column + j});
  }
}

/// L of the block's own triangle. Returns the column that has no pivot, or `none`.
int Factorisation::eliminate_diagonal(const FactorBlock& block, const double* least_pivot,
                                      double* inverse_pivot, WorkSpace& work) const {
  const kernels::FactorKernels& k = kernels::factor_kernels();
  double* const values = values_ + block.first_value;
  const double* const top = top_of(block, work);
  const std::ptrdiff_t stride = block.height;
  int rows[strip_width];
  std::iota(rows, rows + strip_width, 0);
  for (int done = 0; done < block.columns; done += strip_width) {
    const int width = std::min(strip_width, block.columns - done);
    double* const triangle = values + done * stride + done;
    double* column[strip_width];
    for (int j = 0; j < width; ++j) column[j] = triangle + j * stride;
    for (int i = 0; done > 0 && i < width; i += k.lanes)
      for (int j = 0; j < width; j += k.update_columns)
        k.update[0][std::min(k.update_columns, width - j) - 1](
            {values + done + i, top + done + j, stride, done, std::min(k.lanes, width - i),
             rows + i, column + j});
    const int lost = eliminate_triangle(triangle, stride, width, signs_ ? signs_ + block.first_column + done : nullptr,
                                        least_pivot + done, inverse_pivot + done);
    if (lost != none) return done + lost;
    times_signs(block, {done, done + width}, {done, done + width}, work);
    const int height = k.lanes * k.strip_vectors;
    for (int i = done + width; i < block.columns; i += height) {
      const int tile = std::min(height, block.columns - i);
      k.eliminate[(tile + k.lanes - 1) / k.lanes - 1][width - 1](
          {values + done * stride + i, values + i, top + done, top + done * stride + done, inverse_pivot + done,
           stride, done, tile});
    }
    times_signs(block, {done + width, block.columns}, {done, done + width}, work);
  }
  return none;
}

/// `top`: the block's triangle times D.
void Factorisation::eliminate_rows(const FactorBlock& block, const double* inverse_pivot, const double* top,
                                   Range rows) const {
  const kernels::FactorKernels& k = kernels::factor_kernels();
  double* const values = values_ + block.first_value;
  const std::ptrdiff_t stride = block.height;
  const int height = k.lanes * k.strip_vectors;
  for (int i = rows.begin; i < rows.end; i += height) {
    const int tile = std::min(height, rows.end - i);
    for (int done = 0; done < block.columns; done += strip_width)
      k.eliminate[(tile + k.lanes - 1) / k.lanes - 1]
                 [std::min(strip_width, block.columns - done) - 1](
          {values + done * stride + i, values + i, top + done, top + done * stride + done,
           inverse_pivot + done, stride, done, tile});
  }
}

/// Puts a block on the list of the next one that it changes, where that is above the subtrees or not.
void Factorisation::link(int block, bool above) {
  const FactorBlock& b = layout_.blocks[block];
  if (done_rows_[block] == b.height) return;
  const int to = layout_.block_of[layout_.rows_of(b)[done_rows_[block]]];
  if (layout_.is_above[to] != static_cast<char>(above)) return;
  next_update_[block] = first_update_[to];
  first_update_[to] = block;
}

int Factorisation::factor_subtree(Range range, WorkSpace& work) {
  for (int current = range.begin; current < range.end; ++current) {
    const FactorBlock& block = layout_.blocks[current];
    const int last_column = block.first_column + block.columns;
    double pivot[block_width], inverse_pivot[block_width];
    begin_block(block, pivot, work);
    take_updates(current, work);
    for (const int from : work.updating) {
      const FactorBlock& b = layout_.blocks[from];
      const int* const rows = layout_.rows_of(b);
      Range columns{done_rows_[from], done_rows_[from]};
      while (columns.end < b.height && rows[columns.end] < last_column) ++columns.end;
      subtract(b, columns, block, {0, block.height}, work.place, work);
      done_rows_[from] = columns.end;
      link(from, false);
    }
    for (int j = 0; j < block.columns; ++j) pivot[j] = lost_pivot_ * std::abs(pivot[j]);
    const int lost = eliminate_diagonal(block, pivot, inverse_pivot, work);
    if (lost != none) return block.first_column + lost;
    eliminate_rows(block, inverse_pivot, top_of(block, work), {block.columns, block.height});
    done_rows_[current] = block.columns;
    link(current, false);
  }
  return none;
}

/// visit(rows, thread) for all of the rows, shared between the threads where so many multiplications are worth it.
template <class Range, class Visit>
void in_pieces(Range all, double multiplications, Team& team, const Visit& visit) {
  const int threads = multiplications > worth_sharing ? team.threads() : 1;
  const int pieces = threads == 1 ? 1 : pieces_per_thread * threads;
  const int count = all.end - all.begin, piece = rounded_up(count / pieces + 1, tile_rows);
  const auto visit_piece = [&](int k, int thread) {
    const Range rows{all.begin + std::min(k * piece, count), all.begin + std::min((k + 1) * piece, count)};
    if (rows.begin < rows.end) visit(rows, thread);
  };
  if (threads == 1) return visit_piece(0, 0);
  team.run_with_space(pieces, visit_piece);
}

/// The blocks above the subtrees, one after the other, each shared by rows.
int Factorisation::factor_above(std::vector<WorkSpace>& work, Team& team) {
  for (std::size_t b = 0; b < layout_.blocks.size(); ++b)
    if (!layout_.is_above[b]) link(static_cast<int>(b), true);
  std::vector<Range> columns;
  for (const int current : layout_.above) {
    const FactorBlock& block = layout_.blocks[current];
    const int last_column = block.first_column + block.columns;
    double pivot[block_width], inverse_pivot[block_width];
    WorkSpace& shared = work.front();
    begin_block(block, pivot, shared);
    take_updates(current, shared);
    columns.clear();
    double products = 0.0;
    for (const int from : shared.updating) {
      const FactorBlock& b = layout_.blocks[from];
      const int* const rows = layout_.rows_of(b);
      int& done = done_rows_[from];
      const int begin = done;
      while (done < b.height && rows[done] < last_column) ++done;
      columns.push_back({begin, done});
      products += static_cast<double>(b.height - begin) * (done - begin) * b.columns;
      link(from, true);
    }
    in_pieces(Range{0, block.height}, products, team, [&](Range rows, int thread) {
      for (std::size_t k = 0; k < shared.updating.size(); ++k)
        subtract(layout_.blocks[shared.updating[k]], columns[k], block, rows, shared.place, work[thread]);
    });
    for (int j = 0; j < block.columns; ++j) pivot[j] = lost_pivot_ * std::abs(pivot[j]);
    const int lost = eliminate_diagonal(block, pivot, inverse_pivot, shared);
    if (lost != none) return block.first_column + lost;
    const double* const top = top_of(block, shared);
    in_pieces(Range{block.columns, block.height}, 0.5 * block.height * block.columns * block.columns, team,
              [&](Range rows, int) { eliminate_rows(block, inverse_pivot, top, rows); });
    done_rows_[current] = block.columns;
    link(current, true);
  }
  return none;
}

std::vector<Factorisation::WorkSpace> Factorisation::work_spaces(int threads) const {
  std::vector<WorkSpace> work(threads);
  for (WorkSpace& own : work) {
    own.place.resize(layout_.block_of.size());
    own.rows.resize(layout_.tallest);
    own.updating.reserve(layout_.blocks.size());
    if (signs_) own.with_signs.resize(static_cast<std::size_t>(layout_.tallest) * block_width + tile_rows);
  }
  return work;
}

int Factorisation::run(Team& team) {
  std::vector<WorkSpace> work = work_spaces(team.threads());
  std::vector<int> lost(layout_.subtrees.size(), none);
  team.run_with_space(static_cast<int>(lost.size()), [&](int k, int thread) {
    lost[k] = factor_subtree(layout_.subtrees[k], work[thread]);
  });
  int first = none;
  for (const int column : lost)
    if (column != none && (first == none || column < first)) first = column;
  return first == none ? factor_above(work, team) : first;
}

}  // namespace

void SupernodalFactor::analyze(const Supernodes& supernodes, const SubtreeCut& cut,
                               const int* permutation) {
  layout_ = layout_of(supernodes, cut, permutation);
}

int SupernodalFactor::factorize(const SymmetricRows& matrix, double lost_pivot, const std::vector<double>& signs,
                                double* values, Team& team) const {
  return Factorisation(layout_, matrix, lost_pivot, signs.empty() ? nullptr : signs.data(), values).run(team);
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/team.hpp"
#include "sparse/elimination_tree.hpp"
#include "sparse/supernodal_factor.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pfv {

/// Neighbouring columns of L that share the rows below their triangle. Its values, one after the
/// other: the reciprocal pivots; the rest of the triangle by columns; the rows below it in blocks
/// of `block_rows` (the last one may have fewer), each block by columns.
struct Panel {
  int first_column;          ///< of its part's
  int columns;               ///< at most `panel_width`
  int rows;                  ///< below the triangle
  std::int64_t first_row;    ///< in its part's list of row numbers
  std::int64_t first_value;  ///< in the list of values
};

/// As many accumulators as the 16 vector registers of AVX2 leave room for.
constexpr int panel_width = 8;
constexpr int block_rows = 4;

/// Forward and backward substitution with a supernodal L, packed so that both stream
/// through it. CHOLMOD's own solve calls the BLAS for each supernode, too small for that to pay,
/// and reads the unused upper half of each diagonal block.
///
/// Threads take subtrees of the elimination tree, which share no column: the forward substitution of
/// each gathers what it takes from the columns above in an array of its own, and these are added in a
/// fixed order. The subtrees do not depend on the number of threads, nor does any byte of x.
class SupernodalSolve {
 public:
  /// How many values beyond L its array must have room for: a block that is not full is read as if it
  /// were.
  static constexpr std::size_t margin = block_rows;

  /// `single`: keep L in single precision, x is then good to some 1e-7.
  explicit SupernodalSolve(bool single) : single_(single) {}

  /// Cuts the blocks of a factor into panels. `permutation` must outlive this.
  void analyze(const Supernodes& supernodes, const SubtreeCut& cut,
               const std::vector<FactorBlock>& blocks, const int* permutation);
  /// Packs values that lie by blocks where they are: they are L for `solve` alone until the next
  /// factorisation. `signs`: D by columns in the order of elimination; none: it is 1.
  void pack(const std::vector<FactorBlock>& blocks, double* values, std::vector<double> signs = {});
  /// x = P^T L^-T D L^-1 P b.
  void solve(const double* b, double* x, Team& team);
  /// Entries of L that a solve reads twice.
  std::size_t entries() const { return entries_; }

 private:
  /// A subtree of the elimination tree, or what lies above all of them. It numbers its own columns
  /// first, then those above it.
  struct Part {
    std::vector<Panel> panels;
    std::vector<int> rows;
    std::vector<double> y;  ///< of its columns
    int columns = 0;        ///< its own
    int first_column = 0;   ///< of a subtree
  };

  /// Where the analysis has put what.
  struct Places {
    std::vector<int> part;                 ///< of each supernode: number of its subtree, or -1
    std::vector<int> above;                ///< of each column: number among those above the subtrees, or -1
    std::vector<std::int64_t> rows_begin;  ///< of each supernode, in its part
  };

  static void take_rows(const Supernodes& supernodes, int s, Part& part, Places& places);
  void take_panels(const Supernodes& supernodes, const std::vector<FactorBlock>& blocks, const Places& places);
  template <class Value>
  void substitute(const Value* values, const double* b, double* x, Team& team);

  bool single_;
  std::vector<Part> subtrees_;
  Part top_;
  std::vector<int> top_columns_;
  std::size_t entries_ = 0;
  const int* permutation_ = nullptr;
  const double* values_ = nullptr;  ///< or as many numbers of single precision
  std::vector<double> signs_;
  std::vector<double> columns_;     ///< of the panel that is being packed
};

}  // namespace pfv

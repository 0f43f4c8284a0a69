// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/team.hpp"
#include "sparse/elimination_tree.hpp"
#include "sparse/factor_kernels.hpp"
#include "sparse/symmetric_matrix.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pfv {

/// Columns of a supernode that are factored together: a dense column-major piece of L, the rows of
/// the diagonal first.
struct FactorBlock {
  int first_column, columns, height;
  std::int64_t first_row;    ///< in the list of row numbers
  std::int64_t first_value;  ///< in the list of values
};

/// Numeric P A P^T = L D L^T, D = 1 where nothing else is said, on a symbolic factor of CHOLMOD: left-looking by blocks of supernodes (Ng
/// and Peyton 1993), with small products in registers that are added where they belong, so that it
/// needs no work space beside L. CHOLMOD's own calls the BLAS, whose call costs more than the work of
/// most of these supernodes.
///
/// Threads take subtrees of the elimination tree, then rows of what lies above them. No byte of L
/// depends on how many there are.
class SupernodalFactor {
 public:
  /// The symbolic factor must outlive this.
  void analyze(const Supernodes& supernodes, const SubtreeCut& cut, const int* permutation);
  /// Room that L needs, in values.
  std::size_t size() const { return size_; }
  const std::vector<FactorBlock>& blocks() const { return blocks_; }

  static constexpr int none = -1;
  /// Fills `values` with L by blocks. `signs`: of the pivots, 1 or -1, by columns in the order of elimination;
  /// none where all are positive. Returns `none`, or the first column (in that order) whose pivot has not its
  /// sign or has shrunk below `lost_pivot` of its diagonal entry.
  int factorize(const SymmetricRows& matrix, double lost_pivot, const std::vector<double>& signs, double* values,
                Team& team);

 private:
  /// Where a thread notes which row of the block at hand each row of the matrix is.
  struct WorkSpace {
    std::vector<int> place;     ///< by rows of the matrix
    std::vector<int> rows;      ///< of a block that is to be subtracted
    std::vector<int> updating;  ///< those blocks
    std::vector<double> with_signs;  ///< rows of a block times D, in the block's own places; empty without signs
  };
  struct Range {
    int begin, end;
  };

  void add_blocks(const Supernodes& supernodes, int s, int room_behind);
  const int* rows_of(const FactorBlock& block) const { return rows_ + block.first_row; }
  void begin_block(const FactorBlock& block, const SymmetricRows& matrix, double* diagonal,
                   WorkSpace& work);
  void take_updates(int block, WorkSpace& work);
  void subtract(const FactorBlock& from, Range columns, const FactorBlock& to, Range target_rows,
                const std::vector<int>& place, WorkSpace& own) const;
  const double* times_signs(const FactorBlock& block, Range rows, Range columns, WorkSpace& work) const;
  int eliminate_diagonal(const FactorBlock& block, const double* least_pivot, double* inverse_pivot,
                         WorkSpace& work) const;
  const double* top_of(const FactorBlock& block, const WorkSpace& work) const;
  void eliminate_rows(const FactorBlock& block, const double* inverse_pivot, const double* top, Range rows) const;
  void link(int block, bool above);
  int factor_subtree(Range blocks, const SymmetricRows& matrix, WorkSpace& work);
  int factor_above(const SymmetricRows& matrix, std::vector<WorkSpace>& work, Team& team);

  std::vector<FactorBlock> blocks_;
  std::vector<Range> subtrees_;    ///< of blocks
  std::vector<int> above_;         ///< the other blocks
  std::vector<char> is_above_;     ///< by block
  std::vector<int> block_of_;      ///< by column
  std::vector<int> inverse_;       ///< of the permutation
  std::size_t size_ = 0;
  int tallest_ = 0;
  const int* permutation_ = nullptr;
  const int* rows_ = nullptr;

  // while factorising
  double* values_ = nullptr;
  double lost_pivot_ = 0.0;
  const double* signs_ = nullptr;  ///< null: all are 1
  std::vector<int> first_update_, next_update_;  ///< lists of the blocks that a block waits for
  std::vector<int> done_rows_;                   ///< of each block: rows above have been subtracted
};

}  // namespace pfv

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

/// The blocks of L and where each row and column of the matrix is in them: all that the pattern decides.
struct BlockLayout {
  struct Range {
    int begin, end;
  };

  std::vector<FactorBlock> blocks;
  std::vector<Range> subtrees;  ///< of blocks
  std::vector<int> above;       ///< the other blocks
  std::vector<char> is_above;   ///< by block
  std::vector<int> block_of;    ///< by column
  std::vector<int> inverse;     ///< of the permutation
  std::size_t size = 0;         ///< values of L
  int tallest = 0;              ///< rows of the highest block
  const int* permutation = nullptr;
  const int* rows = nullptr;    ///< of the symbolic factor

  const int* rows_of(const FactorBlock& block) const { return rows + block.first_row; }
};

/// Numeric P A P^T = L D L^T, D = 1 where nothing else is said, on a symbolic factor of CHOLMOD: left-looking by
/// blocks of supernodes (Ng and Peyton 1993), with small products in registers that are added where they belong, so
/// that it needs no work space beside L. CHOLMOD's own calls the BLAS, whose call costs more than the work of
/// most of these supernodes.
///
/// Threads take subtrees of the elimination tree, then rows of what lies above them. No byte of L
/// depends on how many there are.
class SupernodalFactor {
 public:
  /// The symbolic factor must outlive this.
  void analyze(const Supernodes& supernodes, const SubtreeCut& cut, const int* permutation);
  /// Room that L needs, in values.
  std::size_t size() const { return layout_.size; }
  const std::vector<FactorBlock>& blocks() const { return layout_.blocks; }

  static constexpr int none = -1;
  /// Fills `values` with L by blocks. `signs`: of the pivots, 1 or -1, by columns in the order of elimination;
  /// none where all are positive. Returns `none`, or the first column (in that order) whose pivot has not its
  /// sign or has shrunk below `lost_pivot` of its diagonal entry.
  int factorize(const SymmetricRows& matrix, double lost_pivot, const std::vector<double>& signs, double* values,
                Team& team) const;

 private:
  BlockLayout layout_;
};

}  // namespace pfv

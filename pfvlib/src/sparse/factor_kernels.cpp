// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/factor_kernels.hpp"

#include "sparse/instructions.hpp"

#include <utility>

namespace pfv::kernels {
namespace {

/// The largest tiles that the registers hold: 32 of 8 numbers, 16 of 4, 16 of 2.
template <class Set>
struct Tiles {
  static constexpr int update_vectors = 3, update_columns = 4, strip_vectors = 1;
};
#ifdef __x86_64__
template <>
struct Tiles<Avx512> {
  static constexpr int update_vectors = 3, update_columns = 8, strip_vectors = 3;
};
#endif

template <class Set, int vectors, int columns>
struct UpdateTile {
  static PFV_INLINE void run(const Update& u) { update<typename Set::Vector, vectors, columns>(u); }
};

template <class Set, int vectors, int columns>
struct EliminateTile {
  static PFV_INLINE void run(const Elimination& e) {
    eliminate<typename Set::Vector, vectors, columns>(e);
  }
};

template <class Set, int vectors, int... column>
void fill(FactorKernels& table, std::integer_sequence<int, column...>) {
  if constexpr (vectors <= Tiles<Set>::update_vectors)
    ((column < Tiles<Set>::update_columns
          ? void(table.update[vectors - 1][column] =
                     Set::template call<UpdateTile<Set, vectors, column + 1>, const Update&>)
          : void()),
     ...);
  if constexpr (vectors <= Tiles<Set>::strip_vectors)
    ((table.eliminate[vectors - 1][column] =
          Set::template call<EliminateTile<Set, vectors, column + 1>, const Elimination&>),
     ...);
}

template <class Set>
struct TableFor {
  static FactorKernels make() {
    FactorKernels table{sizeof(typename Set::Vector) / sizeof(double), Tiles<Set>::update_vectors,
                        Tiles<Set>::update_columns, Tiles<Set>::strip_vectors, {}, {}};
    constexpr std::make_integer_sequence<int, strip_width> columns;
    fill<Set, 1>(table, columns);
    fill<Set, 2>(table, columns);
    fill<Set, 3>(table, columns);
    return table;
  }
};

}  // namespace

std::vector<FactorKernels> usable_factor_kernels() {
  return usable_tables<TableFor>(AllInstructions());
}

const FactorKernels& factor_kernels() {
  static const FactorKernels table = usable_factor_kernels().front();
  return table;
}

}  // namespace pfv::kernels

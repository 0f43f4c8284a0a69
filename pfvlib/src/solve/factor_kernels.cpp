// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/factor_kernels.hpp"

#include <utility>

namespace pfv::kernels {
namespace {

// One set of instructions: 32 registers of 8 numbers, 16 of 4, 16 of 2.
#ifdef __x86_64__
struct Avx512 {
  using Vector = double __attribute__((vector_size(64)));
  static constexpr int update_vectors = 3, update_columns = 8, strip_vectors = 3;
  template <int vectors, int columns>
  __attribute__((target("avx512f,fma"))) static void update(const Update& u) {
    kernels::update<Vector, vectors, columns>(u);
  }
  template <int vectors, int columns>
  __attribute__((target("avx512f,fma"))) static void eliminate(const Elimination& e) {
    kernels::eliminate<Vector, vectors, columns>(e);
  }
};

struct Avx2 {
  using Vector = double __attribute__((vector_size(32)));
  static constexpr int update_vectors = 3, update_columns = 4, strip_vectors = 1;
  template <int vectors, int columns>
  __attribute__((target("avx2,fma"))) static void update(const Update& u) {
    kernels::update<Vector, vectors, columns>(u);
  }
  template <int vectors, int columns>
  __attribute__((target("avx2,fma"))) static void eliminate(const Elimination& e) {
    kernels::eliminate<Vector, vectors, columns>(e);
  }
};
#endif

struct Portable {
  using Vector = double __attribute__((vector_size(16)));
  static constexpr int update_vectors = 3, update_columns = 4, strip_vectors = 1;
  template <int vectors, int columns>
  static void update(const Update& u) {
    kernels::update<Vector, vectors, columns>(u);
  }
  template <int vectors, int columns>
  static void eliminate(const Elimination& e) {
    kernels::eliminate<Vector, vectors, columns>(e);
  }
};

template <class Instructions, int vectors, int... column>
void fill(FactorKernels& table, std::integer_sequence<int, column...>) {
  if constexpr (vectors <= Instructions::update_vectors)
    ((column < Instructions::update_columns
          ? void(table.update[vectors - 1][column] =
                     Instructions::template update<vectors, column + 1>)
          : void()),
     ...);
  if constexpr (vectors <= Instructions::strip_vectors)
    ((table.eliminate[vectors - 1][column] = Instructions::template eliminate<vectors, column + 1>),
     ...);
}

template <class Instructions>
FactorKernels table_for() {
  FactorKernels table{sizeof(typename Instructions::Vector) / sizeof(double), Instructions::update_vectors,
                      Instructions::update_columns, Instructions::strip_vectors, {}, {}};
  constexpr std::make_integer_sequence<int, strip_width> columns;
  fill<Instructions, 1>(table, columns);
  fill<Instructions, 2>(table, columns);
  fill<Instructions, 3>(table, columns);
  return table;
}

}  // namespace

std::vector<FactorKernels> usable_factor_kernels() {
  std::vector<FactorKernels> usable;
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f")) usable.push_back(table_for<Avx512>());
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    usable.push_back(table_for<Avx2>());
#endif
  usable.push_back(table_for<Portable>());
  return usable;
}

const FactorKernels& factor_kernels() {
  static const FactorKernels table = usable_factor_kernels().front();
  return table;
}

}  // namespace pfv::kernels

// SPDX-License-Identifier: GPL-3.0-or-later
// Inner loops are compiled for several sets of instructions, and the program chooses when it runs: this is
// the one way in which that is done here.
//
// A kernel is a class with a static `run` that is always inlined (PFV_INLINE), with all that it calls.
// `Set::call<Kernel, Arguments...>` is that code compiled for a set; a table holds such functions, and
// `usable_tables` makes it for each set that this processor has.
#pragma once

#include <vector>

#define PFV_INLINE inline __attribute__((always_inline))

namespace pfv::kernels {

/// `Vector`: the doubles of a register. (A size that depends on a template's parameter would be dropped by
/// GCC 12 without a word.)
struct Portable {
  using Vector = double __attribute__((vector_size(16)));
  static bool is_here() { return true; }
  template <class Kernel, class... Arguments>
  static void call(Arguments... arguments) {
    Kernel::run(arguments...);
  }
};

#ifdef __x86_64__
struct Avx2 {
  using Vector = double __attribute__((vector_size(32)));
  static bool is_here() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
  template <class Kernel, class... Arguments>
  __attribute__((target("avx2,fma"))) static void call(Arguments... arguments) {
    Kernel::run(arguments...);
  }
};

struct Avx512 {
  using Vector = double __attribute__((vector_size(64)));
  static bool is_here() { return __builtin_cpu_supports("avx512f"); }
  template <class Kernel, class... Arguments>
  __attribute__((target("avx512f,fma"))) static void call(Arguments... arguments) {
    Kernel::run(arguments...);
  }
};
#endif

/// Sets of instructions, the fastest first.
template <class... Sets>
struct InstructionSets {};
#ifdef __x86_64__
using AllInstructions = InstructionSets<Avx512, Avx2, Portable>;
using Within256Bits = InstructionSets<Avx2, Portable>;  ///< where memory sets the time
#else
using AllInstructions = InstructionSets<Portable>;
using Within256Bits = AllInstructions;
#endif

/// TableFor<Set>::make() for each of the sets that this processor has; at least one.
template <template <class> class TableFor, class... Sets>
auto usable_tables(InstructionSets<Sets...>) {
  std::vector<decltype(TableFor<Portable>::make())> tables;
  ((Sets::is_here() ? tables.push_back(TableFor<Sets>::make()) : void()), ...);
  return tables;
}

}  // namespace pfv::kernels

// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the style `pfv` to a stock libliggghts, without rebuilding it. Every `fix` command of every
// Modify object (a `clear` makes a new one) passes through Modify::add_fix; this library's
// definition stands before the one of libliggghts in the lookup order, enters the style, and calls
// the original.
#include "fix_pfv.h"
#include "private_member.h"

#include "modify.h"

#include <dlfcn.h>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

using namespace LAMMPS_NS;

using PfvFixCreator = Fix* (*)(LAMMPS*, int, char**);
using PfvFixMap = std::map<std::string, PfvFixCreator>;

namespace LAMMPS_NS {
PFV_PRIVATE_MEMBER(PfvFixMapOf, PfvFixMap*, Modify, fix_map)
}

namespace {

Fix* create_pfv(LAMMPS* lmp, int narg, char** arg) { return new FixPfv(lmp, narg, arg); }

using AddFix = void (*)(Modify*, int, char**, char*);

AddFix original_add_fix() {
  // Modify::add_fix(int, char**, char*)
  void* symbol = dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS6Modify7add_fixEiPPcS1_");
  if (!symbol) {
    std::fputs("fix pfv: libliggghts has no Modify::add_fix(int, char**, char*) as 3.8 has\n",
               stderr);
    std::abort();
  }
  return reinterpret_cast<AddFix>(symbol);
}

}  // namespace

__attribute__((visibility("default"))) void Modify::add_fix(int narg, char** arg, char* suffix) {
  static const AddFix original = original_add_fix();
  (*(this->*member(PfvFixMapOf())))["pfv"] = &create_pfv;
  original(this, narg, arg, suffix);
}

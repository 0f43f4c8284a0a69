// SPDX-License-Identifier: GPL-3.0-or-later
// Access to private members of LIGGGHTS' classes. Access is not checked for the arguments of an
// explicit instantiation ([temp.spec]), which makes this the one way to them that the language
// allows:
//
//     PFV_PRIVATE_MEMBER(PfvFixMapOf, PfvFixMap*, Modify, fix_map)    // in namespace LAMMPS_NS
//     ... object.*member(PfvFixMapOf())
#ifndef LMP_PFV_PRIVATE_MEMBER_H
#define LMP_PFV_PRIVATE_MEMBER_H

namespace LAMMPS_NS {

template <typename Tag, typename Tag::Member Pointer>
struct PfvExpose {
  friend typename Tag::Member member(Tag) { return Pointer; }
};

}  // namespace LAMMPS_NS

#define PFV_PRIVATE_MEMBER(TAG, TYPE, OWNER, NAME) \
  struct TAG {                                     \
    using Member = TYPE OWNER::*;                  \
    friend Member member(TAG);                     \
  };                                               \
  template struct PfvExpose<TAG, &OWNER::NAME>;

#endif

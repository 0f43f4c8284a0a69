// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/network.hpp"

#include <cstdint>
#include <vector>

namespace pfv {

/// Where pores meet the box and its regions. Boundary number f < face_count is face f, then come the patches,
/// then the regions.
struct PoreBoundaries {
  static constexpr int inside = -1;  ///< in the place of a face: a pore's part in its region
  struct Contact {
    int pore, face, boundary;
  };
  std::vector<Contact> contacts;           ///< sorted by pore, then by face; `inside` comes first
  std::vector<std::uint8_t> no_slip_faces;  ///< one entry a pore; bit f: it rubs on face f
};

/// Which face or patch each boundary pore belongs to; geometry only, so values may change later.
PoreBoundaries find_pore_boundaries(const PoreNetwork& network, const Box& box);

inline int patch_number(std::size_t patch) { return face_count + static_cast<int>(patch); }
inline int first_region(const Box& box) { return patch_number(box.patches.size()); }
inline int boundary_count(const Box& box) {
  return first_region(box) + static_cast<int>(box.regions.size());
}
inline const Boundary& boundary_of(const Box& box, int number) {
  if (number < face_count) return box.faces[number].boundary;
  if (number < first_region(box)) return box.patches[number - face_count].boundary;
  return box.regions[number - first_region(box)].boundary;
}
/// "face zlo", "patch 2 on face zhi", "region 1": for messages.
std::string boundary_name(const Box& box, int number);

}  // namespace pfv

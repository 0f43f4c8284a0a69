// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/network.hpp"

#include <cstdint>
#include <vector>

namespace pfv {

/// Where pores meet the box. Boundary number f < 6 is face f, 6 + i is patch i.
struct PoreBoundaries {
  struct Contact {
    int pore, face, boundary;
  };
  std::vector<Contact> contacts;           ///< sorted by pore, then by face
  std::vector<std::uint8_t> no_slip_faces;  ///< one entry a pore; bit f: it rubs on face f
};

/// Which face or patch each boundary pore belongs to; geometry only, so values may change later.
PoreBoundaries find_pore_boundaries(const PoreNetwork& network, const Box& box);

inline const Boundary& boundary_of(const Box& box, int number) {
  return number < 6 ? box.faces[number].boundary : box.patches[number - 6].boundary;
}
/// "face zlo", "patch 2 on face zhi": for messages.
std::string boundary_name(const Box& box, int number);

}  // namespace pfv

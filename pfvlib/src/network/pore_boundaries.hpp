// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parallel/share.hpp"
#include "pfv/container.hpp"
#include "pfv/network.hpp"

#include <cstdint>
#include <vector>

namespace pfv {

/// Where pores meet the container and its regions. Boundary number f < face_count() is face f, then come the
/// patches, then the regions.
struct PoreBoundaries {
  static constexpr int inside = -1;  ///< in the place of a face: a pore's part in its region
  struct Contact {
    int pore, face, boundary;
  };
  std::vector<Contact> contacts;           ///< sorted by pore, then by face; `inside` comes first
  std::vector<FaceSet> no_slip_faces;  ///< one entry a pore; bit f: it rubs on face f

  /// Number of a pore's contact with a face, which must exist.
  int contact_of(int pore, int face) const;
};

/// Which face or patch each boundary pore belongs to; geometry only, so values may change later.
/// Collective where several ranks share the network.
PoreBoundaries find_pore_boundaries(const PoreNetwork& network, const Container& container, const Share& share = {});

inline int patch_number(const Container& container, std::size_t patch) {
  return container.face_count() + static_cast<int>(patch);
}
inline int first_region(const Container& container) { return patch_number(container, container.patches.size()); }
inline int boundary_count(const Container& container) {
  return first_region(container) + static_cast<int>(container.regions.size());
}
inline const Boundary& boundary_of(const Container& container, int number) {
  const int faces = container.face_count(), regions = first_region(container);
  if (number < faces) return container.faces[number].boundary;
  if (number < regions) return container.patches[number - faces].boundary;
  return container.regions[number - regions].boundary;
}
/// What a boundary with an imposed flow rate lets in, m³/s; 0 for any other. The one place that knows how a kind's value
/// makes a flow rate.
double imposed_inflow(const Container& container, int number);
/// "face zlo", "patch 2 on face zhi", "region 1": for messages.
std::string boundary_name(const Container& container, int number);

}  // namespace pfv

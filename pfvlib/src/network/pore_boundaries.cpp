// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/pore_boundaries.hpp"

#include <algorithm>
#include <limits>

namespace pfv {

namespace {

/// The patch's rectangle and the pore's place in the plane of its face.
struct InFace {
  Eigen::Vector2d lower, upper, place;
};

InFace in_face(const Patch& patch, const PoreNetwork& network, int pore) {
  const int axis = axis_of(patch.face), first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
  const Eigen::Vector3d place = network.origin + network.pore_centres.col(pore);
  return {{patch.rectangle[0], patch.rectangle[2]},
          {patch.rectangle[1], patch.rectangle[3]},
          {place[first], place[second]}};
}

/// Borders included, rounding or not: a lattice may have its pores on them.
bool within(const InFace& p) {
  const Eigen::Array2d slack = 1e-9 * (p.upper - p.lower).array();
  return (p.place.array() >= p.lower.array() - slack).all() &&
         (p.place.array() <= p.upper.array() + slack).all();
}

void give_to_patch(std::vector<PoreBoundaries::Contact>& contacts, const PoreNetwork& network,
                   const Box& box, int number) {
  const Patch& patch = box.patches[number];
  PoreBoundaries::Contact* nearest = nullptr;
  double nearest_distance = std::numeric_limits<double>::infinity();
  bool any = false;
  for (PoreBoundaries::Contact& contact : contacts) {
    if (contact.face != static_cast<int>(patch.face)) continue;
    const InFace place = in_face(patch, network, contact.pore);
    if (within(place)) {
      contact.boundary = patch_number(number);
      any = true;
    }
    const double distance = (place.place - 0.5 * (place.lower + place.upper)).norm();
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = &contact;
    }
  }
  if (!any && nearest) nearest->boundary = patch_number(number);
}

/// The region of each pore, or -1.
std::vector<int> regions_of_pores(const PoreNetwork& network, const Box& box) {
  std::vector<int> region_of(network.pores(), -1);
  for (std::size_t number = 0; number < box.regions.size(); ++number) {
    const Region& region = box.regions[number];
    const Eigen::Array3d slack = 1e-9 * (region.upper - region.lower).array();
    const Eigen::Vector3d middle = 0.5 * (region.lower + region.upper);
    int nearest = -1;
    double nearest_distance = std::numeric_limits<double>::infinity();
    bool any = false;
    for (int pore = 0; pore < network.pores(); ++pore) {
      const Eigen::Vector3d place = network.origin + network.pore_centres.col(pore);
      if ((place.array() >= region.lower.array() - slack).all() &&
          (place.array() <= region.upper.array() + slack).all()) {
        region_of[pore] = static_cast<int>(number);
        any = true;
      }
      const double distance = (place - middle).norm();
      if (distance < nearest_distance) {
        nearest_distance = distance;
        nearest = pore;
      }
    }
    if (!any && nearest >= 0) region_of[nearest] = static_cast<int>(number);
  }
  return region_of;
}

void give_to_regions(std::vector<PoreBoundaries::Contact>& contacts, const PoreNetwork& network,
                     const Box& box) {
  if (box.regions.empty()) return;
  const std::vector<int> region_of = regions_of_pores(network, box);
  for (PoreBoundaries::Contact& contact : contacts)
    if (region_of[contact.pore] >= 0)
      contact.boundary = first_region(box) + region_of[contact.pore];
  for (int pore = 0; pore < network.pores(); ++pore)
    if (region_of[pore] >= 0)
      contacts.push_back({pore, PoreBoundaries::inside, first_region(box) + region_of[pore]});
  std::sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return std::pair(a.pore, a.face) < std::pair(b.pore, b.face);
  });
}

}  // namespace

std::string boundary_name(const Box& box, int number) {
  if (number < face_count) return std::string("face ") + name_of(static_cast<Face>(number));
  if (number >= first_region(box))
    return "region " + std::to_string(number - first_region(box) + 1);
  return "patch " + std::to_string(number - face_count + 1) + " on face " +
         name_of(box.patches[number - face_count].face);
}

PoreBoundaries find_pore_boundaries(const PoreNetwork& network, const Box& box) {
  PoreBoundaries result;
  for (int pore = 0; pore < network.pores(); ++pore)
    for (int face = 0; face < face_count; ++face)
      if (network.pore_faces[pore] >> face & 1) result.contacts.push_back({pore, face, face});
  for (std::size_t i = 0; i < box.patches.size(); ++i)
    give_to_patch(result.contacts, network, box, static_cast<int>(i));

  result.no_slip_faces.assign(network.pores(), 0);
  for (const auto& contact : result.contacts)
    if (box.faces[contact.face].wall == Wall::no_slip &&
        !boundary_of(box, contact.boundary).is_open())
      result.no_slip_faces[contact.pore] |= static_cast<std::uint8_t>(1u << contact.face);
  give_to_regions(result.contacts, network, box);
  return result;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/pore_boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

/// The point of a face that is nearest to a pore.
Eigen::Vector3d place_on(const Surface& surface, const Eigen::Vector3d& pore) {
  return pore + surface.distance(pore) * surface.outward_at(pore);
}

/// Borders included, rounding or not: a lattice may have its pores on them.
bool within(const ContainerPatch& patch, const Eigen::Vector3d& place) {
  for (int axis = 0; axis < 3; ++axis) {
    const double width = patch.upper[axis] - patch.lower[axis], slack = std::isfinite(width) ? 1e-9 * width : 0.0;
    if (!(place[axis] >= patch.lower[axis] - slack && place[axis] <= patch.upper[axis] + slack)) return false;
  }
  return true;
}

/// From the middle of the block, along the axes that it bounds on both sides.
double distance_from_middle(const ContainerPatch& patch, const Eigen::Vector3d& place) {
  Eigen::Vector3d away = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (std::isfinite(patch.upper[axis] - patch.lower[axis]))
      away[axis] = place[axis] - 0.5 * (patch.lower[axis] + patch.upper[axis]);
  return away.norm();
}

/// Which pores take a boundary that has none inside: `nearest` (-1: none here), or of several ranks that of the lowest
/// rank of those that are equally near; its ghosts are told.
std::vector<int> takers(const Share& share, int pores, bool any_inside, int nearest, double distance) {
  if (share.any(any_inside)) return {};
  if (!share.ranks) return nearest < 0 ? std::vector<int>{} : std::vector<int>{nearest};
  const bool least = -share.largest(nearest < 0 ? -std::numeric_limits<double>::infinity() : -distance) == distance &&
                     nearest >= 0;
  Eigen::VectorXd marks = Eigen::VectorXd::Zero(pores);
  if (share.is_lowest(least)) marks[nearest] = 1.0;
  share.pores.refresh(*share.ranks, marks);
  std::vector<int> taken;
  for (int pore = 0; pore < pores; ++pore)
    if (marks[pore] > 0.0) taken.push_back(pore);
  return taken;
}

void give_to_patch(std::vector<PoreBoundaries::Contact>& contacts, const PoreNetwork& network,
                   const Container& container, int number, const Share& share) {
  const ContainerPatch& patch = container.patches[number];
  const Surface& surface = container.faces[patch.face].surface;
  int nearest = -1;
  double nearest_distance = std::numeric_limits<double>::infinity();
  bool any = false;
  for (PoreBoundaries::Contact& contact : contacts) {
    if (contact.face != patch.face || !share.has_whole(contact.pore)) continue;
    const Eigen::Vector3d place = place_on(surface, network.origin + network.pore_centres.col(contact.pore));
    if (within(patch, place)) {
      contact.boundary = patch_number(container, number);
      any = true;
    }
    const double distance = distance_from_middle(patch, place);
    if (share.owns_pore(contact.pore) && distance < nearest_distance) {
      nearest_distance = distance;
      nearest = contact.pore;
    }
  }
  for (const int pore : takers(share, network.pores(), any, nearest, nearest_distance))
    for (PoreBoundaries::Contact& contact : contacts)
      if (contact.pore == pore && contact.face == patch.face) contact.boundary = patch_number(container, number);
}

/// The region of each pore, or -1.
std::vector<int> regions_of_pores(const PoreNetwork& network, const Container& container, const Share& share) {
  std::vector<int> region_of(network.pores(), -1);
  for (std::size_t number = 0; number < container.regions.size(); ++number) {
    const Region& region = container.regions[number];
    const Eigen::Array3d slack = 1e-9 * (region.upper - region.lower).array();
    const Eigen::Vector3d middle = 0.5 * (region.lower + region.upper);
    int nearest = -1;
    double nearest_distance = std::numeric_limits<double>::infinity();
    bool any = false;
    for (int pore = 0; pore < network.pores(); ++pore) {
      if (!share.has_whole(pore)) continue;
      const Eigen::Vector3d place = network.origin + network.pore_centres.col(pore);
      if ((place.array() >= region.lower.array() - slack).all() &&
          (place.array() <= region.upper.array() + slack).all()) {
        region_of[pore] = static_cast<int>(number);
        any = true;
      }
      const double distance = (place - middle).norm();
      if (share.owns_pore(pore) && distance < nearest_distance) {
        nearest_distance = distance;
        nearest = pore;
      }
    }
    for (const int pore : takers(share, network.pores(), any, nearest, nearest_distance))
      region_of[pore] = static_cast<int>(number);
  }
  return region_of;
}

void give_to_regions(std::vector<PoreBoundaries::Contact>& contacts, const PoreNetwork& network,
                     const Container& container, const Share& share) {
  if (container.regions.empty()) return;
  const std::vector<int> region_of = regions_of_pores(network, container, share);
  for (PoreBoundaries::Contact& contact : contacts)
    if (region_of[contact.pore] >= 0)
      contact.boundary = first_region(container) + region_of[contact.pore];
  for (int pore = 0; pore < network.pores(); ++pore)
    if (region_of[pore] >= 0)
      contacts.push_back({pore, PoreBoundaries::inside, first_region(container) + region_of[pore]});
  std::sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return std::pair(a.pore, a.face) < std::pair(b.pore, b.face);
  });
}

}  // namespace

double imposed_inflow(const Container& container, int number) {
  const Boundary& boundary = boundary_of(container, number);
  return boundary.imposes_flux() ? boundary.value : 0.0;
}

std::string boundary_name(const Container& container, int number) {
  const int faces = container.face_count();
  if (number < faces) return "face " + container.faces[number].name;
  if (number >= first_region(container))
    return "region " + std::to_string(number - first_region(container) + 1);
  return "patch " + std::to_string(number - faces + 1) + " on face " +
         container.faces[container.patches[number - faces].face].name;
}

int PoreBoundaries::contact_of(int pore, int face) const {
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), std::pair(pore, face),
                                      [](const Contact& contact, const std::pair<int, int>& wanted) {
                                        return std::pair(contact.pore, contact.face) < wanted;
                                      });
  return static_cast<int>(found - contacts.begin());
}

PoreBoundaries find_pore_boundaries(const PoreNetwork& network, const Container& container, const Share& share) {
  PoreBoundaries result;
  for (int pore = 0; pore < network.pores(); ++pore)
    for (int face = 0; face < container.face_count(); ++face)
      if (network.pore_faces[pore] & face_bit(face)) result.contacts.push_back({pore, face, face});
  for (std::size_t i = 0; i < container.patches.size(); ++i)
    give_to_patch(result.contacts, network, container, static_cast<int>(i), share);

  result.no_slip_faces.assign(network.pores(), 0);
  for (const auto& contact : result.contacts)
    if (container.faces[contact.face].wall == Wall::no_slip &&
        !boundary_of(container, contact.boundary).is_open())
      result.no_slip_faces[contact.pore] |= face_bit(contact.face);
  give_to_regions(result.contacts, network, container, share);
  return result;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/balance.hpp"

#include "step/continuity.hpp"
#include "step/forces.hpp"
#include "step/operators.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// Whether fluid comes in at a contact, by what its boundary imposes.
bool carries(const BuiltNetwork& built, const Solution& solution, const PoreBoundaries::Contact& contact) {
  // what a region brings in enters inside, also into a pore that touches a face
  if (contact.boundary >= first_region(solution.container) && contact.face != PoreBoundaries::inside) return false;
  const Boundary& boundary = boundary_of(solution.container, contact.boundary);
  const int unknown = built.unknowns.of_pore[contact.pore];
  if (unknown == Unknowns::imposed) return boundary.imposes_pressure();
  return boundary.imposes_flux() && built.unknowns.of_boundary[contact.boundary] == unknown;
}

/// Pores that bodies close off may share the pressure of a flux boundary that they do not touch: what they take comes in
/// there, spread over its contacts by area; over a region, which has none, alike.
void add_inflows_of_joined(const BuiltNetwork& built, const Solution& solution, const Eigen::VectorXd& inflow,
                           std::vector<double>& inflows) {
  if (built.closed.joined == 0) return;
  const auto& contacts = built.boundaries.contacts;
  const Unknowns& unknowns = built.unknowns;
  const auto boundaries = static_cast<Eigen::Index>(unknowns.of_boundary.size());
  std::vector<char> at_boundary(unknowns.of_pore.size(), 0);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(2 * boundaries);  // of each boundary: inflow, weight of its contacts
  std::vector<double> weights(contacts.size(), 0.0);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& [pore, face, boundary] = contacts[c];
    if (!carries(built, solution, contacts[c])) continue;
    at_boundary[pore] = 1;
    if (!built.share.owns_pore(pore) || unknowns.of_boundary[boundary] < 0) continue;
    weights[c] = face == PoreBoundaries::inside ? 1.0 : std::abs(built.bases.area[c]);
    sums[boundaries + boundary] += weights[c];
  }
  for (Eigen::Index b = 0; b < boundaries; ++b)
    for (std::size_t pore = 0; pore < at_boundary.size() && unknowns.of_boundary[b] >= 0; ++pore)
      if (unknowns.of_pore[pore] == unknowns.of_boundary[b] && !at_boundary[pore])
        sums[b] += inflow[static_cast<Eigen::Index>(pore)];
  built.share.add(sums);
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (weights[c] > 0.0) inflows[c] += sums[contacts[c].boundary] * weights[c] / sums[boundaries + contacts[c].boundary];
}

/// Flow rate (m³/s) into the box through each boundary contact.
std::vector<double> contact_inflows(const BuiltNetwork& built, const Solution& solution,
                                    const Eigen::VectorXd& inflow) {
  const auto& contacts = built.boundaries.contacts;
  std::vector<double> result(contacts.size(), 0.0);
  for (std::size_t first = 0; first < contacts.size();) {
    std::size_t last = first;
    double area = 0.0;
    int open = 0;
    for (; last < contacts.size() && contacts[last].pore == contacts[first].pore; ++last)
      if (carries(built, solution, contacts[last])) {
        area += std::abs(built.bases.area[last]);
        ++open;
      }
    // a pore on several open faces: by its base on each; where it has none to speak of, alike
    for (std::size_t c = first; c < last; ++c) {
      if (!carries(built, solution, contacts[c])) continue;
      if (contacts[c].face == PoreBoundaries::inside) result[c] = inflow[contacts[c].pore];
      else
        result[c] = inflow[contacts[c].pore] *
                    (area > 0.0 ? std::abs(built.bases.area[c]) / area : 1.0 / open);
    }
    first = last;
  }
  add_inflows_of_joined(built, solution, inflow, result);
  return result;
}

}  // namespace

std::vector<BoundaryPart> boundary_parts(const BuiltNetwork& built, const Solution& solution,
                                         const std::vector<double>& inflows) {
  std::vector<BoundaryPart> parts;
  for (std::size_t c = 0; c < inflows.size(); ++c) {
    const PoreBoundaries::Contact& contact = built.boundaries.contacts[c];
    const bool of_region = contact.boundary >= first_region(solution.container);
    if (of_region && contact.face != PoreBoundaries::inside) continue;  // it enters inside
    if (!built.share.owns_pore(contact.pore)) continue;
    parts.push_back({contact.boundary, inflows[c], solution.pressures[contact.pore]});
  }
  return parts;
}

double traffic(const BuiltNetwork& built, const Solution& solution) {
  const PoreNetwork& network = built.network;
  double sum = gross_rates(built, solution.motion).sum();
  for (int t = 0; t < network.throats(); ++t)
    for (const int pore : network.throat_pores[t])
      if (built.share.owns_pore(pore)) sum += built.conductances.value[t] * std::abs(solution.relative_pressures[pore]);
  if (built.kept.compressible())
    sum += built.kept.storage->dot(solution.pressures.cwiseAbs() +
                                  solution.previous_pressures.cwiseAbs());
  return built.share.sum(sum);
}

namespace {

/// What the macroscopic gradient pushes into the pores of one period, across the surface that parts
/// them from their images; grains and walls carry it.
Eigen::Vector3d driving_force(const BuiltNetwork& built, const Solution& solution) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(3);
  if (solution.container.pressure_gradient.isZero(0.0)) return sum;
  const PoreNetwork& network = built.network;
  for (int t = 0; t < network.throats(); ++t)
    if (built.share.owns_pore(network.throat_pores[t][0]))
      sum += solution.container.pressure_gradient.dot(network.throat_offset(t)) *
             built.throats.area[t] * built.throats.normal.col(t);
  built.share.add(sum);
  return sum;
}

}  // namespace

double force_balance_error(const BuiltNetwork& built, const Solution& solution,
                           const std::vector<FaceResult>& faces) {
  if (solution.loads.cols() == 0) return 0.0;
  const int spheres = built.grains.spheres.size();
  const Eigen::Vector3d driven = driving_force(built, solution);
  Eigen::VectorXd of_spheres = solution.loads.topLeftCorner(3, spheres).rowwise().sum();
  built.share.add(of_spheres);
  Eigen::Vector3d sum = driven + of_spheres;
  for (const FaceResult& face : faces) sum += face.force_pressure + face.force_viscous;
  const double highest = largest_pressure(built, solution.pressures);
  // drags in open water may be all there is
  const double largest = built.share.largest(
      spheres > 0 ? solution.loads.topLeftCorner(3, spheres).colwise().norm().maxCoeff() : 0.0);
  return force_balance_error(sum, highest, solution.container, std::max(driven.norm(), largest));
}

Balance balance_of(const BuiltNetwork& built, const Solution& solution, std::int64_t& solves) {
  Balance balance;
  balance.correction = pressure_correction(built, solution, solves);
  balance.throat_fluxes = throat_fluxes(built, solution, balance.correction);
  balance.contact_inflows = contact_inflows(
      built, solution, pore_inflows(built, solution, balance.throat_fluxes, balance.correction));
  balance.faces = face_forces(built, solution);
  for (std::size_t c = 0; c < balance.contact_inflows.size(); ++c) {
    const int face = built.boundaries.contacts[c].face;
    if (face != PoreBoundaries::inside) balance.faces[face].flux += balance.contact_inflows[c];
  }
  if (built.share.ranks)
    for (FaceResult& face : balance.faces) face.flux = built.share.sum(face.flux);
  return balance;
}

}  // namespace pfv

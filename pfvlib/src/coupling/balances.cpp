// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance_terms.hpp"
#include "coupling/continuity.hpp"
#include "coupling/flow_data.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// Flow rate (m³/s) into the box through each boundary contact.
std::vector<double> contact_inflows(const FlowData& flow, const Eigen::VectorXd& inflow) {
  const auto& contacts = flow.built->boundaries.contacts;
  const auto carries = [&](const PoreBoundaries::Contact& contact) {
    // what a region brings in enters inside, also into a pore that touches a face
    if (contact.boundary >= first_region(flow.solved_box) &&
        contact.face != PoreBoundaries::inside)
      return false;
    const Boundary& boundary = boundary_of(flow.solved_box, contact.boundary);
    const int unknown = flow.built->unknowns.of_pore[contact.pore];
    if (unknown == Unknowns::imposed) return boundary.imposes_pressure();
    return boundary.imposes_flux() &&
           flow.built->unknowns.of_boundary[contact.boundary] == unknown;
  };
  std::vector<double> result(contacts.size(), 0.0);
  for (std::size_t first = 0; first < contacts.size();) {
    std::size_t last = first;
    double area = 0.0;
    for (; last < contacts.size() && contacts[last].pore == contacts[first].pore; ++last)
      if (carries(contacts[last])) area += flow.built->bases.area[last];
    // a pore on several open faces: by its base on each
    for (std::size_t c = first; c < last; ++c) {
      if (!carries(contacts[c])) continue;
      if (contacts[c].face == PoreBoundaries::inside) result[c] = inflow[contacts[c].pore];
      else if (area > 0.0)
        result[c] = inflow[contacts[c].pore] * flow.built->bases.area[c] / area;
    }
    first = last;
  }
  return result;
}

std::vector<OpeningResult> openings(const FlowData& flow, const std::vector<double>& inflows) {
  const Box& box = flow.solved_box;
  std::vector<OpeningResult> results;
  for (int boundary = 6; boundary < boundary_count(box); ++boundary) {
    OpeningResult result;
    result.name = boundary_name(box, boundary);
    double sum = 0.0;
    for (std::size_t c = 0; c < inflows.size(); ++c) {
      const PoreBoundaries::Contact& contact = flow.built->boundaries.contacts[c];
      const bool own = boundary < first_region(box) || contact.face == PoreBoundaries::inside;
      if (contact.boundary != boundary || !own) continue;
      ++result.pores;
      result.flux += inflows[c];
      sum += flow.pressures[contact.pore];
    }
    if (result.pores > 0) result.pressure = sum / static_cast<double>(result.pores);
    results.push_back(result);
  }
  return results;
}

Totals boundary_totals(const FlowData& flow, const std::vector<double>& inflows) {
  const auto& contacts = flow.built->boundaries.contacts;
  std::vector<double> of_boundary(boundary_count(flow.solved_box), 0.0);
  Totals totals;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    of_boundary[contacts[c].boundary] += inflows[c];
    totals.gross += std::abs(inflows[c]);
  }
  for (const double q : of_boundary) (q > 0.0 ? totals.inflow : totals.outflow) += std::abs(q);
  return totals;
}

/// What the throats would carry and the pores store if pressures did not cancel, and what the grains
/// displace: fluxes below the machine precision of this are round-off, not flow.
double traffic(const FlowData& flow) {
  const PoreNetwork& network = flow.built->network;
  double sum = gross_rates(*flow.built, flow.motion).sum();
  for (int t = 0; t < network.throats(); ++t)
    sum += flow.built->conductances.value[t] *
           (std::abs(flow.relative_pressures[network.throat_pores[t][0]]) +
            std::abs(flow.relative_pressures[network.throat_pores[t][1]]));
  if (flow.built->storage.size() > 0)
    sum += flow.built->storage.dot(flow.pressures.cwiseAbs() + flow.previous_pressures.cwiseAbs());
  return sum;
}

/// What the macroscopic gradient pushes into the pores of one period, across the surface that parts
/// them from their images; grains and walls carry it.
Eigen::Vector3d driving_force(const FlowData& flow) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  if (flow.solved_box.pressure_gradient.isZero(0.0)) return sum;
  const PoreNetwork& network = flow.built->network;
  for (int t = 0; t < network.throats(); ++t)
    sum += flow.solved_box.pressure_gradient.dot(network.throat_offset(t)) *
           flow.built->throats.area[t] * flow.built->throats.normal.col(t);
  return sum;
}

double force_balance_error(const FlowData& flow, const std::array<FaceResult, 6>& faces) {
  if (flow.loads.cols() == 0) return 0.0;
  const int spheres = flow.built->grains.spheres.size();
  const Eigen::Vector3d driven = driving_force(flow);
  Eigen::Vector3d sum = driven + flow.loads.topLeftCorner(3, spheres).rowwise().sum();
  for (const FaceResult& face : faces) sum += face.force_pressure + face.force_viscous;
  const double largest_pressure =
      flow.pressures.size() > 0 ? flow.pressures.cwiseAbs().maxCoeff() : 0.0;
  return force_balance_error(sum, largest_pressure, flow.solved_box, driven.norm());
}

void fill_geometry(Report& report, FlowData& flow) {
  BuiltNetwork& built = *flow.built;
  if (!built.solid)
    built.solid = solid_union(built.network, built.vertices, built.grains.spheres);
  report.spheres = static_cast<std::int64_t>(flow.packing_ids.size());
  report.hidden = static_cast<std::int64_t>(built.network.hidden.size());
  report.outside = report.spheres - built.grains.spheres.size();
  report.pores = built.network.pores();
  report.unknowns = built.unknowns.count;
  const double volume = built.grains.spheres.edges.prod();
  // where spheres as large as the box leave nothing, round-off may leave less
  report.pore_volume = std::clamp(volume - built.solid->volume, 0.0, volume);
  report.porosity = report.pore_volume / volume;
  report.solid_area = built.solid->area;
}

}  // namespace

std::array<FaceResult, 6> face_forces(const FlowData& flow) {
  std::array<FaceResult, 6> faces;
  const auto& contacts = flow.built->boundaries.contacts;
  const int spheres = flow.built->grains.spheres.size();
  std::array<double, 6> relative{};
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (contacts[c].face != PoreBoundaries::inside)
      relative[contacts[c].face] +=
          flow.relative_pressures[contacts[c].pore] * flow.built->bases.area[c];
  const Eigen::Vector3d on_growth = flow.forces_on_growth();
  for (const Face face : all_faces) {
    const int f = static_cast<int>(face);
    faces[f].force_pressure = (relative[f] + on_growth[axis_of(face)] +
                               flow.reference * flow.solved_box.area(face)) *
                              outward_normal(face);
    if (flow.loads.cols() > 0) faces[f].force_viscous = flow.loads.col(spheres + f).head<3>();
  }
  return faces;
}

const Balance& FlowData::balance() {
  require_result();
  if (!balance_) {
    Balance fresh;
    fresh.correction = pressure_correction(*this);
    fresh.throat_fluxes = throat_fluxes(*this, solved_box, fresh.correction);
    fresh.contact_inflows =
        contact_inflows(*this, pore_inflows(*this, fresh.throat_fluxes, fresh.correction));
    fresh.faces = face_forces(*this);
    for (std::size_t c = 0; c < fresh.contact_inflows.size(); ++c) {
      const int face = built->boundaries.contacts[c].face;
      if (face != PoreBoundaries::inside) fresh.faces[face].flux += fresh.contact_inflows[c];
    }
    balance_ = std::move(fresh);
  }
  return *balance_;
}

Report make_report(FlowData& flow) {
  Report report;
  fill_geometry(report, flow);
  const Balance& balance = flow.balance();
  const Totals totals = boundary_totals(flow, balance.contact_inflows);
  report.inflow = totals.inflow;
  report.outflow = totals.outflow;
  report.volume_rate_sum = flow.rates.sum();
  if (flow.built->storage.size() > 0)
    report.storage_rate =
        flow.built->storage.dot(flow.pressures - flow.previous_pressures + balance.correction);
  report.fluid_volume =
      fluid_space(flow.solved_box.volume(), flow.built->grains.spheres);
  report.fluid_came_in = flow.account.came_in;
  report.fluid_balance_error =
      flow.fluid_missing() / std::max(*report.fluid_volume, 0.01 * flow.solved_box.volume());
  report.mass_error = mass_error(totals, report.volume_rate_sum, report.storage_rate, traffic(flow));
  add_permeability(report, flow, totals, balance.throat_fluxes);
  if (flow.forces.total.cols() > 0) report.force_sum = flow.forces.total.rowwise().sum();
  report.force_balance_error = force_balance_error(flow, balance.faces);
  report.residual = relative_residual(flow.solved_matrix(), flow.solution, flow.right_side);
  report.solver = flow.built->solver->name();
  report.ordering = name_of(resolved(flow.options.solver, flow.options.ordering));
  report.conductance = name_of(flow.options.conductance);
  report.faces = balance.faces;
  report.openings = openings(flow, balance.contact_inflows);
  report.counts = flow.counts;
  report.threads = flow.options.threads;
  report.seconds = flow.seconds;
  report.wall_seconds.total = flow.wall_total;
  report.wall_seconds.waited = flow.wall_waited;
  report.peak_memory_bytes = peak_memory();
  return report;
}

}  // namespace pfv

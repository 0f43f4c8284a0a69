// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance_terms.hpp"
#include "darcy_grid/darcy_data.hpp"
#include "network/pore_boundaries.hpp"
#include "solve/solver_abilities.hpp"

#include <cmath>

namespace pfv {

namespace {

/// The faces of cells that each patch took.
std::vector<OpeningResult> openings(const DarcyData& flow) {
  std::vector<OpeningResult> results(flow.solved_box.patches.size());
  for (std::size_t patch = 0; patch < results.size(); ++patch) {
    OpeningResult& result = results[patch];
    const int boundary = 6 + static_cast<int>(patch);
    result.name = boundary_name(flow.solved_box, boundary);
    double sum = 0.0;
    for (std::size_t f = 0; f < flow.built->faces.size(); ++f) {
      if (flow.built->faces[f].boundary != boundary) continue;
      ++result.pores;
      result.flux += flow.fields.face_inflow[static_cast<Eigen::Index>(f)];
      sum += flow.fields.face_pressure[static_cast<Eigen::Index>(f)] + flow.reference;
    }
    if (result.pores > 0) result.pressure = sum / static_cast<double>(result.pores);
  }
  return results;
}

Totals boundary_totals(const DarcyData& flow) {
  std::vector<double> of_boundary(boundary_count(flow.solved_box), 0.0);
  Totals totals;
  for (std::size_t f = 0; f < flow.built->faces.size(); ++f) {
    const double inflow = flow.fields.face_inflow[static_cast<Eigen::Index>(f)];
    of_boundary[flow.built->faces[f].boundary] += inflow;
    totals.gross += std::abs(inflow);
  }
  for (const double q : of_boundary) (q > 0.0 ? totals.inflow : totals.outflow) += std::abs(q);
  return totals;
}

std::optional<double> permeability(const DarcyData& flow, const Totals& totals) {
  const std::optional<int> axis = axis_of_flow(flow.solved_box);
  if (!axis || flow.moving) return {};
  std::array<double, 2> mean{0.0, 0.0};
  const Grid& grid = flow.built->grid;
  for (std::size_t f = 0; f < flow.built->faces.size(); ++f) {
    const Face face = flow.built->faces[f].face;
    if (axis_of(face) == *axis)
      mean[is_upper(face)] += flow.fields.face_pressure[static_cast<Eigen::Index>(f)] *
                              grid.face_area(*axis) / flow.solved_box.area(face);
  }
  return permeability_of(flow.solved_box, *axis, flow.fluid.viscosity, totals,
                         std::abs(mean[0] - mean[1]));
}

}  // namespace

Report make_report(const DarcyData& flow) {
  const BuiltGrid& built = *flow.built;
  Report report;
  report.model = "darcy_grid";
  report.spheres = static_cast<std::int64_t>(flow.packing_ids.size());
  report.outside = report.spheres - built.grains.spheres.size();
  report.pores = built.grid.size();
  report.unknowns = built.determined ? built.grid.size() : 0;
  report.porosity = built.porosity.mean();
  report.pore_volume = report.porosity * built.grid.volume() * built.grid.size();
  report.solid_area = built.overlaps.surface;
  const Totals totals = boundary_totals(flow);
  report.inflow = totals.inflow;
  report.outflow = totals.outflow;
  report.volume_rate_sum = flow.rates.sum();
  report.mass_error = mass_error(totals, report.volume_rate_sum, 0.0);
  report.permeability = permeability(flow, totals);
  if (flow.forces.total.cols() > 0) {
    report.force_sum = flow.forces.total.rowwise().sum();
    Eigen::Vector3d sum = flow.grain_sum;
    for (const FaceResult& face : flow.faces) sum += face.force_pressure;
    report.force_balance_error =
        force_balance_error(sum, flow.pressures.cwiseAbs().maxCoeff(), flow.solved_box, 0.0);
  }
  if (built.determined)
    report.residual = relative_residual(built.matrix, flow.solution, flow.right_side);
  if (flow.solver) report.solver = flow.solver->name();
  report.ordering = name_of(resolved(flow.options.solver, flow.options.ordering));
  report.solver_made_of = made_of(flow.options.solver, flow.options.ordering);
  report.conductance = "kozeny_carman";
  report.threads = flow.options.threads;
  report.faces = flow.faces;
  report.openings = openings(flow);
  report.counts = flow.counts;
  report.seconds = flow.seconds;
  report.wall_seconds.total = flow.wall_total;
  report.peak_memory_bytes = peak_memory();
  return report;
}

}  // namespace pfv

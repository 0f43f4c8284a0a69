// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/darcy_data.hpp"
#include "results/balance_terms.hpp"

#include <cmath>

namespace pfv {

namespace {

std::vector<BoundaryPart> boundary_parts(const DarcyData& flow) {
  std::vector<BoundaryPart> parts;
  for (std::size_t f = 0; f < flow.built->faces.size(); ++f) {
    const auto i = static_cast<Eigen::Index>(f);
    parts.push_back({flow.built->faces[f].boundary, flow.fields.face_inflow[i],
                     flow.fields.face_pressure[i] + flow.reference});
  }
  return parts;
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
  const std::vector<BoundaryPart> parts = boundary_parts(flow);
  const Totals totals = totals_of(flow.solved_box, parts);
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
  report.conductance = "kozeny_carman";
  report.threads = flow.options.threads;
  report.faces = flow.faces;
  report.openings = openings_of(flow.solved_box, parts);
  report.counts = flow.counts;
  report.seconds = flow.seconds;
  report.wall_seconds.total = flow.wall_total;
  report.peak_memory_bytes = peak_memory();
  return report;
}

}  // namespace pfv

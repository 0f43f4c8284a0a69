// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/darcy_data.hpp"
#include "results/balance_terms.hpp"
#include "problem/solver_abilities.hpp"
#include "work/peak_memory.hpp"

#include <cmath>

namespace pfv {

namespace {

std::vector<BoundaryPart> boundary_parts(const DarcyData& flow) {
  std::vector<BoundaryPart> parts;
  for (std::size_t f = 0; f < flow.built->faces.size(); ++f) {
    const auto i = static_cast<Eigen::Index>(f);
    parts.push_back({flow.built->faces[f].boundary, flow.last.fields.face_inflow[i],
                     flow.last.fields.face_pressure[i] + flow.last.reference});
  }
  return parts;
}

std::optional<double> permeability(const DarcyData& flow, const Totals& totals) {
  const std::optional<std::array<int, 2>> open = faces_of_flow(flow.last.box);
  if (!open || flow.last.moving) return {};
  std::array<double, 2> mean{0.0, 0.0};
  const Grid& grid = flow.built->grid;
  const std::vector<double> areas = face_areas(flow.last.box);
  for (std::size_t f = 0; f < flow.built->faces.size(); ++f) {
    const Face face = flow.built->faces[f].face;
    for (int i = 0; i < 2; ++i)
      if (static_cast<int>(face) == (*open)[i])
        mean[i] += flow.last.fields.face_pressure[static_cast<Eigen::Index>(f)] *
                   grid.face_area(axis_of(face)) / areas[(*open)[i]];
  }
  return permeability_of(flow.last.box, *open, flow.fluid.viscosity, totals, mean);
}

}  // namespace

Report make_report(const DarcyData& flow) {
  const BuiltGrid& built = *flow.built;
  Report report;
  report.model = "darcy_grid";
  report.spheres = static_cast<std::int64_t>(flow.seen.ids.size());
  report.outside = report.spheres - built.grains.spheres.size();
  report.pores = built.grid.size();
  report.unknowns = built.determined ? built.grid.size() : 0;
  report.porosity = built.porosity.mean();
  report.pore_volume = report.porosity * built.grid.volume() * built.grid.size();
  report.solid_area = built.overlaps.surface;
  const BoundarySums sums = sums_of(flow.last.box, boundary_parts(flow));
  const Totals totals = totals_of(sums);
  report.inflow = totals.inflow;
  report.outflow = totals.outflow;
  report.volume_rate_sum = flow.last.rates.sum();
  report.mass_error = mass_error(totals, report.volume_rate_sum, 0.0);
  report.permeability = permeability(flow, totals);
  if (flow.forces.total.cols() > 0) {
    report.force_sum = flow.forces.total.rowwise().sum();
    Eigen::Vector3d sum = flow.last.grain_sum;
    for (const FaceResult& face : flow.last.faces) sum += face.force_pressure;
    report.force_balance_error =
        force_balance_error(sum, flow.last.pressures.cwiseAbs().maxCoeff(), flow.last.box, 0.0);
  }
  if (built.determined)
    report.residual = relative_residual(built.matrix, flow.last.relative, flow.last.right_side);
  if (flow.solver) report.solver = flow.solver->name();
  report.ordering = name_of(resolved(flow.options.solver, flow.options.ordering));
  report.solver_made_of = made_of(flow.options.solver, flow.options.ordering);
  report.conductance = "kozeny_carman";
  report.threads = flow.options.threads;
  report.faces = flow.last.faces;
  report.openings = openings_of(flow.last.box, sums);
  report.counts = flow.work.counts;
  report.seconds = flow.work.seconds;
  report.wall_seconds = flow.work.wall_seconds;
  report.peak_memory_bytes = peak_memory();
  return report;
}

}  // namespace pfv

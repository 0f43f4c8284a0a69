// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/network_report.hpp"

#include "physics/reynolds_numbers.hpp"
#include "problem/solver_abilities.hpp"
#include "work/peak_memory.hpp"

#include <algorithm>

namespace pfv {

namespace {

SolidUnion whole_union(const BuiltNetwork& built) {
  const Spheres& spheres = built.grains.spheres;
  if (!built.share.ranks) return solid_union(built.network, built.vertices, spheres);
  const std::vector<SolidUnion> parts = solid_parts(built.network, built.vertices, spheres);
  double sums[2] = {0.0, 0.0};
  for (int k = 0; k < spheres.size(); ++k) {
    if (!built.share.own_spheres[k]) continue;
    sums[0] += parts[k].volume;
    sums[1] += parts[k].area;
  }
  built.share.ranks->add(sums, 2);
  return {sums[0], sums[1]};
}

void add_geometry(Report& report, BuiltNetwork& built) {
  std::optional<SolidUnion>& solid = built.operators.solid;
  if (!solid) solid = whole_union(built);
  report.hidden = hidden_spheres(built);
  report.pores = pore_count(built);
  report.unknowns = built.rows ? built.rows->total + static_cast<std::int64_t>(built.rows->borders.size())
                               : built.unknowns.count;
  const double volume = built.grains.spheres.volume;
  // where spheres as large as the box leave nothing, round-off may leave less
  report.pore_volume = std::clamp(volume - solid->volume, 0.0, volume);
  report.porosity = report.pore_volume / volume;
  report.solid_area = solid->area;
}

BoundarySums boundary_sums(const BuiltNetwork& built, const Solution& solution, const Balance& balance) {
  BoundarySums sums = sums_of(solution.container, boundary_parts(built, solution, balance.contact_inflows));
  for (Eigen::VectorXd* values : {&sums.inflow, &sums.pressure, &sums.parts}) built.share.add(*values);
  sums.gross = built.share.sum(sums.gross);
  return sums;
}

void add_balances(Report& report, const BuiltNetwork& built, const Solution& solution,
                  const Balance& balance, const Totals& totals) {
  report.inflow = totals.inflow;
  report.outflow = totals.outflow;
  report.volume_rate_sum = built.share.sum(solution.rates.sum());
  if (built.kept.compressible())
    report.storage_rate = built.share.sum(built.kept.storage->dot(solution.pressures - solution.previous_pressures +
                                                                 balance.correction));
  report.mass_error = mass_error(totals, report.volume_rate_sum, report.storage_rate,
                                 traffic(built, solution));
  report.force_balance_error = force_balance_error(built, solution, balance.faces);
}

}  // namespace

Report network_report(BuiltNetwork& built, const Problem& problem, const Solution& solution,
                      const Balance& balance, std::int64_t& solves) {
  const Options& options = problem.options;
  Report report;
  add_geometry(report, built);
  const BoundarySums sums = boundary_sums(built, solution, balance);
  const Totals totals = totals_of(sums);
  add_balances(report, built, solution, balance, totals);
  const ReynoldsNumbers reynolds =
      reynolds_numbers(built.network, built.throats, built.vertices, built.conductances, balance.throat_fluxes,
                       problem.fluid.density, problem.fluid.viscosity, built.share);
  report.reynolds_largest = reynolds.largest;
  report.reynolds_mean = reynolds.mean;
  add_permeability(report, built, problem, solution, totals, balance.throat_fluxes, solves);
  report.solver = built.kept.solver->name();
  report.ordering = name_of(resolved(options.solver, options.ordering));
  report.solver_made_of = made_of(options.solver, options.ordering);
  report.conductance = name_of(options.conductance);
  report.faces = balance.faces;
  report.openings = openings_of(solution.container, sums);
  report.threads = options.threads;
  report.peak_memory_bytes = static_cast<std::int64_t>(built.share.largest(static_cast<double>(peak_memory())));
  return report;
}

void add_account(Report& report, const FluidMemory& memory, const BuiltNetwork& built,
                 const Fluid& fluid, const Solution& solution) {
  const double volume = solution.geometry.volume;
  report.fluid_volume = space_around(built, volume);
  report.fluid_came_in = memory.account.came_in;
  report.fluid_balance_error = fluid_missing(memory, built, fluid, solution.container) /
                               std::max(*report.fluid_volume, 0.01 * volume);
}

}  // namespace pfv

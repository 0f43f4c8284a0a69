// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/network_builder.hpp"

#include "coupling/phase_clock.hpp"
#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "physics/yade_partition.hpp"

namespace pfv {

std::unique_ptr<BuiltNetwork> derive_network(const Packing& packing, const BuildSettings& settings,
                                             BuildCost cost) {
  const auto& [box, fluid, options, team] = settings;
  check(box);
  auto fresh = std::make_unique<BuiltNetwork>();
  {
    const PhaseClock clock(cost.seconds.triangulate);
    fresh->grains = select_grains(packing, box, options.outside);
    PoreSpace space = build_network(fresh->grains.spheres, box.lower);
    fresh->network = std::move(space.network);
    fresh->vertices = std::move(space.spheres);
    ++cost.counts.triangulate;
  }
  {
    const PhaseClock clock(cost.seconds.throats);
    const Spheres& spheres = fresh->vertices;
    fresh->boundaries = find_pore_boundaries(fresh->network, box);
    fresh->throats = measure_throats(fresh->network, fresh->boundaries, spheres, *team);
    if (options.partition == Partition::yade)
      apply_yade_partition(fresh->throats, fresh->network, spheres, box);
    fresh->conductances = conductances(options.conductance, fluid.viscosity, fresh->network,
                                       fresh->throats, spheres, *team);
    for (std::size_t t = 0; t < fresh->throats.conductance_factor.size(); ++t)
      fresh->conductances.value[t] *= fresh->throats.conductance_factor[t];
    fresh->bases = measure_bases(fresh->network, fresh->boundaries, spheres);
    fresh->strain_volume = strain_volumes(fresh->network, fresh->throats, spheres);
  }
  fresh->unknowns = number_unknowns(fresh->network, fresh->boundaries, box);
  return fresh;
}

void factor_pressures(BuiltNetwork& built, const BuildSettings& settings, double step,
                      BuildCost cost) {
  const bool compressible = settings.fluid.bulk_modulus.has_value();
  if (built.solver && (!compressible || step == built.storage_dt)) return;
  const bool new_pattern = !built.solver;
  built.time_step_limit.reset();  // they belong to the factor
  built.loses_digits.reset();
  if (built.implicit) built.implicit->yielding.resize(6, 0);
  {
    const PhaseClock clock(cost.seconds.assemble);
    if (compressible)
      built.storage = storage_volumes(built.throats) / (*settings.fluid.bulk_modulus * step);
    built.system = assemble(built.network, built.conductances.value, built.unknowns, built.storage);
  }
  if (new_pattern)
    built.solver = built.former_solver ? std::move(built.former_solver)
                                       : make_solver(settings.options, settings.team);
  if (built.unknowns.count > 0) {
    if (new_pattern) {
      const PhaseClock clock(cost.seconds.order);
      built.solver->order(built.system.matrix, unknown_places(built));
      ++cost.counts.order;
    }
    const PhaseClock clock(cost.seconds.factor);
    try {
      built.solver->factor(built.system.matrix);
    } catch (const SolverError& error) {
      built.solver.reset();
      throw too_far_apart(built, settings.fluid, error.what());
    }
    ++cost.counts.factor;
  }
  built.storage_dt = step;
}

void make_force_matrix(BuiltNetwork& built, const Options& options, Team& team, Counts& counts) {
  if (built.force_matrix) return;
  built.viscous_shares =
      viscous_shares(options.conductance, built.network, built.throats, built.vertices);
  built.force_matrix =
      force_matrix(built.network, built.vertices, built.throats, built.viscous_shares,
                   built.grains.spheres.size(), {true, true, options.torques}, team);
  ++counts.force_matrix;
}

void make_volume_rates(BuiltNetwork& built, const Options& options, Team& team, Counts& counts) {
  if (options.volume_rates == VolumeRates::geometric) {
    if (!built.geometric_rates)
      built.geometric_rates = volume_rate_matrix(built.network, built.vertices);
    return;
  }
  make_force_matrix(built, options, team, counts);
  if (!built.sum_order || (team.threads() > 1 && built.sum_order->begin.empty()))
    built.sum_order = sum_order(*built.force_matrix, built.grains.spheres.ids,
                                built.network.pores(), team);
}

void make_force_matrices(BuiltNetwork& built, const Options& options, Team& team,
                         Counts& counts) {
  make_force_matrix(built, options, team, counts);
  if (options.split_forces && !built.pressure_force_matrix)
    built.pressure_force_matrix =
        force_matrix(built.network, built.vertices, built.throats, built.viscous_shares,
                     built.grains.spheres.size(), {true, false, false}, team);
  if (options.shear_viscous && !built.shear_pairs)
    built.shear_pairs = shear_pairs(built.network, built.throats, built.vertices);
  if (options.sphere_pressure && !built.surface_pressure)
    built.surface_pressure =
        surface_pressure(built.network, built.vertices, built.grains.spheres);
}

}  // namespace pfv

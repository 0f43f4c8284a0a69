// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/network_builder.hpp"

#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "physics/yade_partition.hpp"
#include "step/solvability.hpp"
#include "work/phase_clock.hpp"

namespace pfv {

std::unique_ptr<BuiltNetwork> derive_network(const Packing& packing, const Problem& problem,
                                             WorkRecord& work) {
  const auto& [container, fluid, options, team] = problem;
  check(container);
  auto fresh = std::make_unique<BuiltNetwork>();
  {
    const PhaseClock clock(work.seconds.triangulate);
    fresh->grains = select_grains(packing, container, options.outside);
    fresh->container = container;
    fresh->geometry = geometry_of(container, container.lower);
    PoreSpace space = build_network(fresh->grains.spheres, container.lower);
    fresh->network = std::move(space.network);
    fresh->vertices = std::move(space.spheres);
    ++work.counts.triangulate;
  }
  {
    const PhaseClock clock(work.seconds.throats);
    const Spheres& spheres = fresh->vertices;
    fresh->boundaries = find_pore_boundaries(fresh->network, container);
    fresh->throats = measure_throats(fresh->network, fresh->boundaries, spheres, *team);
    if (options.partition == Partition::yade)
      apply_yade_partition(fresh->throats, fresh->network, spheres, container);
    fresh->conductances = conductances(options.conductance, fluid.viscosity, fresh->network,
                                       fresh->throats, spheres, *team);
    for (std::size_t t = 0; t < fresh->throats.conductance_factor.size(); ++t)
      fresh->conductances.value[t] *= fresh->throats.conductance_factor[t];
    fresh->bases = measure_bases(fresh->network, fresh->boundaries, spheres);
    refuse_open_pores(*fresh);
    fresh->strain_volume = strain_volumes(fresh->network, fresh->throats, spheres);
  }
  fresh->unknowns = number_unknowns(fresh->network, fresh->boundaries, container);
  if (!fresh->grains.body.empty())
    fresh->closed = take_out_closed_pores(fresh->network, fresh->throats, fresh->conductances.value,
                                          fresh->grains.body, fresh->unknowns);
  for (const int pore : fresh->unknowns.enclosed_pores)
    fresh->throats.pore_volume[pore] = fresh->throats.pore_fluid_volume[pore] = 0.0;
  return fresh;
}

bool factor_pressures(BuiltNetwork& built, const Problem& problem, double step, WorkRecord& work) {
  KeptSystem& kept = built.kept;
  const bool compressible = problem.fluid.bulk_modulus.has_value();
  if (kept.solver && (!compressible || step == kept.storage_dt)) return false;
  const bool new_pattern = !kept.solver;
  kept.loses_digits.reset();
  {
    const PhaseClock clock(work.seconds.assemble);
    if (compressible)
      kept.storage = storage_volumes(built.throats) / (*problem.fluid.bulk_modulus * step);
    kept.system = assemble(built.network, built.conductances.value, built.unknowns, kept.storage);
  }
  if (new_pattern)
    kept.solver = kept.former_solver ? std::move(kept.former_solver)
                                       : make_solver(problem.options, problem.team);
  if (built.unknowns.count > 0) {
    if (new_pattern) {
      const PhaseClock clock(work.seconds.order);
      kept.solver->order(kept.system.matrix, unknown_places(built));
      ++work.counts.order;
    }
    const PhaseClock clock(work.seconds.factor);
    try {
      kept.solver->factor(kept.system.matrix);
    } catch (const SolverError& error) {
      kept.solver.reset();
      throw too_far_apart(built, problem.fluid, error.what());
    }
    ++work.counts.factor;
  }
  kept.storage_dt = step;
  return true;
}

}  // namespace pfv

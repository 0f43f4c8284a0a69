// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/network_builder.hpp"

#include "distributed/shared_network.hpp"
#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "physics/yade_partition.hpp"
#include "step/solvability.hpp"
#include "step/trapped_pores.hpp"
#include "work/phase_clock.hpp"

namespace pfv {

namespace {

void find_pores(BuiltNetwork& fresh, const Packing& packing, const Problem& problem) {
  const Container& container = problem.container;
  fresh.container = container;
  fresh.geometry = geometry_of(container, container.lower);
  PoreSpace space;
  if (problem.ranks) {
    SharedNetwork shared = build_shared_network(packing, container, problem.options.outside, problem.ranks);
    fresh.halo.emplace(std::move(shared.halo));
    fresh.share = std::move(shared.share);
    fresh.grains = std::move(shared.grains);
    space = std::move(shared.space);
  } else {
    fresh.grains = select_grains(packing, container, problem.options.outside);
    space = build_network(fresh.grains.spheres, container.lower);
  }
  fresh.network = std::move(space.network);
  fresh.vertices = std::move(space.spheres);
}

void measure_pores(BuiltNetwork& fresh, const Problem& problem) {
  const auto& [container, fluid, options, team, ranks] = problem;
  const Spheres& spheres = fresh.vertices;
  fresh.throats = measure_throats(fresh.network, fresh.boundaries, spheres, *team);
  if (options.partition == Partition::yade)
    apply_yade_partition(fresh.throats, fresh.network, spheres, container);
  fresh.conductances = conductances(options.conductance, fluid.viscosity, fresh.network,
                                    fresh.throats, spheres, *team);
  for (std::size_t t = 0; t < fresh.throats.conductance_factor.size(); ++t)
    fresh.conductances.value[t] *= fresh.throats.conductance_factor[t];
  fresh.bases = measure_bases(fresh.network, fresh.boundaries, spheres);
  fresh.strain_volume = strain_volumes(fresh.network, fresh.throats, spheres);
}

/// What is summed over pores counts at their owners.
void leave_to_owners(BuiltNetwork& fresh) {
  if (!fresh.share.ranks) return;
  for (int pore = 0; pore < fresh.network.pores(); ++pore)
    if (!fresh.share.own_pores[pore]) fresh.throats.pore_volume[pore] = fresh.throats.pore_fluid_volume[pore] = 0.0;
  for (int base = 0; base < fresh.bases.size(); ++base) {
    if (fresh.share.own_pores[fresh.bases.pore[base]]) continue;
    fresh.bases.area[base] = 0.0;
    fresh.bases.loads.col(base).setZero();
  }
}

}  // namespace

std::unique_ptr<BuiltNetwork> derive_network(const Packing& packing, const Problem& problem,
                                             WorkRecord& work) {
  check(problem.container);
  auto fresh = std::make_unique<BuiltNetwork>();
  const Share& share = fresh->share;
  {
    const PhaseClock clock(work.seconds.triangulate);
    find_pores(*fresh, packing, problem);
    ++work.counts.triangulate;
  }
  {
    const PhaseClock clock(work.seconds.throats);
    fresh->boundaries = find_pore_boundaries(fresh->network, problem.container, share);
    share.together([&] { measure_pores(*fresh, problem); });
    leave_to_owners(*fresh);
    refuse_open_pores(*fresh);
  }
  fresh->unknowns = number_unknowns(fresh->network, fresh->boundaries, problem.container, share);
  const auto rows = [&] { return share_rows(fresh->network, fresh->conductances.value, fresh->unknowns, share); };
  if (share.ranks) fresh->rows = rows();
  if (fresh->grains.any_bodies) {
    fresh->closed = take_out_closed_pores(fresh->network, fresh->throats, fresh->vertices, fresh->grains.body, share,
                                          fresh->rows.get(), fresh->conductances.value, fresh->unknowns);
    if (share.ranks) fresh->rows = rows();
  }
  for (const int pore : fresh->unknowns.enclosed_pores)
    fresh->throats.pore_volume[pore] = fresh->throats.pore_fluid_volume[pore] = 0.0;
  return fresh;
}

bool is_unfactored(const BuiltNetwork& built, const Fluid& fluid, double step) {
  return !built.kept.solver || (fluid.bulk_modulus && step != built.kept.storage_dt);
}

bool factor_pressures(BuiltNetwork& built, const Problem& problem, double step, WorkRecord& work) {
  KeptSystem& kept = built.kept;
  const bool compressible = problem.fluid.bulk_modulus.has_value();
  if (!is_unfactored(built, problem.fluid, step)) return false;
  const bool new_pattern = !kept.solver;
  kept.loses_digits.reset();
  {
    const PhaseClock clock(work.seconds.assemble);
    if (compressible)
      kept.storage = storage_volumes(built.throats) / (*problem.fluid.bulk_modulus * step);
    kept.system = assemble(built.network, built.conductances.value, built.unknowns, kept.storage, built.share,
                           built.rows.get());
    mark_main_fluid(built);
  }
  if (new_pattern)
    kept.solver = kept.former_solver ? std::move(kept.former_solver)
                                       : make_solver(problem.options, problem.team);
  if (built.rows) kept.solver->share_rows(built.rows);
  if (has_unknowns(built)) {
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

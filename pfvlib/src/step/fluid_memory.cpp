// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/fluid_memory.hpp"

#include "pfv/error.hpp"
#include "problem/container_geometry.hpp"
#include "step/shared_pressures.hpp"

#include <string>

namespace pfv {

namespace {

/// What these pressures have pressed into the pores of a network, m³.
double compressed_in(const BuiltNetwork& built, const Fluid& fluid,
                     const Eigen::VectorXd& pressures) {
  if (!fluid.bulk_modulus || (pressures.size() == 0 && !built.share.ranks)) return 0.0;
  return built.share.sum(storage_volumes(built.throats).dot(pressures)) / *fluid.bulk_modulus;
}

void refuse_other_pores(std::size_t given, std::size_t pores) {
  if (given != pores)
    throw InputError("the state that was set has " + std::to_string(given) +
                     " pore pressures, and the network of this packing has " + std::to_string(pores) +
                     " pores: take states right after a new network (Flow::rebuild before the step), restart "
                     "with its packing, container and settings, or set a state without pressures, from which the "
                     "fluid begins at 0 Pa");
}

void carry_on_ranks(FluidMemory& memory, const Replaced& before, const BuiltNetwork& now, const Fluid& fluid) {
  const BuiltNetwork* old = before.network.get();
  const bool unlike = old ? old->network.pores() != memory.pressures.size() : memory.pressures.size() > 0;
  const bool carries = memory.pressed && !now.share.any(unlike);
  if (memory.is_restored(now.share)) {
    const std::vector<std::size_t> numbers = numbers_among_all(now);
    now.share.together([&] {
      if (now.share.ranks->own() == 0) refuse_other_pores(memory.restored.size(), numbers.size());
    });
    memory.pressures = pressures_from_all(now, numbers, memory.restored);
  } else if (carries && fluid.bulk_modulus) {
    memory.pressures = carried_on_ranks({old, memory.pressures}, now);
  } else {
    memory.pressures.setZero(fluid.bulk_modulus ? now.network.pores() : 0);
  }
  memory.pressed = fluid.bulk_modulus.has_value();
  memory.restored.clear();
}

void carry_pressures(FluidMemory& memory, const Replaced& before, const BuiltNetwork& now,
                     const Fluid& fluid) {
  if (now.share.ranks) return carry_on_ranks(memory, before, now, fluid);
  const int pores = now.network.pores();
  if (!memory.restored.empty()) refuse_other_pores(memory.restored.size(), static_cast<std::size_t>(pores));
  if (!memory.restored.empty())
    memory.pressures = Eigen::Map<const Eigen::VectorXd>(memory.restored.data(), pores);
  else if (before.network && memory.pressures.size() > 0 &&
           memory.pressures.size() == before.network->network.pores())
    memory.pressures = carried_pressures({before.network.get(), memory.pressures}, now);
  else
    memory.pressures.resize(0);
  memory.restored.clear();
  if (fluid.bulk_modulus && memory.pressures.size() == 0) memory.pressures.setZero(pores);
}

void settle_account(FluidMemory& memory, const Replaced& before, const BuiltNetwork& now,
                    const Problem& problem, double swept) {
  FluidAccount& account = memory.account;
  const Fluid& fluid = problem.fluid;
  if (!account.open) {
    account = {true,
               space_around(now, volume_of(problem.container)) +
                   compressed_in(now, fluid, memory.pressures) - swept,
               0.0, 0.0, false};
    return;
  }
  if (!before.grains) return;
  const Spheres grains = own_grains(now);
  // grains that go from one rank to another come in at the one and go at the other
  account.came_in -= now.share.sum(displaced_by_newcomers(*before.grains, grains));
  const double growth = now.share.sum(growth_of_grains(*before.grains, grains));
  double missing = fluid_missing(memory, now, fluid, problem.container) - swept;
  if (before.moved_by_host) {
    account.came_in += missing + growth;
    missing = -growth;
  } else {
    account.came_in += before.put;
    missing -= before.put;
    // where faces are within a long step is known up to a part of that step
    if (account.within_long_step) missing = memory.volume_debt - growth;
  }
  if (!fluid.bulk_modulus) return;
  const double volume = now.share.sum(storage_volumes(now.throats).sum());
  if (volume > 0.0) memory.pressures.array() -= *fluid.bulk_modulus * missing / volume;
  memory.volume_debt = 0.0;
}

}  // namespace

double space_around(const BuiltNetwork& built, double volume) {
  if (!built.share.ranks) return fluid_space(volume, built.grains.spheres);
  return built.share.sum(fluid_space(0.0, own_grains(built))) + volume;
}

void carry_over(FluidMemory& memory, const Replaced& before, const BuiltNetwork& now,
                const Problem& problem, double swept) {
  const bool restored = memory.is_restored(now.share);
  carry_pressures(memory, before, now, problem.fluid);
  if (restored && memory.account.open) return;  // the state is that of these grains: there is nothing to settle
  settle_account(memory, before, now, problem, swept);
}

double swept_volume(const Container& container, double step) {
  if (!any_face_moves(container)) return 0.0;
  return volume_of(container) - geometry_after(container, -step, container.lower).volume;
}

void remember(FluidMemory& memory, const BuiltNetwork& built, const Fluid& fluid,
              const Solution& solution) {
  memory.time += solution.dt;
  memory.volume_debt = solution.unpaid;
  const double grown = solution.dt * built.share.sum(solution.rates.sum());
  memory.account.came_in += grown;
  memory.account.within_long_step = solution.stages > 1 || solution.implicit;
  memory.account.ahead = memory.account.within_long_step ? grown : 0.0;
  if (built.kept.compressible())
    memory.account.came_in += solution.dt * built.share.sum(built.kept.storage->dot(solution.pressures -
                                                                                   solution.previous_pressures));
  if (fluid.bulk_modulus) memory.pressures = solution.pressures;
  memory.pressed = fluid.bulk_modulus.has_value();
}

double fluid_missing(const FluidMemory& memory, const BuiltNetwork& built, const Fluid& fluid,
                     const Container& container) {
  const FluidAccount& account = memory.account;
  return space_around(built, volume_of(container)) + account.ahead +
         compressed_in(built, fluid, memory.pressures) - account.at_start - account.came_in;
}

}  // namespace pfv

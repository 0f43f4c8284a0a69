// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

#include "coupling/phase_clock.hpp"
#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "physics/yade_partition.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

constexpr double pi = 3.14159265358979323846;

}  // namespace

const Forces& FlowData::compute(const Packing& packing, double step, bool advance,
                                Coupling coupling, const GrainDynamics* grains) {
  if (fluid.bulk_modulus && !(step > 0.0))
    throw InputError("a compressible fluid needs a time step > 0");
  const double wall_start = wall_seconds();
  {
    const PhaseClock clock(seconds.total);
    if (!solved) stale = true;  // after a failure the network may be no longer that of the grains
    solved = false;
    balance_.reset();
    rebuild_if_stale(packing);
    assemble_and_factor(step);
    stages = 1;
    force_lag.resize(0);
    mean_motion.resize(3, 0);
    refuse_shear_forces(coupling);
    const double at_time = advance ? time + step : time;
    if (coupling == Coupling::implicit) {
      run_implicit(packing, step, at_time, *grains);
    } else {
      update_rates(packing);
      if (coupling == Coupling::staged)
        run_stages(packing, step, at_time, *grains);
      else
        solve_pressures(at_time, *built->solver);
    }
    if (options.forces) compute_forces(packing);
    dt = step;
    solved_box = box;
    solved = true;
    if (advance) end_step(step, coupling);
  }
  wall_total += wall_seconds() - wall_start;
  return forces;
}

void FlowData::end_step(double step, Coupling coupling) {
  time += step;
  add_strain(step);
  if (coupling == Coupling::implicit)
    lagged += relaxation * (relative_pressures - lagged);
  else
    lagged.resize(0);
  if (fluid.bulk_modulus) old_pressures = pressures;
}

void FlowData::require_result() const {
  if (!solved)
    throw InputError("Flow holds no result: call step() or evaluate() first (the last call failed, "
                     "or there was none)");
}

void FlowData::rebuild_if_stale(const Packing& packing) {
  if (!needs_rebuild(packing)) return;
  const bool first = counts.triangulate == 0;
  const std::unique_ptr<BuiltNetwork> old = std::move(built);
  stale = true;
  build(packing);
  const int pores = built->network.pores();
  const auto take_over = [&](Eigen::VectorXd& values, std::vector<double>& pending) {
    if (!pending.empty() && static_cast<int>(pending.size()) == pores)
      values = Eigen::Map<const Eigen::VectorXd>(pending.data(), pores);
    else if (old && values.size() > 0 && values.size() == old->network.pores())
      values = carried_pressures(*old, values, *built);
    else
      values.resize(0);
    pending.clear();
  };
  take_over(old_pressures, pending_pressures);
  take_over(lagged, pending_lagged);
  if (fluid.bulk_modulus && old_pressures.size() == 0) old_pressures.setZero(pores);
  stale = false;
  strain = 0.0;
  if (!first) ++retriangulations;
}

bool FlowData::needs_rebuild(const Packing& packing) const {
  if (stale || !built || strain >= options.retriangulation_strain) return true;
  if (packing.size() != static_cast<Eigen::Index>(packing_ids.size()) ||
      !std::equal(packing_ids.begin(), packing_ids.end(), packing.ids.data()))
    return true;
  const ActiveGrains& grains = built->grains;
  std::size_t next = 0;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const bool active = next < grains.columns.size() && grains.columns[next] == k;
    if (is_inside(packing, k, box) != active) return true;
    if (!active) continue;
    const auto i = static_cast<Eigen::Index>(next++);
    const double radius = grains.spheres.radii[i];
    const double grown = std::abs(packing.radii[k] - radius);
    Eigen::Vector3d moved = packing.positions.col(k) - built->network.origin -
                            grains.spheres.centres.col(i);
    for (int axis = 0; axis < 3; ++axis)  // the host may have wrapped it
      if (box.periodic[axis])
        moved[axis] = std::remainder(moved[axis], grains.spheres.edges[axis]);
    // negated, so that a number that is not finite leads to a rebuild, whose checks name it
    if (!(3.0 * grown <= options.retriangulation_strain * radius) ||
        !(moved.squaredNorm() <= radius * radius))
      return true;
  }
  return false;
}

void FlowData::build(const Packing& packing) {
  check(box);
  auto fresh = std::make_unique<BuiltNetwork>();
  {
    const PhaseClock clock(seconds.triangulate);
    fresh->grains = select_grains(packing, box, options.outside);
    PoreSpace space = build_network(fresh->grains.spheres, box.lower);
    fresh->network = std::move(space.network);
    fresh->vertices = std::move(space.spheres);
    ++counts.triangulate;
  }
  {
    const PhaseClock clock(seconds.throats);
    const Spheres& spheres = fresh->vertices;
    fresh->boundaries = find_pore_boundaries(fresh->network, box);
    fresh->throats = measure_throats(fresh->network, fresh->boundaries, spheres);
    if (options.partition == Partition::yade)
      apply_yade_partition(fresh->throats, fresh->network, spheres, box);
    fresh->conductances = conductances(options.conductance, fluid.viscosity, fresh->network,
                                       fresh->throats, spheres);
    for (std::size_t t = 0; t < fresh->throats.conductance_factor.size(); ++t)
      fresh->conductances.value[t] *= fresh->throats.conductance_factor[t];
    fresh->base_area = base_areas(fresh->network, fresh->boundaries, spheres);
    fresh->strain_volume = strain_volumes(fresh->network, fresh->throats, spheres);
  }
  fresh->unknowns = number_unknowns(fresh->network, fresh->boundaries, box);
  packing_ids.assign(packing.ids.data(), packing.ids.data() + packing.size());
  built = std::move(fresh);
  counts.degenerate_throats = built->conductances.degenerate;
  counts.merged_pores = built->network.cells() - built->network.pores();
}

void FlowData::assemble_and_factor(double step) {
  const bool compressible = fluid.bulk_modulus.has_value();
  if (built->solver && (!compressible || step == built->storage_dt)) return;
  const bool new_pattern = !built->solver;
  built->time_step_limit.reset();  // it belongs to the factor
  built->loses_digits.reset();
  if (built->implicit) built->implicit->yielding.resize(0);
  {
    const PhaseClock clock(seconds.assemble);
    storage = compressible ? Eigen::VectorXd(storage_volumes(built->throats) /
                                             (*fluid.bulk_modulus * step))
                           : Eigen::VectorXd();
    built->system =
        assemble(built->network, built->conductances.value, built->unknowns, storage);
    counts.pinned_pores = 0;
    for (const Isolated& isolated : built->system.isolated)
      counts.pinned_pores += static_cast<std::int64_t>(isolated.pores.size());
  }
  if (new_pattern) {
    built->solver = make_solver(options, team);
    solution.setZero(built->unknowns.count);  // no trace of the old network in what follows
  }
  if (built->unknowns.count > 0) {
    if (new_pattern) {
      const PhaseClock clock(seconds.order);
      built->solver->order(built->system.matrix, unknown_places(*built));
      ++counts.order;
    }
    const PhaseClock clock(seconds.factor);
    try {
      built->solver->factor(built->system.matrix);
    } catch (const SolverError& error) {
      built->solver.reset();
      throw SolverError(contrast() + " (" + error.what() + ")");
    }
    ++counts.factor;
  }
  built->storage_dt = step;
}

void FlowData::update_rates(const Packing& packing) {
  moving = !at_rest(packing, box);
  refuse_undetermined(moving);
  if (moving) {
    gather_velocities(packing, built->grains.columns, velocities);
    rates_of(velocities);
  } else {
    rates.setZero(built->network.pores());
  }
  refuse_isolated(built->system.isolated);
}

void FlowData::rates_of(const Eigen::Matrix3Xd& of_grains) {
  const PhaseClock clock(seconds.assemble);
  if (!built->volume_rate_matrix)
    built->volume_rate_matrix = volume_rate_matrix(built->network, built->vertices);
  ++counts.volume_rate;
  volume_rates(*built->volume_rate_matrix, of_grains, box, *team, rates);
}

/// Fills in the imposed pressures, less their mean: with a large common pressure the balances would
/// lose its digits.
void FlowData::impose(double at_time) {
  const auto& pores = built->unknowns.imposed_pores;
  impose_pressures(built->network, built->boundaries, box, at_time, relative_pressures);
  const double first = pores.empty() ? 0.0 : relative_pressures[pores.front()];
  double sum = 0.0;  // of the differences: where all are equal, the reference is exact
  for (const int pore : pores) sum += relative_pressures[pore] - first;
  reference = pores.empty() ? 0.0 : first + sum / static_cast<double>(pores.size());
  for (const int pore : pores) relative_pressures[pore] -= reference;
}

/// Pressures for the present rates.
void FlowData::solve_pressures(double at_time, LinearSolver& solver) {
  const PhaseClock clock(seconds.solve);
  const std::vector<int>& unknown = built->unknowns.of_pore;
  relative_pressures.resize(built->network.pores());
  impose(at_time);
  sources = -rates;
  previous_pressures = old_pressures;
  if (storage.size() > 0)
    sources.array() += storage.array() * (old_pressures.array() - reference);
  if (!box.pressure_gradient.isZero(0.0))
    sources += gradient_sources(built->network, built->conductances.value, box.pressure_gradient);
  right_hand_side(built->system, built->unknowns, box, sources, relative_pressures, right_side);
  if (built->unknowns.count > 0) {
    solver.solve(right_side, solution);
    ++counts.solve;
  }
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) relative_pressures[static_cast<Eigen::Index>(p)] = solution[unknown[p]];
  pressures = relative_pressures.array() + reference;
  if (!pressures.allFinite())
    throw SolverError(solver.name() +
                      " returned pressures that are not finite; the conductances span too many "
                      "orders of magnitude or the imposed values are too large");
  if (&solver == built->solver.get()) refine_pressures();
}

Eigen::Vector3d FlowData::buoyancy_of(int sphere) const {
  const double r = built->grains.spheres.radii[sphere];
  return -fluid.density * 4.0 / 3.0 * pi * r * r * r * fluid.gravity;
}

void FlowData::make_force_matrices() {
  const int active = built->grains.spheres.size();
  if (!built->force_matrix) {
    built->viscous_shares =
        viscous_shares(options.conductance, built->network, built->throats, built->vertices);
    built->force_matrix =
        force_matrix(built->network, built->throats, built->viscous_shares, active, {true, true});
    ++counts.force_matrix;
    if (options.split_forces)
      built->pressure_force_matrix = force_matrix(built->network, built->throats,
                                                  built->viscous_shares, active, {true, false});
    if (options.shear_viscous)
      built->shear_pairs = shear_pairs(built->network, built->throats, built->vertices);
    if (options.sphere_pressure)
      built->surface_pressure = surface_pressure(built->network, built->vertices, active);
  }
}

/// S p of the active spheres and the walls.
void FlowData::multiply_forces(const ForceMatrix& matrix, ForceParts parts,
                               Eigen::Matrix3Xd& result) {
  multiply(matrix, force_lag.size() > 0 ? force_lag : relative_pressures, *team, result);
  if (!box.pressure_gradient.isZero(0.0))
    result += gradient_forces(built->network, built->throats, built->viscous_shares,
                              built->grains.spheres.size(), parts,
                              box.pressure_gradient);
}

void FlowData::compute_forces(const Packing& packing) {
  const PhaseClock clock(seconds.forces);
  make_force_matrices();
  const std::vector<int>& columns = built->grains.columns;
  const auto active = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index n = packing.size();
  const auto spread = [&](const Eigen::Matrix3Xd& from, Eigen::Matrix3Xd& to) {
    to.resize(3, n);
    if (active < n) to.setZero();
    for (Eigen::Index i = 0; i < active; ++i) to.col(columns[i]) = from.col(i);
  };
  multiply_forces(*built->force_matrix, {true, true}, fluid_forces);
  if (options.split_forces) {
    Eigen::Matrix3Xd of_pressure;
    multiply_forces(*built->pressure_force_matrix, {true, false}, of_pressure);
    spread(fluid_forces - of_pressure, forces.viscous);
  }
  if (force_lag.size() > 0)  // the work of the change of pressure is that of E^T (implicit step)
    fluid_forces.leftCols(active) +=
        multiply(built->implicit->energy_forces, relative_pressures - force_lag).leftCols(active);
  spread(fluid_forces, forces.total);
  if (options.split_forces) forces.pressure = forces.total - forces.viscous;
  if (options.shear_viscous) add_shear_forces(packing);
  if (options.buoyancy && !fluid.gravity.isZero(0.0)) {
    for (Eigen::Index i = 0; i < active; ++i) {
      const Eigen::Vector3d lift = buoyancy_of(static_cast<int>(i));
      forces.total.col(columns[i]) += lift;
      if (options.split_forces) forces.pressure.col(columns[i]) += lift;
    }
  }
  if (options.sphere_pressure) {
    multiply(*built->surface_pressure, pressures, *team, mean_pressures);
    forces.sphere_pressure.setZero(n);
    for (Eigen::Index i = 0; i < active; ++i) forces.sphere_pressure[columns[i]] = mean_pressures[i];
  }
}

void FlowData::add_strain(double step) {
  if (!moving || built->network.pores() == 0) return;
  const Eigen::Map<const Eigen::ArrayXd> volumes(built->strain_volume.data(), rates.size());
  strain += (rates.array().abs() / volumes).maxCoeff() * step;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

#include "coupling/phase_clock.hpp"
#include "network/pore_network.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

namespace pfv {

namespace {

constexpr double pi = 3.14159265358979323846;

bool any_boundary(const Box& box, Boundary::Kind kind, bool nonzero_only = false) {
  for (int b = 0; b < 6 + static_cast<int>(box.patches.size()); ++b) {
    const Boundary& boundary = boundary_of(box, b);
    if (boundary.kind == kind && (!nonzero_only || boundary.value != 0.0)) return true;
  }
  return false;
}

std::string place_of(const BuiltNetwork& built, int pore) {
  const Eigen::Vector3d x = built.network.origin + built.network.pore_centres.col(pore);
  std::ostringstream text;
  text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

/// Spheres around a set of pores, ascending.
std::vector<int> spheres_around(const BuiltNetwork& built, const std::vector<int>& pores) {
  std::vector<int> spheres;
  for (int c = 0; c < built.network.cells(); ++c)
    if (std::binary_search(pores.begin(), pores.end(), built.network.cell_pore[c]))
      for (const Vertex vertex : built.network.cell_vertices[c])
        if (!is_wall(vertex)) spheres.push_back(vertex);
  std::sort(spheres.begin(), spheres.end());
  spheres.erase(std::unique(spheres.begin(), spheres.end()), spheres.end());
  return spheres;
}

/// The vertices of each cell by the ids of their grains, ascending, with the number of the cell.
std::vector<std::pair<std::array<std::int64_t, 4>, int>> named_cells(const BuiltNetwork& built) {
  constexpr std::int64_t walls = std::numeric_limits<std::int64_t>::min();
  std::vector<std::pair<std::array<std::int64_t, 4>, int>> names(built.network.cells());
  for (int c = 0; c < built.network.cells(); ++c) {
    names[c].second = c;
    for (int i = 0; i < 4; ++i) {
      const Vertex vertex = built.network.cell_vertices[c][i];
      names[c].first[i] =
          is_wall(vertex) ? walls + wall_number(vertex) : built.vertices.ids[vertex];
    }
    std::sort(names[c].first.begin(), names[c].first.end());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// For each cell of `now` the cell of `old` with the same vertices, or -1.
std::vector<int> surviving_cells(const BuiltNetwork& old, const BuiltNetwork& now) {
  const auto before = named_cells(old), after = named_cells(now);
  std::vector<int> survivors(now.network.cells(), -1);
  auto next = before.begin();
  for (const auto& [name, cell] : after) {
    while (next != before.end() && next->first < name) ++next;
    if (next != before.end() && next->first == name) survivors[cell] = next->second;
  }
  return survivors;
}

}  // namespace

Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, const Eigen::VectorXd& sources) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(built.unknowns.count), x(built.unknowns.count);
  const auto& unknown = built.unknowns.of_pore;
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) b[unknown[p]] += sources[static_cast<Eigen::Index>(p)];
  if (built.unknowns.count > 0) built.solver->solve(b, x);
  Eigen::VectorXd pressures = Eigen::VectorXd::Zero(sources.size());
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) pressures[static_cast<Eigen::Index>(p)] = x[unknown[p]];
  return pressures;
}

std::vector<double> strain_volumes(const PoreNetwork& network, const Throats& throats,
                                   const Spheres& spheres) {
  std::vector<double> smallest(network.pores(), std::numeric_limits<double>::infinity());
  for (int c = 0; c < network.cells(); ++c)
    for (const Vertex vertex : network.cell_vertices[c])
      if (!is_wall(vertex)) {
        double& radius = smallest[network.cell_pore[c]];
        radius = std::min(radius, spheres.radii[vertex]);
      }
  std::vector<double> volumes(throats.pore_fluid_volume);
  for (int p = 0; p < network.pores(); ++p)
    volumes[p] = std::max(volumes[p], 0.01 * 4.0 / 3.0 * pi * std::pow(smallest[p], 3));
  return volumes;
}

Eigen::VectorXd storage_volumes(const Throats& throats) {
  Eigen::VectorXd volumes(static_cast<Eigen::Index>(throats.pore_volume.size()));
  for (std::size_t p = 0; p < throats.pore_volume.size(); ++p)
    volumes[static_cast<Eigen::Index>(p)] =
        std::max(throats.pore_fluid_volume[p], 0.01 * throats.pore_volume[p]);
  return volumes;
}

const Forces& FlowData::compute(const Packing& packing, double step, bool advance) {
  if (fluid.bulk_modulus && !(step > 0.0))
    throw InputError("a compressible fluid needs a time step > 0");
  const double wall_start = wall_seconds();
  {
    const PhaseClock clock(seconds.total);
    solved = false;
    rebuild_if_stale(packing);
    assemble_and_factor(step);
    update_rates(packing);
    solve_pressures(advance ? time + step : time);
    if (options.forces) compute_forces(packing);
    dt = step;
    solved = true;
    faces = face_results(*this);
    if (advance) end_step(step);
  }
  wall_total += wall_seconds() - wall_start;
  return forces;
}

void FlowData::end_step(double step) {
  time += step;
  add_strain(step);
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
  const Eigen::VectorXd old_values = old_pressures;
  stale = true;
  build(packing);
  if (fluid.bulk_modulus) {
    old_pressures = Eigen::VectorXd::Zero(built->network.pores());
    if (static_cast<int>(pending_pressures.size()) == built->network.pores())
      old_pressures = Eigen::Map<const Eigen::VectorXd>(pending_pressures.data(),
                                                        old_pressures.size());
    else if (old && old_values.size() == old->network.pores())
      take_over_pressures(*old, old_values);
  }
  pending_pressures.clear();
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
    fresh->conductances = conductances(options.conductance, fluid.viscosity, fresh->network,
                                       fresh->throats, spheres);
    fresh->base_area = base_areas(fresh->network, fresh->boundaries, spheres);
    fresh->strain_volume = strain_volumes(fresh->network, fresh->throats, spheres);
  }
  fresh->unknowns = number_unknowns(fresh->network, fresh->boundaries, box);
  packing_ids.assign(packing.ids.data(), packing.ids.data() + packing.size());
  built = std::move(fresh);
  counts.degenerate_throats = built->conductances.degenerate;
  counts.merged_pores = built->network.cells() - built->network.pores();
}

void FlowData::take_over_pressures(const BuiltNetwork& old, const Eigen::VectorXd& old_values) {
  if (old.network.cells() == 0 || built->network.pores() == 0) return;
  // a cell that survives keeps its pressure: its dual vertex need not lie in it, so its place is no
  // guide to it
  const std::vector<int> survivors = surviving_cells(old, *built);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(built->network.pores());
  Eigen::VectorXi count = Eigen::VectorXi::Zero(built->network.pores());
  for (int c = 0; c < built->network.cells(); ++c)
    if (survivors[c] >= 0) {
      sum[built->network.cell_pore[c]] += old_values[old.network.cell_pore[survivors[c]]];
      ++count[built->network.cell_pore[c]];
    }
  int cell = 0;
  for (int p = 0; p < built->network.pores(); ++p) {
    if (count[p] > 0) {
      old_pressures[p] = sum[p] / count[p];
      continue;
    }
    const Eigen::Vector3d place =
        (built->network.origin + built->network.pore_centres.col(p) - old.network.origin)
            .cwiseMax(0.0)
            .cwiseMin(old.vertices.edges);
    cell = locate(old.network, old.vertices, place, cell);
    old_pressures[p] = old_values[old.network.cell_pore[cell]];
  }
  // the sum of V^f p is what the storage term conserves (thesis eq. 4.8 with compressibility)
  const Eigen::VectorXd before = storage_volumes(old.throats);
  const Eigen::VectorXd now = storage_volumes(built->throats);
  old_pressures.array() += (before.dot(old_values) - now.dot(old_pressures)) / now.sum();
}

void FlowData::assemble_and_factor(double step) {
  const bool compressible = fluid.bulk_modulus.has_value();
  if (built->solver && (!compressible || step == built->storage_dt)) return;
  const bool new_pattern = !built->solver;
  built->time_step_limit.reset();  // it belongs to the factor
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
  if (new_pattern) built->solver = make_solver(options.solver, options.ordering);
  if (built->unknowns.count > 0) {
    if (new_pattern) {
      const PhaseClock clock(seconds.order);
      built->solver->order(built->system.matrix);
      ++counts.order;
    }
    const PhaseClock clock(seconds.factor);
    built->solver->factor(built->system.matrix);
    ++counts.factor;
  }
  built->storage_dt = step;
}

void FlowData::refuse_undetermined(bool moving_now) const {
  // a cell that repeats in itself keeps its volume: its pressure is determined but for the level
  if (fluid.bulk_modulus || box.any_periodic() || any_boundary(box, Boundary::Kind::pressure))
    return;
  if (moving_now)
    throw InputError("the grains or faces move, the fluid is incompressible, and no face or patch "
                     "has a pressure: nothing determines the pressure; give a pressure to a face, "
                     "or a bulk modulus");
  if (any_boundary(box, Boundary::Kind::flux, true))
    throw InputError("a flux is imposed, the fluid is incompressible, and no face or patch has a "
                     "pressure: the fluid cannot leave; give a pressure to a face, or a bulk "
                     "modulus");
}

/// A set of pores without any way to a pressure can only be at rest.
void FlowData::refuse_isolated() const {
  for (const Isolated& isolated : built->system.isolated) {
    double net = 0.0, gross = 0.0;
    for (const int pore : isolated.pores) {
      net -= rates[pore];
      gross += std::abs(rates[pore]);
    }
    for (std::size_t b = 0; b < built->unknowns.of_boundary.size(); ++b) {
      const int shared = built->unknowns.of_boundary[b];
      const bool fed = shared >= 0 && std::any_of(isolated.pores.begin(), isolated.pores.end(),
                                                  [&](int pore) {
                                                    return built->unknowns.of_pore[pore] == shared;
                                                  });
      if (!fed) continue;
      net += boundary_of(box, static_cast<int>(b)).value;
      gross += std::abs(boundary_of(box, static_cast<int>(b)).value);
    }
    // rates are sums of area times velocity: their own round-off is no change of volume
    const double noise = 1e-12 * rates.cwiseAbs().maxCoeff();
    if (std::abs(net) <= 1e-10 * gross + noise) continue;
    std::ostringstream rate;
    rate << net;
    throw InputError(
        std::to_string(isolated.pores.size()) + " pore(s) near " +
        place_of(*built, isolated.pores.front()) + " between " +
        sphere_list(built->vertices.ids, spheres_around(*built, isolated.pores)) +
        " are cut off from every pressure, but " + rate.str() +
        " m3/s (imposed flux less change of volume) must leave them; give the fluid a bulk "
        "modulus, or reduce the overlaps");
  }
}

void FlowData::update_rates(const Packing& packing) {
  moving = !at_rest(packing, box);
  refuse_undetermined(moving);
  if (moving)
    rates = rates_of(active_velocities(packing, built->grains.columns));
  else
    rates = Eigen::VectorXd::Zero(built->network.pores());
  refuse_isolated();
}

Eigen::VectorXd FlowData::rates_of(const Eigen::Matrix3Xd& velocities) {
  const PhaseClock clock(seconds.assemble);
  if (!built->volume_rate_matrix)
    built->volume_rate_matrix = volume_rate_matrix(built->network, built->vertices);
  ++counts.volume_rate;
  return volume_rates(*built->volume_rate_matrix, built->network, velocities, box);
}

/// Pressures for the present rates.
void FlowData::solve_pressures(double at_time) {
  const PhaseClock clock(seconds.solve);
  const Eigen::Index pores = built->network.pores();
  Eigen::VectorXd imposed = imposed_pressures(built->network, built->boundaries, box, at_time);
  double sum = 0.0;
  int count = 0;
  for (Eigen::Index p = 0; p < pores; ++p)
    if (built->unknowns.of_pore[p] == Unknowns::imposed) {
      sum += imposed[p];
      ++count;
    }
  // with a large common pressure the balances would lose its digits
  reference = count > 0 ? sum / count : 0.0;
  for (Eigen::Index p = 0; p < pores; ++p)
    if (built->unknowns.of_pore[p] == Unknowns::imposed) imposed[p] -= reference;

  Eigen::VectorXd sources = -rates;
  previous_pressures = old_pressures;
  if (storage.size() > 0)
    sources.array() += storage.array() * (old_pressures.array() - reference);
  if (!box.pressure_gradient.isZero(0.0))
    sources += gradient_sources(built->network, built->conductances.value, box.pressure_gradient);
  right_side = right_hand_side(built->system, built->unknowns, box, sources, imposed);
  solution.resize(built->unknowns.count);
  if (built->unknowns.count > 0) {
    built->solver->solve(right_side, solution);
    ++counts.solve;
  }
  relative_pressures = imposed;
  for (Eigen::Index p = 0; p < pores; ++p)
    if (built->unknowns.of_pore[p] != Unknowns::imposed)
      relative_pressures[p] = solution[built->unknowns.of_pore[p]];
  pressures = relative_pressures.array() + reference;
  if (!pressures.allFinite())
    throw SolverError(built->solver->name() +
                      " returned pressures that are not finite; the conductances span too many "
                      "orders of magnitude or the imposed values are too large");
}

Eigen::Vector3d FlowData::buoyancy_of(int sphere) const {
  const double volume = 4.0 / 3.0 * pi * std::pow(built->grains.spheres.radii[sphere], 3);
  return -fluid.density * volume * fluid.gravity;
}

void FlowData::make_force_matrices() {
  const int active = built->grains.spheres.size();
  if (!built->force_matrix) {
    built->force_matrix = force_matrix(built->network, built->throats, active, {true, true});
    ++counts.force_matrix;
    if (options.split_forces)
      built->pressure_force_matrix =
          force_matrix(built->network, built->throats, active, {true, false});
    if (options.sphere_pressure)
      built->surface_pressure = surface_pressure(built->network, built->vertices, active);
  }
}

void FlowData::compute_forces(const Packing& packing) {
  const PhaseClock clock(seconds.forces);
  make_force_matrices();
  const int active = built->grains.spheres.size();
  const Eigen::Index n = packing.size();
  const auto spread = [&](const Eigen::Matrix3Xd& from, Eigen::Matrix3Xd& to) {
    to = Eigen::Matrix3Xd::Zero(3, n);
    for (int i = 0; i < active; ++i) to.col(built->grains.columns[i]) = from.col(i);
  };
  const auto of_pressures = [&](const ForceMatrix& matrix, ForceParts parts) {
    Eigen::Matrix3Xd result = multiply(matrix, relative_pressures);
    if (!box.pressure_gradient.isZero(0.0))
      result += gradient_forces(built->network, built->throats, active, parts,
                                box.pressure_gradient);
    return result;
  };
  fluid_forces = of_pressures(*built->force_matrix, {true, true});
  spread(fluid_forces, forces.total);
  if (options.split_forces) {
    spread(of_pressures(*built->pressure_force_matrix, {true, false}), forces.pressure);
    forces.viscous = forces.total - forces.pressure;
  }
  if (options.buoyancy && !fluid.gravity.isZero(0.0)) {
    for (int i = 0; i < active; ++i) {
      const Eigen::Vector3d lift = buoyancy_of(i);
      forces.total.col(built->grains.columns[i]) += lift;
      if (options.split_forces) forces.pressure.col(built->grains.columns[i]) += lift;
    }
  }
  if (options.sphere_pressure) {
    const Eigen::VectorXd mean = multiply(*built->surface_pressure, pressures);
    forces.sphere_pressure = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < active; ++i) forces.sphere_pressure[built->grains.columns[i]] = mean[i];
  }
}

void FlowData::add_strain(double step) {
  double largest = 0.0;
  if (moving)
    for (int p = 0; p < built->network.pores(); ++p)
      largest = std::max(largest, std::abs(rates[p]) / built->strain_volume[p]);
  strain += largest * step;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/operators.hpp"

#include "physics/cell_stretching.hpp"
#include "physics/macroscopic_gradient.hpp"

#include <algorithm>

namespace pfv {

namespace {

/// A face has a load from every pore that it shares a facet with: each counts at its owner.
void leave_faces_to_owners(BuiltNetwork& built) {
  if (!built.share.ranks) return;
  ForceMatrix& matrix = *built.operators.force_matrix;
  for (int i = matrix.row_begin[matrix.spheres]; i < matrix.row_begin[matrix.rows()]; ++i)
    if (!built.share.own_pores[matrix.pore[i]]) matrix.value.col(i).setZero();
}

}  // namespace

void make_force_matrix(BuiltNetwork& built, const Problem& problem, Counts& counts) {
  const std::vector<ContainerFace>& faces = problem.container.faces;
  const bool turning = std::any_of(faces.begin(), faces.end(), [](const ContainerFace& face) {
    return !face.angular_velocity.isZero(0.0);
  });
  const bool stretching = stretches(problem.container);
  const auto& kept = built.operators.force_matrix;
  if (kept && (!turning || kept->wall_moments) && (!stretching || kept->stretching)) return;
  built.operators.viscous_shares =
      viscous_shares(problem.options.conductance, built.network, built.throats, built.vertices);
  built.operators.force_matrix =
      force_matrix(built.network, built.vertices, built.throats, built.operators.viscous_shares,
                   built.grains.spheres.size(),
                   {true, true, problem.options.torques, turning || !problem.container.is_box},
                   *problem.team);
  if (stretching) {
    add_stretching(*built.operators.force_matrix, built.network, built.grains.spheres, built.vertices,
                   built.throats, built.operators.viscous_shares);
  }
  leave_faces_to_owners(built);
  built.operators.sum_order.reset();
  ++counts.force_matrix;
}

void make_volume_rates(BuiltNetwork& built, const Problem& problem, Counts& counts) {
  if (problem.options.volume_rates == VolumeRates::geometric) {
    auto& rates = built.operators.geometric_rates;
    if (!rates) rates = volume_rate_matrix(built.network, built.vertices);
    if (!rates->stretching && stretches(problem.container))
      add_stretching(*rates, built.network, built.grains.spheres, built.vertices);
    return;
  }
  make_force_matrix(built, problem, counts);
  if (!built.operators.sum_order || (problem.team->threads() > 1 && built.operators.sum_order->begin.empty()))
    built.operators.sum_order = sum_order(*built.operators.force_matrix, built.grains.spheres.ids,
                                built.network.pores(), *problem.team);
}

namespace {

void find_open_water(BuiltNetwork& built, const Problem& problem) {
  built.operators.open_water.emplace();
  built.operators.still_water = is_still(problem.container);
  if (!problem.options.open_water || problem.options.volume_rates == VolumeRates::geometric) return;
  std::vector<ResistanceBlock> of_shear;
  if (built.operators.shear_pairs) add_blocks(*built.operators.shear_pairs, problem.fluid.viscosity, of_shear);
  const std::vector<int>& unknown = built.unknowns.of_pore;
  std::vector<char> imposed(unknown.size());
  std::transform(unknown.begin(), unknown.end(), imposed.begin(), [](int of) { return of == Unknowns::imposed; });
  built.operators.open_water =
      open_water_drags(built.network, built.grains.spheres, built.vertices, built.throats, built.conductances,
                       *built.operators.force_matrix, imposed, problem.container, problem.fluid.viscosity, of_shear,
                       built.grains.body, built.operators.still_water, built.share);
}

}  // namespace

std::int64_t open_water_count(const BuiltNetwork& built) {
  const auto& drags = built.operators.open_water;
  const auto own = drags ? std::count_if(drags->begin(), drags->end(), [](const auto& drag) { return drag.is_own; }) : 0;
  return static_cast<std::int64_t>(built.share.sum(static_cast<double>(own)));
}

void make_force_matrices(BuiltNetwork& built, const Problem& problem, Counts& counts) {
  make_force_matrix(built, problem, counts);
  if (problem.options.split_forces && !built.operators.pressure_force_matrix)
    built.operators.pressure_force_matrix =
        force_matrix(built.network, built.vertices, built.throats, built.operators.viscous_shares,
                     built.grains.spheres.size(), {true, false, false}, *problem.team);
  if (problem.options.shear_viscous && !built.operators.shear_pairs)
    built.operators.shear_pairs = shear_pairs(built.network, built.throats, built.grains.spheres, built.vertices,
                                              built.grains.any_bodies ? built.grains.body : std::vector<int>{}, built.share);
  if (!built.operators.open_water || built.operators.still_water != is_still(problem.container)) {
    find_open_water(built, problem);
    counts.open_water = open_water_count(built);
  }
  if (problem.options.sphere_pressure && !built.operators.surface_pressure)
    built.operators.surface_pressure =
        surface_pressure(built.network, built.vertices, built.grains.spheres);
}

Loads loads_of(const BuiltNetwork& built, const Eigen::VectorXd& pressures) {
  Loads loads = multiply(*built.operators.force_matrix, pressures);
  const Bases& bases = built.bases;
  for (int b = 0; b < bases.size(); ++b)
    if (bases.face[b] >= 0)
      loads.col(built.grains.spheres.size() + bases.face[b]) += pressures[bases.pore[b]] * bases.load(b);
  return loads;
}

void join_loads(const BuiltNetwork& built, Loads& loads) {
  const Share& share = built.share;
  if (!share.ranks) return;
  const Eigen::Index spheres = built.grains.spheres.size();
  for (Eigen::Index i = 0; i < spheres; ++i)
    if (!share.own_spheres[i]) loads.col(i).setZero();
  Eigen::VectorXd of_faces = loads.rightCols(loads.cols() - spheres).reshaped();
  share.add(of_faces);
  loads.rightCols(loads.cols() - spheres) = of_faces.reshaped(6, loads.cols() - spheres);
}

const Loads& gradient_loads(BuiltNetwork& built, const Problem& problem) {
  auto& kept = built.operators.gradient_loads;
  const Eigen::Vector3d& gradient = problem.container.pressure_gradient;
  if (!kept || kept->first != gradient)
    kept = {gradient, gradient_forces(built.network, built.vertices, built.throats,
                                      built.operators.viscous_shares, built.grains.spheres.size(),
                                      {true, true, problem.options.torques}, gradient, built.share)};
  return kept->second;
}

namespace {

/// How much faster images move than their spheres, a column for a period along each axis, m/s.
Eigen::Matrix3d velocities_of_periods(const BuiltNetwork& built, const Motion& motion) {
  const Eigen::Index spheres = built.grains.spheres.size();
  Eigen::Matrix3d of_periods = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (built.container.periodic[axis] && built.container.is_box)
      of_periods.col(axis) =
          (motion.col(spheres + 2 * axis + 1) - motion.col(spheres + 2 * axis)).head<3>();
  return of_periods;
}

}  // namespace

Loads shear_forces_of(const BuiltNetwork& built, double viscosity, const Motion& motion) {
  Loads sum = Loads::Zero(6, motion.cols());
  const Eigen::Index spheres = built.grains.spheres.size();
  if (built.operators.shear_pairs)
    sum.topLeftCorner(3, spheres) = shear_forces(*built.operators.shear_pairs, viscosity,
                                                 motion.topLeftCorner(3, spheres), velocities_of_periods(built, motion));
  return sum;
}

void add_open_water_forces(const BuiltNetwork& built, const Motion& motion, Loads& loads) {
  const auto& drags = built.operators.open_water;
  if (drags && !drags->empty())
    add_open_water_forces(*drags, motion, velocities_of_periods(built, motion), loads);
}

Loads resisting_forces(const BuiltNetwork& built, double viscosity, const Motion& motion) {
  Loads sum = shear_forces_of(built, viscosity, motion);
  add_open_water_forces(built, motion, sum);
  return sum;
}

std::vector<ResistanceBlock> resistance_blocks(const BuiltNetwork& built, double viscosity) {
  std::vector<ResistanceBlock> blocks;
  if (built.operators.shear_pairs) add_blocks(*built.operators.shear_pairs, viscosity, blocks);
  if (built.operators.open_water) add_blocks(*built.operators.open_water, blocks);
  return blocks;
}

void rates_of(const BuiltNetwork& built, const Motion& motion, Team& team, Eigen::VectorXd& rates) {
  rates.resize(built.network.pores());
  if (built.operators.geometric_rates)
    volume_rates(*built.operators.geometric_rates, motion, team, rates);
  else
    reciprocal_rates(*built.operators.force_matrix, *built.operators.sum_order, built.bases, motion, team, rates);
  for (const int pore : built.unknowns.enclosed_pores) rates[pore] = 0.0;
  leave_to_owners(built.share, rates);
}

Eigen::VectorXd gradient_sources(const BuiltNetwork& built, const Eigen::Vector3d& gradient) {
  Eigen::VectorXd sources = gradient_sources(built.network, built.conductances.value, gradient);
  leave_to_owners(built.share, sources);
  return sources;
}

Eigen::VectorXd gross_rates(const BuiltNetwork& built, const Motion& motion) {
  const int pores = built.network.pores();
  if (built.operators.geometric_rates) return gross_rates(*built.operators.geometric_rates, motion);
  if (!built.operators.force_matrix) return Eigen::VectorXd::Zero(pores);
  Eigen::VectorXd rates = gross_rates(*built.operators.force_matrix, built.bases, motion, pores);
  leave_to_owners(built.share, rates);
  return rates;
}

Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, const Eigen::VectorXd& sources,
                                      std::int64_t& solves) {
  return homogeneous_pressures(built, *built.kept.solver, sources, solves);
}

Eigen::VectorXd homogeneous_pressures(const BuiltNetwork& built, LinearSolver& solver,
                                      const Eigen::VectorXd& sources, std::int64_t& solves) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(built.unknowns.count), x = b;
  const auto& unknown = built.unknowns.of_pore;
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) b[unknown[p]] += sources[static_cast<Eigen::Index>(p)];
  if (has_unknowns(built)) {
    solver.solve(b, x);
    ++solves;
  }
  Eigen::VectorXd pressures = Eigen::VectorXd::Zero(sources.size());
  for (std::size_t p = 0; p < unknown.size(); ++p)
    if (unknown[p] >= 0) pressures[static_cast<Eigen::Index>(p)] = x[unknown[p]];
  return pressures;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

#include "pfv/error.hpp"
#include "physics/chebyshev_stages.hpp"
#include "physics/time_step_limit.hpp"

#include <cmath>
#include <limits>

namespace pfv {

namespace {

void check(const GrainDynamics& grains, const Packing& packing) {
  if (grains.other_forces.cols() != packing.size())
    throw InputError("a staged step needs the other force of each of the " +
                     std::to_string(packing.size()) + " grains");
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    if (!grains.other_forces.col(k).allFinite())
      throw InputError("sphere " + std::to_string(packing.ids[k]) +
                       ": its other force is not finite; a staged step needs it");
}

}  // namespace

double FlowData::time_step_limit(const Eigen::VectorXd& masses) {
  if (masses.size() != static_cast<Eigen::Index>(packing_ids.size()))
    throw InputError("time step limit: " + std::to_string(masses.size()) + " masses for " +
                     std::to_string(packing_ids.size()) + " spheres; give one a sphere");
  if (!(masses.array() > 0.0).all())
    throw InputError("time step limit: a mass is not a positive number; give kg");
  if (built->time_step_limit && masses == built->limit_masses) return *built->time_step_limit;
  built->limit_masses = masses;
  const int spheres = built->grains.spheres.size();
  double eigenvalue = 0.0;
  if (built->unknowns.count > 0 && spheres > 0) {
    make_force_matrices();
    if (!built->volume_rate_matrix)
      built->volume_rate_matrix = volume_rate_matrix(built->network, built->vertices);
    Box fixed = box;
    for (FaceCondition& face : fixed.faces) face.velocity = 0.0;
    const auto drag = [&](const Eigen::VectorXd& v) {
      const Eigen::VectorXd rates =
          volume_rates(*built->volume_rate_matrix, v.reshaped(3, spheres), fixed);
      Eigen::Matrix3Xd acceleration =
          multiply(*built->force_matrix, homogeneous_pressures(*built, rates)).leftCols(spheres);
      for (int i = 0; i < spheres; ++i) acceleration.col(i) /= masses[built->grains.columns[i]];
      return Eigen::VectorXd(acceleration.reshaped());
    };
    eigenvalue = largest_eigenvalue(drag, 3 * spheres);
  }
  built->time_step_limit =
      eigenvalue > 0.0 ? 2.0 / eigenvalue : std::numeric_limits<double>::infinity();
  return *built->time_step_limit;
}

/// Integrates m dv/dt = (other forces) + S p(v) over the step. The mean pressure and the mean volume
/// rates are carried through the same recursion from zero; by linearity S times the mean pressure is
/// the mean force, so that forces, fluxes and volumes of the step balance exactly.
void FlowData::run_stages(const Packing& packing, double step, double at_time,
                          const GrainDynamics& grains) {
  if (!options.forces) throw InputError("a staged step needs forces: switch Options::forces on");
  check(grains, packing);
  const double limit = time_step_limit(grains.masses);
  const std::vector<ChebyshevStage> all = chebyshev_stages(2.0 * step / limit);
  stages = static_cast<int>(all.size());
  if (stages == 1) return solve_pressures(at_time);

  make_force_matrices();
  const auto& columns = built->grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::RowVectorXd per_mass(count);  // dt / m: 0 for a prescribed velocity
  Eigen::Matrix3Xd held(3, count);
  const bool lifted = options.buoyancy && !fluid.gravity.isZero(0.0);
  for (Eigen::Index i = 0; i < count; ++i) {
    per_mass[i] = step / grains.masses[columns[i]];
    held.col(i) = grains.other_forces.col(columns[i]);
    if (lifted) held.col(i) += buoyancy_of(static_cast<int>(i));
  }
  Eigen::Matrix3Xd start;
  gather_velocities(packing, columns, start);
  Eigen::Matrix3Xd before = start, now = start;
  Eigen::VectorXd mean_pressure = Eigen::VectorXd::Zero(built->network.pores());
  Eigen::VectorXd mean_rates = mean_pressure, pressure_before = mean_pressure,
                  rates_before = mean_pressure;
  for (const ChebyshevStage& stage : all) {
    rates_of(now);
    solve_pressures(at_time);
    const Eigen::Matrix3Xd fluid_force =
        multiply(*built->force_matrix, relative_pressures).leftCols(count);
    const Eigen::Matrix3Xd change =
        ((held + fluid_force).array().rowwise() * per_mass.array()).matrix();
    Eigen::Matrix3Xd next =
        (1.0 - stage.m - stage.n) * start + stage.m * now + stage.n * before + stage.f * change;
    before = std::move(now);
    now = std::move(next);
    const auto carry = [&](Eigen::VectorXd& mean, Eigen::VectorXd& last,
                           const Eigen::VectorXd& value) {
      Eigen::VectorXd next_mean = stage.m * mean + stage.n * last + stage.f * value;
      last = std::move(mean);
      mean = std::move(next_mean);
    };
    carry(mean_pressure, pressure_before, relative_pressures);
    carry(mean_rates, rates_before, rates);
  }
  relative_pressures = mean_pressure;
  rates = mean_rates;
  pressures = relative_pressures.array() + reference;
}

}  // namespace pfv

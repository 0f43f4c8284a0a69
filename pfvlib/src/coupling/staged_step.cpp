// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

#include "pfv/error.hpp"
#include "physics/chebyshev_stages.hpp"
#include "physics/time_step_limit.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace pfv {

namespace {

/// Twice the kinetic energy of a change of velocity, over dt, one entry a grain and face; a face moves
/// along its axis alone, and what does not yield not at all.
Eigen::VectorXd energies(const Eigen::Matrix3Xd& change, const Eigen::RowVectorXd& per_mass) {
  const Eigen::Index spheres = change.cols() - 6;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(change.cols());
  for (Eigen::Index k = 0; k < change.cols(); ++k) {
    if (!(per_mass[k] > 0.0)) continue;
    const double square = k < spheres ? change.col(k).squaredNorm()
                                      : std::pow(change((k - spheres) / 2, k), 2);
    result[k] = square / per_mass[k];
  }
  return result;
}

/// For a drag that brakes, symmetric and with eigenvalues within the stages' interval, the Chebyshev
/// scheme changes the velocities by no more, in the norm of the kinetic energy, than one explicit step
/// of the same length would: |1 - P(z)| <= |z| for its stability polynomial P. Twice as much is left
/// for what S lacks of that (doc/stability.md, growth); beyond, the fluid multiplies velocities by
/// more than three in one step, and pressures after them.
constexpr double allowed_change = 2.0;

}  // namespace

double FlowData::time_step_limit(const Eigen::VectorXd& masses,
                                 const std::array<Piston, 6>& pistons) {
  const auto count = static_cast<Eigen::Index>(packing_ids.size());
  if (masses.size() != count)
    throw InputError("time step limit: " + std::to_string(masses.size()) + " masses for " +
                     std::to_string(count) + " spheres; give one a sphere");
  Eigen::VectorXd all(count + 6);
  all.head(count) = masses;
  for (int face = 0; face < 6; ++face) all[count + face] = pistons[face].mass;
  if (!(all.array() > 0.0).all())
    throw InputError("time step limit: a mass is not a positive number; give kg");
  if (built->time_step_limit && all == built->limit_masses) return *built->time_step_limit;
  built->limit_masses = all;
  const int spheres = built->grains.spheres.size();
  double eigenvalue = 0.0;
  if (built->unknowns.count > 0 && spheres > 0) {
    make_force_matrices(*built, options, *team, counts);
    make_volume_rates(*built);
    // similar to M^-1 S G^-1 E, and nearly symmetric
    Eigen::RowVectorXd root(spheres + 6);
    for (int i = 0; i < spheres; ++i) root[i] = 1.0 / std::sqrt(masses[built->grains.columns[i]]);
    for (int face = 0; face < 6; ++face) root[spheres + face] = 1.0 / std::sqrt(pistons[face].mass);
    const auto drag = [&](const Eigen::VectorXd& u) {
      const Eigen::Matrix3Xd v =
          (u.reshaped(3, spheres + 6).array().rowwise() * root.array()).matrix();
      const Eigen::VectorXd p = homogeneous_pressures(
          *built, volume_rates(*built->volume_rate_matrix, v));
      Eigen::Matrix3Xd force = forces_with_faces(*built, p) - shear_forces_of(v);
      force.array().rowwise() *= root.array();
      for (int face = 0; face < 6; ++face)  // guided along its axis
        for (int axis = 0; axis < 3; ++axis)
          if (axis != face / 2) force(axis, spheres + face) = 0.0;
      return Eigen::VectorXd(force.reshaped());
    };
    eigenvalue = largest_eigenvalue(drag, 3 * (spheres + 6));
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
  check_dynamics(grains, packing);
  const double limit = time_step_limit(grains.masses, grains.pistons);
  const std::vector<ChebyshevStage> all = chebyshev_stages(2.0 * step / limit);
  stages = static_cast<int>(all.size());
  if (stages == 1) return solve_pressures(at_time, *built->solver);

  make_force_matrices(*built, options, *team, counts);
  const Eigen::RowVectorXd per_mass = yielding(grains, step);
  relative_pressures.setZero(built->network.pores());
  impose(at_time);  // the reference pressure acts on pistons
  const Eigen::Matrix3Xd held = held_forces(grains);
  const Eigen::Matrix3Xd start = motion_of(packing);
  Eigen::Matrix3Xd before = start, now = start;
  Eigen::VectorXd mean_pressure = Eigen::VectorXd::Zero(built->network.pores());
  Eigen::VectorXd mean_rates = mean_pressure, pressure_before = mean_pressure,
                  rates_before = mean_pressure;
  mean_motion.setZero(3, start.cols());
  Eigen::Matrix3Xd motion_before = mean_motion, first_change;
  for (const ChebyshevStage& stage : all) {
    const Eigen::Matrix3Xd motion = now;
    rates_of_motion(motion);
    solve_pressures(at_time, *built->solver);
    const Eigen::Matrix3Xd change =
        ((held + forces_with_faces(*built, relative_pressures) + shear_forces_of(motion))
             .array()
             .rowwise() *
         per_mass.array())
            .matrix();
    if (first_change.size() == 0) first_change = change;
    Eigen::Matrix3Xd next =
        (1.0 - stage.m - stage.n) * start + stage.m * now + stage.n * before + stage.f * change;
    before = std::move(now);
    now = std::move(next);
    const auto carry = [&](auto& mean, auto& last, const auto& value) {
      auto next_mean = (stage.m * mean + stage.n * last + stage.f * value).eval();
      last = std::move(mean);
      mean = std::move(next_mean);
    };
    carry(mean_pressure, pressure_before, relative_pressures);
    carry(mean_rates, rates_before, rates);
    carry(mean_motion, motion_before, motion);
  }
  refuse_feeding(now - start, first_change, per_mass, step / limit);
  relative_pressures = mean_pressure;
  rates = mean_rates;
  pressures = relative_pressures.array() + reference;
}

void FlowData::refuse_feeding(const Eigen::Matrix3Xd& change, const Eigen::Matrix3Xd& explicit_one,
                              const Eigen::RowVectorXd& per_mass, double ratio) const {
  const Eigen::VectorXd gained = energies(change, per_mass);
  const double explicit_sum = energies(explicit_one, per_mass).sum();
  if (gained.sum() <= allowed_change * allowed_change * explicit_sum) return;
  Eigen::Index worst;
  gained.maxCoeff(&worst);
  const Eigen::Index spheres = gained.size() - 6;
  const std::string who =
      worst < spheres
          ? "sphere " + std::to_string(built->grains.spheres.ids[static_cast<std::size_t>(worst)])
          : std::string("the piston on ") + name_of(static_cast<Face>(worst - spheres));
  std::ostringstream text;
  text.precision(3);
  text << "a staged step of " << ratio << " limits of the explicit coupling went out of control, most "
       << "at " << who << ": it changed velocities " << std::sqrt(gained.sum() / explicit_sum)
       << " times as much as an explicit step would, where a fluid that brakes stays below; take the "
          "implicit coupling or a much shorter step";
  Culprits culprits;
  if (worst < spheres)
    culprits.spheres.push_back(built->grains.spheres.ids[static_cast<std::size_t>(worst)]);
  throw UnstableStep(text.str(), culprits);
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>
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

/// As in the implicit step, but fewer: the stages follow their own pressures besides the last ones.
constexpr double prompt_limits = 24.0;

}  // namespace

/// Integrates m dv/dt = held + S q + E^T (p(v) - q) over the step, where q goes from p_old to p(v) as
/// far as the lag lets it: the stages take that part of S which does not outgrow the contacts. The
/// mean pressure, volume rates and motion are carried through the same recursion from zero; by linearity
/// they belong to the mean force, so that forces, fluxes and volumes of the step balance exactly.
void FlowData::run_recursion(const StagedMotion& staged, double at_time,
                             const Eigen::VectorXd& old) {
  const Eigen::Matrix3Xd& start = staged.start;
  Eigen::Matrix3Xd before = start, now = start;
  Eigen::VectorXd mean_pressure = Eigen::VectorXd::Zero(built->network.pores());
  Eigen::VectorXd mean_rates = mean_pressure, pressure_before = mean_pressure,
                  rates_before = mean_pressure;
  mean_motion.setZero(3, start.cols());
  Eigen::Matrix3Xd motion_before = mean_motion, first_change;
  const auto forces = [&](const Eigen::Matrix3Xd& motion) {
    if (lag.relaxation == 1.0)
      return Eigen::Matrix3Xd(staged.held + forces_with_faces(*built, relative_pressures) +
                              shear_forces_of(motion));
    const Eigen::VectorXd followed = old + lag.relaxation * (relative_pressures - old);
    return Eigen::Matrix3Xd(staged.held + forces_with_faces(*built, followed) +
                            multiply(*built->energy_forces, relative_pressures - followed) +
                            shear_forces_of(motion));
  };
  for (const ChebyshevStage& stage : staged.stages) {
    const Eigen::Matrix3Xd motion = now;
    rates_of_motion(motion);
    solve_pressures(at_time, *built->solver);
    const Eigen::Matrix3Xd change =
        (forces(motion).array().rowwise() * staged.per_mass.array()).matrix();
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
  refuse_feeding(now - start, first_change, staged.per_mass, staged.ratio);
  relative_pressures = mean_pressure;
  rates = mean_rates;
  pressures = relative_pressures.array() + reference;
}

/// The limit with E^T, or with S where that is shorter: what lies between them is within both.
double FlowData::stage_limit_near(double limit) {
  // ten times the stages; they are 1.1 apart in beds of like grains, 14 at a size ratio of 20
  constexpr double farthest = 100.0;
  if (limit > farthest * stage_limit())
    throw UnstableStep("a staged step this long needs the transpose of the volume rates for S, whose "
                       "drag is more than " + std::to_string(static_cast<int>(farthest)) + " times as "
                       "strong here: spheres overlap by most of their radii, or touch nothing in pores "
                       "of spheres many times larger; take the implicit coupling, shear viscous "
                       "forces or a much shorter step");
  return std::min(limit, stage_limit());
}

void FlowData::run_stages(const Packing& packing, double step, double at_time,
                          const GrainDynamics& grains) {
  check_dynamics(grains, packing);
  const double limit = time_step_limit(grains.masses, grains.pistons);
  if (chebyshev_stages(2.0 * step / limit).size() == 1)
    return solve_pressures(at_time, *built->solver);

  lag.relax(step / limit, prompt_limits);
  const bool lags = lag.relaxation < 1.0;
  make_force_matrices(*built, options, *team, counts);
  StagedMotion staged;
  staged.ratio = step / limit;
  staged.stages = chebyshev_stages(2.0 * step / (lags ? stage_limit_near(limit) : limit));
  stages = static_cast<int>(staged.stages.size());
  relative_pressures.setZero(built->network.pores());
  impose(at_time);  // the reference pressure acts on pistons
  staged.held = held_forces(grains);
  staged.start = motion_of(packing);
  staged.per_mass = yielding(grains, step);
  const auto solve = [&](const Eigen::VectorXd& old) { run_recursion(staged, at_time, old); };
  if (!lags) return solve({});
  find_lag(solve);
  const Eigen::VectorXd old = lag.expected();
  solve(old);
  force_lag = old + lag.relaxation * (relative_pressures - old);
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

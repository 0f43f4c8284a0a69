// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/flow_data.hpp"

namespace pfv {

/// Integrates m dv/dt = held + S p(v) over the step. The mean pressure, volume rates and motion are carried
/// through the same recursion from zero; by linearity they belong to the mean force, so that forces, fluxes
/// and volumes of the step balance exactly. `z`: the step times the largest eigenvalue of the drag.
void FlowData::run_recursion(const ForcedMotion& forced, double z, double at_time) {
  const std::vector<ChebyshevStage> recursion = chebyshev_stages(z);
  stages = static_cast<int>(recursion.size());
  Motion before = forced.start, now = forced.start;
  Motion mean_motion = Motion::Zero(6, now.cols()), motion_before = mean_motion;
  Eigen::VectorXd mean_pressure = Eigen::VectorXd::Zero(built->network.pores());
  Eigen::VectorXd mean_rates = mean_pressure, pressure_before = mean_pressure,
                  rates_before = mean_pressure;
  for (const ChebyshevStage& stage : recursion) {
    const auto carry = [&](auto& mean, auto& last, const auto& value) {
      auto next_mean = (stage.m * mean + stage.n * last + stage.f * value).eval();
      last = std::move(mean);
      mean = std::move(next_mean);
    };
    find_rates(now);
    solve_pressures(at_time, *built->solver);
    Motion next = (1.0 - stage.m - stage.n) * forced.start + stage.m * now + stage.n * before +
                  stage.f * (forced.moved_by(pressure_loads() + shear_forces_of(now)) - forced.start);
    carry(mean_pressure, pressure_before, relative_pressures);
    carry(mean_rates, rates_before, rates);
    carry(mean_motion, motion_before, now);
    before = std::move(now);
    now = std::move(next);
  }
  motion = std::move(mean_motion);
  relative_pressures = mean_pressure;
  rates = mean_rates;
  pressures = relative_pressures.array() + reference;
}

void FlowData::run_stages(const Packing& packing, double step, double at_time,
                          const GrainDynamics& grains) {
  check_dynamics(grains, packing);
  const double z = 2.0 * step / time_step_limit(grains.masses, grains.pistons);
  if (chebyshev_stages(z).size() == 1) return solve_pressures(at_time, *built->solver);
  make_force_matrices(*built, options, *team, counts);
  relative_pressures.setZero(built->network.pores());
  impose(at_time);  // the reference pressure acts on pistons
  const ForcedMotion forced{motion, held_forces(grains), yielding(grains, step)};
  moving = true;
  run_recursion(forced, z, at_time);
}

}  // namespace pfv

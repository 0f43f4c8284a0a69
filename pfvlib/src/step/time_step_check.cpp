// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace pfv {

TimeStepCheck check_time_step(FlowModel& flow, const Packing& packing, const Eigen::VectorXd& masses,
                              const std::vector<Piston>& pistons, double step,
                              const std::vector<RigidBody>& bodies) {
  double estimate = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < masses.size(); ++k)
    estimate = std::min(
        estimate, estimated_time_step(masses[k], packing.radii[k], flow.fluid().viscosity));
  const auto free = std::count_if(pistons.begin(), pistons.end(), [](const Piston& piston) {
    return std::isfinite(piston.mass);
  });
  return {flow.time_step_limit(masses, pistons, bodies),
          estimate,
          step,
          static_cast<int>(free),
          flow.coupling(),
          flow.stages(),
          flow.fluid().bulk_modulus.has_value()};
}

std::string TimeStepCheck::text() const {
  char text[300];
  std::snprintf(text, sizeof text,
                "limit of the explicit coupling %.4g s (papers' pi rho d^2/(1200 mu): %.4g s), flow "
                "step %.4g s, ratio %.4g, pistons %d, %s coupling, stages %d",
                limit, estimate, step, ratio(), pistons, name_of(coupling), stages);
  return text;
}

std::vector<std::string> warnings_of(const TimeStepCheck& check, int held, double safety,
                                     const std::string& remedy) {
  std::vector<std::string> warnings;
  if (check.compressible && check.pistons > 0 && held > 1)
    warnings.push_back("a compressible fluid whose pressure is held over " + std::to_string(held) +
                       " steps drives a piston (servo) on at any time step; use `couple_every 1` or "
                       "`couple_every auto`");
  if (check.coupling != Coupling::explicit_step || check.ratio() <= safety) return warnings;
  char text[300];
  std::snprintf(text, sizeof text,
                "the flow step of %.4g s is %.4g times the limit of the explicit coupling; grains will "
                "shake. Use a time step below %.3g s",
                check.step, check.ratio(), safety * check.limit / held);
  warnings.push_back(text + remedy);
  return warnings;
}

}  // namespace pfv

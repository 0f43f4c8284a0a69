// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/solve_plan.hpp"

#include "geometry/pi.hpp"
#include "parallel/ranks.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

bool NextSolve::has_jumped(double motion_now, double tolerance) const {
  constexpr double foreseen = 10.0;  // tolerances
  return std::abs(motion_now - motion) * sensitivity > foreseen * tolerance * motion;
}

void SolvePlan::restart() {
  interval_.restart();
  next_ = {};
  solved_ = false;
  limit_ = -1.0;
  limit_network_ = last_network_ = 0;
  strain_ = 0.0;
}

/// The loads' change is at most as much as the fluid's loads are, and so at first; it fades as long as changes of
/// the motion have led to smaller ones of the loads, as in a steady flow through grains that creep.
void SolvePlan::update_sensitivity(double motion) {
  constexpr double fading = 0.9;
  const double share = interval_.share_of_fluid(), before = next_.motion;
  const double change = std::abs(motion - before);
  const bool seen = solved_ && change > interval_.tolerance() * before;
  next_.sensitivity = !solved_ ? share
                      : std::min(share, std::max(fading * next_.sensitivity,
                                                 seen ? interval_.change() * before / change : 0.0));
  next_.motion = motion;
  solved_ = true;
}

/// Steps over which loads can be held at most: within the limit of the explicit coupling, until the strain asks
/// for a new network if it goes on as since the last solve, and one with a compressible fluid, whose held
/// pressure drives grains and pistons like a spring with negative damping.
int SolvePlan::most_steps(FlowModel& flow, const SolvedInstant& now) {
  constexpr double part_of_limit = 0.7;
  constexpr std::int64_t networks_for_a_limit = 4;
  if (flow.fluid().bulk_modulus) return 1;
  if (limit_ < 0.0 || flow.retriangulations() - limit_network_ >= networks_for_a_limit) {
    limit_ = flow.time_step_limit(now.masses, now.pistons, now.bodies ? *now.bodies : std::vector<RigidBody>{});
    limit_network_ = flow.retriangulations();
  }
  const double strain = std::abs(flow.strain() - strain_);
  double most = part_of_limit * limit_ / now.step;
  if (strain > 0.0) most = std::min(most, now.retriangulation_strain / strain * now.steps);
  return static_cast<int>(std::clamp(most, 1.0, 1e6));
}

bool SolvePlan::take_up_network(FlowModel& flow, const SolvedInstant& now) const {
  if (flow.fluid().bulk_modulus || flow.strain() < now.retriangulation_strain) return false;
  flow.evaluate(now.packing, now.steps * now.step);
  return true;
}

namespace {

/// Weight of the free grains less their lift, N.
double weight_of(const SolvedInstant& now, const Fluid& fluid) {
  double weight = 0.0;
  for (Eigen::Index k = 0; k < now.masses.size(); ++k)
    if (std::isfinite(now.masses[k]))
      weight += fluid.gravity.norm() *
                std::max(0.0, now.masses[k] - 4.0 / 3.0 * pi * std::pow(now.packing.radii[k], 3) *
                                                  fluid.density);
  return weight;
}

}  // namespace

void SolvePlan::take(FlowModel& flow, const SolvedInstant& now) {
  const auto& radii = now.packing.radii;
  double sums[] = {static_cast<double>(radii.size()), radii.squaredNorm(), weight_of(now, flow.fluid())};
  if (ranks_) ranks_->add(sums, 3);
  const auto [grains, squares, weight] = sums;
  if (grains == 0.0) {
    next_ = {1, 0.0, 0.0, now.motion};
    return;
  }
  const double section = pi * squares / grains;
  const std::vector<double> areas = face_areas(flow.container());
  const double area = *std::max_element(areas.begin(), areas.end());
  const bool new_network = flow.retriangulations() != last_network_;
  last_network_ = flow.retriangulations();
  const double load = std::max(now.load_on_faces, weight);
  const int most = most_steps(flow, now);
  const double answer = 0.5 * limit_ / now.step;  // the fastest motion fades by 2 / limit; not known: below 0
  interval_.take(now.packing.ids, flow.forces(), flow.face_forces(), now.steps, load, area, section, most,
                 new_network, answer);
  if (take_up_network(flow, now)) {
    last_network_ = flow.retriangulations();
    interval_.put_on_network(flow.forces(), flow.face_forces());
  }
  strain_ = flow.strain();
  update_sensitivity(now.motion);
  next_.steps = interval_.steps();
  next_.offset = interval_.held().offset;
}

bool imposed_values_differ(const Container& now, const Container& then, double tolerance) {
  double change = 0.0, largest = 0.0;
  const auto compare = [&](const Boundary& a, const Boundary& b) {
    change = std::max(change, std::abs(a.value - b.value));
    largest = std::max({largest, std::abs(a.value), std::abs(b.value)});
    if (a.profile && b.profile)  // a cosine: its two extremes tell mean and amplitude
      for (const auto& place : {then.lower, then.upper})
        change = std::max(change, std::abs(a.profile(place, 0.0) - b.profile(place, 0.0)));
  };
  if (now.pressure_gradient != then.pressure_gradient) {  // what it makes of the cell's length
    const Eigen::Vector3d length = then.upper - then.lower;
    change = (now.pressure_gradient - then.pressure_gradient).cwiseProduct(length).cwiseAbs().maxCoeff();
    largest = now.pressure_gradient.cwiseAbs().cwiseMax(then.pressure_gradient.cwiseAbs()).cwiseProduct(length).maxCoeff();
  }
  for (std::size_t f = 0; f < now.faces.size(); ++f) compare(now.faces[f].boundary, then.faces[f].boundary);
  for (std::size_t i = 0; i < now.patches.size(); ++i)
    compare(now.patches[i].boundary, then.patches[i].boundary);
  for (std::size_t i = 0; i < now.regions.size(); ++i)
    compare(now.regions[i].boundary, then.regions[i].boundary);
  return change > tolerance * largest;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/solve_plan.hpp"

#include "geometry/pi.hpp"
#include "network/pore_boundaries.hpp"
#include "parallel/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

bool NextSolve::has_jumped(double motion_now, double tolerance) const {
  return std::abs(motion_now - motion) * sensitivity > foreseen * tolerance * motion;
}

bool NextSolve::walls_have_jumped(double change, double fastest, double tolerance) const {
  return std::max(share, tolerance) * change > foreseen * tolerance * fastest;
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
  next_.share = share;
  solved_ = true;
}

/// Steps over which loads can be held at most: within the limit of the explicit coupling, until the strain asks
/// for a new network if it goes on as since the last solve, and one with a compressible fluid, whose held
/// pressure drives grains and pistons like a spring with negative damping.
int SolvePlan::most_steps(FlowModel& flow, const SolvedInstant& now) {
  constexpr double part_of_limit = 0.7;
  constexpr std::int64_t networks_for_a_limit = 4;
  if (flow.fluid().bulk_modulus) return 1;
  const std::int64_t networks = flow.retriangulations() - limit_network_;
  const bool is_new = flow.retriangulations() != last_network_;
  if (limit_ < 0.0 || networks >= networks_for_a_limit || (is_new && flow.stiffest_grain(now.masses).limit < limit_)) {
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

/// Places within a container that the waves of no profile all have their zeros at: multiples of the powers of the root
/// of x⁴ = x + 1, modulo 1.
std::vector<Eigen::Vector3d> places_within(const Container& container) {
  constexpr int count = 32;
  const Eigen::Array3d stride(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  std::vector<Eigen::Vector3d> places;
  for (int k = 1; k <= count; ++k) {
    const Eigen::Array3d part = k * stride - (k * stride).floor();
    places.push_back(container.lower + part.matrix().cwiseProduct(container.upper - container.lower));
  }
  return places;
}

/// Changes of fluxes and of pressures, and what each is measured by.
class ImposedChange {
 public:
  explicit ImposedChange(const Container& then) : places_(places_within(then)) {}

  void compare_inflows(double now, double then) {
    fluxes_ = std::max(fluxes_, std::abs(now - then));
    largest_flux_ = std::max({largest_flux_, std::abs(now), std::abs(then)});
  }

  void compare(const Boundary& now, const Boundary& then, const Surface* face) {
    if (!then.imposes_pressure()) return;
    if (!now.profile || !then.profile) return compare_pressures(now.value, then.value);
    for (Eigen::Vector3d place : places_) {
      if (face) place += face->distance(place) * face->outward_at(place);
      compare_pressures(now.profile(place, 0.0), then.profile(place, 0.0));
    }
  }

  /// Pa, over the length of a cell.
  void compare_gradients(const Eigen::Vector3d& now, const Eigen::Vector3d& then) {
    pressures_ = std::max(pressures_, (now - then).cwiseAbs().maxCoeff());
    along_cell_ = now.cwiseAbs().cwiseMax(then.cwiseAbs()).maxCoeff();
  }

  /// Pa; infinite where no pressure is imposed.
  double lowest() const { return lowest_; }
  double part() const {
    const auto over = [](double change, double scale) { return change > 0.0 ? change / scale : 0.0; };
    return std::max(over(fluxes_, largest_flux_), over(pressures_, std::max(highest_ - lowest_, along_cell_)));
  }

 private:
  void compare_pressures(double now, double then) {
    pressures_ = std::max(pressures_, std::abs(now - then));
    lowest_ = std::min({lowest_, now, then});
    highest_ = std::max({highest_, now, then});
  }

  std::vector<Eigen::Vector3d> places_;
  double fluxes_ = 0.0, largest_flux_ = 0.0, pressures_ = 0.0, along_cell_ = 0.0;
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;
};

ImposedChange change_of_boundaries(const Container& now, const Container& then) {
  ImposedChange change(then);
  for (int b = 0; b < boundary_count(then); ++b)
    if (boundary_of(then, b).imposes_flux()) change.compare_inflows(imposed_inflow(now, b), imposed_inflow(then, b));
  for (std::size_t f = 0; f < now.faces.size(); ++f)
    change.compare(now.faces[f].boundary, then.faces[f].boundary, &then.faces[f].surface);
  for (std::size_t i = 0; i < now.patches.size(); ++i)
    change.compare(now.patches[i].boundary, then.patches[i].boundary, &then.faces[then.patches[i].face].surface);
  for (std::size_t i = 0; i < now.regions.size(); ++i)
    change.compare(now.regions[i].boundary, then.regions[i].boundary, nullptr);
  return change;
}

/// What the lowest pressure that is imposed is on each face, N: a level that moves no grain. The faces' areas as vectors
/// add up to nothing, so that a round one has what the planes leave; of several round ones each has none.
std::vector<Eigen::Vector3d> loads_of_level(const Container& container, const std::vector<double>& areas) {
  const double lowest = change_of_boundaries(container, container).lowest();
  std::vector<Eigen::Vector3d> loads(areas.size(), Eigen::Vector3d::Zero());
  if (!std::isfinite(lowest) || lowest == 0.0) return loads;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::vector<std::size_t> round;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Surface& surface = container.faces[f].surface;
    if (!surface.is_plane()) round.push_back(f);
    else sum += loads[f] = lowest * areas[f] * surface.normal;
  }
  if (round.size() == 1) loads[round[0]] = -sum;
  return loads;
}

}  // namespace

void SolvePlan::take(FlowModel& flow, const SolvedInstant& now) {
  const auto& radii = now.packing.radii;
  double sums[] = {static_cast<double>(radii.size()), radii.squaredNorm(), weight_of(now, flow.fluid())};
  if (ranks_) ranks_->add(sums, 3);
  const auto [grains, squares, weight] = sums;
  if (grains == 0.0) {
    next_ = {1, 0.0, 0.0, now.motion, 0.0};
    return;
  }
  if (now.jumped) {
    interval_.restart();
    solved_ = false;
  }
  const double section = pi * squares / grains;
  const std::vector<double> areas = face_areas(flow.container());
  const double area = *std::max_element(areas.begin(), areas.end());
  const bool new_network = flow.retriangulations() != last_network_;
  const double load = std::max(now.load_on_faces, weight);
  const int most = most_steps(flow, now);
  last_network_ = flow.retriangulations();
  const double answer = 0.5 * limit_ / now.step;  // the fastest motion fades by 2 / limit; not known: below 0
  interval_.take(now.packing.ids, flow.forces(), flow.face_forces(), now.steps, load, area, section, most,
                 new_network, answer, loads_of_level(flow.container(), areas));
  if (take_up_network(flow, now)) {
    last_network_ = flow.retriangulations();
    interval_.put_on_network(flow.forces(), flow.face_forces());
  }
  strain_ = flow.strain();
  update_sensitivity(now.motion);
  next_.steps = interval_.steps();
  next_.offset = interval_.held().offset;
}

double change_of_imposed_values(const Container& now, const Container& then) {
  ImposedChange change = change_of_boundaries(now, then);
  const Eigen::Vector3d length = then.upper - then.lower;
  change.compare_gradients(now.pressure_gradient.cwiseProduct(length), then.pressure_gradient.cwiseProduct(length));
  return change.part();
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/solve_interval.hpp"

#include "parallel/ranks.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

constexpr int longest = 1000;  // steps: something may begin to move meanwhile
constexpr double aim = 0.7;    // of the tolerance
constexpr double fastest_growth = 1.5, fastest_fall = 0.25;  // of the interval, at a solve
constexpr double at_once = 0.1;  // of the tolerance: what an error may be that does not last
constexpr double fading = 0.9;  // of what errors were, at a solve: they pass through zero where trends turn

double largest_norm(const std::vector<Eigen::Vector3d>& faces) {
  double largest = 0.0;
  for (const Eigen::Vector3d& force : faces) largest = std::max(largest, force.norm());
  return largest;
}

/// one - factor other, face by face.
std::vector<Eigen::Vector3d> minus(std::vector<Eigen::Vector3d> one, double factor,
                                   const std::vector<Eigen::Vector3d>& other) {
  for (std::size_t f = 0; f < one.size(); ++f) one[f] -= factor * other[f];
  return one;
}

double ratio(double part, double whole) { return part > 0.0 ? part / whole : 0.0; }

}  // namespace

void SolveInterval::restart() {
  last_.reset();
  trend_.reset();
  continues_ = false;
  steps_ = 1;
  error_ = change_ = 0.0;
  memory_ = {0.0, 0.0};
  held_ = {};
  missed_ = {};
}

SolveInterval::Loads SolveInterval::loads_of(const Forces& forces, const std::vector<Eigen::Vector3d>& faces) {
  Loads loads{Eigen::Matrix<double, 6, Eigen::Dynamic>(6, forces.total.cols()), faces};
  loads.grains.topRows<3>() = forces.total;
  if (forces.torque.cols() > 0)
    loads.grains.bottomRows<3>() = forces.torque;
  else
    loads.grains.bottomRows<3>().setZero();
  return loads;
}

/// Of the norms of columns, on all ranks.
double SolveInterval::root_mean_square(const Eigen::Matrix3Xd& grains) const {
  double sums[] = {grains.squaredNorm(), static_cast<double>(grains.cols())};
  if (ranks_) ranks_->add(sums, 2);
  return sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}

double SolveInterval::size_of(const Difference& difference, const Scales& scales) const {
  return std::max(ratio(largest_norm(difference.faces), scales.face),
                  ratio(root_mean_square(difference.grains), scales.grain));
}

/// Takes what a solve has missed into the mean with this weight.
double SolveInterval::error_of(const Difference& missed, Difference& mean, double weight, const Scales& scales) const {
  if (mean.faces.empty()) {
    mean = missed;
  } else {
    mean.grains += weight * (missed.grains - mean.grains);
    for (std::size_t f = 0; f < mean.faces.size(); ++f) mean.faces[f] += weight * (missed.faces[f] - mean.faces[f]);
  }
  return std::max(size_of(mean, scales), at_once * size_of(missed, scales));
}

/// What errors are measured by, and the fluid's part in it.
SolveInterval::Scales SolveInterval::scales_of(const Forces& forces, const std::vector<Eigen::Vector3d>& faces,
                                               double face_load, double face_area, double section,
                                               const std::vector<Eigen::Vector3d>& of_level) {
  const double of_fluid = largest_norm(of_level.empty() ? faces : minus(faces, 1.0, of_level));
  const double of_grains = root_mean_square(forces.total);
  const double face = std::max(face_load, of_fluid);
  const Scales scales{face, std::max(of_grains, face / face_area * section)};
  share_ = std::max(ratio(of_fluid, scales.face), ratio(of_grains, scales.grain));
  return scales;
}

SolveInterval::Errors SolveInterval::errors_of(const Loads& loads, const Scales& scales, double apart, double weight) {
  Difference missed{loads.grains.topRows<3>() - last_->loads.grains.topRows<3>(),
                    minus(loads.faces, 1.0, last_->loads.faces)};
  change_ = size_of(missed, scales);
  Errors errors{error_of(missed, missed_.held, weight, scales), 0.0};
  errors.continued = errors.held;
  if (!trend_) return errors;
  missed.grains -= apart * trend_->grains.topRows<3>();
  missed.faces = minus(missed.faces, apart, trend_->faces);
  errors.continued = error_of(missed, missed_.continued, weight, scales);
  return errors;
}

void SolveInterval::choose(Errors errors, int most) {
  const double wanted = aim * tolerance_;
  const double now = last_->steps;
  // the middles of two intervals of n steps are n apart; what is held errs with that, a trend with its square
  memory_.held = std::max(errors.held / now, fading * memory_.held);
  if (trend_)
    memory_.continued = std::max(errors.continued / (now * now), fading * memory_.continued);
  const double unlimited = fastest_growth * now + 1.0;
  const double if_held =
      std::min<double>(most, memory_.held > 0.0 ? wanted / memory_.held : unlimited);
  const double if_continued =
      !trend_ ? 0.0
              : std::min<double>(most / 2, memory_.continued > 0.0
                                               ? std::sqrt(wanted / memory_.continued)
                                               : unlimited);
  continues_ = if_continued > if_held;
  const double bounded =
      std::clamp(std::max(if_held, if_continued), fastest_fall * now, unlimited);
  const int limit = std::min(continues_ ? most / 2 : most, longest);
  steps_ = std::clamp(static_cast<int>(std::floor(bounded + 1e-9)), 1, std::max(limit, 1));
}

/// Takes these loads beside those of the last solve, `steps` before: errors, the interval that follows, the trend.
void SolveInterval::compare(const Loads& loads, const Scales& scales, int steps, int most, double answer) {
  const double apart = 0.5 * (steps + last_->steps);  // of the middles of this interval and the last
  const double weight = answer > 0.0 ? -std::expm1(-steps / answer) : 1.0;
  const Errors errors = errors_of(loads, scales, apart, weight);
  error_ = continues_ ? errors.continued : errors.held;
  largest_error_ = std::max(largest_error_, error_);
  last_->steps = steps;
  choose(errors, most);
  trend_ = Loads{(loads.grains - last_->loads.grains) / apart, minus(loads.faces, 1.0, last_->loads.faces)};
  for (Eigen::Vector3d& change : trend_->faces) change /= apart;
}

void SolveInterval::take(const Packing::Ids& ids, const Forces& forces,
                         const std::vector<Eigen::Vector3d>& faces, int steps, double face_load,
                         double face_area, double section, int most,
                         bool new_network, double answer, const std::vector<Eigen::Vector3d>& of_level) {
  forget_others(ids);
  Loads loads = loads_of(forces, faces);
  const Scales scales = scales_of(forces, faces, face_load, face_area, section, of_level);
  if (last_ && new_network) {
    trend_.reset();
    continues_ = false;
    last_->steps = steps;
    steps_ = std::min(steps_, std::max(most, 1));
  } else if (last_) {
    compare(loads, scales, steps, most, answer);
  }
  held_.offset = 0.5 * steps;
  const bool goes_on = continues_ && steps_ > 1;
  held_.slope =
      goes_on ? trend_->grains : Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, loads.grains.cols());
  held_.face_slope = goes_on ? trend_->faces : std::vector<Eigen::Vector3d>(faces.size(), Eigen::Vector3d::Zero());
  const int last_steps = last_ ? last_->steps : 1;
  last_ = Solve{ids, std::move(loads), last_steps};
}

/// Another set of grains begins anew, on all ranks.
void SolveInterval::forget_others(const Packing::Ids& ids) {
  const bool others = last_ && (ids.size() != last_->ids.size() || ids != last_->ids);
  if (ranks_ ? ranks_->any(others) : others) restart();
}

Eigen::MatrixXd SolveInterval::memory_of_grains(const Packing::Ids& ids) {
  forget_others(ids);
  Eigen::MatrixXd memory(rows_of_memory(), ids.size());
  if (!last_) return memory;
  Eigen::Index row = 0;
  const auto put = [&](const auto& columns) {
    memory.middleRows(row, columns.rows()) = columns;
    row += columns.rows();
  };
  put(last_->loads.grains);
  if (trend_) put(trend_->grains);
  for (const Difference* missed : {&missed_.held, &missed_.continued})
    if (!missed->faces.empty()) put(missed->grains);
  return memory;
}

Eigen::Index SolveInterval::rows_of_memory() const {
  const auto of_missed = [](const Difference& missed) { return missed.faces.empty() ? 0 : 3; };
  return !last_ ? 0 : 6 + (trend_ ? 6 : 0) + of_missed(missed_.held) + of_missed(missed_.continued);
}

void SolveInterval::remember_grains(const Packing::Ids& ids, const Eigen::MatrixXd& memory) {
  if (!last_) return;
  Eigen::Index row = 0;
  const auto take = [&](auto& columns) {
    columns = memory.middleRows(row, columns.rows());
    row += columns.rows();
  };
  last_->ids = ids;
  take(last_->loads.grains);
  if (trend_) take(trend_->grains);
  for (Difference* missed : {&missed_.held, &missed_.continued})
    if (!missed->faces.empty()) take(missed->grains);
}

void SolveInterval::put_on_network(const Forces& forces, const std::vector<Eigen::Vector3d>& faces) {
  last_->loads = loads_of(forces, faces);
}

}  // namespace pfv

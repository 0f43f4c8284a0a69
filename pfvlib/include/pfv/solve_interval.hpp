// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pfv {

/// What acts on each grain, and on each face, in a host that does not solve the flow at each of its steps:
/// the loads of the last solve and how they are expected to change, each step.
struct HeldLoads {
  Eigen::Matrix<double, 6, Eigen::Dynamic> slope;  ///< force (N) and torque (N m) a step; zeros: held
  std::vector<Eigen::Vector3d> face_slope;         ///< N a step; none before the first solve
  double offset = 0.0;  ///< steps before the last solve that its loads belong to: the middle of its interval
};

/// When to solve the flow between grains that move little from step to step. Between two solves the loads are
/// held or go on as they changed, whichever would have erred less at the last solve; the interval is made so
/// long that this error stays within a tolerance. A pure function of what it is told, so that two runs do
/// the same. A run begins with `restart`.
///
/// The error of a solve is what its loads differ by from those that had been expected in the middle of its
/// interval: on the faces, the largest, over the largest load on a face; on the grains, the root mean square,
/// over the largest of that of the loads themselves and what that load is on a grain's cross-section.
class SolveInterval {
 public:
  /// `tolerance` > 0: of the load, 1 is all of it.
  explicit SolveInterval(double tolerance) : tolerance_(tolerance) {}

  void restart();

  /// Takes in the loads of a solve after `steps` steps. `face_load` (N): the largest load on a face beside the
  /// fluid's; `face_area` (m²): the largest; `section` (m²): mean cross-section of the grains; `most`:
  /// steps that loads may be held at most, >= 1, half as many if they go on: a trend turns a delay into growth
  /// sooner. `ids`: of the grains; another set begins anew. `new_network`: the first solve on it, whose loads
  /// differ from the last by no change in time alone: the interval stays.
  void take(const Packing::Ids& ids, const Forces& forces,
            const std::vector<Eigen::Vector3d>& faces, int steps, double face_load,
            double face_area, double section, int most, bool new_network = false);

  /// The loads of the same instant on another network, right after `take`: from here on they are held, and
  /// what the last solve said of the change in time stays.
  void put_on_network(const Forces& forces, const std::vector<Eigen::Vector3d>& faces);

  int steps() const { return steps_; }       ///< from the last solve to the next
  const HeldLoads& held() const { return held_; }
  double error() const { return error_; }    ///< of the last solve, over the load
  double change() const { return change_; }  ///< of the loads since the solve before it, in the same way
  double largest_error() const { return largest_error_; }  ///< since the first `restart`
  /// The part of the loads that the fluid's can have in the scale of the errors, 0 to 1.
  double share_of_fluid() const { return share_; }
  double tolerance() const { return tolerance_; }

 private:
  struct Errors {
    double held, continued;
  };
  Errors errors_of(const Forces& forces, const std::vector<Eigen::Vector3d>& faces,
                   double face_scale, double grain_scale, double apart) const;
  void choose(Errors errors, int most);

  double tolerance_;
  bool known_ = false, trend_known_ = false, continues_ = false;
  int steps_ = 1, last_steps_ = 1;
  double error_ = 0.0, largest_error_ = 0.0, change_ = 0.0, share_ = 0.0;
  Errors memory_{0.0, 0.0};  ///< of the errors over the steps, or their square: it fades
  Packing::Ids ids_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> last_, trend_;  ///< loads, and their change a step
  std::vector<Eigen::Vector3d> last_faces_, face_trend_;
  HeldLoads held_;
};

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
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
/// interval, as a mean that fades with the time in which grains answer a load: an error that comes and goes within
/// it, as where grains bounce, moves nothing. It is no less than a tenth of the last solve's alone. On the faces it
/// is the largest, over the largest load on a face; on the grains, the root mean square, over the largest of that of
/// the loads themselves and what that load is on a grain's cross-section.
class SolveInterval {
 public:
  /// `tolerance` > 0: of the load, 1 is all of it. `ranks`: those that share the grains; each tells of its own.
  explicit SolveInterval(double tolerance, std::shared_ptr<const Ranks> ranks = nullptr)
      : tolerance_(tolerance), ranks_(std::move(ranks)) {}

  void restart();

  /// Takes in the loads of a solve after `steps` steps. `face_load` (N): the largest load on a face beside the
  /// fluid's; `face_area` (m²): the largest; `section` (m²): mean cross-section of the grains; `most`:
  /// steps that loads may be held at most, >= 1, half as many if they go on: a trend turns a delay into growth
  /// sooner. `ids`: of the grains; another set begins anew. `new_network`: the first solve on it, whose loads
  /// differ from the last by no change in time alone: the interval stays. `answer`: steps in which the velocities
  /// of the grains follow a load, over which errors are means; 0: each counts by itself. `of_level`: what a constant in
  /// all pressures is on each face, N, which is no load to measure by; empty: none.
  void take(const Packing::Ids& ids, const Forces& forces,
            const std::vector<Eigen::Vector3d>& faces, int steps, double face_load,
            double face_area, double section, int most, bool new_network = false, double answer = 0.0,
            const std::vector<Eigen::Vector3d>& of_level = {});

  /// The loads of the same instant on another network, right after `take`: from here on they are held, and
  /// what the last solve said of the change in time stays.
  void put_on_network(const Forces& forces, const std::vector<Eigen::Vector3d>& faces);

  /// All that is remembered of each grain of the last solve, a column each, and the same where a host has dealt the
  /// grains to its ranks anew: `ids` are this rank's now. Where they are others than at the last solve all is forgotten,
  /// and there are no rows.
  Eigen::MatrixXd memory_of_grains(const Packing::Ids& ids);
  void remember_grains(const Packing::Ids& ids, const Eigen::MatrixXd& memory);

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
  /// Forces on grains and on faces.
  struct Difference {
    Eigen::Matrix3Xd grains;
    std::vector<Eigen::Vector3d> faces;
  };
  /// Means of what loads differ by from what had been expected; empty where none is known.
  struct Missed {
    Difference held, continued;
  };
  struct Loads {
    Eigen::Matrix<double, 6, Eigen::Dynamic> grains;  ///< force (N) and torque (N m)
    std::vector<Eigen::Vector3d> faces;               ///< N
  };
  struct Solve {
    Packing::Ids ids;
    Loads loads;
    int steps;  ///< since the one before it
  };
  struct Scales {
    double face, grain;  ///< N
  };
  static Loads loads_of(const Forces& forces, const std::vector<Eigen::Vector3d>& faces);
  Eigen::Index rows_of_memory() const;
  void forget_others(const Packing::Ids& ids);
  double root_mean_square(const Eigen::Matrix3Xd& grains) const;
  double size_of(const Difference& difference, const Scales& scales) const;
  double error_of(const Difference& missed, Difference& mean, double weight, const Scales& scales) const;
  Scales scales_of(const Forces& forces, const std::vector<Eigen::Vector3d>& faces, double face_load,
                   double face_area, double section, const std::vector<Eigen::Vector3d>& of_level);
  Errors errors_of(const Loads& loads, const Scales& scales, double apart, double weight);
  void compare(const Loads& loads, const Scales& scales, int steps, int most, double answer);
  void choose(Errors errors, int most);

  double tolerance_;
  std::shared_ptr<const Ranks> ranks_;  ///< null: one has all grains
  std::optional<Solve> last_;
  std::optional<Loads> trend_;  ///< change of the loads a step
  bool continues_ = false;
  int steps_ = 1;
  double error_ = 0.0, largest_error_ = 0.0, change_ = 0.0, share_ = 0.0;
  Errors memory_{0.0, 0.0};  ///< of the errors over the steps, or their square: it fades
  Missed missed_;
  HeldLoads held_;
};

}  // namespace pfv

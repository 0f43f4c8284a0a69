// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "pfv/solve_interval.hpp"

#include <array>
#include <cstdint>

namespace pfv {

/// What a host tells of a solve: of the grains and faces as the flow has just seen them.
struct SolvedInstant {
  const Packing& packing;
  const Eigen::VectorXd& masses;           ///< kg, one a sphere; infinite: its velocity is prescribed
  const std::vector<Piston>& pistons;
  int steps;                               ///< of the host since the last solve
  double step;                             ///< of the host, s
  double motion;                           ///< sum of |v| r² of the grains, m³/s
  double load_on_faces;                    ///< N: the largest on a face beside the fluid's, as far as it is known
  double retriangulation_strain;
  const std::vector<RigidBody>* bodies = nullptr;  ///< in the order of Packing::bodies; null: none
  bool jumped = false;  ///< boundaries, walls or grains are so much other than at the last solve that it tells nothing
};

/// What a host needs between two solves; small enough to be told to all ranks.
struct NextSolve {
  int steps = 1;             ///< from the last solve
  double offset = 0.0;       ///< from the instant that its loads belong to until it, steps of the host
  double sensitivity = 0.0;  ///< change of the loads, over the load, with that of the motion by all of itself
  double motion = 0.0;       ///< at the last solve
  double share = 0.0;        ///< of the fluid in the loads at the last solve, 0 to 1

  /// Tolerances that a change between two solves may have: one beyond is a jump.
  static constexpr double foreseen = 10.0;

  /// Whether the grains move so much faster or slower that an interval which was made from what had happened
  /// before cannot have foreseen it.
  bool has_jumped(double motion_now, double tolerance) const;
  /// The same of walls that the host moves: `change` of what they sweep, m³/s, since the last solve, at which `fastest`
  /// was the most that any of them or all grains swept. The fluid's loads are taken to go with that; where it had
  /// none, tenfold speed is a jump.
  bool walls_have_jumped(double change, double fastest, double tolerance) const;
};

/// When an explicit host solves the flow next (`couple_every auto`): SolveInterval with its bounds - the
/// limit of the explicit coupling, the strain that asks for a network, a compressible fluid - and what else
/// asks for a solve.
class SolvePlan {
 public:
  /// `tolerance` > 0: of the load, 1 is all of it. `ranks`: those that share the flow; all of them call `take`.
  explicit SolvePlan(double tolerance, std::shared_ptr<const Ranks> ranks = nullptr)
      : ranks_(ranks), interval_(tolerance, std::move(ranks)) {}

  /// A run begins; what an earlier one saw is forgotten.
  void restart();

  /// Takes in a solve. Where it has brought the strain to its threshold, the network is built anew at once and
  /// the loads are those on the new one, not at the next solve: the difference between two solves then is the change
  /// in time alone, and the network is not an interval older than was asked for. Cost: that of the limit every
  /// fourth network; one solve more where a network is taken up.
  void take(FlowModel& flow, const SolvedInstant& now);

  /// See SolveInterval.
  Eigen::MatrixXd memory_of_grains(const Packing::Ids& ids) { return interval_.memory_of_grains(ids); }
  void remember_grains(const Packing::Ids& ids, const Eigen::MatrixXd& memory) { interval_.remember_grains(ids, memory); }

  const NextSolve& next() const { return next_; }
  const SolveInterval& interval() const { return interval_; }

 private:
  int most_steps(FlowModel& flow, const SolvedInstant& now);
  bool take_up_network(FlowModel& flow, const SolvedInstant& now) const;
  void update_sensitivity(double motion);

  std::shared_ptr<const Ranks> ranks_;  ///< null: one has all grains
  SolveInterval interval_;
  NextSolve next_;
  bool solved_ = false;             ///< in this run
  double limit_ = -1.0;             ///< of the explicit coupling, s; negative: not known
  std::int64_t limit_network_ = 0;  ///< for which it was found
  std::int64_t last_network_ = 0;   ///< of the last solve
  double strain_ = 0.0;             ///< after it
};

/// The largest change of a boundary's value from one container to another with the same faces, patches and regions: of
/// a flux over the largest flux that is imposed; of a pressure, or of what a gradient makes of the cell's length, over
/// the largest difference between two pressures that are imposed, now or then. The change of a lone pressure is all
/// of it, 1; a constant that all pressures have in addition changes nothing. Profiles are compared at 32 places, those of
/// `then`, whose `lower` and `upper` are known, at time 0.
double change_of_imposed_values(const Container& now, const Container& then);

}  // namespace pfv

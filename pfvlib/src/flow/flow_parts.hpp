// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow.hpp"
#include "results/balance.hpp"
#include "step/automatic_solver.hpp"
#include "step/coupling_choice.hpp"
#include "step/fluid_memory.hpp"
#include "step/implicit_step.hpp"
#include "step/network_keeper.hpp"
#include "step/staged_step.hpp"

#include <memory>
#include <optional>

namespace pfv {

/// The ways to take a step, each with what it keeps.
class Schemes {
 public:
  Schemes() : staged_(limit) {}

  TimeStepLimit limit;  ///< of the explicit one
  CouplingChoice choice;

  StepScheme& of(Coupling coupling);
  const ImplicitStep& implicit() const { return implicit_; }
  void forget_network();
  void forget_factor();

 private:
  ExplicitStep explicit_;
  StagedStep staged_;
  ImplicitStep implicit_;
};

/// Who owns what behind Flow.
struct Flow::Parts {
  Parts(Container container, Fluid fluid, const Options& options, std::shared_ptr<const Ranks> ranks);

  Container container;
  Fluid fluid;
  Options options;
  std::shared_ptr<Team> team;  ///< of options.threads
  std::shared_ptr<const Ranks> ranks;  ///< null: one has the packing
  AutomaticSolver automatic;
  NetworkKeeper keeper;
  FluidMemory memory;
  Schemes schemes;
  WorkRecord work;

  // of the last call
  bool solved = false;  ///< it has succeeded
  Coupling coupling = Coupling::explicit_step;
  Solution solution;  ///< its memory serves the next one
  Forces forces;
  std::optional<Balance> kept_balance;

  Problem problem() const { return {container, fluid, options, team, ranks}; }
  /// Solves, and books the step where it is committed.
  const Forces& solve(const Packing& packing, double dt, Coupling by,
                      const GrainDynamics* dynamics, bool commit);
  /// The same with the coupling that is cheapest and stable.
  const Forces& solve_by_choice(const Packing& packing, double dt, const Step& step);
  double time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons,
                         const std::vector<RigidBody>& bodies);

  /// Throws InputError without a result.
  BuiltNetwork& network() const;
  /// The same for what several ranks cannot tell together: throws InputError there.
  BuiltNetwork& whole_network(const char* what) const;
  const Balance& balance();
  /// Grains that are left out because they are outside, on all ranks.
  std::int64_t outside() const;

 private:
  /// From here on, on the present network too; not while a step is under way.
  void use(SolverKind solver);
  BuiltNetwork& update_network(const Packing& packing, double dt, bool commit);
  void begin_solution(const BuiltNetwork& built, double dt, bool commit);
  void find_solution(const StepTask& task, double dt, bool commit);
  void choose_coupling(double dt, const Step& step);
};

}  // namespace pfv

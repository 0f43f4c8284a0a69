// SPDX-License-Identifier: GPL-3.0-or-later
// The order of work of a step.
#include "pfv/flow.hpp"

#include "pfv/error.hpp"
#include "problem/box_changes.hpp"
#include "problem/solver_abilities.hpp"
#include "flow/flow_parts.hpp"
#include "network/grains.hpp"
#include "parallel/mpi_session.hpp"
#include "parallel/ranks.hpp"
#include "step/forces.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"
#include "step/shared_pressures.hpp"
#include "step/trapped_pores.hpp"
#include "work/phase_clock.hpp"

namespace pfv {

StepScheme& Schemes::of(Coupling coupling) {
  switch (coupling) {
    case Coupling::staged: return staged_;
    case Coupling::implicit: return implicit_;
    default: return explicit_;
  }
}

void Schemes::forget_network() {
  limit.forget();
  staged_.forget_network();
  implicit_.forget_network();
}

void Schemes::forget_factor() {
  limit.forget();
  staged_.forget_factor();
  implicit_.forget_factor();
}

Flow::Parts::Parts(Container in, Fluid of, const Options& by, std::shared_ptr<const Ranks> all)
    : container(std::move(in)), fluid(of), options(by), team(std::make_shared<Team>(by.threads)), ranks(std::move(all)),
      automatic(by, ranks != nullptr) {}

void Flow::Parts::use(SolverKind solver) {
  if (options.solver == solver) return;
  options.solver = solver;
  if (!keeper.has_network()) return;
  keeper.network().kept.solver.reset();
  keeper.network().kept.former_solver.reset();
}

BuiltNetwork& Flow::Parts::update_network(const Packing& packing, double dt, bool commit) {
  // explicit steps have ended when they are booked, so that the faces have swept already
  const double swept =
      commit && coupling == Coupling::explicit_step ? swept_volume(container, dt) : 0.0;
  const auto taken_up = [&](Replaced&& before) {
    carry_over(memory, before, keeper.network(), problem(), swept);
    schemes.forget_network();
    if (automatic.is_open()) automatic.begin(keeper.network().grains.spheres.size(), work.counts);
    // no trace of the old network in what follows
    solution.unknown_pressures.setZero(keeper.network().unknowns.count);
  };
  BuiltNetwork& built =
      keeper.update(packing, problem(),
                    {dt, commit, memory.pressures.size() > 0, solution}, work, taken_up);
  if (automatic.is_open() && coupling != Coupling::implicit) use(automatic.now(work.counts));
  if (ranks && is_unfactored(built, fluid, dt)) keeper.await_next();  // hypre sets up one hierarchy at a time
  if (factor_pressures(built, problem(), dt, work)) schemes.forget_factor();
  work.counts.open_water = built.operators.open_water ? open_water_count(built) : 0;
  work.counts.pinned_pores = trapped_pores(built);
  return built;
}

void Flow::Parts::begin_solution(const BuiltNetwork& built, double dt, bool commit) {
  solution.container = container;
  solution.geometry = same_shape(container, built.container) ? built.geometry
                                                             : geometry_of(container, built.network.origin);
  solution.time = commit ? memory.time + dt : memory.time;
  solution.dt = dt;
  solution.stages = 1;
  solution.implicit = false;
  solution.unpaid = 0.0;
  solution.debt_rate = dt > 0.0 ? memory.volume_debt / dt : 0.0;
  solution.previous_pressures = memory.pressures;
  solution.growth = growth_of(container, solution.geometry, built,
                              0.5 * schemes.of(coupling).direction() * dt);
}

/// By the chosen scheme. Where `auto` has taken amg and it comes to no solution, by a factor.
void Flow::Parts::find_solution(const StepTask& task, double dt, bool commit) {
  begin_solution(task.built, dt, commit);
  try {
    schemes.of(coupling).find(task, solution);
  } catch (const SolverError&) {
    if (!automatic.is_open() || options.solver != SolverKind::amg || !automatic.takes_factor_after_failure()) throw;
    use(SolverKind::supernodal);
    if (factor_pressures(task.built, problem(), dt, work)) schemes.forget_factor();
    begin_solution(task.built, dt, commit);
    schemes.of(coupling).find({task.built, problem(), task.packing, task.dynamics, work}, solution);
  }
}

namespace {

void forget_ghosts(Forces& forces, Eigen::Index own) {
  for (Eigen::Matrix3Xd* columns : {&forces.total, &forces.pressure, &forces.viscous, &forces.torque})
    if (columns->cols() > own) columns->conservativeResize(3, own);
  if (forces.sphere_pressure.size() > own) forces.sphere_pressure.conservativeResize(own);
}

}  // namespace

const Forces& Flow::Parts::solve(const Packing& packing, double dt, Coupling by,
                                 const GrainDynamics* dynamics, bool commit) {
  const double wall_start = wall_seconds();
  {
    const PhaseClock clock(work.seconds.total);
    if (!solved) keeper.discard(false);  // after a failure the network may be no longer that of the grains
    solved = false;
    kept_balance.reset();
    coupling = by;
    const Counts before = work.counts;
    if (automatic.is_open() && by == Coupling::implicit) use(SolverKind::supernodal);
    schemes.of(by).check(problem());
    BuiltNetwork& built = update_network(packing, dt, commit);
    const Packing seen = built.halo ? built.halo->seen() : packing;
    find_solution({built, problem(), seen, dynamics, work}, dt, commit);
    if (options.forces) find_forces(built, problem(), seen, work, solution, forces);
    if (built.halo) forget_ghosts(forces, packing.size());
    solved = true;
    if (commit) {
      automatic.count_step(before, work.counts, by == Coupling::staged);
      remember(memory, built, fluid, solution);
      if (solution.moving) keeper.strain(solution);
    }
  }
  work.wall_seconds.total += wall_seconds() - wall_start;
  return forces;
}

double Flow::Parts::time_step_limit(const Eigen::VectorXd& masses,
                                    const std::vector<Piston>& pistons,
                                    const std::vector<RigidBody>& bodies) {
  return schemes.limit.of(network(), problem(), keeper.packed(), masses, pistons, bodies, work);
}

void Flow::Parts::choose_coupling(double dt, const Step& step) {
  const GrainDynamics& dynamics = *step.dynamics;
  Options able = options;
  if (automatic.is_open()) able.solver = SolverKind::automatic;
  schemes.choice.choose(time_step_limit(dynamics.masses, dynamics.pistons, dynamics.bodies), dt, step, able,
                        dynamics.masses.size(), keeper.rebuilds());
}

const Forces& Flow::Parts::solve_by_choice(const Packing& packing, double dt, const Step& step) {
  CouplingChoice& choice = schemes.choice;
  if (!step.commit) {
    solve(packing, dt, Coupling::explicit_step, nullptr, false);
    choice.begin_run();
    choose_coupling(dt, step);
    if (choice.chosen() == Coupling::explicit_step) return forces;
    return solve(packing, dt, choice.chosen(), step.dynamics, false);
  }
  const double before = keeper.strain();
  const std::int64_t network = keeper.rebuilds();
  solve(packing, dt, choice.chosen(), step.dynamics, true);
  const double strained = keeper.strain() - (network == keeper.rebuilds() ? before : 0.0);
  if (choice.is_due_after(strained, keeper.rebuilds())) choose_coupling(dt, step);
  return forces;
}

namespace {

/// What several ranks can do together.
void check_shared(const Options& options) {
  if (!abilities_of(options.solver).shared_by_ranks)
    throw InputError(std::string("the solver ") + name_of(options.solver) + " runs on one rank; on several give " +
                     solvers_with(&SolverAbilities::shared_by_ranks));
  if (options.volume_rates == VolumeRates::geometric || options.partition == Partition::yade)
    throw InputError("the papers' volume rates and YADE's partition work on one rank; on several leave them out");
}

/// A hierarchy that another thread builds sends messages, on one rank to itself.
void check_threads(const Options& options, const Ranks* ranks) {
  if (options.rebuild_lag == 0 || resolved(options.solver) != SolverKind::amg) return;
  MpiSession::start();
  const bool lacking = !MpiSession::takes_threads();
  if (ranks ? ranks->any(lacking) : lacking)
    throw InputError(
        "rebuild_lag with the solver amg has two threads in MPI at once, and the program has started MPI for one: start it by "
        "MPI_Init_thread with MPI_THREAD_MULTIPLE, or leave rebuild_lag at 0");
}

}  // namespace

Flow::Flow(Container container, Fluid fluid, Options options, std::shared_ptr<const Ranks> ranks) {
  check(container);
  find_bounds(container);
  check(fluid);
  if (ranks && options.solver == SolverKind::automatic) options.solver = SolverKind::amg;
  check(options);
  check(container, options);
  if (ranks) check_shared(options);
  check_threads(options, ranks.get());
  parts_ = std::make_unique<Parts>(std::move(container), fluid, options, std::move(ranks));
}

Flow::~Flow() = default;
Flow::Flow(Flow&&) noexcept = default;
Flow& Flow::operator=(Flow&&) noexcept = default;

const Forces& Flow::advance(const Packing& packing, double dt, const Step& step) {
  const auto refuse_what_is_not_finite = [&] { check_motion(packing); };
  if (parts_->ranks)
    parts_->ranks->together(refuse_what_is_not_finite);
  else
    refuse_what_is_not_finite();
  const bool steady = step.coupling == Coupling::explicit_step && !step.commit;
  require_time_step(dt, !steady);
  if (parts_->fluid.bulk_modulus && !(dt > 0.0))
    throw InputError("a compressible fluid needs a time step > 0");
  if (step.coupling != Coupling::explicit_step && !step.dynamics)
    throw InputError(std::string(name_of(step.coupling)) +
                     " coupling needs the masses and other forces of the grains: give Step::dynamics");
  if (parts_->ranks && step.coupling == Coupling::implicit)
    throw InputError("implicit coupling works on one rank; on several take explicit or staged steps, or auto");
  if (step.coupling == Coupling::automatic) return parts_->solve_by_choice(packing, dt, step);
  return parts_->solve(packing, dt, step.coupling, step.dynamics, step.commit);
}

Coupling Flow::coupling() const { return parts_->coupling; }
int Flow::stages() const { return parts_->solution.stages; }

void Flow::rebuild() { parts_->keeper.discard(true); }

void Flow::set_container(const Container& container) {
  Container next = container;
  if (take_bounds(next, parts_->container)) {
    check_conditions(next);
  } else {
    check(container);
    find_bounds(next);
  }
  check(container, parts_->options);
  if (!same_kinds(parts_->container, container)) parts_->keeper.discard(true);
  parts_->container = std::move(next);
}

void Flow::set_retriangulation(StrainMeasure measure, double strain) {
  Options changed = parts_->options;
  changed.strain_measure = measure;
  changed.retriangulation_strain = strain;
  check(changed);
  if (measure != parts_->options.strain_measure) parts_->keeper.discard(false);
  parts_->options = changed;
}

FlowState Flow::state() const {
  const FluidMemory& memory = parts_->memory;
  const Eigen::VectorXd& pressures = memory.pressures;
  const bool of_all = parts_->ranks && memory.pressed && parts_->keeper.has_network();
  return {memory.time,
          strain(),
          retriangulations(),
          of_all ? pressures_of_all(parts_->keeper.network(), pressures)
                 : std::vector<double>(pressures.data(), pressures.data() + pressures.size()),
          memory.volume_debt,
          memory.account.at_start,
          memory.account.came_in,
          parts_->automatic.last_served()};
}

void Flow::set_state(FlowState state) {
  FluidMemory& memory = parts_->memory;
  parts_->solved = false;  // what was found belongs to another state, as the network and its pressures do
  parts_->kept_balance.reset();
  memory.pressures.resize(0);
  memory.pressed = false;
  memory.time = state.time;
  parts_->keeper.restore(state.strain, state.retriangulations);
  memory.restored = std::move(state.pore_pressures);
  memory.volume_debt = state.volume_debt;
  parts_->automatic.restore(state.served_by_last_network);
  memory.account = {state.fluid_at_start != 0.0, state.fluid_at_start, state.fluid_came_in, 0.0, false};
}

}  // namespace pfv

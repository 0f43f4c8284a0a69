// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/background_rebuild.hpp"
#include "coupling/fluid_account.hpp"
#include "physics/chebyshev_stages.hpp"
#include "pfv/flow.hpp"

#include <functional>
#include <optional>

namespace pfv {

/// What follows from the pressures of the last call for the throats and the faces. A step does not need
/// it, so it is made when asked for.
struct Balance {
  Eigen::VectorXd correction;           ///< to the pressures, beyond the digits of a double, Pa
  std::vector<double> throat_fluxes;    ///< from the first pore of a throat to its second, m³/s
  std::vector<double> contact_inflows;  ///< into the box through each boundary contact, m³/s
  std::array<FaceResult, 6> faces;
};

/// How the forces of a step are found from the velocities of its beginning.
enum class Coupling { explicit_step, staged, implicit };

/// What a staged or implicit step integrates, a column for each active sphere and each face.
struct ForcedMotion {
  Motion start;
  Loads held;          ///< all but those of the pressures less their reference
  Matrix6Xd yielding;  ///< dt over mass, s/kg, or over inertia, s/(kg m²); 0 for what no force moves

  Motion moved_by(const Loads& loads) const {
    return start + (yielding.array() * (held + loads).array()).matrix();
  }
};

struct Totals;

/// The state behind Flow.
struct FlowData {
  Box box;
  Fluid fluid;
  Options options;

  std::shared_ptr<Team> team;  ///< of options.threads

  std::unique_ptr<BuiltNetwork> built;
  bool stale = true;
  bool moved_by_host = false;  ///< the host has asked for a new network
  FluidAccount account;
  std::optional<Spheres> former_grains;  ///< of the network before, while the next is taken up
  double swept = 0.0;  ///< by the faces in the step that has just ended and is not in the account yet, m³
  bool had_network = false;
  std::optional<BackgroundRebuild> next;  ///< the network that comes after `built`
  int steps_to_next = 0;                  ///< until it is taken up
  double strain_before_next = 0.0;        ///< had accumulated when it was begun
  Eigen::VectorXd changes_before_next;    ///< `volume_changes` then
  double time = 0.0, strain = 0.0;
  double strain_taken_over = 0.0;  ///< what the grains of the network had strained when it was taken up
  Eigen::VectorXd volume_changes;  ///< of its pores since, m³; empty unless the mean strain is wanted
  std::int64_t retriangulations = 0;
  Counts counts;
  Seconds seconds;
  double wall_total = 0.0, wall_waited = 0.0;

  // of the last call
  bool solved = false;
  bool moving = false;
  bool solved_implicitly = false;  ///< the pressures are those of the matrix A
  double dt = 0.0;
  int stages = 1;
  double reference = 0.0;                ///< pressure that was subtracted before solving, Pa
  Motion motion;                         ///< that `rates` belong to; of a long step the mean over it
  Eigen::VectorXd rates;                 ///< dV/dt of each pore, m³/s
  /// What the faces normal to each axis have grown by since the network was built, m²: until the middle
  /// of the step, and until now.
  Eigen::Vector3d grown_areas = Eigen::Vector3d::Zero(), grown_areas_now = Eigen::Vector3d::Zero();
  double volume_debt = 0.0;  ///< what the box has grown by beyond the rates of implicit steps, m³
  double unpaid_growth = 0.0;  ///< what the last step leaves of it, m³
  double debt_rate = 0.0;      ///< at which the last step pays it, m³/s
  Eigen::VectorXd old_pressures;         ///< at the last step, of the present pores, Pa
  Eigen::VectorXd previous_pressures;    ///< the old pressures that the last solve started from, Pa
  Eigen::VectorXd relative_pressures;    ///< minus the reference, Pa
  Eigen::VectorXd pressures;             ///< Pa
  Eigen::VectorXd right_side, solution;  ///< of the unknowns
  Loads loads;                           ///< S p
  Forces forces;
  Box solved_box;  ///< the box may be another by the time that a balance is asked for
  std::vector<std::int64_t> packing_ids;
  std::vector<double> pending_pressures;  ///< from set_state, for the next network

  const Forces& compute(const Packing& packing, double step, bool advance,
                        Coupling coupling = Coupling::explicit_step,
                        const GrainDynamics* grains = nullptr);
  double time_step_limit(const Eigen::VectorXd& masses, const std::array<Piston, 6>& pistons);
  std::vector<Eigen::Matrix3d> viscosity_matrices(const std::vector<int>& columns);
  /// The matrix of the last solve.
  const SymmetricMatrix& solved_matrix() const {
    return solved_implicitly ? built->implicit->system.matrix : built->system.matrix;
  }
  void require_result() const;
  /// What is in the box beyond what was at the start and came in, m³: 0 but for what the volume rates do
  /// not know of.
  double fluid_missing() const;
  /// Of the relative pressures on what the faces normal to each axis have grown by, N.
  Eigen::Vector3d forces_on_growth() const;
  /// Throws InputError without a result. Cost: one solve and a pass over the throats, once a call.
  const Balance& balance();

 private:
  std::optional<Balance> balance_;

  double largest_drag();

  BuildSettings build_settings() const { return {box, fluid, options, team}; }
  void update_network(const Packing& packing, double step, bool advance);
  bool is_outdated(const Packing& packing) const;
  void rebuild_now(const Packing& packing);
  void begin_next(const Packing& packing, double step);
  void take_up_next();
  void take_up(std::unique_ptr<BuiltNetwork> fresh);
  double swept_volume(double step) const;
  void settle_account(const Spheres* before, double swept);
  /// What these pressures have pressed into the pores of a network, m³.
  double compressed_in(const BuiltNetwork& network, const Eigen::VectorXd& values) const;
  void refuse_undetermined(bool moving_now) const;
  void refuse_isolated(const std::vector<Isolated>& held) const;
  void measure_grown_areas(double ahead);
  void set_motion(const Packing& packing);
  double rounding_of_rates() const;
  void update_rates(const Packing& packing);
  /// Rates of a motion, which add up to that of the box as it is now.
  void find_rates(const Motion& of);
  double growth_beyond_rates(const Motion& of) const;
  void spread_over_pores(double rate);
  void impose(double at_time);
  void solve_pressures(double at_time, LinearSolver& solver);
  /// Where conductances lie so far apart that a solve on the kept factor loses digits of the pressures
  /// (found out by the first solve on it): iterative refinement with the continuity defect, which
  /// keeps them. Throws SolverError where that does not converge.
  /// `follow` brings up to date what follows from the pressures in the same step.
  void refine_pressures(LinearSolver& solver, std::optional<bool>& loses_digits,
                        const std::function<void()>& follow);
  Eigen::Vector3d buoyancy_of(int sphere) const;
  void compute_forces(const Packing& packing);
  void refuse_shear_forces(Coupling coupling) const;
  void refuse_lag(Coupling coupling) const;
  void refuse_geometric(Coupling coupling) const;
  void add_shear_forces();
  /// Of this motion; none where switched off.
  Loads shear_forces_of(const Motion& motion) const;
  const Loads& gradient_loads();
  void check_dynamics(const GrainDynamics& grains, const Packing& packing) const;
  Matrix6Xd yielding(const GrainDynamics& grains, double step) const;
  Loads held_forces(const GrainDynamics& grains);
  Loads pressure_loads() const;
  void run_stages(const Packing& packing, double step, double at_time,
                  const GrainDynamics& grains);
  void run_recursion(const ForcedMotion& forced, double z, double at_time);
  void run_implicit(const Packing& packing, double step, double at_time,
                    const GrainDynamics& grains);
  void factor_implicit(const Matrix6Xd& yielding);
  void end_step(double step);
  void add_strain(double step);
  /// coupling/pore_strain.hpp
  double mean_strain(const Eigen::VectorXd& changes) const;

  Eigen::VectorXd displaced;    ///< m³, by the active spheres
  Eigen::VectorXd sources, mean_pressures;
};

/// Force on each face from the pressures of the last call; its flux is left 0.
std::array<FaceResult, 6> face_forces(const FlowData& flow);
/// Permeability and tensor with their estimated error, where they have a meaning; `report` holds the
/// porosity already, `fluxes` are those of the throats, m³/s.
void add_permeability(Report& report, const FlowData& flow, const Totals& totals,
                      const std::vector<double>& fluxes);
/// Everything a report holds, from the last call.
Report make_report(FlowData& flow);

}  // namespace pfv

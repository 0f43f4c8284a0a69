// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/background_rebuild.hpp"
#include "coupling/pressure_lag.hpp"
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

/// What the stages of one step integrate; 3 x (active spheres + 6), and one entry each of them.
struct StagedMotion {
  std::vector<ChebyshevStage> stages;
  double ratio;                 ///< of the step to the limit of the explicit coupling
  Eigen::Matrix3Xd start;       ///< velocities, m/s
  Eigen::Matrix3Xd held;        ///< forces other than those of the pressures, N
  Eigen::RowVectorXd per_mass;  ///< dt/m, s/kg
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
  Eigen::VectorXd rates;                 ///< dV/dt of each pore, m³/s
  Eigen::Matrix3Xd mean_motion;  ///< over a staged or implicit step, of active spheres and faces; else empty
  Eigen::VectorXd old_pressures;         ///< at the last step, of the present pores, Pa
  Eigen::VectorXd previous_pressures;    ///< the old pressures that the last solve started from, Pa
  Eigen::VectorXd relative_pressures;    ///< minus the reference, Pa
  Eigen::VectorXd pressures;             ///< Pa
  PressureLag lag;            ///< of the last long steps; empty after a plain one
  Eigen::VectorXd force_lag;  ///< pressures that S acted with in the last call; empty: the present
  Eigen::VectorXd right_side, solution;  ///< of the unknowns
  Eigen::Matrix3Xd fluid_forces;         ///< S p: 3 x (active spheres + 6), N
  Forces forces;
  Box solved_box;  ///< the box may be another by the time that a balance is asked for
  std::vector<std::int64_t> packing_ids;
  /// From set_state, for the next network.
  std::vector<double> pending_pressures, pending_level, pending_delayed;

  /// Only the explicit step needs no `grains`.
  const Forces& compute(const Packing& packing, double step, bool advance,
                        Coupling coupling = Coupling::explicit_step,
                        const GrainDynamics* grains = nullptr);
  double time_step_limit(const Eigen::VectorXd& masses, const std::array<Piston, 6>& pistons);
  std::vector<Eigen::Matrix3d> viscosity_matrices(const std::vector<int>& columns);
  /// The same with E^T in place of S, which the stages take; after `time_step_limit`.
  double stage_limit();
  double stage_limit_near(double limit);
  /// The matrix of the last solve.
  const SymmetricMatrix& solved_matrix() const {
    return solved_implicitly ? built->implicit->system.matrix : built->system.matrix;
  }
  void require_result() const;
  /// Velocities that `rates` belong to, of active spheres and faces.
  Eigen::Matrix3Xd rated_motion() const;
  /// Throws InputError without a result. Cost: one solve and a pass over the throats, once a call.
  const Balance& balance();

 private:
  std::optional<Balance> balance_;

  /// Largest eigenvalue of M^-1 F G^-1 E, 1/s; F: pressures to forces on active spheres and faces.
  double largest_drag(
      const std::function<Eigen::Matrix3Xd(const Eigen::VectorXd&)>& forces_of_pressures);

  BuildSettings build_settings() const { return {box, fluid, options, team}; }
  void update_network(const Packing& packing, double step, bool advance);
  bool is_outdated(const Packing& packing) const;
  void rebuild_now(const Packing& packing);
  void begin_next(const Packing& packing, double step);
  void take_up_next();
  void take_up(std::unique_ptr<BuiltNetwork> fresh);
  void refuse_undetermined(bool moving_now) const;
  void refuse_isolated(const std::vector<Isolated>& held) const;
  double rounding_of_rates() const;
  void update_rates(const Packing& packing);
  void rates_of(const Eigen::Matrix3Xd& of_grains);
  void rates_of_motion(const Eigen::Matrix3Xd& motion);
  void impose(double at_time);
  void solve_pressures(double at_time, LinearSolver& solver);
  /// Where conductances lie so far apart that a solve on the kept factor loses digits of the pressures
  /// (found out by the first solve on it): iterative refinement with the continuity defect, which
  /// keeps them. Throws SolverError where that does not converge.
  void refine_pressures();
  Eigen::Vector3d buoyancy_of(int sphere) const;
  void multiply_forces(const ForceMatrix& matrix, ForceParts parts, Eigen::Matrix3Xd& result);
  void compute_forces(const Packing& packing);
  void refuse_shear_forces(Coupling coupling) const;
  void refuse_lag(Coupling coupling) const;
  void add_shear_forces(const Packing& packing);
  /// 3 x (active spheres + 6): of these velocities of active spheres and faces; none where switched off.
  Eigen::Matrix3Xd shear_forces_of(const Eigen::Matrix3Xd& motion) const;
  Eigen::Matrix3Xd motion_of(const Packing& packing) const;
  void check_dynamics(const GrainDynamics& grains, const Packing& packing) const;
  Eigen::RowVectorXd yielding(const GrainDynamics& grains, double step) const;
  Eigen::Matrix3Xd held_forces(const GrainDynamics& grains) const;
  void find_lag(const std::function<void(const Eigen::VectorXd&)>& solve);
  void run_recursion(const StagedMotion& staged, double at_time, const Eigen::VectorXd& old);
  void run_stages(const Packing& packing, double step, double at_time,
                  const GrainDynamics& grains);
  /// UnstableStep where a staged step changed the velocities beyond its bound; all 3 x (active + 6), m/s.
  void refuse_feeding(const Eigen::Matrix3Xd& change, const Eigen::Matrix3Xd& explicit_one,
                      const Eigen::RowVectorXd& per_mass, double ratio) const;
  void run_implicit(const Packing& packing, double step, double at_time,
                    const GrainDynamics& grains);
  void factor_implicit(const Eigen::RowVectorXd& per_mass);
  void end_step(double step);
  void add_strain(double step);
  /// Sum of |changes| over sum of volumes.
  double mean_strain(const Eigen::VectorXd& changes) const;

  Eigen::Matrix3Xd velocities;  ///< of the active spheres
  Eigen::VectorXd displaced;    ///< m³, likewise
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

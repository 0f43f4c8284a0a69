// SPDX-License-Identifier: GPL-3.0-or-later
// fix pfv: pore-scale finite volume flow between the grains. See doc/fix_pfv.md.
#ifdef FIX_CLASS

FixStyle(pfv,FixPfv)

#else

#ifndef LMP_FIX_PFV_H
#define LMP_FIX_PFV_H

#include "arguments.h"
#include "bodies.h"
#include "face_sources.h"
#include "flow_ranks.h"
#include "found_walls.h"
#include "grain_exchange.h"
#include "kept_flow.h"
#include "obstacles.h"
#include "other_fixes.h"
#include "restart_record.h"
#include "result_files.h"
#include "script_units.h"
#include "solve_schedule.h"
#include "unseen_walls.h"

#include "pfv/flow_model.hpp"
#include "pfv/time_step.hpp"

#include "fix.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace LAMMPS_NS {

/// Gathers the grains where the flow is, calls the flow library once, scatters the forces. The physics is in
/// pfv::FlowModel, which lives on rank 0 alone or is shared by all ranks; everything else here is the same on all.
class FixPfv : public Fix {
 public:
  FixPfv(class LAMMPS*, int, char**);

  int setmask() override;
  void post_create() override;
  void pre_delete(bool unfixflag) override;
  void init() override;
  void setup(int vflag) override;
  void setup_pre_force(int vflag) override;
  void pre_force(int vflag) override;
  void post_force(int vflag) override;
  void post_run() override;

  double compute_scalar() override;
  double compute_vector(int n) override;
  int modify_param(int narg, char** arg) override;
  void write_restart(FILE* file) override;
  void restart(char* bytes) override;
  double memory_usage() override;

 private:
  /// Of compute_vector, before and behind those of the obstacles.
  static constexpr int own_quantities = 10, last_quantities = 4;

  // errors: each ends the run on all ranks, with one line
  template <typename Work>
  void everywhere(Work&& work);  ///< work that fails on all ranks or on none
  template <typename Work>
  void on_root(Work&& work);  ///< work of rank 0, whose failure the others are told of
  template <typename Work>
  void on_flow(Work&& work);  ///< work of the ranks that hold the flow
  void fail_on_flow(const std::exception& problem);
  void stop(const char* file, int line, const std::string& problem);
  void fail_together(std::string message);
  /// Its text, once those of the grains that it names are drawn.
  std::string with_culprits(const std::exception& problem, const pfv::Packing& grains) const;
  pfv::PackingArrays grains_named(const std::vector<std::int64_t>& tags) const;

  const PfvUnits& units() const;

  // refusals
  void check_environment();
  const char* other_fluid() const;
  void check_cell();
  void check_variables();
  void check_other_fixes();
  bool wants_contact_stress() const { return settings_.fields && settings_.fields->contact_stress; }
  void check_contact_stress();

  // one flow call
  pfv::Container current_container();
  void update_bound_numbers();
  void read_host();
  void advance();
  void place_faces(pfv::Container& container);
  void follow_grains(const PfvGrainExchange& grains);
  void use_mean_velocities_of_faces();
  void move_cell(pfv::Container& container) const;
  Eigen::Vector3d cell_lengths_then() const;
  PfvLeftState state_of(const PfvGrainExchange& grains);
  std::uint64_t fingerprint();
  bool are_moved();
  void begin_anew_where_moved();
  void remember_state();
  void warn_of_empty_box() const;
  void warn_of(const std::string& problem) const;
  void warn_of_obstacles_and_surfaces() const;
  void warn_of_light_grains() const;
  void warn_of_likely_slips() const;
  void warn_of_gaps(const std::vector<double>& mesh_areas) const;
  void say_what_holds_the_fluid();
  void say_what_is_filled();
  std::int64_t hidden_or_outside() const;
  double solid_inside() const;
  pfv::Container closed_container(const std::vector<pfv::ContainerFace>& faces) const;
  Eigen::Vector3d gravity();
  void after_flow_call();
  void apply_forces();
  void push_meshes();
  PfvRestartRecord::Meshes meshes_for_restart();
  void restore_meshes(const PfvRestartRecord& record);

  // which ranks hold the flow, and which grains
  void choose_ranks();
  std::string needs_one_rank() const;
  PfvHomes homes() const;
  void deal_where_due();
  void deal_anew();
  Eigen::Matrix3Xd spheres_to_deal() const;
  void deal_obstacles(const std::vector<int>& parts);
  double spread() const;

  // when to solve the flow
  bool adapts() const;
  bool solve_due();
  double change_of_viscosity() const;
  int column_of_radii() const;
  PfvPresent look_around() const;
  bool has_jumped(const PfvPresent& present, double imposed) const;
  void plan_next_solve(int steps, double imposed);

  // time step and coupling
  void bind_coupling();
  bool needs_forces() const;
  double flow_step() const;  ///< s, between two flow steps of a run
  void call_flow(double dt, bool commit);
  pfv::TimeStepCheck look_at_time_step(const std::string& reason = "");
  void check_time_step();
  void watch_time_step();
  void check_servos();
  std::string swinging_servo(int face, const PfvServoGain& servo, double resistance,
                             double swing) const;
  Eigen::MatrixXd resistances_to(const std::vector<PfvServoGain>& gains);

  // outputs
  double quantity(int n);
  double last_quantity(int n);
  bool has_per_atom() const;
  PfvOfGrains of_grains();
  pfv::StokesNumbers stokes() const;  ///< of all ranks that hold the flow; collective among these
  void print_phases();
  Eigen::MatrixXd stresses_where_due();
  void print(const std::string& text);

  PfvSettings settings_;
  PfvFaceSources faces_;
  PfvPeriodicCell cell_;
  PfvGrainExchange grains_;
  PfvBodies bodies_;
  PfvObstacles obstacles_;
  PfvOfOthers others_;
  class FixPropertyAtom* per_atom_ = nullptr;
  PfvFlowRanks ranks_;
  pfv::Container container_;

  PfvSinceSolve since_;
  PfvSolveSchedule schedule_;

  // where the flow is
  PfvKeptFlow flow_;
  std::unique_ptr<PfvResultFiles> files_;
  struct Said {
    bool citation = false;
    bool time_step = false;  // warned of, in this run
    std::int64_t network = 0;  // retriangulations when the time step was looked at
    std::int64_t grain_network = 0;  // and when the stiffest grain was
  } said_;
};

template <typename Work>
void FixPfv::on_root(Work&& work) {
  std::string message;
  if (ranks_.is_first()) {
    try {
      work();
    } catch (const std::exception& problem) {
      message = with_culprits(problem, grains_.packing());
      if (message.empty()) message = "an exception without a text";
    }
  }
  fail_together(message);
}

template <typename Work>
void FixPfv::on_flow(Work&& work) {
  if (!ranks_.are_all()) return on_root(work);
  try {
    work();
  } catch (const std::exception& problem) {
    fail_on_flow(problem);
  }
}

}  // namespace LAMMPS_NS

#endif
#endif

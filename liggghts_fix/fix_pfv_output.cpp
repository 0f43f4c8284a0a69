// SPDX-License-Identifier: GPL-3.0-or-later
// What `fix pfv` answers to thermo output and prints at the end of a run.
#include "fix_pfv.h"

#include "comm.h"

#include <mpi.h>
#include <cstdio>

namespace LAMMPS_NS {

double FixPfv::compute_scalar() { return compute_vector(-1); }

double FixPfv::compute_vector(int n) {
  double value = 0.0;
  on_root([&] {
    if (flow_) value = quantity(n);
  });
  MPI_Bcast(&value, 1, MPI_DOUBLE, 0, world);
  return value;
}

double FixPfv::quantity(int n) {
  switch (n) {
    case 0: return report().inflow;
    case 1: return report().outflow;
    case 2: return report().mass_error;
    case 3: return report().force_balance_error;
    case 4: return static_cast<double>(flow_->retriangulations());
    case 5: return flow_->time_step_limit(grains_.masses(), pistons_);
    case 6: return flow_->mean_pressure();
    case 7: return static_cast<double>(flow_->hidden_or_outside());
    case 8: return static_cast<double>(flow_->stages());
    case 9: return static_cast<double>(steps_since_flow_);
    default: return flow_->strain();
  }
}

/// One report serves all outputs of a step.
const pfv::Report& FixPfv::report() {
  if (!report_) report_ = flow_->report();
  return *report_;
}

void FixPfv::post_run() {
  remember_state();
  on_root([&] {
    if (flow_) print_phases();
  });
}

void FixPfv::print_phases() {
  const pfv::Report& done = report();
  const struct {
    const char* name;
    double seconds;
    std::int64_t count;
  } phases[] = {{settings_.grid() ? "porosity" : "triangulate", done.seconds.triangulate, done.counts.triangulate},
                {"throats", done.seconds.throats, done.counts.triangulate},
                {"assemble", done.seconds.assemble, done.counts.triangulate},
                {"order", done.seconds.order, done.counts.order},
                {"factor", done.seconds.factor, done.counts.factor},
                {"solve", done.seconds.solve, done.counts.solve},
                {"forces", done.seconds.forces, done.counts.force_matrix},
                {"total", done.seconds.total, done.counts.solve}};
  char line[160];
  std::string text = "\nFix pfv (id " + std::string(id) + ") since it began:\n";
  text += "phase         CPU seconds       count\n";
  for (const auto& phase : phases) {
    std::snprintf(line, sizeof line, "%-12s %12.4f %11lld\n", phase.name, phase.seconds,
                  static_cast<long long>(phase.count));
    text += line;
  }
  std::snprintf(line, sizeof line,
                "spheres %lld  hidden %lld  outside %lld  pores %lld  unknowns %lld\n",
                static_cast<long long>(done.spheres), static_cast<long long>(done.hidden),
                static_cast<long long>(done.outside), static_cast<long long>(done.pores),
                static_cast<long long>(done.unknowns));
  text += line;
  std::snprintf(line, sizeof line, "residual %.3g  mass error %.3g  force balance error %.3g\n",
                done.residual, done.mass_error, done.force_balance_error);
  text += line;
  text += "solver " + done.solver + ": " + done.solver_made_of + "\n";
  if (plan_) {
    std::snprintf(line, sizeof line,
                  "couple_every auto: solved at %lld of %lld steps, estimated error %.2g %% of the load\n",
                  static_cast<long long>(solves_), static_cast<long long>(steps_),
                  100.0 * plan_->interval().largest_error());
    text += line;
  }
  if (settings_.options.rebuild_lag > 0) {
    std::snprintf(line, sizeof line, "built in the background %lld  waited for them %.4g s\n",
                  static_cast<long long>(done.counts.background), done.wall_seconds.waited);
    text += line;
  }
  if (done.permeability && done.permeability_error) {  // only while all grains are at rest
    std::snprintf(line, sizeof line,
                  "permeability %.6g m2  estimated error %.2g %%  in degenerate throats %.2g %%\n",
                  *done.permeability, 100.0 * *done.permeability_error,
                  100.0 * *done.degenerate_share);
    text += line;
    for (const std::string& reason : done.outside_range)
      text += "WARNING: the permeability's estimated error may not hold: " + reason + "\n";
  }
  if (!cited_ && !settings_.grid())
    text +=
        "Please cite, for the flow and for its coupling with the grains:\n"
        "  Chareyre, Cortis, Catalano, Barthelemy (2012) Pore-scale modeling of viscous flow and\n"
        "  induced forces in dense sphere packings. Transport in Porous Media 92:473-493\n"
        "  Catalano, Chareyre, Barthelemy (2014) Pore-scale modeling of fluid-particles\n"
        "  interaction and emerging poromechanical effects. Int. J. Numer. Anal. Methods\n"
        "  Geomech. 38:51-71\n";
  cited_ = true;
  print(text);
}

void FixPfv::print(const std::string& text) {
  for (FILE* file : {screen, logfile})
    if (file) std::fputs(text.c_str(), file);
}

double FixPfv::memory_usage() { return grains_.memory_usage(); }

}  // namespace LAMMPS_NS

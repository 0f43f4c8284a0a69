// SPDX-License-Identifier: GPL-3.0-or-later
// What `fix pfv` answers to thermo output and prints at the end of a run.
#include "fix_pfv.h"

#include "contact_forces.h"

#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include "comm.h"
#include "error.h"
#include "update.h"

#include <mpi.h>
#include <cstdio>

namespace LAMMPS_NS {

namespace {

std::string text_of(const pfv::StokesNumbers& stokes) {
  if (!(stokes.largest > 0.0)) return {};
  char text[100];
  std::snprintf(text, sizeof text, "Stokes number of the grains: largest %.3g  mean %.3g\n", stokes.largest, stokes.mean);
  return text;
}

}  // namespace

double FixPfv::compute_scalar() { return compute_vector(-1); }

double FixPfv::compute_vector(int n) {
  double value = 0.0;
  on_flow([&] {
    if (flow_) value = quantity(n);
  });
  MPI_Bcast(&value, 1, MPI_DOUBLE, 0, world);
  return value;
}

double FixPfv::quantity(int n) {
  switch (n) {
    case 0: return flow_.report().inflow;
    case 1: return flow_.report().outflow;
    case 2: return flow_.report().mass_error;
    case 3: return flow_.report().force_balance_error;
    case 4: return static_cast<double>(flow_->retriangulations());
    case 5: return flow_->time_step_limit(grains_.masses(), faces_.pistons(), bodies_.rigid());
    case 6: return flow_.mean_pressure();
    case 7: return static_cast<double>(hidden_or_outside());
    case 8: return static_cast<double>(flow_->stages());
    case 9: return static_cast<double>(since_.steps);
    case -1: return flow_->strain();
    default: break;
  }
  const int load = n - own_quantities;
  return load < obstacles_.components() ? obstacles_.load(load) : last_quantity(load - obstacles_.components());
}

double FixPfv::last_quantity(int n) {
  switch (n) {
    case 0: return flow_.report().reynolds_largest.value_or(0.0);
    case 1: return flow_.report().reynolds_mean.value_or(0.0);
    case 2: return stokes().largest;
    default: return stokes().mean;
  }
}

pfv::StokesNumbers FixPfv::stokes() const {
  pfv::StokesNumbers found = pfv::stokes_numbers(grains_.packing(), grains_.masses(), settings_.fluid.viscosity);
  double sums[] = {found.mean * found.mass, found.mass};
  ranks_.add(sums, 2);
  ranks_.take_largest(&found.largest, 1);
  return {found.largest, sums[1] > 0.0 ? sums[0] / sums[1] : 0.0, sums[1]};
}

/// For the history. Where the flow is.
PfvOfGrains FixPfv::of_grains() {
  return {hidden_or_outside(), flow_.report().force_sum - obstacles_.force(), stokes()};
}

void FixPfv::post_run() {
  remember_state();
  on_flow([&] {
    if (flow_) print_phases();
  });
}

void FixPfv::print_phases() {
  std::string text = "\nFix pfv (id " + std::string(id) + ") since it began:\n" +
                     units().relabelled(pfv::summary_of(flow_.report()) + text_of(stokes())) + schedule_.summary();
  if (ranks_.dealt.times > 0)
    text += "  grains dealt to the ranks " + std::to_string(ranks_.dealt.times) + " times\n";
  if (!said_.citation && settings_.model == pfv::Model::pores) text += pfv::citation();
  said_.citation = true;
  print(text);
}

/// What contacts and motion cause in the grains, where files that are to tell of it are due: at their homes. No rows
/// elsewhere. Collective.
Eigen::MatrixXd FixPfv::stresses_where_due() {
  if (!wants_contact_stress()) return {};
  int due = ranks_.is_first() && files_->fields_due(update->ntimestep);
  MPI_Bcast(&due, 1, MPI_INT, 0, world);
  if (!due) return {};
  std::vector<double> rows;
  try {
    rows = PfvContactForces(lmp).rows(groupbit);
  } catch (const pfv::Error& problem) {
    error->one(FLERR, problem.what());  // of this rank alone
  }
  return grains_.at_homes(rows, PfvContactForces::width);
}

void FixPfv::check_contact_stress() {
  if (!wants_contact_stress()) return;
  const std::string obstacle = PfvContactForces(lmp).obstacle(*this);
  if (!obstacle.empty()) stop(FLERR, obstacle);
}

/// Once, whichever ranks hold the flow: LIGGGHTS gives each of them a screen.
void FixPfv::print(const std::string& text) {
  if (!ranks_.is_first()) return;
  for (FILE* file : {screen, logfile})
    if (file) std::fputs(text.c_str(), file);
}

double FixPfv::memory_usage() { return grains_.memory_usage(); }

}  // namespace LAMMPS_NS

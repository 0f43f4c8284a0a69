// SPDX-License-Identifier: GPL-3.0-or-later
#include "fix_pfv.h"

#include "contact_forces.h"
#include "pfv/darcy_grid.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "pfv/io.hpp"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_buoyancy.h"
#include "fix_gravity.h"
#include "fix_property_atom.h"
#include "group.h"
#include "input.h"
#include "modify.h"
#include "universe.h"
#include "update.h"
#include "variable.h"

#include <mpi.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace LAMMPS_NS {

using namespace FixConst;

FixPfv::FixPfv(LAMMPS* lmp, int narg, char** arg) : Fix(lmp, narg, arg), faces_(lmp), cell_(lmp), grains_(lmp), bodies_(lmp),
      obstacles_(lmp), ranks_(world) {
  check_environment();
  everywhere([&] {
    settings_ = parse_pfv(narg - 3, arg + 3, cell_.axes(), units());
    settings_.left_out = PfvFoundWalls(lmp, groupbit).complete(settings_);
    if (wants_contact_stress()) PfvContactForces(lmp).ask();
  });
  on_root([&] { files_ = std::make_unique<PfvResultFiles>(settings_, true); });
  if (!files_) files_ = std::make_unique<PfvResultFiles>(settings_, false);

  scalar_flag = vector_flag = 1;
  size_vector = own_quantities + 6 * static_cast<int>(settings_.obstacles.size()) + last_quantities;
  extscalar = extvector = 0;
  global_freq = 1;
  peratom_flag = 1;
  size_peratom_cols = PfvGrainExchange::returned_width;
  schedule_.adapt_within(settings_.steps.couple_error);
  peratom_freq = 1;
  restart_global = 1;
}

int FixPfv::setmask() { return PRE_FORCE | POST_FORCE | POST_RUN; }

void FixPfv::post_create() {
  const std::string property_id = std::string(id) + "_prop";
  std::vector<const char*> words{property_id.c_str(), group->names[igroup], "property/atom",
                                 property_id.c_str(), "vector", "no", "no", "no"};
  ranks_.dealt.column = adapts() ? PfvGrainExchange::width_with_slopes : PfvGrainExchange::returned_width;
  words.insert(words.end(), column_of_radii() + (adapts() ? 1 : 0), "0.");
  per_atom_ = modify->add_fix_property_atom(static_cast<int>(words.size()),
                                            const_cast<char**>(words.data()), style);
  array_atom = per_atom_->array_atom;
}

/// A script may have removed it.
bool FixPfv::has_per_atom() const {
  return std::find(modify->fix, modify->fix + modify->nfix, static_cast<const Fix*>(per_atom_)) != modify->fix + modify->nfix;
}

void FixPfv::pre_delete(bool unfixflag) {
  if (unfixflag && has_per_atom()) modify->delete_fix(per_atom_->id);
  per_atom_ = nullptr;
}

void FixPfv::init() {
  check_environment();
  if (std::strcmp(update->integrate_style, "verlet") != 0)
    stop(FLERR, "needs run_style verlet");
  if (!has_per_atom())
    stop(FLERR, "keeps its forces in fix '" + std::string(id) + "_prop', which has been removed; leave that to `unfix " + id + "`");
  check_variables();
  check_other_fixes();
  check_contact_stress();
  bind_coupling();
  check_cell();
  choose_ranks();
  everywhere([&] {
    faces_.bind(settings_);
    obstacles_.bind(settings_, groupbit);
  });
  array_atom = per_atom_->array_atom;
  // computes behind variables have to be ready for the setup's evaluation
  if (!settings_.bindings.empty()) modify->addstep_compute_all(update->ntimestep);
}

// ---------------------------------------------------------------------------------------- errors

template <typename Work>
void FixPfv::everywhere(Work&& work) {
  try {
    work();
  } catch (const std::exception& problem) {
    stop(FLERR, problem.what());
  }
}

std::string FixPfv::with_culprits(const std::exception& problem, const pfv::Packing& grains) const {
  const std::string message = problem.what();
  const auto* error = dynamic_cast<const pfv::Error*>(&problem);
  if (!settings_.culprits || !error) return message;
  try {
    if (ranks_.is_first()) pfv::write_culprits(*settings_.culprits, grains, error->culprits());
  } catch (const pfv::FileError& unwritten) {
    return message + " (" + unwritten.what() + ")";
  }
  return message + " (drawn in " + *settings_.culprits + ")";
}

/// Those of the script; SI until it is known that these are none.
const PfvUnits& FixPfv::units() const {
  const PfvUnits* units = units_of(update->unit_style);
  return units ? *units : si_units();
}

// LIGGGHTS-PUBLIC adds to one error in five, by the clock, a "tip of the day" that it prints from freed
// memory. It looks for its name in the version, which nothing reads after an error.
void FixPfv::stop(const char* file, int line, const std::string& problem) {
  static char version[] = "3.8";
  universe->version = version;
  // mpirun ends the other ranks as soon as one has stopped, the first perhaps with the message still in its buffer
  for (FILE* output : {screen, logfile})
    if (output) std::setvbuf(output, nullptr, _IONBF, 0);
  error->fix_error(file, line, this, units().relabelled(problem).c_str());
}

void FixPfv::fail_together(std::string message) {
  int length = static_cast<int>(message.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  if (length == 0) return;
  message.resize(length);
  MPI_Bcast(message.data(), length, MPI_CHAR, 0, world);
  stop(FLERR, message);
}

// -------------------------------------------------------------------------------------- refusals

void FixPfv::check_environment() {
  // The classes of another version may have another layout in memory than the headers used here.
  if (!std::strstr(universe->version, "LIGGGHTS-PUBLIC 3.8"))
    stop(FLERR, "was built for LIGGGHTS-PUBLIC 3.8; build it for this version");
  if (!units_of(update->unit_style)) stop(FLERR, why_refused(update->unit_style));
  if (!atom->radius_flag || !atom->rmass_flag || !atom->tag_enable)
    stop(FLERR, "needs atoms with radius, mass and tag; use `atom_style granular`");
  if (atom->superquadric_flag)
    stop(FLERR, "needs spheres; superquadric atoms have no pore network");
  const char* instead = other_fluid();
  if (!instead) return;
  const std::string message = std::string("takes the place of `fix couple/cfd`, and ") + instead +
      " stands beside it: take out all lines of couple/cfd, and give fix pfv the fluid's viscosity and density and "
      "the faces of its box (doc/from_couple_cfd.md)";
  stop(FLERR, message);
}

/// A fix of another fluid, or null.
const char* FixPfv::other_fluid() const {
  for (int i = 0; i < modify->nfix; ++i)
    if (modify->fix[i] && std::strncmp(modify->fix[i]->style, "couple/cfd", 10) == 0) return modify->fix[i]->style;
  return nullptr;
}

/// What was known when the fix was made, and may have changed since.
void FixPfv::check_cell() {
  if (cell_.axes() != settings_.box.periodic)
    stop(FLERR, "the periodic sides of the simulation box have changed since this fix was defined; define it anew");
  if (settings_.container && cell_.changes())
    stop(FLERR, "the period of a pipe does not change its length; take fix deform out, or walls that are faces of a box");
  const std::string obstacle = cell_.obstacle(adapts() ? 0 : settings_.steps.couple_every, others_.rigid_bodies);
  if (!obstacle.empty()) stop(FLERR, obstacle);
}

void FixPfv::check_variables() {
  for (const PfvBinding& binding : settings_.bindings) {
    const int index = input->variable->find(const_cast<char*>(binding.variable.c_str()));
    const std::string remedy = "; define `variable " + binding.variable + " equal ...` before the run";
    if (index < 0) stop(FLERR, "there is no variable '" + binding.variable + "' for v_" + binding.variable + remedy);
    if (!input->variable->equalstyle(index))
      stop(FLERR, "variable '" + binding.variable + "' is not of equal style" + remedy);
  }
}

void FixPfv::check_other_fixes() {
  bool gravity = false, buoyancy = false;
  for (int i = 0; i < modify->nfix; ++i) {
    const Fix* other = modify->fix[i];
    gravity |= dynamic_cast<const FixGravity*>(other) != nullptr;
    buoyancy |= dynamic_cast<const FixBuoyancy*>(other) != nullptr;
    if (other != this && std::strcmp(other->style, style) == 0 &&
        PfvOtherFixes(lmp, *this).share_grains_with(*other)) {
      const std::string message = std::string("shares grains with fix pfv '") + other->id +
                                  "'; two flows need groups without a common grain";
      stop(FLERR, message);
    }
  }
  if (gravity && buoyancy && settings_.options.buoyancy)
    stop(FLERR, "counts buoyancy twice with `fix buoyancy`; remove that or set `buoyancy no`");
}

// ------------------------------------------------------------------------------------- flow calls

/// Collects the grains and the places of the faces; collective.
void FixPfv::read_host() {
  grains_.gather(others_.groups, needs_forces(), cell_.streaming(since_.cell_rates), homes());
  everywhere([&] {
    faces_.read();
    obstacles_.read();
  });
  deal_where_due();
  bodies_.apply(others_.groups, settings_.fluid.gravity, homes(), ranks_, grains_);
  faces_.read_pistons(needs_forces());
}

/// Of grains and periodic sides, for a restart file. Collective where the flow is.
std::uint64_t FixPfv::fingerprint() {
  std::vector<double> sides;
  const auto periodic = cell_.axes();
  for (int face = 0; face < pfv::face_count; ++face)
    if (periodic[face / 2]) sides.push_back(cell_.position(face));
  return ranks_.sum(fingerprint_of_grains(state_of(grains_))) + hash_of(sides.data(), sides.size());
}

/// Since the last run, or since the restart file was written. Where the flow is.
bool FixPfv::are_moved() {
  if (since_.in_restart_file) return *since_.in_restart_file != fingerprint();
  if (!flow_.has_left()) return false;
  follow_grains(grains_);
  return !flow_.is_as_left(state_of(grains_));
}

/// Between runs anything may be moved or replaced: grains (displace_atoms, set), walls and meshes of the
/// same name. The network then begins anew, as that of a new fix would, and so does an interval of
/// couple_every, whose mean velocities would hold the displacement. Collective, after read_host.
void FixPfv::begin_anew_where_moved() {
  int moved = 0;
  on_flow([&] { moved = are_moved(); });
  MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPI_INT, MPI_MAX, world);
  if (!moved) return;
  on_flow([&] { flow_.begin_anew(state_of(grains_)); });
  bodies_.forget();
  since_.cell_rates = {};
  for (int f = 0; f < container_.face_count(); ++f)
    if (container_.is_box && container_.periodic[f / 2]) container_.faces[f].velocity.setZero();
  read_host();
  since_.steps = 0;
  since_.time = 0.0;
  since_.face_positions = faces_.positions();
  since_.pivots = faces_.pivots();
  since_.grains = {};
  on_flow([&] {
    if (since_.in_restart_file) since_.in_restart_file = fingerprint();  // moved once, not again in the next run
  });
}

/// Puts faces where the grains are, if any ask for that. Where the flow is.
void FixPfv::follow_grains(const PfvGrainExchange& grains) {
  if (faces_.wants_grains()) faces_.follow_grains(totals_of(grains.grains(), ranks_));
}

/// What the next run compares with. The grains of the last flow step stay as they were gathered.
void FixPfv::remember_state() {
  PfvGrainExchange now(lmp);
  now.gather(others_.groups, false, {}, homes());
  everywhere([&] {
    faces_.read();
    obstacles_.read();
  });
  on_flow([&] {
    if (ranks_.any(now.packing().size() > 0)) follow_grains(now);
    flow_.leave(state_of(now));
  });
}

PfvLeftState FixPfv::state_of(const PfvGrainExchange& grains) {
  const pfv::Packing packing = grains.grains();
  Eigen::Matrix3Xd positions = packing.positions;
  cell_.wrap(positions);
  std::vector<double> places = faces_.positions();
  for (const double place : obstacles_.places()) places.push_back(place);
  return left_state(packing, positions, places);
}

Eigen::Vector3d FixPfv::gravity() {
  Eigen::Vector3d found;
  everywhere([&] { found = PfvOtherFixes(lmp, *this).gravity(); });
  return found;
}

void FixPfv::setup_pre_force(int vflag) { pre_force(vflag); }

void FixPfv::pre_force(int) { faces_.begin_forces(); }

/// The forces of the present state, without advancing the flow: a run begins.
void FixPfv::setup(int) {
  settings_.fluid.gravity = gravity();
  if (!cell_.changes()) since_.cell_rates = {};
  read_host();
  begin_anew_where_moved();
  container_ = current_container();
  // fix deform changes the cell after the last flow step of a run: that is part of the next run's first interval
  // (an older restart file cannot tell whether a box that nothing changes has been changed by hand: it begins anew)
  const bool by_hand = since_.from_older_file && !cell_.changes() && since_.steps == 0;
  const bool goes_on = !by_hand && (since_.steps > 0 || (cell_.any() && !settings_.container && !since_.face_positions.empty()));
  since_.in_restart_file.reset();
  since_.from_older_file = false;
  if (!goes_on) since_.face_positions = faces_.positions();
  if (since_.steps == 0 || since_.pivots.size() != faces_.pivots().size()) since_.pivots = faces_.pivots();
  const std::vector<PfvUnseenWall> beside = walls_beside_the_faces(lmp, groupbit, settings_);
  const std::vector<double> mesh_areas = faces_.mesh_areas();
  on_flow([&] {
    place_faces(container_);
    warn_of_empty_box();
    for (const std::string& warning : warnings_of_unseen_walls(beside, container_, grains_.grains(), ranks_))
      warn_of(warning);
    warn_of_obstacles_and_surfaces();
    warn_of_likely_slips();
    flow_.prepare(container_, settings_, grains_.packing(), flow_step(), ranks_.library());
    check_servos();
    call_flow(flow_step(), false);
    warn_of_gaps(mesh_areas);
    say_what_holds_the_fluid();
    say_what_is_filled();
    if (!goes_on || since_.grains.tags.empty()) since_.grains = grains_.snapshot();
    check_time_step();
    flow_.begin_run();
  });
  schedule_.begin_run();
  if (adapts()) plan_next_solve(1, 0.0);
  after_flow_call();
  apply_forces();
}

void FixPfv::post_force(int) {
  since_.time += update->dt;
  ++since_.steps;
  schedule_.count_step();
  if (solve_due()) advance();
  apply_forces();
  push_meshes();
}

void FixPfv::advance() {
  if (gravity() != settings_.fluid.gravity)
    stop(FLERR, "gravity has changed within a run; change it between runs");
  const int steps = since_.steps;
  since_.steps = 0;
  schedule_.count_solve();
  if (cell_.any() && !settings_.container) since_.cell_rates = cell_.rates_since(since_.face_positions, since_.time);
  read_host();
  pfv::Container now = current_container();
  const double thickened = change_of_viscosity();
  const double imposed =
      std::max(thickened, adapts() && ranks_.is_first() ? pfv::change_of_imposed_values(now, container_) : 0.0);
  container_ = std::move(now);
  // x is that of the step's end and v that of its middle: just what backward Euler needs; over
  // several steps the displacement gives the mean (Catalano 2012, eq. 4.8)
  const bool mean = steps > 1;
  if (mean) use_mean_velocities_of_faces();
  const Eigen::Vector3d lengths = cell_lengths_then();
  since_.face_positions = faces_.positions();
  since_.pivots = faces_.pivots();
  on_flow([&] {
    place_faces(container_);
    if (mean) grains_.use_mean_velocities(since_.grains, since_.time, lengths);
    flow_.prepare(container_, settings_, grains_.packing(), since_.time, ranks_.library());
    call_flow(since_.time, true);
    if (thickened > 0.0)
      check_time_step();
    else
      watch_time_step();
    // a later run must not take an old one for that of the last solve
    const bool is_needed = settings_.steps.couple_every > 1 || adapts() || cell_.changes();
    since_.grains = is_needed ? grains_.snapshot() : PfvSnapshot{};
  });
  since_.time = 0.0;
  if (adapts()) plan_next_solve(steps, imposed);
  after_flow_call();
}

void FixPfv::after_flow_call() {
  since_.viscosity = settings_.fluid.viscosity;
  const Eigen::MatrixXd stresses = stresses_where_due();
  on_flow([&] {
    flow_.forget_results();
    obstacles_.take_loads(grains_, flow_->forces(), ranks_);
    files_->write(*flow_, {grains_.packing(), grains_.unwrapped(), stresses}, update->ntimestep, ranks_);
    if (files_->history_due(update->ntimestep))
      files_->write_history(history_row(*flow_, flow_.report(), of_grains(), update->ntimestep, schedule_.taken()));
  });
  grains_.scatter(ranks_.is_one() ? flow_->forces() : pfv::Forces{},
                  ranks_.is_one() ? schedule_.held() : nullptr,
                  per_atom_->array_atom, settings_.steps.couple_error.has_value());
}

void FixPfv::apply_forces() {
  array_atom = per_atom_->array_atom;  // reallocated when the number of atoms grows
  const double trend = schedule_.steps_of_trend(since_.steps);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit)
      for (int k = 0; k < 3; ++k) {
        atom->f[i][k] += array_atom[i][k];
        atom->torque[i][k] += array_atom[i][4 + k];
        if (trend == 0.0) continue;
        atom->f[i][k] += trend * array_atom[i][PfvGrainExchange::returned_width + k];
        atom->torque[i][k] += trend * array_atom[i][PfvGrainExchange::returned_width + 3 + k];
      }
}

void FixPfv::push_meshes() {
  if (!ranks_.is_one()) return;
  if (ranks_.is_first()) obstacles_.push();
  if (!faces_.any_mesh()) return;
  std::vector<Eigen::Vector3d> forces = flow_.face_forces();
  if (const double trend = schedule_.steps_of_trend(since_.steps); trend != 0.0)
    for (std::size_t f = 0; f < forces.size(); ++f)
      forces[f] += trend * schedule_.held()->face_slope[f];
  if (ranks_.is_first()) faces_.push_meshes(forces);
}

// ------------------------------------------------------------------------------- changes, restart

int FixPfv::modify_param(int narg, char** arg) {
  int taken = 0;
  everywhere([&] { taken = modify_pfv(settings_, narg, arg); });
  on_flow([&] {
    if (auto* pores = dynamic_cast<pfv::Flow*>(flow_.get()))
      pores->set_retriangulation(settings_.options.strain_measure,
                                 settings_.options.retriangulation_strain);
  });
  return taken;
}

/// The run that goes on builds its network anew from the grains of the restart file, just as the
/// run that starts from the file will: both go on from the same network, strain and pressures.
/// Boundary values stay as they were: between runs LIGGGHTS cannot evaluate every variable.
void FixPfv::write_restart(FILE* file) {
  bodies_.forget();
  ranks_.dealt.wanted = true;  // as the run that starts from the file will
  read_host();
  begin_anew_where_moved();
  PfvRestartRecord record;
  record.step = update->ntimestep;
  record.steps_since_flow = since_.steps;
  record.elapsed = since_.time;
  record.last_positions = since_.face_positions;
  record.cell_rates = since_.cell_rates;
  record.meshes = meshes_for_restart();
  record.taken = schedule_.taken();
  on_flow([&] {
    if (flow_) place_faces(container_);
    if (auto state = flow_.state_on_new_network(container_, grains_.packing(), flow_step()))
      record.flow = std::move(*state);
    if (flow_ && since_.grains.tags.empty()) since_.grains = grains_.snapshot();
    if (settings_.steps.couple_every > 1 || settings_.steps.couple_error || cell_.changes())
      record.last_grains = gathered(since_.grains, ranks_);
    record.left = fingerprint();
  });
  on_root([&] {
    record.written = files_->written();
    if (obstacles_.any()) record.obstacles = obstacles_.record();
    const std::vector<double> data = pack(record);
    const int bytes = static_cast<int>(data.size() * sizeof(double));
    if (std::fwrite(&bytes, sizeof bytes, 1, file) != 1 ||
        std::fwrite(data.data(), 1, bytes, file) != static_cast<std::size_t>(bytes))
      throw pfv::FileError("the restart file cannot be written; is the disk full?");
  });
}

void FixPfv::restart(char* bytes) {
  everywhere([&] {
    PfvRestartRecord record = unpack(bytes);
    restore_meshes(record);
    since_.in_restart_file = record.left;
    since_.steps = record.steps_since_flow;
    since_.time = record.elapsed;
    since_.from_older_file = !record.left;
    since_.face_positions = record.last_positions;
    since_.cell_rates = record.cell_rates;
    schedule_.go_on_after(record.taken);
    obstacles_.restore(record.obstacles);
    since_.grains = std::move(record.last_grains);
    files_->resume(record.step, record.flow.time, std::move(record.written));
    flow_.begin_with(std::move(record.flow));
  });
}

}  // namespace LAMMPS_NS

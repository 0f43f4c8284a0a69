// SPDX-License-Identifier: GPL-3.0-or-later
// What the settings of a flow exclude, each once.
#include "pfv/settings.hpp"
#include "problem/solver_abilities.hpp"
#include "text/number_text.hpp"

#include <limits>
#include <utility>

namespace pfv {
namespace {

/// Said by the user, or set by a program to something else than the default.
bool is_said(const Settings& settings, const Setting& setting) {
  static const Settings defaults;
  return settings.given.count(setting.name) > 0 || setting.text(settings) != setting.text(defaults);
}

bool reads(Model model, const Setting& setting) {
  for (const Model one : setting.models)
    if (one == model) return true;
  return false;
}

/// Loads can be held by explicit steps on a pore network; the others integrate the drag over each step, look at
/// the grid as often as they are told or count their steps until the next network.
bool can_hold_loads(const Settings& s) {
  return s.steps.coupling == Coupling::explicit_step && s.model == Model::pores &&
         s.options.rebuild_lag == 0;
}

bool may_be_implicit(const Settings& s) {
  return s.steps.coupling == Coupling::implicit || s.steps.coupling == Coupling::automatic;
}

struct Rule {
  bool (*broken)(const Settings&);
  const char* message;  ///< {solver}: the one that is used; {background}, {implicit}: those that can do it
};

// Broken by what was said: the message says which of the two to change.
const Rule rules[]{
    {[](const Settings& s) { return s.options.rebuild_lag > 0 && !abilities_of(s.options.solver).factors_beside_steps; },
     "the solver {solver} does not factor in the background: use the solver {background}, or set rebuild_lag to 0"},
    {[](const Settings& s) {
       return s.options.rebuild_lag > 0 && s.options.ordering == OrderingKind::metis;
     },
     "the ordering metis draws on random numbers that it shares with all threads, so that runs with rebuilds in the "
     "background would not repeat: use the ordering geometric, or set rebuild_lag to 0"},
    {[](const Settings& s) { return s.options.rebuild_lag > 0 && may_be_implicit(s); },
     "implicit steps factor a matrix with the masses of the grains, which is not done in the background: use "
     "`coupling explicit` or `coupling staged`, or set rebuild_lag to 0"},
    {[](const Settings& s) {
       return s.steps.coupling == Coupling::implicit && !abilities_of(s.options.solver).implicit_steps;
     },
     "the solver {solver} solves no implicit steps, whose matrix is indefinite: use the solver {implicit}, or "
     "`coupling explicit` or `coupling staged`"},
    {[](const Settings& s) {
       return s.options.volume_rates == VolumeRates::geometric &&
              s.steps.coupling != Coupling::explicit_step;
     },
     "`volume_rates geometric` goes with `coupling explicit` alone: take `volume_rates reciprocal`, the default"},
    {[](const Settings& s) {
       return s.model == Model::darcy_grid && s.steps.coupling != Coupling::explicit_step;
     },
     "darcy_grid has no staged coupling and no implicit one: use `coupling explicit` (the default), or the model pfv"},
    {[](const Settings& s) {
       return s.given.count("couple_every") > 0 && s.steps.couple_error && !can_hold_loads(s);
     },
     "`couple_every auto` goes with `coupling explicit` on the model pfv without rebuild_lag: leave it away, so that "
     "the flow is solved at each step"},
    {[](const Settings& s) {
       return s.options.partition == Partition::yade && s.options.conductance == ConductanceLaw::open_throat;
     },
     "the yade partition reproduces YADE's results: use it with the conductance law hydraulic_radius (or "
     "effective_radius), not with open_throat"},
    {[](const Settings& s) {
       return s.options.partition == Partition::yade && s.options.volume_rates != VolumeRates::geometric;
     },
     "the yade partition reproduces YADE's results: use it with geometric volume rates"},
    {[](const Settings& s) {
       return s.options.torques && s.options.volume_rates != VolumeRates::reciprocal;
     },
     "torques go with reciprocal volume rates: by geometric ones spins move no fluid"},
    {[](const Settings& s) {
       return !s.options.forces &&
              (s.options.split_forces || s.options.sphere_pressure || s.options.shear_viscous);
     },
     "split forces, sphere pressures and shear viscous forces need forces: switch those on too"},
    {[](const Settings& s) { return s.given.count("model") > 0 && s.model == Model::darcy_grid &&
                                    s.given.count("cells") == 0; },
     "darcy_grid needs the numbers of its cells along x, y and z: give them as `model darcy_grid NX NY NZ` (in the "
     "command as --cells NX NY NZ)"},
    {[](const Settings& s) {
       double cells = 1.0;
       for (const int count : s.darcy.cells) cells *= count;
       return cells > std::numeric_limits<int>::max() / 8;
     },
     "darcy_grid has too many cells: give fewer"},
};

std::string filled(std::string message, const Settings& settings) {
  const std::pair<std::string, std::string> blanks[]{
      {"{solver}", name_of(resolved(settings.options.solver))},
      {"{background}", solvers_with(&SolverAbilities::factors_beside_steps)},
      {"{implicit}", solvers_with(&SolverAbilities::implicit_steps)}};
  for (const auto& [blank, text] : blanks)
    if (const std::size_t at = message.find(blank); at != std::string::npos)
      message.replace(at, blank.size(), text);
  return message;
}

/// A setting that does nothing would mislead.
void check_readers(const Settings& settings) {
  for (const Setting& setting : all_settings()) {
    const bool model = reads(settings.model, setting);
    const bool solver = !setting.solvers || abilities_of(settings.options.solver).*setting.solvers;
    if ((model && solver) || !is_said(settings, setting)) continue;
    const std::string rest =
        " takes no " + setting.noun + ": leave `" + setting.name + ' ' + setting.text(settings) + "` away, or use the ";
    if (!model) throw InputError(name_of(settings.model) + rest + "model " + name_of(setting.models.front()));
    throw InputError(std::string("the solver ") + name_of(resolved(settings.options.solver)) + rest + "solver " +
                     solvers_with(setting.solvers));
  }
}

}  // namespace

void settle(Settings& settings) {
  Options& options = settings.options;
  if (options.partition == Partition::yade) {
    if (settings.given.count("conductance") == 0) options.conductance = ConductanceLaw::hydraulic_radius;
    if (settings.given.count("volume_rates") == 0) options.volume_rates = VolumeRates::geometric;
  }
  if (!can_hold_loads(settings) && settings.given.count("couple_every") == 0) settings.steps.couple_error.reset();
  // the papers' volume rates feed some motions, which long steps outgrow
  if (options.volume_rates == VolumeRates::geometric && settings.steps.coupling == Coupling::automatic)
    settings.steps.coupling = Coupling::explicit_step;
}

void check(const Settings& settings) {
  for (const Setting& setting : all_settings()) setting.check(settings);
  name_of(settings.options.strain_measure);
  check(settings.options.solver, settings.options.ordering);
  check_readers(settings);
  for (const Rule& rule : rules)
    if (rule.broken(settings)) throw InputError(filled(rule.message, settings));
}

void check(const Fluid& fluid) {
  Settings settings;
  settings.fluid = fluid;
  check(settings);
}

void check(const Options& options, Coupling step) {
  Settings settings;
  settings.options = options;
  settings.steps.coupling = step;
  check(settings);
}

void check(const DarcyOptions& grid, const Fluid& fluid, const Options& options) {
  Settings settings;
  settings.model = Model::darcy_grid;
  settings.darcy = grid;
  settings.fluid = fluid;
  settings.options = options;
  check(settings);
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// The table of settings: how each is written, where it goes, what it may be and who reads it.
#include "pfv/settings.hpp"

#include "problem/solver_abilities.hpp"
#include "text/number_text.hpp"

namespace pfv {
namespace {

using detail::number_text;

// ------------------------------------------------- a value by its type: read, written, looked at

std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }

void read_value(Words& words, const std::string& noun, const Demand& demand, double& value) {
  value = words.number("the " + noun, demand);
}
void read_value(Words& words, const std::string& noun, const Demand& demand, std::optional<double>& value) {
  value = words.number("the " + noun, demand);
}
void read_value(Words& words, const std::string& noun, const Demand& demand, int& value) {
  value = words.whole_number("the " + noun, demand);
}
void read_value(Words& words, const std::string& noun, const Demand& demand, Eigen::Vector3d& value) {
  for (int axis = 0; axis < 3; ++axis) value[axis] = words.number(noun + " along " + axis_name(axis), demand);
}
void read_value(Words& words, const std::string& noun, const Demand& demand, std::array<int, 3>& value) {
  for (int axis = 0; axis < 3; ++axis)
    value[static_cast<std::size_t>(axis)] =
        words.whole_number("the number of " + noun + " along " + axis_name(axis), demand);
}

std::string text_of(double value) { return number_text(value); }
std::string text_of(const std::optional<double>& value) { return value ? number_text(*value) : "none"; }
std::string text_of(int value) { return std::to_string(value); }
std::string text_of(const Eigen::Vector3d& value) {
  return number_text(value[0]) + ' ' + number_text(value[1]) + ' ' + number_text(value[2]);
}
std::string text_of(const std::array<int, 3>& value) {
  return text_of(value[0]) + ' ' + text_of(value[1]) + ' ' + text_of(value[2]);
}

void check_value(const std::string& noun, const Demand& demand, double value) {
  if (!demand.met(value)) throw InputError(noun + " is " + number_text(value) + ": give " + demand.text);
}
void check_value(const std::string& noun, const Demand& demand, const std::optional<double>& value) {
  if (value) check_value(noun, demand, *value);
}
void check_value(const std::string& noun, const Demand& demand, const Eigen::Vector3d& value) {
  for (int axis = 0; axis < 3; ++axis) check_value(noun + " along " + axis_name(axis), demand, value[axis]);
}
void check_value(const std::string& noun, const Demand& demand, const std::array<int, 3>& value) {
  for (int axis = 0; axis < 3; ++axis)
    check_value("the number of " + noun + " along " + axis_name(axis), demand,
                value[static_cast<std::size_t>(axis)]);
}

template <class Value>
int words_of(const Value&) { return 1; }
int words_of(const Eigen::Vector3d&) { return 3; }
int words_of(const std::array<int, 3>&) { return 3; }

template <class Value>
bool is_whole(const Value&) { return false; }
bool is_whole(const int&) { return true; }
bool is_whole(const std::array<int, 3>&) { return true; }

// ---------------------------------------------------------------------------------- kinds of rows

const std::vector<Model> any_model{Model::pores, Model::darcy_grid}, pores{Model::pores},
    grid{Model::darcy_grid};

/// What a row says of itself, before it is known where its value goes.
Setting row(const char* group, const char* name, const char* help, Hosts hosts, std::vector<Model> models) {
  Setting setting;
  setting.group = group;
  setting.name = name;
  setting.help = help;
  setting.hosts = hosts;
  setting.models = std::move(models);
  setting.unit = "";
  return setting;
}

/// A place in the settings: a part and the value in it.
template <class Part, class Value>
struct Place {
  Part Settings::*part;
  Value Part::*value;
  Value& operator()(Settings& settings) const { return settings.*part.*value; }
  const Value& operator()(const Settings& settings) const { return settings.*part.*value; }
};

template <class Part, class Value>
Setting number(Setting setting, const char* noun, const char* values, const char* unit, const Demand& demand,
               Place<Part, Value> place) {
  setting.noun = noun;
  setting.values = values;
  setting.unit = unit;
  setting.words = words_of(place(Settings{}));
  setting.whole = is_whole(place(Settings{}));
  setting.read = [noun = setting.noun, &demand, place](Settings& settings, Words& words) {
    read_value(words, noun, demand, place(settings));
  };
  setting.text = [place](const Settings& settings) { return text_of(place(settings)); };
  setting.check = [noun = setting.noun, &demand, place](const Settings& settings) {
    check_value(noun, demand, place(settings));
  };
  return setting;
}

template <class Part>
Setting yes_or_no(Setting setting, const char* noun, Place<Part, bool> place) {
  setting.noun = noun;
  setting.values = "yes|no";
  setting.words = 0;
  setting.read = [place](Settings& settings, Words& words) { place(settings) = words.yes_or_no(); };
  setting.text = [place](const Settings& settings) { return place(settings) ? "yes" : "no"; };
  setting.check = [](const Settings&) {};
  return setting;
}

template <class Part, class Enum>
Setting choice(Setting setting, const char* noun, Place<Part, Enum> place) {
  setting.noun = noun;
  setting.values = names_of<Enum>("|");
  setting.read = [place](Settings& settings, Words& words) { place(settings) = words.choice<Enum>(); };
  setting.text = [place](const Settings& settings) { return name_of(place(settings)); };
  setting.check = [place](const Settings& settings) { name_of(place(settings)); };
  return setting;
}

Setting of_solvers(Setting setting, bool SolverAbilities::*trait) {
  setting.solvers = trait;
  return setting;
}

template <class Value> Place<Fluid, Value> fluid(Value Fluid::*value) { return {&Settings::fluid, value}; }
template <class Value> Place<Options, Value> option(Value Options::*value) { return {&Settings::options, value}; }
template <class Value> Place<DarcyOptions, Value> darcy(Value DarcyOptions::*value) {
  return {&Settings::darcy, value};
}
template <class Value> Place<StepSettings, Value> step(Value StepSettings::*value) {
  return {&Settings::steps, value};
}

// ------------------------------------------------------------------------- rows of several words

/// Behind the name of a grid, in the fix, what it is made of.
void read_model(Settings& settings, Words& words) {
  settings.model = words.choice<Model>();
  if (settings.model != Model::darcy_grid || words.done()) return;
  read(*setting_named("cells"), words, settings);
  for (bool taken = true; taken;) {
    taken = false;
    for (const Setting& setting : all_settings())
      if (setting.hosts.of_grid && words.take(setting.name)) {
        read(setting, words, settings);
        taken = true;
      }
  }
}

Setting model() {
  Setting setting = row("Method", "model", "pores between the grains, or Darcy flow on a coarse grid",
                        {true, true}, any_model);
  setting.noun = "model";
  setting.values = names_of<Model>("|");
  setting.read = read_model;
  setting.text = [](const Settings& settings) { return name_of(settings.model); };
  setting.check = [](const Settings& settings) { name_of(settings.model); };
  return setting;
}

Setting retriangulate() {
  Setting setting = number(row("Steps", "retriangulate",
                               "accumulated pore strain (0.01 is 1 %) at which the network is built anew: the mean of all pores', or "
                               "the largest (without a word, too)",
                               {false, true, true}, pores),
                           "retriangulation strain", "[mean|largest] STRAIN", "", demands::positive_or_infinite,
                           option(&Options::retriangulation_strain));
  setting.read = [strain = setting.read](Settings& settings, Words& words) {
    // the papers' strain without a word
    settings.options.strain_measure =
        words.take("mean") ? StrainMeasure::mean : StrainMeasure::largest;
    words.take("largest");
    strain(settings, words);
  };
  setting.text = [strain = setting.text](const Settings& settings) {
    return name_of(settings.options.strain_measure) + (" " + strain(settings));
  };
  return setting;
}

void read_couple_every(Settings& settings, Words& words) {
  StepSettings& steps = settings.steps;
  steps.couple_every = 1;
  if (!words.take("auto")) {
    steps.couple_error.reset();
    steps.couple_every = words.whole_number("auto or the number of steps", demands::count);
    return;
  }
  steps.couple_error = words.take("error") ? words.number("the error in per cent", demands::percent) / 100.0
                                           : StepSettings{}.couple_error;
}

/// Of the host that runs the loop over the steps; a program in Python runs its own.
constexpr Hosts of_loop{false, true, true, false, false};

Setting couple_every() {
  Setting setting = row("Steps", "couple_every",
                        "solve the flow every N time steps, or when the loads have changed by this part of them, "
                        "per cent",
                        of_loop, any_model);
  setting.noun = "couple_every";
  setting.values = "auto [error PERCENT]|N";
  setting.read = read_couple_every;
  setting.text = [](const Settings& settings) {
    const StepSettings& steps = settings.steps;
    return steps.couple_error ? "auto error " + number_text(100.0 * *steps.couple_error)
                              : std::to_string(steps.couple_every);
  };
  setting.check = [](const Settings& settings) {
    check_value("the number of steps of couple_every", demands::count, settings.steps.couple_every);
    if (settings.steps.couple_error)
      check_value("the error of couple_every", demands::part, *settings.steps.couple_error);
  };
  return setting;
}

// -------------------------------------------------------------------------------------- the table

//                 command fix modify of_grid python
constexpr Hosts command{true, false, false, false}, fix{false, true, false, false},
    fix_alone{false, true, false, false, false},
    both{true, true, false, false}, both_and_modify{true, true, true, false},
    modify_alone{false, false, true, false}, in_model{false, false, false, true},
    command_and_in_model{true, false, false, true}, python_alone{false, false, false, false, true};

std::vector<Setting> of_fluid() {
  return {
      number(row("Fluid", "viscosity", "dynamic viscosity of the fluid; always to be given in the fix",
                 both_and_modify, any_model),
             "viscosity", "MU", "Pa s", demands::positive, fluid(&Fluid::viscosity)),
      number(row("Fluid", "density", "density of the fluid, used with gravity only", both, any_model), "density",
             "RHO", "kg/m3", demands::not_negative, fluid(&Fluid::density)),
      number(row("Fluid", "gravity", "gravity; adds buoyancy to the forces", command, any_model), "gravity",
             "GX GY GZ", "m/s2", demands::finite, fluid(&Fluid::gravity)),
      number(row("Fluid", "bulk_modulus", "bulk modulus of the fluid; none: incompressible", both, pores),
             "bulk modulus", "KF", "Pa", demands::positive, fluid(&Fluid::bulk_modulus)),
      yes_or_no(row("Fluid", "buoyancy", "add the lift of the grains where there is gravity", fix, any_model),
                "buoyancy", option(&Options::buoyancy)),
  };
}

std::vector<Setting> of_method() {
  return {
      model(),
      number(row("Method", "cells",
                 "cells along x, y and z, always to be given; in the fix behind the name of the model", command,
                 grid),
             "cells", "NX NY NZ", "", demands::count, darcy(&DarcyOptions::cells)),
      number(row("Method", "every", "renew the porosity every this many flow steps", in_model, grid),
             "number of flow steps between two renewals of the porosity", "N", "", demands::count,
             darcy(&DarcyOptions::refresh_every)),
      choice(row("Method", "drag", "drag on a grain", command_and_in_model, grid), "drag",
             darcy(&DarcyOptions::drag)),
      yes_or_no(row("Method", "grain_motion", "grains carry the fluid with them and displace it", in_model, grid),
                "motion of grains", darcy(&DarcyOptions::grain_motion)),
      choice(row("Method", "partition",
                 "geometry of a throat: signed volumes, or YADE's rules to reproduce its results", command, pores),
             "partition of throats", option(&Options::partition)),
      choice(row("Method", "conductance", "conductance law of a throat (with partition yade: hydraulic_radius)", both,
                 pores),
             "conductance law", option(&Options::conductance)),
      choice(row("Method", "volume_rates",
                 "how moving grains change the volumes of pores: by the transpose of the forces, or by the papers' "
                 "geometry (with partition yade: geometric)",
                 both, pores),
             "choice of volume rates", option(&Options::volume_rates)),
      yes_or_no(row("Method", "torques", "forces act where they lie and turn grains, spins move fluid", both, pores),
                "torques", option(&Options::torques)),
      yes_or_no(row("Method", "shear_viscous", "add the viscous forces of neighbours that slide", fix, pores),
                "shear viscous forces", option(&Options::shear_viscous)),
      yes_or_no(row("Method", "open_water", "brake grains in open water at least as in unbounded fluid", both, pores),
                "drag in open water", option(&Options::open_water)),
  };
}

Setting tolerance() {
  Setting setting = number(row("Solver", "tolerance",
                               "where an iterative solver ends: residual over right-hand side; of amg mass defect over "
                               "flow through the pores; auto: ",
                               {true, true}, any_model),
                           "tolerance", "auto|T", "", demands::part, option(&Options::tolerance));
  setting.help += own_tolerances();
  setting.solvers = &SolverAbilities::is_iterative;
  setting.read = [number = setting.read](Settings& settings, Words& words) {
    if (words.take("auto"))
      settings.options.tolerance.reset();
    else
      number(settings, words);
  };
  setting.text = [](const Settings& settings) {
    return settings.options.tolerance ? number_text(*settings.options.tolerance) : "auto";
  };
  return setting;
}

std::vector<Setting> of_solver() {
  Setting solver = choice(row("Solver", "solver", "linear solver; auto: ", both, any_model), "solver",
                          option(&Options::solver));
  solver.help += std::string(name_of(resolved(SolverKind::automatic))) + "; from " + std::to_string(Options{}.amg_from) +
                 " spheres on (where they are solved once from " + std::to_string(amg_from_for_one_solution) +
                 " on), and from 2000 on where the network before has served few solves, amg until a factor pays; also where "
                 "that does not fit in memory";
  if (!is_built(SolverKind::mumps)) solver.lacks = "; this build has no mumps";
  Setting ordering = choice(row("Solver", "ordering", "fill-reducing ordering of a direct solver; auto: ", both,
                                any_model),
                            "ordering", option(&Options::ordering));
  ordering.help += name_of(resolved(SolverKind::automatic, OrderingKind::automatic));
  return {
      solver,
      ordering,
      tolerance(),
      of_solvers(choice(row("Solver", "precision",
                            "how the solver keeps its factor: mixed has half as much to read a step and solves to a "
                            "residual of 1e-9",
                            both, any_model),
                        "choice of precision", option(&Options::precision)),
                 &SolverAbilities::mixed_precision),
      number(row("Solver", "threads", "threads that share a rebuild or step, 1 to 64; they change no result", both,
                 any_model),
             "number of threads", "N", "", demands::threads, option(&Options::threads)),
      choice(row("Solver", "ranks",
                 "of LIGGGHTS' ranks those that hold the flow; auto: all with `solver amg` where nothing needs one",
                 fix_alone, pores),
             "choice of ranks", step(&StepSettings::ranks)),
  };
}

std::vector<Setting> of_steps() {
  return {
      retriangulate(),
      number(row("Steps", "rebuild_lag",
                 "flow steps from the beginning of a network that is built in the background to its first use", fix,
                 pores),
             "rebuild lag", "K", "", demands::flow_steps, option(&Options::rebuild_lag)),
      couple_every(),
      choice(row("Steps", "coupling", "how forces act over a time step", fix, any_model), "coupling",
             step(&StepSettings::coupling)),
      yes_or_no(row("Steps", "time_step_check", "find the limit of the time step at the setup of a run",
                    fix_alone, any_model),
                "check of the time step", step(&StepSettings::time_step_check)),
      number(row("Steps", "safety", "part of the explicit limit that a time step may reach", modify_alone, any_model),
             "safety factor", "ZETA", "", demands::positive, step(&StepSettings::safety)),
  };
}

/// What a call answers: the command and the fix know it from what they write.
std::vector<Setting> of_results() {
  return {
      yes_or_no(row("Results", "forces", "find the forces on the grains", python_alone, any_model), "forces",
                option(&Options::forces)),
      yes_or_no(row("Results", "split_forces", "the pressure and the viscous part of each force, too", python_alone,
                    any_model),
                "split forces", option(&Options::split_forces)),
      yes_or_no(row("Results", "sphere_pressure", "the mean pressure around each grain, too", python_alone,
                    any_model),
                "sphere pressure", option(&Options::sphere_pressure)),
      choice(row("Results", "outside", "what to do with grains whose centre is outside the box", python_alone,
                 any_model),
             "rule for grains outside the box", option(&Options::outside)),
  };
}

}  // namespace

const std::vector<Setting>& all_settings() {
  static const std::vector<Setting> all = [] {
    std::vector<Setting> rows;
    for (auto* part : {of_fluid, of_method, of_solver, of_steps, of_results})
      for (Setting& setting : part()) rows.push_back(std::move(setting));
    return rows;
  }();
  return all;
}

const Setting* setting_named(const std::string& name) {
  for (const Setting& setting : all_settings())
    if (name == setting.name) return &setting;
  return nullptr;
}

void read(const Setting& setting, Words& words, Settings& settings) {
  if (!settings.given.insert(setting.name).second)
    words.fail(std::string(setting.name) + " is given twice; give it once");
  setting.read(settings, words);
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/darcy_options.hpp"
#include "pfv/fluid.hpp"
#include "pfv/names.hpp"
#include "pfv/options.hpp"
#include "pfv/words.hpp"

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace pfv {

enum class Model { pores, darcy_grid };
template <>
struct Names<Model> {
  static constexpr const char* what = "model";
  static constexpr std::array<Named<Model>, 2> all{{{Model::pores, "pfv"}, {Model::darcy_grid, "darcy_grid"}}};
};

/// All that a program specifies about a flow besides its box.
struct Settings {
  Model model = Model::pores;
  Fluid fluid;
  Options options;
  DarcyOptions darcy;
  StepSettings steps;
  std::set<std::string> given;  ///< names of the settings that were given, even at their default

  /// For make_flow.
  std::optional<DarcyOptions> grid() const {
    return model == Model::darcy_grid ? std::optional(darcy) : std::nullopt;
  }
};

/// Where a setting can be given.
struct Hosts {
  bool command = false;   ///< `pfv solve`: --name, with '-' for '_'
  bool fix = false;       ///< `fix pfv`: a keyword
  bool modify = false;    ///< `fix_modify`
  bool of_grid = false;   ///< `fix pfv`: behind `model darcy_grid NX NY NZ`
  bool python = true;     ///< the module `pfv`: a keyword
};

struct SolverAbilities;

/// One row of the table that the command line, the fix, the Python module, their help and messages and the
/// page doc/settings.md are made of.
struct Setting {
  const char* group;
  const char* name;
  std::string noun;    ///< for messages: "viscosity"
  std::string values;  ///< as they are written: "MU", "yes|no"
  const char* unit;    ///< "" for none
  std::string help;
  Hosts hosts;
  std::vector<Model> models;                    ///< that read it
  bool SolverAbilities::*solvers = nullptr;        ///< the solvers that read it; null: all
  int words = 1;                                ///< of its value; 0: yes or no, which the command may leave away for yes
  bool whole = false;                           ///< its number is a whole one
  std::function<void(Settings&, Words&)> read;
  std::function<std::string(const Settings&)> text;  ///< of its present value
  std::function<void(const Settings&)> check;        ///< throws InputError where that is out of range
  std::string lacks;  ///< what its help says of this build alone
};

const std::vector<Setting>& all_settings();
/// The row, or null.
const Setting* setting_named(const std::string& name);

/// Reads the value of a setting. Throws InputError for a bad one and for a setting that was given before.
void read(const Setting& setting, Words& words, Settings& settings);

/// What follows from the settings given for those that were not: YADE's partition has YADE's law and rates;
/// loads are not held where they cannot be; the papers' volume rates have explicit steps.
void settle(Settings& settings);

/// Throws InputError for a value out of range, for a setting that the model or the solver does not read, and
/// for settings that exclude each other. Both programs and every flow come here.
void check(const Settings& settings);

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include "pfv/error.hpp"

#include <algorithm>

namespace LAMMPS_NS {

namespace {

using pfv::Boundary;
using pfv::Words;
using Of = PfvBinding::Of;
using Source = PfvFaceSource::Kind;
namespace demands = pfv::demands;

void append(std::string& list, const std::string& word) { list += (list.empty() ? "" : ", ") + word; }

/// "sealed, pressure P, flux Q"
std::string boundary_forms() {
  std::string forms;
  for (const pfv::BoundaryKind& one : pfv::boundary_kinds)
    append(forms, one.name + (one.symbol ? std::string(" ") + one.symbol : ""));
  return forms;
}

// ------------------------------------------------------------------------------ faces and openings

/// A number or v_name, which then feeds what is `of`.
double take_value(Words& words, const std::string& what, PfvBinding binding, PfvSettings& settings) {
  if (!words.begins("v_")) return words.number(what, demands::finite);
  binding.variable = words.word(what).substr(2);
  settings.bindings.push_back(binding);
  return 0.0;
}

void unbind(PfvSettings& settings, Of of, std::size_t number) {
  auto& bindings = settings.bindings;
  bindings.erase(std::remove_if(bindings.begin(), bindings.end(),
                                [&](const PfvBinding& one) { return one.of == of && one.number == number; }),
                 bindings.end());
}

Boundary take_boundary_of(const pfv::BoundaryKind& kind, Words& words, PfvBinding binding, PfvSettings& settings) {
  if (!kind.symbol) return {kind.kind, 0.0, {}};
  return {kind.kind, take_value(words, std::string("the ") + kind.name, binding, settings), {}};
}

/// `sealed | pressure P | flux Q`, if that comes next.
std::optional<Boundary> take_boundary(Words& words, PfvBinding binding, PfvSettings& settings) {
  for (const pfv::BoundaryKind& kind : pfv::boundary_kinds)
    if (words.take(kind.name)) return take_boundary_of(kind, words, binding, settings);
  return std::nullopt;
}

void take_source(Words& words, PfvFaceSource& source) {
  if (words.take("plane")) {
    source.kind = Source::plane;
    source.plane = words.number("the plane's position", demands::finite);
  } else if (words.take("wall")) {
    source.kind = Source::wall;
    source.fix_id = words.word("the ID of a fix wall/gran");
  } else if (words.take("mesh")) {
    source.kind = Source::mesh;
    source.fix_id = words.word("the ID of a fix mesh/surface");
  } else if (words.take("extent")) {
    source.kind = Source::extent;
  } else {
    words.fail("the face's name must be followed by plane X, wall FIX_ID, mesh FIX_ID or extent");
  }
}

std::optional<pfv::Wall> take_wall(Words& words) {
  for (const auto& wall : pfv::Names<pfv::Wall>::all)
    if (words.take(wall.name)) return wall.value;
  return std::nullopt;
}

std::string face_given_twice(pfv::Face face) {
  return std::string("face ") + pfv::name_of(face) + " is given twice";
}

void parse_face(Words& words, PfvSettings& settings) {
  const auto name = words.choice<pfv::Face>();
  const auto number = static_cast<std::size_t>(name);
  if (settings.sources[number].kind != Source::none) words.fail(face_given_twice(name));
  take_source(words, settings.sources[number]);
  pfv::FaceCondition& face = settings.box[name];
  bool has_wall = false, has_boundary = false;
  while (true) {
    if (const auto wall = take_wall(words)) {
      if (has_wall) words.fail("say either no_slip or symmetry, once");
      face.wall = *wall;
      has_wall = true;
    } else if (const auto boundary = take_boundary(words, {Of::face, number, {}}, settings)) {
      if (has_boundary) words.fail("say one of " + boundary_forms() + ", once");
      face.boundary = *boundary;
      has_boundary = true;
    } else {
      return;
    }
  }
}

void parse_patch(Words& words, PfvSettings& settings) {
  pfv::Patch patch;
  patch.face = words.choice<pfv::Face>();
  for (double& edge : patch.rectangle) edge = words.number("the rectangle's edge", demands::finite);
  const auto boundary = take_boundary(words, {Of::patch, settings.box.patches.size(), {}}, settings);
  if (!boundary) words.fail("the rectangle must be followed by one of " + boundary_forms());
  patch.boundary = *boundary;
  settings.box.patches.push_back(patch);
}

/// A region has two bounds an axis, a point one place.
void parse_place(Words& words, PfvSettings& settings, bool point) {
  pfv::Region region;
  for (int axis = 0; axis < 3; ++axis) {
    region.lower[axis] = words.number(point ? "the point's coordinate" : "the region's bound", demands::finite);
    region.upper[axis] = point ? region.lower[axis] : words.number("the region's bound", demands::finite);
  }
  const auto boundary = take_boundary(words, {Of::region, settings.box.regions.size(), {}}, settings);
  if (!boundary || !boundary->is_open()) words.fail("the place must be followed by pressure P or flux Q");
  region.boundary = *boundary;
  settings.box.regions.push_back(region);
}
void parse_region(Words& words, PfvSettings& settings) { parse_place(words, settings, false); }
void parse_point(Words& words, PfvSettings& settings) { parse_place(words, settings, true); }

void parse_pressure_profile(Words& words, PfvSettings& settings) {
  const auto name = words.choice<pfv::Face>();
  const auto number = static_cast<std::size_t>(name);
  if (settings.profiles[number]) words.fail(face_given_twice(name));
  if (!words.take("cosine")) words.fail("the one profile that exists is cosine");
  PfvCosine cosine;
  cosine.axis = words.axis();
  cosine.mean = take_value(words, "the mean pressure", {Of::mean, number, {}}, settings);
  cosine.amplitude = take_value(words, "the amplitude", {Of::amplitude, number, {}}, settings);
  cosine.half_period = words.number("the half period", demands::positive);
  settings.profiles[number] = cosine;
}

// ------------------------------------------------------------------------------------------ files

void parse_fields(Words& words, PfvSettings& settings) {
  PfvFieldOutput fields;
  fields.every = words.whole_number("the number of steps", demands::count);
  fields.path = words.word("the file's name");
  const std::string ending = ".pvd";
  if (fields.path.size() <= ending.size() ||
      fields.path.compare(fields.path.size() - ending.size(), ending.size(), ending) != 0)
    words.fail("the file's name must end in .pvd, not be '" + fields.path + "'");
  settings.fields = fields;
}

PfvProfileOutput take_profile(Words& words) {
  PfvProfileOutput profile;
  profile.axis = words.axis();
  profile.planes = words.whole_number("the number of planes", demands::count);
  profile.every = words.whole_number("the number of steps", demands::count);
  profile.path = words.word("the file's name");
  return profile;
}
void parse_profile(Words& words, PfvSettings& settings) { settings.profile = take_profile(words); }
void parse_flux_profile(Words& words, PfvSettings& settings) { settings.flux_profile = take_profile(words); }

void parse_sensors(Words& words, PfvSettings& settings) {
  PfvSensorOutput sensors;
  sensors.every = words.whole_number("the number of steps", demands::count);
  sensors.path = words.word("the file's name");
  do {
    Eigen::Vector3d place;
    for (double& coordinate : place) coordinate = words.number("a sensor's coordinate", demands::finite);
    sensors.places.push_back(place);
  } while (words.number_comes());
  settings.sensors = sensors;
}

void parse_culprits(Words& words, PfvSettings& settings) { settings.culprits = words.word("the file's name"); }

// --------------------------------------------------------------------------------------- keywords

/// What the fix knows beside the table of settings.
struct Keyword {
  const char* name;
  bool comes_several_times;  ///< it says itself what it is about
  void (*parse)(Words&, PfvSettings&);
};
constexpr Keyword keywords[]{{"face", true, parse_face},
                             {"patch", true, parse_patch},
                             {"region", true, parse_region},
                             {"point", true, parse_point},
                             {"pressure_profile", true, parse_pressure_profile},
                             {"output", false, parse_fields},
                             {"profile", false, parse_profile},
                             {"flux_profile", false, parse_flux_profile},
                             {"sensors", false, parse_sensors},
                             {"culprits", false, parse_culprits}};

std::string settings_with(bool pfv::Hosts::*host) {
  std::string names;
  for (const pfv::Setting& setting : pfv::all_settings())
    if (setting.hosts.*host) append(names, setting.name);
  return names;
}

void parse_keyword(Words& words, PfvSettings& settings) {
  const std::string keyword = words.keyword();
  const pfv::Setting* setting = pfv::setting_named(keyword);
  if (setting && setting->hosts.fix) return pfv::read(*setting, words, settings);
  for (const Keyword& one : keywords) {
    if (keyword != one.name) continue;
    if (!settings.given.insert(keyword).second && !one.comes_several_times)
      words.fail(keyword + " is given twice; give it once");
    return one.parse(words, settings);
  }
  std::string known = settings_with(&pfv::Hosts::fix);
  for (const Keyword& one : keywords) append(known, one.name);
  throw pfv::InputError("unknown keyword '" + keyword + "'; there are " + known);
}

/// A profile makes its face one of imposed pressure and takes the place of a constant one, which a face with
/// another boundary does not have.
void apply_profiles(PfvSettings& settings) {
  for (const pfv::Face name : pfv::all_faces) {
    const auto number = static_cast<std::size_t>(name);
    if (!settings.profiles[number]) continue;
    Boundary& boundary = settings.box[name].boundary;
    if (boundary.imposes_flux())
      throw pfv::InputError(std::string("face ") + pfv::name_of(name) +
                            " has a flux and a pressure_profile; give it one of them");
    unbind(settings, Of::face, number);
    boundary = Boundary::pressure(settings.profiles[number]->mean);
  }
}

void check_all(PfvSettings& settings) {
  pfv::settle(settings);
  pfv::check(settings);
  if (settings.model == pfv::Model::darcy_grid && settings.flux_profile)
    throw pfv::InputError("darcy_grid has no flux_profile: leave it away, or use the model pfv");
}

void require_all_faces(const PfvSettings& settings) {
  std::string missing;
  for (const pfv::Face name : pfv::all_faces)
    if (settings.sources[static_cast<std::size_t>(name)].kind == Source::none)
      append(missing, pfv::name_of(name));
  if (!missing.empty())
    throw pfv::InputError("missing: face " + missing +
                          "; each of the six needs `face NAME (plane X | wall FIX_ID | mesh FIX_ID "
                          "| extent)`");
}

/// `pressure NAME P`, `flux NAME Q`, `sealed NAME`: false for another keyword.
bool modify_face(const std::string& keyword, Words& words, PfvSettings& settings) {
  for (const pfv::BoundaryKind& kind : pfv::boundary_kinds) {
    if (keyword != kind.name) continue;
    const auto face = words.choice<pfv::Face>();
    const auto number = static_cast<std::size_t>(face);
    for (const Of of : {Of::face, Of::mean, Of::amplitude}) unbind(settings, of, number);
    settings.profiles[number].reset();
    settings.box[face].boundary = take_boundary_of(kind, words, {Of::face, number, {}}, settings);
    return true;
  }
  return false;
}

/// What the fix was built for stays: it has no room for held loads.
void modify_setting(const pfv::Setting& setting, Words& words, PfvSettings& settings) {
  const PfvSettings before = settings;
  settings.given.erase(setting.name);
  pfv::read(setting, words, settings);
  if (settings.steps.couple_error && settings.steps.couple_error != before.steps.couple_error)
    words.fail("only a number of steps can be given here; give auto with the fix");
}

}  // namespace

PfvSettings parse_pfv(int narg, char** arg) {
  PfvSettings settings;
  settings.options.outside = pfv::OutsideGrains::leave_out;
  settings.options.sphere_pressure = true;
  Words words({arg, arg + narg});
  while (!words.done()) parse_keyword(words, settings);
  if (settings.given.count("viscosity") == 0)
    throw pfv::InputError("keyword 'viscosity' is missing; give `viscosity MU`, Pa s");
  require_all_faces(settings);
  apply_profiles(settings);
  check_all(settings);
  return settings;
}

int modify_pfv(PfvSettings& settings, int narg, char** arg) {
  Words words({arg, arg + narg});
  PfvSettings changed = settings;
  const std::string keyword = words.keyword();
  const pfv::Setting* setting = pfv::setting_named(keyword);
  if (setting && setting->hosts.modify) {
    modify_setting(*setting, words, changed);
  } else if (!modify_face(keyword, words, changed)) {
    std::string known = settings_with(&pfv::Hosts::modify);
    for (const pfv::BoundaryKind& kind : pfv::boundary_kinds) append(known, kind.name);
    throw pfv::InputError("fix_modify knows no keyword '" + keyword + "'; there are " + known);
  }
  check_all(changed);
  settings = changed;
  return words.taken();
}

double& bound_number(PfvSettings& settings, const PfvBinding& binding) {
  switch (binding.of) {
    case Of::patch: return settings.box.patches[binding.number].boundary.value;
    case Of::region: return settings.box.regions[binding.number].boundary.value;
    case Of::mean: return settings.profiles[binding.number]->mean;
    case Of::amplitude: return settings.profiles[binding.number]->amplitude;
    case Of::face: break;
  }
  return settings.box.faces[binding.number].boundary.value;
}

}  // namespace LAMMPS_NS

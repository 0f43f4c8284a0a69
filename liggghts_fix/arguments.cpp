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
  return pfv::list_boundary_kinds(
      [](const pfv::BoundaryKind& one) { return one.name + (one.symbol ? std::string(" ") + one.symbol : ""); });
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

Eigen::Vector3d take_vector(Words& words, const char* what) {
  Eigen::Vector3d vector;
  for (double& component : vector) component = words.number(what, demands::finite);
  return vector;
}

/// `plane X Y Z NX NY NZ`, `extent AXIS lo|hi`: what a container has in place of the box's forms.
void take_container_plane(Words& words, PfvFaceSource& source) {
  const Eigen::Vector3d point = take_vector(words, "a point of the plane");
  const Eigen::Vector3d inward = take_vector(words, "the plane's normal into the fluid");
  if (!(inward.norm() > 0.0)) words.fail("the plane's normal has no length");
  source.surface = pfv::Surface::plane(-inward, point);
}
void take_container_extent(Words& words, PfvFaceSource& source) {
  if (!words.begins("x") && !words.begins("y") && !words.begins("z"))
    words.fail("in a container `extent` must be followed by an axis and lo or hi, as in `extent z hi`");
  const int axis = words.axis();
  const bool upper = words.take("hi");
  if (!upper && !words.take("lo")) words.fail("extent AXIS must be followed by lo or hi");
  source.surface.normal = (upper ? 1.0 : -1.0) * Eigen::Vector3d::Unit(axis);
}

bool source_comes(const Words& words) {
  for (const char* word : {"plane", "wall", "mesh", "extent"})
    if (words.begins(word)) return true;
  return false;
}

void take_source(Words& words, PfvFaceSource& source, bool container) {
  if (words.take("plane")) {
    source.kind = Source::plane;
    if (container) return take_container_plane(words, source);
    source.plane = words.number("the plane's position", demands::finite);
  } else if (words.take("wall")) {
    source.kind = Source::wall;
    source.fix_id = words.word("the ID of a fix wall/gran");
  } else if (words.take("mesh")) {
    source.kind = Source::mesh;
    source.fix_id = words.word("the ID of a fix mesh/surface");
  } else if (words.take("extent")) {
    source.kind = Source::extent;
    if (container) take_container_extent(words, source);
  } else {
    words.fail(container ? "the face's name must be followed by plane X Y Z NX NY NZ, wall FIX_ID, mesh FIX_ID or "
                           "extent AXIS lo|hi"
                         : "the face's name must be followed by plane X, wall FIX_ID, mesh FIX_ID or extent");
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

/// `[no_slip|symmetry] [sealed | pressure P | flux Q]` in any order.
template <class AnyFace>
void take_condition(Words& words, std::size_t number, PfvSettings& settings, AnyFace& face) {
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

void parse_container_face(Words& words, PfvSettings& settings) {
  pfv::ContainerFace face;
  face.name = words.word("the face's name");
  for (const pfv::ContainerFace& other : settings.faces)
    if (other.name == face.name) words.fail("face " + face.name + " is given twice");
  PfvFaceSource source;
  if (settings.all_walls) face.wall = *settings.all_walls;
  if (!settings.all_walls || source_comes(words)) take_source(words, source, true);
  take_condition(words, settings.faces.size(), settings, face);
  settings.faces.push_back(face);
  settings.sources.push_back(source);
}

void parse_face(Words& words, PfvSettings& settings) {
  if (settings.container) return parse_container_face(words, settings);
  const auto name = words.choice<pfv::Face>();
  const auto number = static_cast<std::size_t>(name);
  if (settings.sources[number].kind == Source::periodic)
    words.fail(std::string("the simulation box is periodic along ") + "xyz"[number / 2] +
               " and has no faces there; take this face out, or use `boundary f` along that axis");
  if (settings.sources[number].kind != Source::none) words.fail(face_given_twice(name));
  take_source(words, settings.sources[number], false);
  take_condition(words, number, settings, settings.box[name]);
}

/// From here on the faces have names of their own and may be walls at any angle.
void parse_container(Words& words, PfvSettings& settings) {
  for (const PfvFaceSource& source : settings.sources)
    if (source.kind != Source::none && source.kind != Source::periodic) words.fail("container must come before the faces");
  settings.container = true;
  settings.sources.clear();
  const bool walls = words.take("walls");
  if (!walls && settings.box.any_periodic())
    throw pfv::InputError("container: it is closed by walls alone, and the simulation box is periodic; take `container "
                          "walls` or the faces of a box, or use `boundary f f f`");
  if (walls) settings.all_walls = take_wall(words).value_or(pfv::Wall::no_slip);
  settings.flats = words.take("flats");
}

void parse_obstacle(Words& words, PfvSettings& settings) {
  if (settings.box.any_periodic())
    throw pfv::InputError("obstacle: it takes no periodic sides; use `boundary f f f`");
  if (!words.take("mesh")) words.fail("obstacle must be followed by mesh FIX_ID");
  PfvObstacleSource obstacle;
  obstacle.fix_id = words.word("the ID of a fix mesh/surface");
  if (words.take("diameter")) obstacle.diameter = words.number("the spheres' diameter", demands::positive);
  const auto same = [&](const auto& other) { return other.fix_id == obstacle.fix_id; };
  if (std::any_of(settings.obstacles.begin(), settings.obstacles.end(), same) ||
      std::any_of(settings.sources.begin(), settings.sources.end(), same))
    words.fail("mesh " + obstacle.fix_id + " is given twice, as an obstacle or as a face");
  settings.obstacles.push_back(obstacle);
}

/// A block of space that cuts the part out of the face.
void parse_container_patch(Words& words, PfvSettings& settings) {
  PfvPatch part;
  part.face = words.word("the face's name");
  for (int axis = 0; axis < 3; ++axis) {
    part.patch.lower[axis] = words.number("the block's bound", demands::finite);
    part.patch.upper[axis] = words.number("the block's bound", demands::finite);
  }
  const auto boundary = take_boundary(words, {Of::patch, settings.patches.size(), {}}, settings);
  if (!boundary) words.fail("the block X0 X1 Y0 Y1 Z0 Z1 must be followed by one of " + boundary_forms());
  part.patch.boundary = *boundary;
  settings.patches.push_back(part);
}

void parse_patch(Words& words, PfvSettings& settings) {
  if (settings.container) return parse_container_patch(words, settings);
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

/// Pa/m, along periodic axes.
void parse_gradient(Words& words, PfvSettings& settings) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<std::size_t>(axis);
    unbind(settings, Of::gradient, number);
    const std::size_t bound = settings.bindings.size();
    settings.box.pressure_gradient[axis] =
        take_value(words, std::string("the gradient along ") + "xyz"[axis], {Of::gradient, number, {}}, settings);
    if (!settings.box.periodic[axis] &&
        (settings.box.pressure_gradient[axis] != 0.0 || settings.bindings.size() > bound))
      words.fail(std::string("the simulation box is not periodic along ") + "xyz"[axis] +
                 ": give 0 there and pressures to its faces, or use `boundary p` along that axis");
  }
}

void parse_pressure_profile(Words& words, PfvSettings& settings) {
  if (settings.container) words.fail("a container has no pressure_profile; it needs the faces of a box");
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
  fields.contact_stress = words.take("contact_stress");
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

void parse_history(Words& words, PfvSettings& settings) {
  PfvHistoryOutput history;
  history.every = words.whole_number("the number of steps", demands::count);
  history.path = words.word("the file's name");
  settings.history = history;
}

void parse_culprits(Words& words, PfvSettings& settings) { settings.culprits = words.word("the file's name"); }

// --------------------------------------------------------------------------------------- keywords

/// What the fix knows beside the table of settings.
struct Keyword {
  const char* name;
  bool comes_several_times;  ///< it says itself what it is about
  void (*parse)(Words&, PfvSettings&);
};
constexpr Keyword keywords[]{{"container", false, parse_container},
                             {"face", true, parse_face},
                             {"obstacle", true, parse_obstacle},
                             {"patch", true, parse_patch},
                             {"region", true, parse_region},
                             {"point", true, parse_point},
                             {"gradient", false, parse_gradient},
                             {"pressure_profile", true, parse_pressure_profile},
                             {"output", false, parse_fields},
                             {"profile", false, parse_profile},
                             {"flux_profile", false, parse_flux_profile},
                             {"sensors", false, parse_sensors},
                             {"history", false, parse_history},
                             {"culprits", false, parse_culprits}};

std::vector<std::string> settings_with(bool pfv::Hosts::*host) {
  std::vector<std::string> names;
  for (const pfv::Setting& setting : pfv::all_settings())
    if (setting.hosts.*host) names.emplace_back(setting.name);
  return names;
}

/// What a word is that is none of the names.
std::string not_among(const std::string& word, const std::vector<std::string>& names) {
  const std::string meant = pfv::meant_by(word, names);
  std::string known;
  for (const std::string& name : names) append(known, name);
  return "'" + word + "'" + (meant.empty() ? "; there are " : meant + " There are ") + known;
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
  std::vector<std::string> known = settings_with(&pfv::Hosts::fix);
  for (const Keyword& one : keywords) known.emplace_back(one.name);
  throw pfv::InputError("unknown keyword " + not_among(keyword, known) + "; and behind a face " +
                        pfv::names_of<pfv::Wall>(", ") + ", " + boundary_forms());
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
  if (settings.model == pfv::Model::darcy_grid && settings.container)
    throw pfv::InputError("darcy_grid takes no container: leave it away, or use the model pfv");
  if (settings.model == pfv::Model::darcy_grid && !settings.obstacles.empty())
    throw pfv::InputError("darcy_grid knows no obstacle: leave it away, or use the model pfv");
  if (settings.model == pfv::Model::darcy_grid && settings.flux_profile)
    throw pfv::InputError("darcy_grid has no flux_profile: leave it away, or use the model pfv");
}

void require_all_faces(const PfvSettings& settings) {
  if (settings.container) return;
  std::string missing;
  for (const pfv::Face name : pfv::all_faces)
    if (settings.sources[static_cast<std::size_t>(name)].kind == Source::none)
      append(missing, pfv::name_of(name));
  if (!missing.empty())
    throw pfv::InputError("missing: face " + missing +
                          "; each of the six needs `face NAME (plane X | wall FIX_ID | mesh FIX_ID "
                          "| extent)`");
}

std::size_t take_face_number(Words& words, const PfvSettings& settings) {
  if (!settings.container) return static_cast<std::size_t>(words.choice<pfv::Face>());
  const std::string name = words.word("the face's name");
  std::string known;
  for (std::size_t f = 0; f < settings.faces.size(); ++f) {
    if (settings.faces[f].name == name) return f;
    append(known, settings.faces[f].name);
  }
  words.fail("there is no face '" + name + "'; there are " + known);
}

/// `pressure NAME P`, `flux NAME Q`, `sealed NAME`: false for another keyword.
bool modify_face(const std::string& keyword, Words& words, PfvSettings& settings) {
  for (const pfv::BoundaryKind& kind : pfv::boundary_kinds) {
    if (keyword != kind.name) continue;
    const std::size_t number = take_face_number(words, settings);
    if (settings.sources[number].kind == Source::periodic)
      words.fail("the simulation box is periodic there and has no faces; take `gradient GX GY GZ`");
    for (const Of of : {Of::face, Of::mean, Of::amplitude}) unbind(settings, of, number);
    if (!settings.container) settings.profiles[number].reset();
    (settings.container ? settings.faces[number].boundary : settings.box.faces[number].boundary) =
        take_boundary_of(kind, words, {Of::face, number, {}}, settings);
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

PfvSettings parse_pfv(int narg, char** arg, const std::array<bool, 3>& periodic, const PfvUnits& units) {
  PfvSettings settings;
  settings.fluid.density = units.of_density(settings.fluid.density);
  settings.box.periodic = periodic;
  for (std::size_t face = 0; face < 6; ++face)
    if (periodic[face / 2]) settings.sources[face].kind = Source::periodic;
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
  } else if (keyword == "gradient") {
    parse_gradient(words, changed);
  } else if (!modify_face(keyword, words, changed)) {
    std::vector<std::string> known = settings_with(&pfv::Hosts::modify);
    known.emplace_back("gradient");
    for (const pfv::BoundaryKind& kind : pfv::boundary_kinds) known.emplace_back(kind.name);
    throw pfv::InputError("fix_modify knows no keyword " + not_among(keyword, known));
  }
  check_all(changed);
  settings = changed;
  return words.taken();
}

double& bound_number(PfvSettings& settings, const PfvBinding& binding) {
  switch (binding.of) {
    case Of::patch:
      return settings.container ? settings.patches[binding.number].patch.boundary.value
                                : settings.box.patches[binding.number].boundary.value;
    case Of::region: return settings.box.regions[binding.number].boundary.value;
    case Of::mean: return settings.profiles[binding.number]->mean;
    case Of::amplitude: return settings.profiles[binding.number]->amplitude;
    case Of::gradient: return settings.box.pressure_gradient[static_cast<Eigen::Index>(binding.number)];
    case Of::face: break;
  }
  if (settings.container) return settings.faces[binding.number].boundary.value;
  return settings.box.faces[binding.number].boundary.value;
}

std::string face_name(const PfvSettings& settings, int face) {
  return settings.container ? settings.faces[face].name : pfv::name_of(pfv::all_faces[face]);
}

}  // namespace LAMMPS_NS

// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include "pfv/error.hpp"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <set>

namespace LAMMPS_NS {

namespace {

using Kind = pfv::Boundary::Kind;
using Source = PfvFace::Source;

/// Reads the words one after the other; every error names the keyword in whose list it is.
class Words {
 public:
  Words(int narg, char** arg) : words_(arg, arg + narg) {}

  bool done() const { return next_ == words_.size(); }
  int taken() const { return static_cast<int>(next_); }

  std::string keyword() { return keyword_ = words_[next_++]; }

  bool take(const char* word) {
    if (done() || words_[next_] != word) return false;
    ++next_;
    return true;
  }

  /// Whether the next word is a number rather than a keyword.
  bool number_comes() const {
    if (done()) return false;
    char* end = nullptr;
    std::strtod(words_[next_].c_str(), &end);
    return end != words_[next_].c_str();
  }

  std::string word(const char* what) {
    if (done()) fail(std::string(what) + " is missing");
    return words_[next_++];
  }

  double number(const char* what) { return to_number(word(what), what); }

  int count(const char* what, int least = 1) {
    const std::string text = word(what);
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (end == text.c_str() || *end != '\0' || errno != 0 || value < least ||
        value > INT_MAX)
      fail(std::string(what) + " must be a whole number >" + (least == 0 ? "= 0" : " 0") + ", not '" +
           text + "'");
    return static_cast<int>(value);
  }

  PfvValue value(const char* what) {
    const std::string text = word(what);
    if (text.rfind("v_", 0) == 0) return {0.0, text.substr(2)};
    return {to_number(text, what), ""};
  }

  pfv::Face face() { return pfv::named<pfv::Face>(word("the name of a face")); }

  int axis() {
    const std::string text = word("the axis");
    if (text.size() != 1 || text[0] < 'x' || text[0] > 'z')
      fail("the axis must be x, y or z, not '" + text + "'");
    return text[0] - 'x';
  }

  bool yes_or_no() {
    const std::string text = word("yes or no");
    if (text != "yes" && text != "no") fail("say yes or no, not '" + text + "'");
    return text == "yes";
  }

  PfvCoupling coupling() {
    const std::string text = word("the coupling");
    if (text == "explicit") return PfvCoupling::explicit_forces;
    if (text == "staged") return PfvCoupling::staged;
    if (text == "implicit") return PfvCoupling::implicit;
    if (text == "auto") return PfvCoupling::automatic;
    fail("there are explicit, staged, implicit and auto, not '" + text + "'");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw pfv::InputError("keyword '" + keyword_ + "': " + what);
  }

 private:
  double to_number(const std::string& text, const char* what) const {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0' || !std::isfinite(value))
      fail(std::string(what) + " must be a number, not '" + text + "'");
    return value;
  }

  std::vector<std::string> words_;
  std::size_t next_ = 0;
  std::string keyword_;
};

/// Refuses what is said a second time: of two values only one would be heard.
class Once {
 public:
  explicit Once(const Words& words) : words_(words) {}
  void claim(const std::string& word) {
    if (!claimed_.insert(word).second) words_.fail(word + " is given twice; give it once");
  }

 private:
  const Words& words_;
  std::set<std::string> claimed_;
};

/// `sealed | pressure P | flux Q`, if that comes next.
std::optional<PfvBoundary> take_boundary(Words& words) {
  if (words.take("sealed")) return PfvBoundary{};
  if (words.take("pressure")) return PfvBoundary{Kind::pressure, words.value("the pressure")};
  if (words.take("flux")) return PfvBoundary{Kind::flux, words.value("the flux")};
  return std::nullopt;
}

void take_source(Words& words, PfvFace& face) {
  if (words.take("plane")) {
    face.source = Source::plane;
    face.plane = words.number("the plane's position");
  } else if (words.take("wall")) {
    face.source = Source::wall;
    face.fix_id = words.word("the ID of a fix wall/gran");
  } else if (words.take("mesh")) {
    face.source = Source::mesh;
    face.fix_id = words.word("the ID of a fix mesh/surface");
  } else if (words.take("extent")) {
    face.source = Source::extent;
  } else {
    words.fail("the face's name must be followed by plane X, wall FIX_ID, mesh FIX_ID or extent");
  }
}

std::optional<pfv::Wall> take_wall(Words& words) {
  if (words.take("no_slip")) return pfv::Wall::no_slip;
  if (words.take("symmetry")) return pfv::Wall::symmetry;
  return std::nullopt;
}

void parse_face(Words& words, PfvSettings& settings) {
  const pfv::Face name = words.face();
  PfvFace& face = settings.faces[static_cast<int>(name)];
  if (face.source != Source::none)
    words.fail(std::string("face ") + pfv::name_of(name) + " is given twice");
  take_source(words, face);
  bool has_wall = false, has_boundary = false;
  while (true) {
    if (const auto wall = take_wall(words)) {
      if (has_wall) words.fail("say either no_slip or symmetry, once");
      face.wall = *wall;
      has_wall = true;
    } else if (const auto boundary = take_boundary(words)) {
      if (has_boundary) words.fail("say one of sealed, pressure P and flux Q, once");
      face.boundary = *boundary;
      has_boundary = true;
    } else {
      return;
    }
  }
}

void parse_patch(Words& words, PfvSettings& settings) {
  PfvPatch patch{};
  patch.face = words.face();
  for (double& edge : patch.rectangle) edge = words.number("the rectangle's edge");
  const auto boundary = take_boundary(words);
  if (!boundary) words.fail("the rectangle must be followed by sealed, pressure P or flux Q");
  patch.boundary = *boundary;
  settings.patches.push_back(patch);
}

/// A region has two bounds an axis, a point one place.
void parse_region(Words& words, PfvSettings& settings, bool point) {
  PfvRegion region;
  for (int axis = 0; axis < 3; ++axis) {
    region.lower[axis] = words.number(point ? "the point's coordinate" : "the region's bound");
    region.upper[axis] = point ? region.lower[axis] : words.number("the region's bound");
  }
  const auto boundary = take_boundary(words);
  if (!boundary || boundary->kind == Kind::sealed)
    words.fail("the place must be followed by pressure P or flux Q");
  region.boundary = *boundary;
  settings.regions.push_back(region);
}

void parse_pressure_profile(Words& words, PfvSettings& settings) {
  const pfv::Face name = words.face();
  PfvFace& face = settings.faces[static_cast<int>(name)];
  if (face.profile) words.fail(std::string("face ") + pfv::name_of(name) + " is given twice");
  if (!words.take("cosine")) words.fail("the one profile that exists is cosine");
  PfvCosine cosine;
  cosine.axis = words.axis();
  cosine.mean = words.value("the mean pressure");
  cosine.amplitude = words.value("the amplitude");
  cosine.half_period = words.number("the half period");
  if (cosine.half_period <= 0.0) words.fail("the half period must be > 0");
  face.profile = cosine;
}

void parse_fields(Words& words, PfvSettings& settings) {
  PfvFieldOutput fields;
  fields.every = words.count("the number of steps");
  fields.path = words.word("the file's name");
  const std::string ending = ".pvd";
  if (fields.path.size() <= ending.size() ||
      fields.path.compare(fields.path.size() - ending.size(), ending.size(), ending) != 0)
    words.fail("the file's name must end in .pvd, not be '" + fields.path + "'");
  settings.fields = fields;
}

PfvProfileOutput parse_profile(Words& words) {
  PfvProfileOutput profile;
  profile.axis = words.axis();
  profile.planes = words.count("the number of planes");
  profile.every = words.count("the number of steps");
  profile.path = words.word("the file's name");
  return profile;
}

void parse_sensors(Words& words, PfvSettings& settings) {
  PfvSensorOutput sensors;
  sensors.every = words.count("the number of steps");
  sensors.path = words.word("the file's name");
  do {
    Eigen::Vector3d place;
    for (double& coordinate : place) coordinate = words.number("a sensor's coordinate");
    sensors.places.push_back(place);
  } while (words.number_comes());
  settings.sensors = sensors;
}

void parse_model(Words& words, PfvSettings& settings) {
  settings.grid.reset();
  if (words.take("pfv")) return;
  if (!words.take("darcy_grid")) words.fail("the models are pfv and darcy_grid");
  pfv::DarcyOptions grid;
  for (int& cells : grid.cells) cells = words.count("the number of cells");
  Once once(words);
  const auto take = [&](const char* word) {
    if (!words.take(word)) return false;
    once.claim(word);
    return true;
  };
  while (true) {
    if (take("every")) grid.refresh_every = words.count("the number of flow steps");
    else if (take("drag")) grid.drag = pfv::named<pfv::DragLaw>(words.word("the drag law"));
    else if (take("grain_motion")) grid.grain_motion = words.yes_or_no();
    else break;
  }
  settings.grid = grid;
}

void parse_retriangulation(Words& words, pfv::Options& options) {
  const bool mean = words.take("mean");
  options.strain_measure = mean ? pfv::StrainMeasure::mean : pfv::StrainMeasure::largest;
  options.retriangulation_strain = words.number("the strain");
}

/// `N` or `auto [error PERCENT]`.
void parse_couple_every(Words& words, PfvSettings& settings) {
  settings.couple_error.reset();
  settings.couple_every = 1;
  if (!words.take("auto")) {
    settings.couple_every = words.count("auto or the number of steps");
    return;
  }
  const double percent = words.take("error") ? words.number("the error in per cent")
                                             : 100.0 * PfvSettings::default_couple_error;
  if (!(percent > 0.0 && percent < 100.0)) words.fail("the error must be above 0 and below 100 per cent");
  settings.couple_error = percent / 100.0;
}

/// Keywords of a face or of an opening, which say themselves what they are about.
bool comes_several_times(const std::string& keyword) {
  static const std::set<std::string> several{"face", "patch", "region", "point",
                                             "pressure_profile"};
  return several.count(keyword) > 0;
}

void parse_keyword(Words& words, Once& once, PfvSettings& settings) {
  const std::string keyword = words.keyword();
  if (!comes_several_times(keyword)) once.claim(keyword);
  if (keyword == "viscosity") settings.fluid.viscosity = words.number("the viscosity");
  else if (keyword == "density") settings.fluid.density = words.number("the density");
  else if (keyword == "bulk_modulus") settings.fluid.bulk_modulus = words.number("the modulus");
  else if (keyword == "buoyancy") settings.options.buoyancy = words.yes_or_no();
  else if (keyword == "model") parse_model(words, settings);
  else if (keyword == "face") parse_face(words, settings);
  else if (keyword == "patch") parse_patch(words, settings);
  else if (keyword == "region") parse_region(words, settings, false);
  else if (keyword == "point") parse_region(words, settings, true);
  else if (keyword == "pressure_profile") parse_pressure_profile(words, settings);
  else if (keyword == "retriangulate") parse_retriangulation(words, settings.options);
  else if (keyword == "rebuild_lag")
    settings.options.rebuild_lag = words.count("the number of flow steps", 0);
  else if (keyword == "couple_every") parse_couple_every(words, settings);
  else if (keyword == "coupling") settings.coupling = words.coupling();
  else if (keyword == "time_step_check") settings.time_step_check = words.yes_or_no();
  else if (keyword == "shear_viscous") settings.options.shear_viscous = words.yes_or_no();
  else if (keyword == "torques") settings.options.torques = words.yes_or_no();
  else if (keyword == "volume_rates")
    settings.options.volume_rates = pfv::named<pfv::VolumeRates>(words.word("the name"));
  else if (keyword == "conductance")
    settings.options.conductance = pfv::named<pfv::ConductanceLaw>(words.word("the law's name"));
  else if (keyword == "solver")
    settings.options.solver = pfv::named<pfv::SolverKind>(words.word("the solver's name"));
  else if (keyword == "tolerance")
    settings.options.tolerance = words.number("the tolerance");
  else if (keyword == "precision")
    settings.options.precision = pfv::named<pfv::Precision>(words.word("the precision's name"));
  else if (keyword == "threads")
    settings.options.threads = words.count("the number of threads");
  else if (keyword == "output") parse_fields(words, settings);
  else if (keyword == "profile") settings.profile = parse_profile(words);
  else if (keyword == "flux_profile") settings.flux_profile = parse_profile(words);
  else if (keyword == "sensors") parse_sensors(words, settings);
  else if (keyword == "culprits") settings.culprits = words.word("the file's name");
  else
    throw pfv::InputError("unknown keyword '" + keyword +
                          "'; there are viscosity, density, bulk_modulus, buoyancy, face, patch, "
                          "region, point, pressure_profile, retriangulate, rebuild_lag, "
                          "couple_every, coupling, "
                          "time_step_check, conductance, volume_rates, torques, shear_viscous, solver, tolerance, "
                          "precision, threads, output, profile, flux_profile, sensors and "
                          "culprits");
}

/// A profile makes its face one of imposed pressure, which a face with another boundary is not.
void apply_profiles(PfvSettings& settings) {
  for (const pfv::Face name : pfv::all_faces) {
    PfvFace& face = settings.faces[static_cast<int>(name)];
    if (!face.profile) continue;
    if (face.boundary.kind == Kind::flux)
      throw pfv::InputError(std::string("face ") + pfv::name_of(name) +
                            " has a flux and a pressure_profile; give it one of them");
    face.boundary.kind = Kind::pressure;
  }
}

/// The papers' volume rates feed some motions, which long steps outgrow.
void check_geometric(PfvSettings& settings) {
  if (settings.coupling == PfvCoupling::automatic) settings.coupling = PfvCoupling::explicit_forces;
  if (settings.coupling != PfvCoupling::explicit_forces)
    throw pfv::InputError("`volume_rates geometric` goes with `coupling explicit` alone; take "
                          "`volume_rates reciprocal`, the default");
}

/// Only explicit steps on a pore network can hold loads; the others integrate the drag over each step, look at
/// the grid as often as they are told or count their steps until the next network.
void settle_interval(PfvSettings& settings) {
  const bool can_hold = settings.coupling == PfvCoupling::explicit_forces && !settings.grid &&
                        settings.options.rebuild_lag == 0;
  if (!can_hold) settings.couple_error.reset();
}

void check_all(PfvSettings& settings) {
  settle_interval(settings);
  pfv::check(settings.fluid);
  pfv::check(settings.options);
  if (settings.options.volume_rates == pfv::VolumeRates::geometric) check_geometric(settings);
  if (settings.options.rebuild_lag > 0 && (settings.coupling == PfvCoupling::implicit ||
                                           settings.coupling == PfvCoupling::automatic))
    throw pfv::InputError("rebuild_lag goes with `coupling explicit` and `coupling staged`: implicit "
                          "steps factor a matrix with the masses of the grains, which is not done in "
                          "the background");
  if (!settings.grid) return;
  pfv::check(*settings.grid, settings.fluid, settings.options);
  if (settings.flux_profile)
    throw pfv::InputError("darcy_grid has no flux_profile: leave it away, or use the model pfv");
  if (settings.coupling != PfvCoupling::explicit_forces)
    throw pfv::InputError("darcy_grid has no staged coupling: use `coupling explicit` (the "
                          "default), or the model pfv");
}

void require_all_faces(const PfvSettings& settings) {
  std::string missing;
  for (const pfv::Face name : pfv::all_faces)
    if (settings.faces[static_cast<int>(name)].source == Source::none)
      missing += std::string(missing.empty() ? "" : ", ") + pfv::name_of(name);
  if (!missing.empty())
    throw pfv::InputError("missing: face " + missing +
                          "; each of the six needs `face NAME (plane X | wall FIX_ID | mesh FIX_ID "
                          "| extent)`");
}

}  // namespace

PfvSettings parse_pfv(int narg, char** arg) {
  PfvSettings settings;
  settings.options.outside = pfv::OutsideGrains::leave_out;
  settings.options.sphere_pressure = true;
  if (std::none_of(arg, arg + narg, [](const char* a) { return std::string(a) == "viscosity"; }))
    throw pfv::InputError("keyword 'viscosity' is missing; give `viscosity MU`, Pa s");
  Words words(narg, arg);
  Once once(words);
  while (!words.done()) parse_keyword(words, once, settings);
  require_all_faces(settings);
  apply_profiles(settings);
  check_all(settings);
  return settings;
}

int modify_pfv(PfvSettings& settings, int narg, char** arg) {
  Words words(narg, arg);
  PfvSettings changed = settings;
  const std::string keyword = words.keyword();
  const auto set_boundary = [&](Kind kind, const char* what) {
    PfvFace& face = changed.faces[static_cast<int>(words.face())];
    face.boundary = {kind, kind == Kind::sealed ? PfvValue{} : words.value(what)};
    face.profile.reset();
  };
  if (keyword == "viscosity") changed.fluid.viscosity = words.number("the viscosity");
  else if (keyword == "retriangulate")
    changed.options.retriangulation_strain = words.number("the strain");
  else if (keyword == "couple_every") changed.couple_every = words.count("the number of steps");
  else if (keyword == "safety") {
    changed.safety = words.number("the safety factor");
    if (changed.safety <= 0.0) words.fail("the safety factor must be > 0");
  } else if (keyword == "pressure") set_boundary(Kind::pressure, "the pressure");
  else if (keyword == "flux") set_boundary(Kind::flux, "the flux");
  else if (keyword == "sealed") set_boundary(Kind::sealed, "");
  else
    throw pfv::InputError("fix_modify knows no keyword '" + keyword +
                          "'; there are viscosity, retriangulate, couple_every, safety, pressure, "
                          "flux and sealed");
  check_all(changed);
  settings = changed;
  return words.taken();
}

std::vector<const PfvValue*> values_of(const PfvSettings& settings) {
  std::vector<const PfvValue*> values;
  for (const PfvFace& face : settings.faces) {
    if (face.profile) {
      values.push_back(&face.profile->mean);
      values.push_back(&face.profile->amplitude);
    } else {
      values.push_back(&face.boundary.value);
    }
  }
  for (const PfvPatch& patch : settings.patches) values.push_back(&patch.boundary.value);
  for (const PfvRegion& region : settings.regions) values.push_back(&region.boundary.value);
  return values;
}

}  // namespace LAMMPS_NS

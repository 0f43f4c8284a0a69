// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/box.hpp"
#include "pfv/error.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"
#include "pfv/settings.hpp"
#include "support/boxes.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace settings_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

using support::expect_line;
using support::refusal;

template <class Settings>
std::string refusal_of(const std::function<void(Settings&)>& spoil) {
  Settings settings;
  spoil(settings);
  return refusal([&] { pfv::check(settings); });
}

template <class Enum>
void reads_back() {
  for (const auto& one : pfv::Names<Enum>::all) {
    EXPECT_EQ(pfv::named<Enum>(one.name), one.value);
    EXPECT_STREQ(pfv::name_of(one.value), one.name);
  }
}

TEST(Names, EachFaceReadsBackAsItself) {
  for (const pfv::Face face : pfv::all_faces)
    EXPECT_EQ(pfv::named<pfv::Face>(pfv::name_of(face)), face);
  EXPECT_STREQ(pfv::name_of(pfv::Face::yhi), "yhi");
}

TEST(Names, EachOptionReadsBackAsItself) {
  using namespace pfv;
  reads_back<ConductanceLaw>();
  reads_back<Partition>();
  reads_back<SolverKind>();
  reads_back<OrderingKind>();
  reads_back<Coupling>();
}

TEST(Names, AnUnknownNameIsRefusedWithTheListOfThoseThatExist) {
  expect_line(refusal([] { pfv::named<pfv::SolverKind>("pardiso"); }), "auto, supernodal, cholmod, tacho, klu2");
  expect_line(refusal([] { pfv::named<pfv::OrderingKind>(""); }), "auto, geometric, metis, amd");
  expect_line(refusal([] { pfv::named<pfv::ConductanceLaw>("Hydraulic_radius"); }),
               "hydraulic_radius, effective_radius");
  expect_line(refusal([] { pfv::named<pfv::Face>("xmid"); }), "xlo, xhi, ylo, yhi, zlo, zhi");
}

TEST(Names, AValueOutsideItsEnumerationIsRefused) {
  refusal([] { pfv::name_of(static_cast<pfv::Face>(6)); });
  refusal([] { pfv::name_of(static_cast<pfv::SolverKind>(99)); });
}

TEST(CheckBox, TakesTheUnitCubeWithAnyKindOfBoundary) {
  pfv::Box box;
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(-1e5);
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(-1e-6);
  box[pfv::Face::zlo].velocity = -0.1;
  box.patches.push_back({pfv::Face::xlo, {0.4, 0.6, -1.0, 2.0}, pfv::Boundary::sealed()});
  EXPECT_NO_THROW(pfv::check(box));
}

TEST(CheckBox, RefusesFlatInvertedOrInfiniteEdges) {
  using pfv::Box;
  expect_line(refusal_of<Box>([](Box& box) { box.upper[1] = 0; }), "along y is [0, 0]");
  expect_line(refusal_of<Box>([](Box& box) { box.upper[2] = -3; }), "along z is [0, -3]");
  expect_line(refusal_of<Box>([](Box& box) { box.lower[0] = nan; }), "along x: lower bound");
  expect_line(refusal_of<Box>([](Box& box) { box.upper[0] = infinity; }), "upper bound is inf");
  expect_line(refusal_of<Box>([](Box& box) {
                 box.lower[0] = -1.7e308;
                 box.upper[0] = 1.7e308;
               }),
               "length is inf");
}

TEST(CheckBox, RefusesValuesOfAFaceThatAreNotFinite) {
  using namespace pfv;
  expect_line(refusal_of<Box>([](Box& box) { box[Face::yhi].velocity = nan; }),
               "face yhi: velocity");
  expect_line(refusal_of<Box>([](Box& box) {
                 box[Face::xlo].boundary = Boundary::pressure(infinity);
               }),
               "face xlo: pressure");
  expect_line(refusal_of<Box>([](Box& box) { box[Face::zlo].boundary = Boundary::flux(nan); }),
               "face zlo: flux");
}

// Axes of a rectangle: the two that are not the face's own, in the order x, y, z.
TEST(CheckBox, RefusesPatchesThatAreInvertedOrOffTheirFace) {
  using namespace pfv;
  const auto patch = [](Face face, std::array<double, 4> rectangle) {
    return refusal_of<Box>([=](Box& box) {
      box.upper = {1, 2, 3};
      box.patches.push_back({Face::zhi, {0, 1, 0, 1}, Boundary::sealed()});
      box.patches.push_back({face, rectangle, Boundary::pressure(0)});
    });
  };
  expect_line(patch(Face::yhi, {0.5, 0.5, 0, 1}), "patch 2 on face yhi along x is [0.5, 0.5]");
  expect_line(patch(Face::yhi, {0, 1, 4, 5}), "along z is [4, 5], outside its face [0, 3]");
  expect_line(patch(Face::xlo, {2, 3, 0, 1}), "along y is [2, 3], outside its face [0, 2]");
  expect_line(patch(Face::zlo, {0, nan, 0, 1}), "patch 2 on face zlo along x: upper bound");
}

TEST(CheckFluid, RefusesWhatNoFluidHas) {
  using pfv::Fluid;
  expect_line(refusal_of<Fluid>([](Fluid& f) { f.viscosity = 0; }), "viscosity is 0");
  expect_line(refusal_of<Fluid>([](Fluid& f) { f.viscosity = nan; }), "viscosity is nan");
  expect_line(refusal_of<Fluid>([](Fluid& f) { f.viscosity = infinity; }), "viscosity is inf");
  expect_line(refusal_of<Fluid>([](Fluid& f) { f.density = -1; }), "density is -1");
  expect_line(refusal_of<Fluid>([](Fluid& f) { f.gravity[1] = nan; }), "gravity along y");
  expect_line(refusal_of<Fluid>([](Fluid& f) { f.bulk_modulus = 0.0; }), "bulk modulus is 0");
  Fluid weightless;
  weightless.density = 0;
  EXPECT_NO_THROW(pfv::check(weightless));
}

TEST(CheckOptions, RefusesWhatContradicts) {
  using pfv::Options;
  expect_line(refusal_of<Options>([](Options& o) { o.retriangulation_strain = 0; }), "strain");
  expect_line(refusal_of<Options>([](Options& o) { o.retriangulation_strain = nan; }), "strain");
  expect_line(refusal_of<Options>([](Options& o) {
                 o.solver = pfv::SolverKind::klu2;
                 o.ordering = pfv::OrderingKind::metis;
               }),
               "klu2");
  expect_line(refusal_of<Options>([](Options& o) {
                 o.forces = false;
                 o.split_forces = true;
               }),
               "need forces");
  expect_line(refusal_of<Options>([](Options& o) { o.partition = pfv::Partition::yade; }),
               "use it with the conductance law hydraulic_radius");
  refusal_of<Options>([](Options& o) { o.conductance = static_cast<pfv::ConductanceLaw>(7); });
  EXPECT_NO_THROW(pfv::check(Options{}));
  EXPECT_EQ(Options{}.conductance, pfv::ConductanceLaw::open_throat);
}

/// The settings that `words` give, one keyword after the other, as a host reads them.
pfv::Settings settings_of(std::vector<std::string> all) {
  pfv::Settings settings;
  pfv::Words words(std::move(all));
  while (!words.done()) pfv::read(*pfv::setting_named(words.keyword()), words, settings);
  pfv::settle(settings);
  pfv::check(settings);
  return settings;
}

TEST(SettingsTable, EachDefaultIsInRangeAndReadsBackAsItself) {
  const pfv::Settings defaults;
  for (const pfv::Setting& setting : pfv::all_settings()) {
    SCOPED_TRACE(setting.name);
    EXPECT_NO_THROW(setting.check(defaults));
    if (setting.text(defaults) == "none") continue;
    std::istringstream text(setting.text(defaults));
    pfv::Words words(std::vector<std::string>(std::istream_iterator<std::string>(text), {}));
    pfv::Settings read_back;
    pfv::read(setting, words, read_back);
    EXPECT_TRUE(words.done());
    EXPECT_EQ(setting.text(read_back), setting.text(defaults));
  }
}

TEST(SettingsTable, GivesEachValueItsPlace) {
  const pfv::Settings settings = settings_of({"viscosity", "2", "retriangulate", "mean", "0.1", "couple_every", "5",
                                              "solver", "cg", "tolerance", "1e-4", "gravity", "0", "0", "-9.81"});
  EXPECT_EQ(settings.fluid.viscosity, 2.0);
  EXPECT_EQ(settings.fluid.gravity[2], -9.81);
  EXPECT_EQ(settings.options.strain_measure, pfv::StrainMeasure::mean);
  EXPECT_EQ(settings.options.retriangulation_strain, 0.1);
  EXPECT_EQ(settings.steps.couple_every, 5);
  EXPECT_FALSE(settings.steps.couple_error);
  EXPECT_EQ(settings.options.tolerance, 1e-4);
  EXPECT_FALSE(settings.grid());
  const pfv::Settings grid = settings_of({"model", "darcy_grid", "1", "2", "3", "every", "7", "drag", "kozeny_carman"});
  EXPECT_EQ(grid.grid()->cells[2], 3);
  EXPECT_EQ(grid.grid()->refresh_every, 7);
  EXPECT_FALSE(grid.steps.couple_error);  // follows from the model
}

TEST(SettingsTable, RefusesWhatIsNotReadAlsoAtItsDefault) {
  const auto refused = [](std::vector<std::string> words, const char* part) {
    expect_line(refusal([&] { settings_of(words); }), part);
  };
  refused({"tolerance", "1e-10"}, "takes no tolerance: leave `tolerance 1e-10` away, or use the solver amg, cg or gauss_seidel");
  refused({"shear_viscous", "yes", "model", "darcy_grid", "1", "1", "1"}, "darcy_grid takes no shear viscous forces");
  refused({"torques", "no", "model", "darcy_grid", "1", "1", "1"}, "darcy_grid takes no torques");
  refused({"drag", "di_felice"}, "pfv takes no drag: leave `drag di_felice` away, or use the model darcy_grid");
  refused({"couple_every", "auto", "coupling", "staged"}, "`couple_every auto` goes with `coupling explicit`");
}

TEST(SettingsTable, NamesTheKeywordOfABadWord) {
  const auto refused = [](std::vector<std::string> words, const char* part) {
    expect_line(refusal([&] { settings_of(words); }), part);
  };
  refused({"viscosity", "thick"}, "keyword 'viscosity': the viscosity is 'thick': give a finite number > 0");
  refused({"viscosity"}, "keyword 'viscosity': the viscosity is missing");
  refused({"threads", "65"}, "keyword 'threads': the number of threads is '65': give 1 to 64");
  refused({"solver", "magic"}, "keyword 'solver': unknown solver 'magic': use one of auto");
  refused({"density", "1", "density", "2"}, "keyword 'density': density is given twice");
}

TEST(CheckOptions, OfAStepRefusesWhatItDoesNotHave) {
  pfv::Options lagging;
  lagging.rebuild_lag = 3;
  expect_line(refusal([&] { pfv::check(lagging, pfv::Coupling::implicit); }), "masses of the grains");
  EXPECT_NO_THROW(pfv::check(lagging, pfv::Coupling::staged));
  pfv::Options by;
  EXPECT_NO_THROW(pfv::check(by, pfv::Coupling::implicit));
  by.solver = pfv::SolverKind::cholmod;
  expect_line(refusal([&] { pfv::check(by, pfv::Coupling::implicit); }),
              "the solver cholmod solves no implicit steps, whose matrix is indefinite: use the solver supernodal, or "
              "`coupling explicit` or `coupling staged`");
  EXPECT_NO_THROW(pfv::check(by, pfv::Coupling::automatic));
}

}  // namespace
}  // namespace settings_test

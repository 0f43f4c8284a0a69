// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/box.hpp"
#include "pfv/error.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"
#include "support/boxes.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <limits>

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

TEST(Names, EachFaceReadsBackAsItself) {
  for (const pfv::Face face : pfv::all_faces)
    EXPECT_EQ(pfv::face_named(pfv::name_of(face)), face);
  EXPECT_STREQ(pfv::name_of(pfv::Face::yhi), "yhi");
}

TEST(Names, EachOptionReadsBackAsItself) {
  using namespace pfv;
  for (const char* name : {"hydraulic_radius", "effective_radius", "open_throat"})
    EXPECT_STREQ(name_of(conductance_law_named(name)), name);
  for (const char* name : {"auto", "supernodal", "cholmod", "tacho", "klu2", "mumps", "cg", "gauss_seidel"})
    EXPECT_STREQ(name_of(solver_named(name)), name);
  for (const char* name : {"auto", "metis", "amd"})
    EXPECT_STREQ(name_of(ordering_named(name)), name);
}

TEST(Names, AnUnknownNameIsRefusedWithTheListOfThoseThatExist) {
  expect_line(refusal([] { pfv::solver_named("pardiso"); }), "auto, supernodal, cholmod, tacho, klu2");
  expect_line(refusal([] { pfv::ordering_named(""); }), "auto, geometric, metis, amd");
  expect_line(refusal([] { pfv::conductance_law_named("Hydraulic_radius"); }),
               "hydraulic_radius, effective_radius");
  expect_line(refusal([] { pfv::face_named("xmid"); }), "xlo, xhi, ylo, yhi, zlo, zhi");
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

}  // namespace

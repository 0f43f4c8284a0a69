// SPDX-License-Identifier: GPL-3.0-or-later
// MUMPS on several ranks beside the kept factor of one: what several ranks add to the error of a direct solver is round-off.
#include "as_on_one_rank.hpp"
#include "world.hpp"

#include "pfv/dense_packing.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "problem/solver_abilities.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace mumps_on_ranks_test {
namespace {

class MumpsOnRanks : public testing::Test {
  void SetUp() override {
    if (!pfv::is_built(pfv::SolverKind::mumps)) GTEST_SKIP() << "this build has no mumps";
  }
};

pfv::Options by(pfv::SolverKind solver) {
  pfv::Options options;
  options.solver = solver;
  options.torques = options.sphere_pressure = true;
  return options;
}

pfv::Box seepage() {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(2.0);
  box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  return box;
}

void expect_as_by_a_factor(const pfv::PackingArrays& packing, const pfv::Container& container, const pfv::Fluid& fluid = {},
                           double dt = 0.0, Deal deal = Deal::by_place) {
  const std::vector<int> columns = own_columns(packing, deal);
  const pfv::PackingArrays part = part_of(packing, columns);
  pfv::Flow one(container, fluid, by(pfv::SolverKind::supernodal)), all(container, fluid, by(pfv::SolverKind::mumps), world());
  for (int step = 0; step < (dt > 0.0 ? 2 : 1); ++step) {
    const pfv::Forces& expected = dt > 0.0 ? one.step(packing.view(), dt) : one.evaluate(packing.view());
    const pfv::Forces& found = dt > 0.0 ? all.step(part.view(), dt) : all.evaluate(part.view());
    const Difference forces = difference_of(found.total, expected.total, columns);
    EXPECT_LT(forces.rms, 1e-10);
    EXPECT_LT(forces.worst, 1e-9);
    ASSERT_EQ(all.report().permeability.has_value(), one.report().permeability.has_value());
    EXPECT_NEAR(all.report().permeability.value_or(1.0) / one.report().permeability.value_or(1.0), 1.0, 1e-10);
  }
  EXPECT_LT(std::abs(all.report().mass_error), 1e-10);
  EXPECT_EQ(all.report().solver, "mumps");
}

pfv::PackingArrays moving(pfv::PackingArrays packing) {
  set_in_motion(packing, 5);
  return packing;
}

TEST_F(MumpsOnRanks, ADenseBedHoweverItIsDealt) {
  for (const Deal deal : {Deal::by_place, Deal::at_random, Deal::all_to_one})
    expect_as_by_a_factor(moving(pfv::dense_packing(60)), seepage(), {}, 0.0, deal);
}

TEST_F(MumpsOnRanks, FluxesWhosePoresShareAPressure) {
  pfv::Box box = seepage();
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1e-3);
  box.patches.push_back({pfv::Face::xlo, {0.2, 0.6, 0.2, 0.6}, pfv::Boundary::flux(-2e-3)});
  expect_as_by_a_factor(pfv::dense_packing(100), box);
}

TEST_F(MumpsOnRanks, ACompressibleFluidBetweenSealedWalls) {
  pfv::Fluid fluid;
  fluid.bulk_modulus = 1e3;
  expect_as_by_a_factor(moving(pfv::dense_packing(60)), pfv::Box{}, fluid, 1e-3);
}

TEST_F(MumpsOnRanks, ACellThatIsPeriodicAllAround) {
  pfv::Box box;
  box.periodic = {true, true, true};
  box.pressure_gradient = {0.3, -1.0, 2.0};
  expect_as_by_a_factor(pfv::dense_packing(60), box);
}

TEST_F(MumpsOnRanks, PressuresThatNothingDeterminesAreRefused) {
  pfv::Box box;
  box[pfv::Face::zlo].boundary = pfv::Boundary::flux(1e-3);
  box[pfv::Face::zhi].boundary = pfv::Boundary::flux(-1e-3);
  const pfv::PackingArrays packing = pfv::dense_packing(60);
  pfv::Flow all(box, {}, by(pfv::SolverKind::mumps), world());
  EXPECT_THROW(all.evaluate(part_of(packing, own_columns(packing, Deal::by_place)).view()), pfv::InputError);
}

}  // namespace
}  // namespace mumps_on_ranks_test

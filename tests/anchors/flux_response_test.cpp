// SPDX-License-Identifier: GPL-3.0-or-later
// What a sphere that moves alone drives through an open face is its force at rest under a pressure there
// (Lorentz), so that the finite-element forces are a reference for moving grains, too. With S^T the flux
// has the error of the force; the papers' E = dV/dx errs by up to three times as much.
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/tables.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <tuple>
#include <vector>

namespace flux_response_test {
namespace {

using namespace support;

struct Case {
  std::string bed;
  bool no_slip;
  pfv::Wall wall() const { return no_slip ? pfv::Wall::no_slip : pfv::Wall::symmetry; }
  pfv::PackingArrays packing() const { return data_packing("packing_36_" + bed + ".csv"); }
};

Eigen::Matrix3Xd exact_forces(const Case& c, Eigen::Index spheres) {
  const std::string wall = c.no_slip ? "no_slip" : "symmetry";
  Eigen::Matrix3Xd forces(3, spheres);
  for (const Row& row : table("stokes_36_" + c.bed + "_forces.csv"))
    forces.col(static_cast<Eigen::Index>(number(row, "id")) - 1) =
        Eigen::Vector3d(number(row, wall + "_fx"), number(row, wall + "_fy"), number(row, wall + "_fz"));
  return forces;
}

/// Into the box through zlo for each sphere and direction that moves alone, by 1 m/s: N per Pa.
Eigen::Matrix3Xd responses(const Case& c, pfv::VolumeRates rates) {
  pfv::PackingArrays packing = c.packing();
  pfv::Options options;
  options.volume_rates = rates;
  pfv::Flow flow(pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, c.wall()), viscosity_one(), options);
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  Eigen::Matrix3Xd result = packing.velocities;
  for (Eigen::Index entry = 0; entry < result.size(); ++entry) {
    packing.velocities(entry) = 1.0;
    flow.evaluate(packing.view());
    packing.velocities(entry) = 0.0;
    result(entry) = flow.faces()[static_cast<int>(pfv::Face::zlo)].flux;
  }
  return result;
}

Eigen::Matrix3Xd forces_at_rest(const Case& c) {
  const pfv::PackingArrays packing = c.packing();
  pfv::Flow flow(upward_box(c.wall()), viscosity_one());
  return flow.evaluate(packing.view()).total;
}

struct Errors {
  double median, worst, rms;
};

Errors errors(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& exact) {
  const Eigen::ArrayXd differences = (found - exact).colwise().norm();
  Eigen::ArrayXd relative = differences / exact.colwise().norm().transpose().array();
  std::sort(relative.begin(), relative.end());
  const Eigen::Index half = relative.size() / 2;
  const double median = 0.5 * (relative[half] + relative[relative.size() - 1 - half]);
  return {median, relative[relative.size() - 1], (found - exact).norm() / exact.norm()};
}

void expect_recorded(const Errors& measured, const Errors& recorded) {
  EXPECT_NEAR(measured.median, recorded.median, 1e-3);
  EXPECT_NEAR(measured.worst, recorded.worst, 1e-3);
  EXPECT_NEAR(measured.rms, recorded.rms, 1e-3);
}

struct Recorded {
  Case bed;
  Errors reciprocal, geometric;
};

class FluxResponse : public testing::TestWithParam<Recorded> {};

TEST_P(FluxResponse, HasTheErrorOfTheForceAndThatOfThePapersIsLarger) {
  const Case c = GetParam().bed;
  const Eigen::Matrix3Xd forces = forces_at_rest(c);
  const Eigen::Matrix3Xd reciprocal = responses(c, pfv::VolumeRates::reciprocal);
  EXPECT_LT((reciprocal - forces).cwiseAbs().maxCoeff(), 1e-10 * forces.cwiseAbs().maxCoeff());
  const Eigen::Matrix3Xd exact = exact_forces(c, forces.cols());
  expect_recorded(errors(reciprocal, exact), GetParam().reciprocal);
  expect_recorded(errors(responses(c, pfv::VolumeRates::geometric), exact), GetParam().geometric);
}

INSTANTIATE_TEST_SUITE_P(
    Beds, FluxResponse,
    testing::Values(Recorded{{"loose", true}, {0.0905, 0.283, 0.0977}, {0.198, 0.591, 0.272}},
                    Recorded{{"loose", false}, {0.0809, 0.202, 0.0861}, {0.104, 0.244, 0.109}},
                    Recorded{{"near_touching", true}, {0.056, 0.199, 0.07}, {0.136, 0.447, 0.177}},
                    Recorded{{"near_touching", false}, {0.0671, 0.145, 0.0674}, {0.0888, 0.244, 0.0956}}),
    [](const auto& one) {
      return one.param.bed.bed + (one.param.bed.no_slip ? "_no_slip" : "_symmetry");
    });

/// Spheres that the fluid pushes on in some direction in which they alone move.
int fed(pfv::VolumeRates rates) {
  pfv::Options options;
  options.volume_rates = rates;
  const pfv::PackingArrays packing = pfv::dense_packing(2000, 0.6, 2.0 / 3.0);  // size ratio 5
  pfv::Flow flow(upward_box(pfv::Wall::symmetry), viscosity_one(), options);
  flow.evaluate(packing.view());
  std::vector<int> columns(static_cast<std::size_t>(packing.radii.size()));
  std::iota(columns.begin(), columns.end(), 0);
  int count = 0;
  for (const Eigen::Matrix3d& drag : flow.viscosity_matrices(columns)) {
    const Eigen::Vector3d eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(0.5 * (drag + drag.transpose())).eigenvalues();
    count += eigenvalues.minCoeff() < -1e-10 * std::abs(eigenvalues.maxCoeff());
  }
  return count;
}

TEST(OwnDrag, OfNoSphereIsNegativeAndWithThePapersVolumeRatesOfSome) {
  EXPECT_EQ(fed(pfv::VolumeRates::reciprocal), 0);
  EXPECT_EQ(fed(pfv::VolumeRates::geometric), 12);
}

/// Mean over the axes of the torque on each sphere that turns alone with 1 rad/s, over that in fluid without
/// end, 8 pi mu r^3.
Eigen::ArrayXd braking_of_spins(const std::string& bed) {
  constexpr double pi = 3.14159265358979323846;
  pfv::PackingArrays packing = data_packing(bed);
  packing.velocities = packing.angular_velocities = Eigen::Matrix3Xd::Zero(3, packing.radii.size());
  pfv::Options options;
  options.torques = true;
  pfv::Flow flow(pressure_box(pfv::Face::zlo, 0.0, pfv::Face::zhi, 0.0, pfv::Wall::symmetry),
                 viscosity_one(), options);
  Eigen::ArrayXd result = Eigen::ArrayXd::Zero(packing.radii.size());
  for (Eigen::Index entry = 0; entry < packing.angular_velocities.size(); ++entry) {
    packing.angular_velocities(entry) = 1.0;
    result[entry / 3] -= flow.evaluate(packing.view()).torque(entry) / 3.0;
    packing.angular_velocities(entry) = 0.0;
  }
  result /= 8.0 * pi * packing.radii.array().cube();
  std::sort(result.begin(), result.end());
  return result;
}

// Spheres at rest around can only raise it: the pores know what its moments press through their throats, not
// how its surface rubs on the fluid beside it.
TEST(OwnDrag, OfASphereThatTurnsIsAPartOfThatOfStokes) {
  for (const auto& [bed, median, largest] :
       {std::tuple("packing_36_loose.csv", 0.042, 0.148), std::tuple("packing_100.csv", 0.078, 0.245),
        std::tuple("bed_two_sizes.csv", 0.076, 0.414), std::tuple("bed_24_small.csv", 0.089, 0.942)}) {
    const Eigen::ArrayXd braking = braking_of_spins(bed);
    EXPECT_GT(braking[0], 0.0);
    EXPECT_NEAR(braking[braking.size() / 2], median, 1e-3) << bed;
    EXPECT_NEAR(braking[braking.size() - 1], largest, 1e-3) << bed;
  }
}

}  // namespace
}  // namespace flux_response_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/sphere_stresses.hpp"

#include "pfv/flow.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

namespace sphere_stresses_test {
namespace {

using namespace support;

struct SmallSphere {
  double stress, force;  ///< viscous: the largest component of its stress, its force along z
};

/// The ninth sphere of the paper's cell, in a pressure with a gradient (which pushes it) and a
/// curvature (which stretches it).
SmallSphere ninth_sphere(pfv::ConductanceLaw law) {
  const Stages s = stages_of(nine_spheres(0.1), upward_box(pfv::Wall::symmetry));
  const Eigen::VectorXd z = s.network.pore_centres.row(2).transpose().array() - 0.5;
  const Eigen::VectorXd pressures = z.array() + z.array().square();
  const auto shares = pfv::viscous_shares(law, s.network, s.throats, s.spheres);
  const pfv::ViscousShares none(shares.size(), {0.0, 0.0, 0.0});
  const auto stresses = [&](const pfv::ViscousShares& some) -> pfv::Stresses {
    return pfv::sphere_stresses(s.network, s.throats, some, s.spheres, pressures, s.spheres,
                                Eigen::Vector3d::Zero());
  };
  const auto forces = pfv::multiply(
      pfv::force_matrix(s.network, s.spheres, s.throats, shares, s.spheres.size(), {false, true}),
      pressures);
  return {(stresses(shares) - stresses(none)).col(8).cwiseAbs().maxCoeff(), forces(2, 8)};
}

// Its twelve throats are alike, so that its share changes by one factor.
TEST(SphereStresses, TakeTheShareOfTheViscousForceThatTheForcesTake) {
  const SmallSphere papers = ninth_sphere(pfv::ConductanceLaw::hydraulic_radius);
  const SmallSphere open = ninth_sphere(pfv::ConductanceLaw::open_throat);
  EXPECT_GT(papers.stress, 0.0);
  EXPECT_LT(papers.force, 0.0);  // down the gradient
  EXPECT_LT(open.force, 2.0 * papers.force);
  EXPECT_NEAR(open.stress / papers.stress, open.force / papers.force, 1e-12);
}

// Where the period is cut is a choice: it must show in no result but the level of the pressure.
TEST(SphereStresses, OfAPeriodicCellDoNotDependOnWhereItIsCut) {
  const pfv::PackingArrays packing = data_packing("bed_periodic_64.csv");
  pfv::Box box;
  box.periodic = {true, true, true};
  box.pressure_gradient = {0.0, 0.0, -1.0};
  pfv::Options options;
  options.sphere_pressure = true;
  const auto solve = [&](const Eigen::Vector3d& shift) {
    pfv::PackingArrays shifted = packing;
    for (Eigen::Index k = 0; k < shifted.radii.size(); ++k) {
      const Eigen::Array3d place = (packing.positions.col(k) + shift).array();
      shifted.positions.col(k) = (place - place.floor()).matrix();
    }
    pfv::Flow flow(box, viscosity_one(), options);
    flow.evaluate(shifted.view());
    // tractions of the gradient's own pressure, by which two images of a sphere differ
    const Eigen::RowVectorXd own = box.pressure_gradient.transpose() * shifted.positions;
    pfv::Stresses stresses = flow.sphere_stresses();
    stresses.topRows(3).rowwise() += own;
    const Eigen::RowVectorXd around = flow.forces().sphere_pressure.transpose() - own;
    stresses.topRows(3).array() += around.mean();
    return std::pair(stresses, Eigen::RowVectorXd(around.array() - around.mean()));
  };
  const auto [stresses, around] = solve(Eigen::Vector3d::Zero());
  const auto [moved_stresses, moved_around] = solve({0.37, 0.21, 0.58});
  EXPECT_GT(around.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((moved_around - around).cwiseAbs().maxCoeff(), 1e-9 * around.cwiseAbs().maxCoeff());
  EXPECT_LT((moved_stresses - stresses).cwiseAbs().maxCoeff(),
            1e-9 * stresses.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace sphere_stresses_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/sphere_stresses.hpp"

#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

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
    return pfv::sphere_stresses(s.network, s.throats, some, s.spheres, pressures,
                                s.spheres.size());
  };
  const auto forces = pfv::multiply(
      pfv::force_matrix(s.network, s.throats, shares, s.spheres.size(), {false, true}), pressures);
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

}  // namespace

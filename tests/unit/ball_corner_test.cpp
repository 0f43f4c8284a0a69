// SPDX-License-Identifier: GPL-3.0-or-later
// A ball cut by three planes normal to the axes.
#include "geometry/ball_corner.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace ball_corner_test {
namespace {

using pfv::beyond_corner;
using support::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(BallCorner, HalvesQuartersAndEighths) {
  const double ball = 4.0 / 3.0 * pi * 8.0, sphere = 4.0 * pi * 4.0;
  const double corners[4][3] = {{-infinity, -infinity, -infinity},
                                {0.0, -infinity, -infinity},
                                {0.0, -infinity, 0.0},
                                {0.0, 0.0, 0.0}};
  for (int planes = 0; planes < 4; ++planes) {
    const auto& c = corners[planes];
    const pfv::BallSection part = beyond_corner(2.0, {c[0], c[1], c[2]});
    EXPECT_NEAR(part.volume, ball / (1 << planes), 1e-14 * ball);
    EXPECT_NEAR(part.area, sphere / (1 << planes), 1e-14 * sphere);
  }
}

TEST(BallCorner, CapAndNothing) {
  const double h = 0.3;  // height of the cap: pi h² (3 R - h)/3 and 2 pi R h
  const pfv::BallSection cap = beyond_corner(1.0, {-infinity, 1.0 - h, -2.0});
  EXPECT_NEAR(cap.volume, pi * h * h * (3.0 - h) / 3.0, 1e-15);
  EXPECT_NEAR(cap.area, 2.0 * pi * h, 1e-15);
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(1.0, -2.0, -2.0), Eigen::Vector3d(0.8, 0.7, -2.0),
        Eigen::Vector3d(0.6, 0.6, 0.6)}) {
    EXPECT_EQ(beyond_corner(1.0, corner).volume, 0.0);
    EXPECT_EQ(beyond_corner(1.0, corner).area, 0.0);
  }
}

/// Columns of a fine raster over y > b, z > c; midpoints.
double volume_by_columns(const Eigen::Vector3d& corner) {
  constexpr int n = 600;
  const double y0 = std::max(corner[1], -1.0), z0 = std::max(corner[2], -1.0);
  const double dy = (1.0 - y0) / n, dz = (1.0 - z0) / n;
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double y = y0 + (i + 0.5) * dy, z = z0 + (j + 0.5) * dz;
      const double half2 = 1.0 - y * y - z * z;
      if (half2 <= 0.0) continue;
      const double half = std::sqrt(half2);
      sum += std::max(0.0, half - std::max(corner[0], -half));
    }
  return sum * dy * dz;
}

TEST(BallCorner, AgreesWithQuadratureOnEverySideOfTheCentre) {
  support::Random random(31);
  for (int sample = 0; sample < 40; ++sample) {
    const Eigen::Vector3d corner = random.in_cube(-0.9, 0.7);
    // the raster's own error, halved with every doubling of n to the 3/2, is 3e-5 at n = 600
    EXPECT_NEAR(beyond_corner(1.0, corner).volume, volume_by_columns(corner), 6e-5)
        << corner.transpose();
  }
}

TEST(BallCorner, AreaIsTheGrowthOfTheVolumeWithTheRadius) {
  support::Random random(32);
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::Vector3d corner = random.in_cube(-1.1, 1.1);
    const double h = 1e-5;
    const double growth = (beyond_corner(1.0 + h, corner).volume -
                           beyond_corner(1.0 - h, corner).volume) / (2.0 * h);
    // difference quotient: h where a corner is on the very surface, else h² and 1e-16/h
    EXPECT_NEAR(beyond_corner(1.0, corner).area, growth, 2e-5) << corner.transpose();
  }
}

TEST(BallCorner, EveryRadiusByScaling) {
  const Eigen::Vector3d corner(0.2, -0.4, 0.1);
  const pfv::BallSection unit = beyond_corner(1.0, corner);
  const pfv::BallSection small = beyond_corner(1e-3, 1e-3 * corner);
  EXPECT_NEAR(small.volume / unit.volume, 1e-9, 1e-23);
  EXPECT_NEAR(small.area / unit.area, 1e-6, 1e-20);
}

}  // namespace
}  // namespace ball_corner_test

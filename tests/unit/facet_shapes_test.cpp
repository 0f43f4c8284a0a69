// SPDX-License-Identifier: GPL-3.0-or-later
// Facets measured in batches, against the formulas for one at a time.
#include "geometry/arctangent.hpp"
#include "geometry/solid_angle.hpp"
#include "network/facets.hpp"
#include "pfv/dense_packing.hpp"
#include "physics/facet_shapes.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace facet_shapes_test {
namespace {

TEST(Arctangent, IsThatOfTheLibraryToThreeUnitsInTheLastPlace) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  for (int k = 0; k < 100000; ++k) {
    const double angle = -3.14159 + 6.28318e-5 * k, scale = std::exp(0.01 * (k % 2000) - 10.0);
    const double y = scale * std::sin(angle), x = scale * std::cos(angle);
    EXPECT_NEAR(pfv::arctangent(y, x), std::atan2(y, x), 3.0 * epsilon * std::abs(std::atan2(y, x)))
        << y << ' ' << x;
  }
  EXPECT_EQ(pfv::arctangent(0.0, 0.0), 0.0);
  EXPECT_EQ(pfv::arctangent(0.0, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(pfv::arctangent(3.0, 0.0), std::acos(0.0));
  EXPECT_DOUBLE_EQ(pfv::arctangent(0.0, -2.0), std::acos(-1.0));
  EXPECT_DOUBLE_EQ(pfv::arctangent(-1e-300, -2.0), -std::acos(-1.0));
}

TEST(FacetShapes, AreThoseOfTheirTriangles) {
  const support::Stages s = support::stages_of(pfv::dense_packing(60), pfv::Box{});
  const pfv::PoreNetwork& network = s.network;
  std::vector<int> facets, throats;
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      if (!pfv::is_wall(network.facet_vertices[f][2])) facets.push_back(f), throats.push_back(t);
  ASSERT_GT(facets.size(), 3u * pfv::facet_batch);
  const std::size_t count = pfv::facet_batch - 5;  // not a full batch
  std::vector<pfv::FacetShape> shapes(count);
  for (std::size_t first = 0; first + count <= facets.size(); first += count) {
    pfv::measure_facets(network, s.spheres, &facets[first], &throats[first],
                        static_cast<int>(count), shapes.data());
    for (std::size_t i = 0; i < count; ++i) {
      const pfv::FacetShape& shape = shapes[i];
      const auto& facet = network.facet_vertices[facets[first + i]];
      const Eigen::Vector3d area = pfv::area_vector(facet, s.spheres);
      EXPECT_NEAR(shape.area, area.norm(), 1e-14);
      EXPECT_LT((shape.normal - area.normalized()).norm(), 1e-11);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d u = s.spheres.towards(facet[k], facet[(k + 1) % 3]);
        const Eigen::Vector3d v = s.spheres.towards(facet[k], facet[(k + 2) % 3]);
        EXPECT_NEAR(shape.side[k], u.norm(), 1e-15);
        EXPECT_NEAR(shape.angle[k], std::atan2(u.cross(v).norm(), u.dot(v)), 1e-12);
        for (int side = 0; side < 2; ++side) {
          const Eigen::Vector3d out =
              network.pore_centres.col(network.throat_pores[throats[first + i]][side]) -
              s.spheres.centres.col(facet[k]);
          const double sign = side == 0 ? -1.0 : 1.0;
          EXPECT_NEAR(shape.solid_angle[k][side], sign * pfv::solid_angle(u, v, out), 1e-10);
          EXPECT_NEAR(shape.height[side], sign * area.normalized().dot(out), 1e-12);
        }
      }
    }
  }
}

}  // namespace
}  // namespace facet_shapes_test

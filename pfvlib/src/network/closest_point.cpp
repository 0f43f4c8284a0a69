// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/closest_point.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace pfv {

namespace {

using ClosestKernel = CGAL::Simple_cartesian<double>;
using ClosestTriangles = std::vector<ClosestKernel::Triangle_3>;
using ClosestPrimitive = CGAL::AABB_triangle_primitive<ClosestKernel, ClosestTriangles::const_iterator>;

ClosestKernel::Point_3 point_of(const Eigen::Vector3d& place) { return {place[0], place[1], place[2]}; }

}  // namespace

struct ClosestPoint::Tree {
  ClosestTriangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<ClosestKernel, ClosestPrimitive>> boxes;
};

ClosestPoint::ClosestPoint(const std::vector<Triangle>& triangles) : tree_(std::make_unique<Tree>()) {
  for (const Triangle& one : triangles)
    tree_->triangles.emplace_back(point_of(one.col(0)), point_of(one.col(1)), point_of(one.col(2)));
  tree_->boxes.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->boxes.build();
  tree_->boxes.accelerate_distance_queries();
}

ClosestPoint::~ClosestPoint() = default;

ClosestPoint::Found ClosestPoint::to(const Eigen::Vector3d& place) const {
  const auto found = tree_->boxes.closest_point_and_primitive(point_of(place));
  return {{found.first.x(), found.first.y(), found.first.z()},
          static_cast<int>(found.second - tree_->triangles.cbegin())};
}

}  // namespace pfv

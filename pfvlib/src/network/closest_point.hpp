// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/mesh_walls.hpp"

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace pfv {

/// Finds the place of a mesh that is nearest to another: a tree of boxes (CGAL), some log(triangles) a query.
class ClosestPoint {
 public:
  struct Found {
    Eigen::Vector3d place;
    int triangle;
  };
  explicit ClosestPoint(const std::vector<Triangle>& triangles);
  ~ClosestPoint();
  Found to(const Eigen::Vector3d& place) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace pfv {

/// Non-owning view of the grains at one instant.
///
/// Column k of `positions` and `velocities` and entry k of `ids` and `radii` belong to one sphere.
/// A row-major N x 3 array (LIGGGHTS' own x and v) maps onto it without a copy.
///
/// | member     | shape | unit | meaning                                              |
/// |------------|-------|------|------------------------------------------------------|
/// | ids        | N     | -    | unique; every error message names spheres by id       |
/// | positions  | 3 x N | m    | centres                                              |
/// | radii      | N     | m    | > 0                                                  |
/// | velocities | 3 x N | m/s  | empty (3 x 0): the grains are at rest and no volume  |
/// |            |       |      | rate is computed                                     |
/// | angular_velocities | 3 x N | rad/s | about the centres; empty (3 x 0): nothing spins |
/// | displaced_ | N     | m³   | what each sphere's lift and the fluid's volume count: |
/// | volumes    |       |      | of spheres that overlap in one rigid body its share   |
/// |            |       |      | of their union (pfv/union_parts.hpp); empty: whole    |
/// |            |       |      | spheres                                               |
/// | bodies     | N     | -    | number of the rigid body that holds the sphere, from  |
/// |            |       |      | 0 on, -1 for none; empty: there are no bodies. What   |
/// |            |       |      | lies within one body is no fluid. On several ranks    |
/// |            |       |      | the same number is the same body                      |
struct Packing {
  using Ids = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>;

  Eigen::Map<const Ids> ids{nullptr, 0};
  Eigen::Map<const Eigen::Matrix3Xd> positions{nullptr, 3, 0};
  Eigen::Map<const Eigen::VectorXd> radii{nullptr, 0};
  Eigen::Map<const Eigen::Matrix3Xd> velocities{nullptr, 3, 0};
  Eigen::Map<const Eigen::Matrix3Xd> angular_velocities{nullptr, 3, 0};
  Eigen::Map<const Eigen::VectorXd> displaced_volumes{nullptr, 0};
  Eigen::Map<const Eigen::VectorXi> bodies{nullptr, 0};

  Eigen::Index size() const { return ids.size(); }
};

/// m; grains in water whose mean diameter is larger are most likely millimetres read as metres.
inline constexpr double largest_usual_diameter = 0.3;

/// Owner of the arrays that a `Packing` looks at: what file readers return.
/// The view is valid as long as the arrays are neither resized nor destroyed.
struct PackingArrays {
  Packing::Ids ids;
  Eigen::Matrix3Xd positions;
  Eigen::VectorXd radii;
  Eigen::Matrix3Xd velocities = Eigen::Matrix3Xd(3, 0);
  Eigen::Matrix3Xd angular_velocities = Eigen::Matrix3Xd(3, 0);
  Eigen::VectorXd displaced_volumes;
  Eigen::VectorXi bodies;

  Packing view() const {
    return {{ids.data(), ids.size()},
            {positions.data(), 3, positions.cols()},
            {radii.data(), radii.size()},
            {velocities.data(), 3, velocities.cols()},
            {angular_velocities.data(), 3, angular_velocities.cols()},
            {displaced_volumes.data(), displaced_volumes.size()},
            {bodies.data(), bodies.size()}};
  }
};

}  // namespace pfv

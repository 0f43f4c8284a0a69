// SPDX-License-Identifier: GPL-3.0-or-later
#include "grains.hpp"

#include "faces.hpp"

#include <algorithm>
#include <new>
#include <numeric>

namespace pfv::python {
namespace {

Numbers<std::int64_t> row_numbers(py::ssize_t count) {
  Numbers<std::int64_t> ids(count);
  std::iota(ids.mutable_data(), ids.mutable_data() + count, 0);
  return ids;
}

/// An Eigen map can be made to look elsewhere in no other way.
template <class Map>
void look_at(Map& map, const Map& other) {
  new (&map) Map(other);
}

}  // namespace

Grains::Grains(const GivenGrains& given)
    : positions_(rows_of_three(given.positions, "positions")),
      radii_(one_each(given.radii, "radii", count())),
      ids_(given.ids.is_none() ? row_numbers(count()) : ids_of(given.ids, count())) {
  if (!given.velocities.is_none()) velocities_ = rows_of_three(given.velocities, "velocities", count());
  if (!given.angular_velocities.is_none())
    angular_velocities_ = rows_of_three(given.angular_velocities, "angular_velocities", count());
  if (!given.displaced_volumes.is_none())
    displaced_volumes_ = one_each(given.displaced_volumes, "displaced_volumes", count());
  if (!given.bodies.is_none()) bodies_ = bodies_of(given.bodies, count());
}

Packing Grains::packing() const {
  return {vector_of(ids_),
          columns_of(positions_),
          vector_of(radii_),
          columns_of(velocities_),
          columns_of(angular_velocities_),
          vector_of(displaced_volumes_),
          {bodies_.data(), bodies_.size()}};
}

Dynamics::Dynamics(const GivenDynamics& given, py::ssize_t spheres, const Container& container) {
  look_at(dynamics_.masses, each(given.masses, "masses", spheres));
  if (given.other_forces.is_none()) {
    Numbers<double> none(std::vector<py::ssize_t>{spheres, 3});
    std::fill_n(none.mutable_data(), none.size(), 0.0);
    kept_.push_back(none);
    look_at(dynamics_.other_forces, columns_of(none));
  } else {
    look_at(dynamics_.other_forces, rows(given.other_forces, "other_forces", spheres));
  }
  if (!given.other_torques.is_none())
    look_at(dynamics_.other_torques, rows(given.other_torques, "other_torques", spheres));
  if (!given.inertias.is_none()) look_at(dynamics_.inertias, each(given.inertias, "inertias", spheres));
  dynamics_.pistons = pistons_of(container, given.pistons);
  dynamics_.bodies = given.bodies;
}

Eigen::Map<const Eigen::Matrix3Xd> Dynamics::rows(py::handle given, const char* name, py::ssize_t spheres) {
  kept_.push_back(rows_of_three(given, name, spheres));
  return columns_of(kept_.back());
}

Eigen::Map<const Eigen::VectorXd> Dynamics::each(py::handle given, const char* name, py::ssize_t spheres) {
  kept_.push_back(one_each(given, name, spheres));
  return vector_of(kept_.back());
}

}  // namespace pfv::python

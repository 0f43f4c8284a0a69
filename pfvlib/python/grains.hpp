// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of Python as the library's packing.
#pragma once

#include "arrays.hpp"
#include "pfv/flow_model.hpp"

#include <memory>
#include <vector>

namespace pfv::python {

/// The arrays of one call, as Python gave them; None where there is none.
struct GivenGrains {
  py::object positions, radii, velocities, angular_velocities, ids, displaced_volumes, bodies;
};

/// Keeps the arrays that its packing looks at.
class Grains {
 public:
  /// Throws as rows_of_three does. Without ids the spheres have the numbers of their rows.
  explicit Grains(const GivenGrains& given);

  py::ssize_t count() const { return positions_.shape(0); }
  Packing packing() const;

 private:
  Numbers<double> positions_, radii_;
  Numbers<double> velocities_ = none(), angular_velocities_ = none(), displaced_volumes_{0};
  Numbers<std::int64_t> ids_;
  Eigen::VectorXi bodies_;

  static Numbers<double> none() { return Numbers<double>(std::vector<py::ssize_t>{0, 3}); }
};

struct GivenDynamics {
  py::object masses = py::none(), other_forces = py::none(), other_torques = py::none(), inertias = py::none(),
             pistons = py::none();
  std::vector<RigidBody> bodies{};
};

/// What staged and implicit steps must know of the grains, with the arrays that it looks at.
class Dynamics {
 public:
  Dynamics(const GivenDynamics& given, py::ssize_t spheres, const Container& container);

  const GrainDynamics& get() const { return dynamics_; }

 private:
  std::vector<Numbers<double>> kept_;
  GrainDynamics dynamics_;

  Eigen::Map<const Eigen::Matrix3Xd> rows(py::handle given, const char* name, py::ssize_t spheres);
  Eigen::Map<const Eigen::VectorXd> each(py::handle given, const char* name, py::ssize_t spheres);
};

}  // namespace pfv::python

// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/long_step.hpp"

#include "pfv/error.hpp"
#include "step/forces.hpp"
#include "step/operators.hpp"

#include <cmath>

namespace pfv {

void check_long_step(const Problem& problem, Coupling coupling) {
  check(problem.options, coupling);
  if (!problem.options.forces)
    throw InputError("a staged or implicit step needs forces: switch Options::forces on");
  refuse_periodic_shear(problem);
}

namespace {

void check_sizes(const GrainDynamics& dynamics, Eigen::Index n) {
  if (dynamics.other_forces.cols() != n || dynamics.masses.size() != n)
    throw InputError("a staged or implicit step needs mass and other force of each of the " +
                     std::to_string(n) + " grains");
  if ((dynamics.other_torques.cols() != 0 && dynamics.other_torques.cols() != n) ||
      (dynamics.inertias.size() != 0 && dynamics.inertias.size() != n))
    throw InputError("a staged or implicit step takes an inertia and other torque for each of the " +
                     std::to_string(n) + " grains, or none");
}

}  // namespace

void check_dynamics(const GrainDynamics& dynamics, const Packing& packing) {
  check_sizes(dynamics, packing.size());
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const std::string sphere = "sphere " + std::to_string(packing.ids[k]);
    if (!dynamics.other_forces.col(k).allFinite() ||
        (dynamics.other_torques.cols() > 0 && !dynamics.other_torques.col(k).allFinite()))
      throw InputError(sphere + ": its other force or torque is not finite; a staged or implicit step "
                                "needs it");
    if (!(dynamics.masses[k] > 0.0) ||
        (dynamics.inertias.size() > 0 && !(dynamics.inertias[k] > 0.0)))
      throw InputError(sphere + ": its mass or inertia is not a positive number; give kg and kg m2");
  }
  for (const Face face : all_faces) {
    const Piston& piston = dynamics.pistons[static_cast<int>(face)];
    if (!(piston.mass > 0.0) || !std::isfinite(piston.other_force))
      throw InputError(std::string("piston ") + name_of(face) +
                       ": its mass must be > 0 (kg) and its other force finite (N)");
  }
}

Matrix6Xd yielding_of(const BuiltNetwork& built, const GrainDynamics& dynamics, double step) {
  const std::vector<int>& columns = built.grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  Matrix6Xd result = no_motion(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int k = columns[i];
    const double inertia = dynamics.inertias.size() > 0
                               ? dynamics.inertias[k]
                               : inertia_of(dynamics.masses[k], built.grains.spheres.radii[i]);
    result.col(i).head<3>().setConstant(step / dynamics.masses[k]);
    result.col(i).tail<3>().setConstant(step / inertia);
  }
  for (const Face face : all_faces) {
    const int f = static_cast<int>(face);
    result(axis_of(face), count + f) = step / dynamics.pistons[f].mass;
  }
  return result;
}

Loads held_loads(const StepTask& task, const Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const std::vector<int>& columns = built.grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  Loads held = no_motion(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    held.col(i).head<3>() = dynamics->other_forces.col(columns[i]);
    if (dynamics->other_torques.cols() > 0)
      held.col(i).tail<3>() = dynamics->other_torques.col(columns[i]);
    if (problem.lifts()) held.col(i).head<3>() += lift_of(problem, packing, columns[i]);
  }
  if (!problem.box.pressure_gradient.isZero(0.0)) held += gradient_loads(built, problem);
  for (const Face face : all_faces) {
    const int f = static_cast<int>(face);
    held.col(count + f).head<3>() =
        dynamics->pistons[f].other_force * Eigen::Vector3d::Unit(axis_of(face)) +
        solution.reference * problem.box.area(face) * outward_normal(face);
  }
  return held;
}

}  // namespace pfv

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

void check_dynamics(const GrainDynamics& dynamics, const Packing& packing, const Container& container) {
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
  for (int f = 0; f < container.face_count(); ++f) {
    const Piston piston = piston_of(dynamics.pistons, f);
    if (!(piston.mass > 0.0) || !std::isfinite(piston.other_force))
      throw InputError("piston " + container.faces[f].name +
                       ": its mass must be > 0 (kg) and its other force finite (N)");
  }
}

int guided_axis(const Container& container, int face) {
  int axis = 0;
  const ContainerFace& piston = container.faces[face];
  if (!(piston.guide.cwiseAbs().maxCoeff(&axis) > 1.0 - 1e-12))
    throw InputError("face " + piston.name +
                     " is a piston: it can be guided along x, y or z alone; prescribe its velocity instead");
  return axis;
}

Matrix6Xd yielding_of(const BuiltNetwork& built, const Problem& problem, const GrainDynamics& dynamics,
                      double step) {
  const std::vector<int>& columns = built.grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  const Container& container = problem.container;
  Matrix6Xd result = no_motion(count, container.face_count());
  for (Eigen::Index i = 0; i < count; ++i) {
    const int k = columns[i];
    const double inertia = dynamics.inertias.size() > 0
                               ? dynamics.inertias[k]
                               : inertia_of(dynamics.masses[k], built.grains.spheres.radii[i]);
    result.col(i).head<3>().setConstant(step / dynamics.masses[k]);
    result.col(i).tail<3>().setConstant(step / inertia);
  }
  for (int f = 0; f < container.face_count(); ++f)
    if (const double mass = piston_of(dynamics.pistons, f).mass; std::isfinite(mass))
      result(guided_axis(container, f), count + f) = step / mass;
  return result;
}

Loads held_loads(const StepTask& task, const Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const std::vector<int>& columns = built.grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  const Container& container = problem.container;
  Loads held = no_motion(count, container.face_count());
  for (Eigen::Index i = 0; i < count; ++i) {
    held.col(i).head<3>() = dynamics->other_forces.col(columns[i]);
    if (dynamics->other_torques.cols() > 0)
      held.col(i).tail<3>() = dynamics->other_torques.col(columns[i]);
    if (problem.lifts()) held.col(i).head<3>() += lift_of(problem, packing, columns[i]);
  }
  if (!problem.container.pressure_gradient.isZero(0.0)) held += gradient_loads(built, problem);
  for (int f = 0; f < container.face_count(); ++f)
    held.col(count + f).head<3>() = piston_of(dynamics->pistons, f).other_force * container.faces[f].guide +
                                    solution.reference * solution.geometry.loads.col(f).head<3>();
  return held;
}

}  // namespace pfv

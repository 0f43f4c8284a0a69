// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/long_step.hpp"

#include "pfv/error.hpp"
#include "step/forces.hpp"
#include "step/operators.hpp"
#include "text/number_text.hpp"

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

Loads ForcedMotion::all(const Loads& loads) const {
  if (!bodies) return held + loads;
  Loads wide = bodies->gathered(held.leftCols(bodies->first) + loads);
  wide.rightCols(bodies->count()) += held.rightCols(bodies->count());
  return wide;
}

Motion ForcedMotion::moved_by(const Loads& loads) const {
  if (!bodies) return start + (yielding.array() * (held + loads).array()).matrix();
  return start + bodies->spread((yielding.array() * all(loads).array()).matrix());
}

namespace {

void check_body(const RigidBody& body, int number, Eigen::Index spheres) {
  const std::string name = "rigid body " + std::to_string(number);
  if (body.arms.cols() != spheres)
    throw InputError(name + ": it has " + std::to_string(body.arms.cols()) + " arms for " + std::to_string(spheres) +
                     " spheres; give one for each sphere of the packing that it holds");
  if (!body.arms.allFinite() || !body.other_force.allFinite() || !body.other_torque.allFinite())
    throw InputError(name + ": an arm, its other force or torque is not finite");
  if (!(body.masses.array() > 0.0).all() || !(body.inertias.array() > 0.0).all())
    throw InputError(name + ": a mass or inertia is not a positive number; give kg and kg m2");
  if (!((body.axes.transpose() * body.axes).isIdentity(1e-6)))
    throw InputError(name + ": its axes are not of unit length and square to each other");
}

}  // namespace

namespace {

/// Of each sphere that this rank has in its packing its body, or -1.
Eigen::Map<const Eigen::VectorXi> held_here(const BuiltNetwork& built) {
  const Eigen::VectorXi& held = built.grains.held;
  return {held.data(), built.halo && held.size() > 0 ? built.halo->own_count() : held.size()};
}

}  // namespace

void check_bodies(const std::vector<RigidBody>& bodies, const BuiltNetwork& built) {
  const auto held = held_here(built);
  std::vector<Eigen::Index> spheres(bodies.size(), 0);
  for (Eigen::Index k = 0; k < held.size(); ++k) {
    if (held[k] < 0) continue;
    if (held[k] >= static_cast<int>(bodies.size()))
      throw InputError("the packing has spheres of a rigid body " + std::to_string(held[k]) + ", but mass and inertia of " +
                       std::to_string(bodies.size()) + " bodies are given; give those of each body, in the order of "
                       "Packing::bodies");
    ++spheres[held[k]];
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (spheres[b] == 0 && !built.share.ranks)
      throw InputError("rigid body " + std::to_string(b) + ": it holds no sphere of the packing; leave it away");
    check_body(bodies[b], static_cast<int>(b), spheres[b]);
  }
}

void take_bodies(BuiltNetwork& built, const Problem& problem, const std::vector<RigidBody>& bodies) {
  if (!built.grains.any_bodies || built.operators.bodies) return;
  const double most = built.share.largest(static_cast<double>(bodies.size()));
  built.share.together([&] {
    if (static_cast<double>(bodies.size()) != most)
      throw InputError("the ranks give " + std::to_string(bodies.size()) + " and " + detail::number_text(most) +
                       " rigid bodies; each gives all of them, with the arms of the spheres that it has");
  });
  built.operators.bodies = rigid_bodies(held_here(built), built.grains.columns, problem.container.face_count(), bodies);
  built.operators.bodies->ranks = built.share.ranks;
}

const RigidBodies* bodies_of(const BuiltNetwork& built) {
  return built.operators.bodies ? &*built.operators.bodies : nullptr;
}

Matrix6Xd yielding_of_bodies(const std::vector<RigidBody>& bodies, double step) {
  Matrix6Xd result(6, static_cast<Eigen::Index>(bodies.size()));
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    auto own = result.col(static_cast<Eigen::Index>(b));
    own.head<3>() = step * bodies[b].masses.cwiseInverse();
    own.tail<3>() = step * bodies[b].inertias.cwiseInverse();
  }
  return result;
}

Eigen::Index own_count(const StepTask& task) {
  return task.built.halo ? task.built.halo->own_count() : task.packing.size();
}

namespace {

void check_grains(const GrainDynamics& dynamics, const Packing& packing, Eigen::Index own) {
  check_sizes(dynamics, own);
  for (Eigen::Index k = 0; k < own; ++k) {
    const std::string sphere = "sphere " + std::to_string(packing.ids[k]);
    if (!dynamics.other_forces.col(k).allFinite() ||
        (dynamics.other_torques.cols() > 0 && !dynamics.other_torques.col(k).allFinite()))
      throw InputError(sphere + ": its other force or torque is not finite; a staged or implicit step "
                                "needs it");
    if (!(dynamics.masses[k] > 0.0) ||
        (dynamics.inertias.size() > 0 && !(dynamics.inertias[k] > 0.0)))
      throw InputError(sphere + ": its mass or inertia is not a positive number; give kg and kg m2");
  }
}

void check_pistons(const GrainDynamics& dynamics, const Container& container) {
  for (int f = 0; f < container.face_count(); ++f) {
    const Piston piston = piston_of(dynamics.pistons, f);
    if (!(piston.mass > 0.0) || !std::isfinite(piston.other_force))
      throw InputError("piston " + container.faces[f].name +
                       ": its mass must be > 0 (kg) and its other force finite (N)");
  }
}

}  // namespace

void check_dynamics(const StepTask& task) {
  task.built.share.together([&] {
    check_grains(*task.dynamics, task.packing, own_count(task));
    check_pistons(*task.dynamics, task.problem.container);
  });
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
  const std::optional<RigidBodies>& bodies = built.operators.bodies;
  Matrix6Xd result = no_motion(count, container.face_count() + (bodies ? bodies->count() : 0));
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!built.share.owns_sphere(static_cast<int>(i))) continue;  // its owner moves it
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
  if (!bodies) return result;
  for (const auto& member : bodies->members) result.col(member.sphere).setZero();
  result.rightCols(bodies->count()) = yielding_of_bodies(dynamics.bodies, step);
  return result;
}

namespace {

/// On the bodies, beside what acts on the spheres of the network: their own loads, and those on spheres that the
/// fluid leaves out.
Loads held_by_bodies(const StepTask& task, const RigidBodies& bodies) {
  const GrainDynamics& dynamics = *task.dynamics;
  const ActiveGrains& grains = task.built.grains;
  Loads held = Loads::Zero(6, bodies.count());
  const auto add = [&](int b, const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
    held.col(b).head<3>() += force;
    held.col(b).tail<3>() += bodies.axes[b].transpose() * torque;
  };
  std::vector<Eigen::Index> seen(bodies.count(), 0);
  std::size_t next = 0;
  const auto of_sphere = held_here(task.built);
  for (int k = 0; k < of_sphere.size(); ++k) {
    const bool active = next < grains.columns.size() && grains.columns[next] == k;
    next += active;
    const int b = of_sphere[k];
    if (b < 0) continue;
    const Eigen::Vector3d arm = dynamics.bodies[b].arms.col(seen[b]++), force = dynamics.other_forces.col(k);
    if (active) continue;
    add(b, force, arm.cross(force));
    if (dynamics.other_torques.cols() > 0) add(b, Eigen::Vector3d::Zero(), dynamics.other_torques.col(k));
  }
  if (bodies.ranks) bodies.ranks->add(held.data(), static_cast<std::size_t>(held.size()));
  for (int b = 0; b < bodies.count(); ++b) add(b, dynamics.bodies[b].other_force, dynamics.bodies[b].other_torque);
  return held;
}

}  // namespace

Loads held_loads(const StepTask& task, const Solution& solution) {
  const auto& [built, problem, packing, dynamics, work] = task;
  const std::vector<int>& columns = built.grains.columns;
  const auto count = static_cast<Eigen::Index>(columns.size());
  const Container& container = problem.container;
  const std::optional<RigidBodies>& bodies = built.operators.bodies;
  const Eigen::Index wide = bodies ? bodies->count() : 0;
  Loads held = no_motion(count, container.face_count() + wide);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!built.share.owns_sphere(static_cast<int>(i))) continue;
    held.col(i).head<3>() = dynamics->other_forces.col(columns[i]);
    if (dynamics->other_torques.cols() > 0)
      held.col(i).tail<3>() = dynamics->other_torques.col(columns[i]);
    if (problem.lifts()) held.col(i).head<3>() += lift_of(problem, packing, columns[i]);
  }
  if (!problem.container.pressure_gradient.isZero(0.0)) held.leftCols(held.cols() - wide) += gradient_loads(built, problem);
  for (int f = 0; f < container.face_count(); ++f)
    held.col(count + f).head<3>() = piston_of(dynamics->pistons, f).other_force * container.faces[f].guide +
                                    solution.reference * solution.geometry.loads.col(f).head<3>();
  if (bodies) held.rightCols(wide) = held_by_bodies(task, *bodies);
  return held;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: does a proportional servo on a face swing against the fluid?
#include "fix_pfv.h"

#include "pfv/error.hpp"

#include "error.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <string>

namespace LAMMPS_NS {

namespace {

/// Along the ways that pistons would be guided.
Eigen::VectorXd along_guides(const std::vector<Eigen::Vector3d>& forces, const pfv::Container& container) {
  Eigen::VectorXd result(container.face_count());
  for (int face = 0; face < container.face_count(); ++face)
    result[face] = forces[face].dot(container.faces[face].guide);
  return result;
}

}  // namespace

/// N s/m: column j is what the fluid sets against each face when face j moves with 1 m/s along its axis and
/// then back in the next flow step, and so on, the grains being too slow to follow. A compressible fluid
/// answers such a motion as it would a steady one in steps of half the length: A p' = B p + q with
/// p' = -p, where A = G + B, is (G + 2 B) p' = q. Where the flow is. Cost: a solve for each face with a gain, and two
/// factorisations where the fluid is compressible.
Eigen::MatrixXd FixPfv::resistances_to(const std::vector<PfvServoGain>& gains) {
  const auto forces_in = [&](const pfv::Container& container) {
    flow_->set_container(container);
    flow_->evaluate(grains_.packing(), 0.5 * flow_step());
    return along_guides(flow_->face_forces(), container);
  };
  const int faces = container_.face_count();
  Eigen::MatrixXd resistances = Eigen::MatrixXd::Zero(faces, faces);
  const Eigen::VectorXd at_present = forces_in(container_);
  for (int face = 0; face < faces; ++face) {
    if (!(gains[face].gain > 0.0)) continue;
    pfv::Container moved = container_;
    moved.faces[face].velocity += moved.faces[face].guide;
    resistances.col(face) = at_present - forces_in(moved);
  }
  flow_->set_container(container_);
  return resistances;
}

/// A proportional servo answers the force F of a step with v = K (target - F) in the next, the fluid that
/// with F = R v: where an eigenvalue of K R is above 1, v changes its sign in each step and grows, up to
/// vel_max. Dashpots and stiffness of the contacts take their own part of that 1. Where the flow is, before
/// its first call of the setup.
void FixPfv::check_servos() {
  constexpr double left_to_contacts = 0.5;
  const std::vector<PfvServoGain> gains = faces_.proportional_gains();
  const int faces = static_cast<int>(gains.size());
  Eigen::VectorXd roots(faces);
  for (int face = 0; face < faces; ++face) roots[face] = std::sqrt(gains[face].gain);
  if (!settings_.steps.time_step_check || roots.isZero(0.0)) return;
  const Eigen::MatrixXd resistances = resistances_to(gains);
  // K R has the eigenvalues of this, which is symmetric as far as S is the transpose of E
  const Eigen::MatrixXd loop =
      roots.asDiagonal() * (0.5 * (resistances + resistances.transpose())) * roots.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(loop);
  const double swing = solved.eigenvalues()[faces - 1];
  if (!(swing > left_to_contacts)) return;
  int worst;
  solved.eigenvectors().col(faces - 1).cwiseAbs().maxCoeff(&worst);
  const std::string text = swinging_servo(worst, gains[worst], resistances(worst, worst), swing);
  // A servo that the fluid alone cannot bring to its target moves with vel_max until grains help, and
  // only then swings; grains that follow within a step leave less of the resistance than is known here.
  const bool reaches_target = gains[worst].kp <= 1.0 + swing;
  if (swing > 1.0 && reaches_target && settings_.steps.coupling == pfv::Coupling::explicit_step)
    throw pfv::InputError(text);
  warn_of(text);
}

std::string FixPfv::swinging_servo(int face, const PfvServoGain& servo, double resistance,
                                   double swing) const {
  constexpr double calm = 0.25;
  char text[700];
  std::snprintf(text, sizeof text,
                "face %s: the proportional servo '%s' %s against the fluid: its gain of %.4g m/s per N (kp "
                "%.4g) times the fluid's resistance of %.4g N s/m to this face is %.4g, with those of all "
                "servos %.4g; above 1, less what contacts take, the plate is thrown to and fro. Take kp %.3g "
                "(and for other servos as much less), or make it a piston of mass m: kp 0 and ki "
                "target/(vel_max m)",
                face_name(settings_, face).c_str(), settings_.sources[face].fix_id.c_str(),
                swing > 1.0 ? "swings" : "may swing", servo.gain, servo.kp, resistance,
                servo.gain * resistance, swing, servo.kp * calm / swing);
  return text;
}

}  // namespace LAMMPS_NS

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"

#include <Eigen/Core>
#include <string>
#include <vector>

namespace pfv {

// The papers' estimates of the time step: one grain moves, all others are held (Catalano 2012
// sec. 4.2.3; Flow::viscosity_matrices has the V^k). Flow::time_step_limit is what they estimate.

/// 2 M / rho(V), s (thesis eq. 4.15); infinite where nothing resists.
double viscous_time_step(double mass, const Eigen::Matrix3d& viscosity);
/// sqrt(M / rho(K)), s (thesis eq. 2.14; half of what an undamped oscillator bears); infinite without contact.
double contact_time_step(double mass, const Eigen::Matrix3d& stiffness);
/// pi rho d²/(1200 mu) = M/(400 mu r), s: eq. 4.20, which is eq. 4.15 with V = 400 mu d.
double estimated_time_step(double mass, double radius, double viscosity);

/// The time step of a run beside its limits.
struct TimeStepCheck {
  double limit;     ///< of the explicit coupling, s
  double estimate;  ///< the papers', of the most critical grain, s
  double step;      ///< between two solves, s
  int pistons;
  Coupling coupling;
  int stages;
  bool compressible;

  double ratio() const { return step / limit; }
  /// "limit of the explicit coupling ...": one line.
  std::string text() const;
};

/// Of a model that holds a result. `masses` in kg, one a sphere of `packing`; `bodies` in the order of
/// Packing::bodies; `step`, s, between two solves.
/// Cost: that of FlowModel::time_step_limit.
TimeStepCheck check_time_step(FlowModel& flow, const Packing& packing, const Eigen::VectorXd& masses,
                              const std::vector<Piston>& pistons, double step,
                              const std::vector<RigidBody>& bodies = {});

/// Warnings for a host that solves the flow once in `held` of its steps, a line each. `safety`: part of the limit
/// that a step may reach; `remedy`: what it can take instead of a shorter step, or why there is nothing.
std::vector<std::string> warnings_of(const TimeStepCheck& check, int held, double safety,
                                     const std::string& remedy);

/// Linear springs of all contacts, N/m.
struct ContactStiffness {
  double normal = 0.0;      ///< > 0
  double tangential = 0.0;  ///< >= 0
};

/// Springs where spheres overlap each other and the faces, which are walls that do not yield. Along
/// periodic axes spheres touch the nearest image.
class ContactSprings {
 public:
  /// Throws InputError for a stiffness that is not finite, a normal one <= 0 or a tangential one < 0.
  /// Cost: a sort and a sweep along x.
  ContactSprings(const Packing& packing, const Container& container, ContactStiffness stiffness);
  /// K^k of each sphere, N/m, all others held. Rotations are left out.
  std::vector<Eigen::Matrix3d> of_spheres() const;
  /// 2 / omega_max of all spheres together, s: the limit of the contacts alone without dashpots. Infinite
  /// without contacts. `masses` in kg, one a sphere.
  double time_step_limit(const Eigen::VectorXd& masses) const;

 private:
  struct Spring {
    int first, second;  ///< columns; second is -1 for a face
    Eigen::Matrix3d stiffness;
  };
  Eigen::Index spheres_;
  std::vector<Spring> springs_;
};

}  // namespace pfv

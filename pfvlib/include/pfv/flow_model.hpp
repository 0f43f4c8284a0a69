// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"
#include "pfv/fields.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"
#include "pfv/packing.hpp"
#include "pfv/report.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pfv {

class Ranks;

/// Forces of the fluid on the grains, one column a sphere of the packing, in its order, N.
/// Hidden and left-out spheres get buoyancy (hidden ones) or nothing (left-out ones).
struct Forces {
  Eigen::Matrix3Xd total;     ///< pressure + viscous + buoyancy
  Eigen::Matrix3Xd pressure;  ///< with buoyancy; empty unless Options::split_forces
  Eigen::Matrix3Xd viscous;   ///< empty unless Options::split_forces
  Eigen::Matrix3Xd torque;    ///< N m about the centres; empty where forces act at the centres
  Eigen::VectorXd sphere_pressure;  ///< Pa, mean over the sphere's surface; empty unless
                                    ///< Options::sphere_pressure; 0 for hidden and left-out spheres
};

/// What a model needs to go on after a restart with the same packing, besides its settings.
struct FlowState {
  double time = 0.0;                       ///< s
  double strain = 0.0;                     ///< accumulated since the last triangulation
  std::int64_t retriangulations = 0;       ///< triangulations after the first
  /// Pa, in the order of the pores of the present network; of several ranks all on the first, in the order of one rank.
  std::vector<double> pore_pressures;
  double volume_debt = 0.0;                ///< m³ that implicit steps still owe the pores
  double fluid_at_start = 0.0, fluid_came_in = 0.0;  ///< m³, for the fluid's balance; 0: it begins anew
  double served_by_last_network = -1.0;  ///< solves, by which `solver auto` goes; -1: not known
};

/// What one grain alone says of the limit of explicit steps.
struct StiffestGrain {
  double limit = std::numeric_limits<double>::infinity();  ///< s
  std::int64_t id = -1;  ///< the grain's; -1 where none resists
};

/// A face that moves freely along its guide (of a box: its axis): a piston. By default its velocity is prescribed.
struct Piston {
  double mass = std::numeric_limits<double>::infinity();  ///< kg, > 0; infinite: prescribed velocity
  double other_force = 0.0;  ///< N along the guide, beside that of the fluid: load, contacts
};
/// Of face number `face`; faces beyond the list are none.
inline Piston piston_of(const std::vector<Piston>& pistons, int face) {
  return face < static_cast<int>(pistons.size()) ? pistons[face] : Piston{};
}

/// How a rigid body of several spheres (Packing::bodies) yields to forces, and what acts on it beside those on its
/// spheres. Of several ranks each gives all bodies, alike but for the arms: those of the spheres that it has.
struct RigidBody {
  Eigen::Matrix3Xd arms;  ///< m, from its centre of mass to each of its spheres, in the order of the packing
  Eigen::Vector3d masses;    ///< kg, > 0, along x, y, z: its mass; infinite along what it is held
  Eigen::Vector3d inertias;  ///< kg m², > 0, about its principal axes; infinite about what it does not turn
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< the principal axes, one a column
  Eigen::Vector3d other_force = Eigen::Vector3d::Zero();   ///< N: its weight, where that is not on its spheres
  Eigen::Vector3d other_torque = Eigen::Vector3d::Zero();  ///< N m, about its centre of mass
};

/// What a staged or implicit step must know of the grains, one entry (or column) a sphere of the
/// packing, and of the faces.
struct GrainDynamics {
  Eigen::Map<const Eigen::VectorXd> masses{nullptr, 0};  ///< kg, > 0; infinite: a grain whose velocity
                                                         ///< is prescribed (frozen, moved by force)
  Eigen::Map<const Eigen::Matrix3Xd> other_forces{nullptr, 3, 0};  ///< N: contacts, gravity, ...
  std::vector<Piston> pistons{};  ///< in the order of the faces; none: all velocities are prescribed
  Eigen::Map<const Eigen::Matrix3Xd> other_torques{nullptr, 3, 0};  ///< N m; empty: none
  Eigen::Map<const Eigen::VectorXd> inertias{nullptr, 0};  ///< kg m²; empty: 2/5 m r²; infinite: a grain that
                                                           ///< keeps its spin
  /// In the order of Packing::bodies. Masses and inertias of the spheres that they hold are not read.
  std::vector<RigidBody> bodies{};
};

/// How to take a step.
struct Step {
  Coupling coupling = Coupling::explicit_step;
  const GrainDynamics* dynamics = nullptr;  ///< wanted by all but explicit steps
  /// false: nothing is advanced: a steady state, the setup of a run, a timing. With automatic coupling a run
  /// begins so.
  bool commit = true;
  // of automatic coupling
  double safety = 1.0;   ///< part of the explicit limit that explicit steps may reach
  std::string obstacle;  ///< why the host allows explicit steps alone, if so: thrown where others are needed

  static Step with(Coupling coupling, const GrainDynamics& dynamics) {
    return {coupling, &dynamics, true, 1.0, {}};
  }
  static Step trial() { return {Coupling::explicit_step, nullptr, false, 1.0, {}}; }
  static Step trial(Coupling coupling, const GrainDynamics& dynamics) {
    return {coupling, &dynamics, false, 1.0, {}};
  }
};

/// A fluid between moving grains, as a host program sees it: grains in, forces out. `Flow` (pore-scale
/// finite volumes) and `DarcyGrid` (a coarse grid) are the two implementations; a host that needs no
/// more than this works with either.
///
/// Every method throws InputError (bad packing, a pressure that nothing determines) or SolverError;
/// after a throw the model holds no result until the next successful call.
class FlowModel {
 public:
  virtual ~FlowModel() = default;

  /// The forces of a step of `dt` (s, > 0; with `commit` false 0 means a steady state). A committed step advances
  /// the fluid by dt:
  ///
  /// * explicit: to the instant at which the grains are at `packing`, whose velocities are the means over dt
  ///   (backward Euler, thesis eq. 4.8). Stable below `time_step_limit`.
  /// * staged: `packing.velocities` are those of the instant from which the host will apply the forces over dt
  ///   (leapfrog: v(n+1/2)); the drag is integrated over the step in Chebyshev sub-stages on the kept factor, the
  ///   other forces held, and the forces returned are their mean. Stable where the contacts are; below the limit
  ///   it is explicit. Cost: about 1.6 sqrt(dt / limit) solves.
  /// * implicit: the same velocities; pressures and the velocities that follow from all forces are found together
  ///   with the denser matrix A = G + theta dt S^T M^-1 S, factored anew when a mass or dt changes. Continuity
  ///   holds exactly for v(n+1/2) + theta (v(n+3/2) - v(n+1/2)), so that over many steps the volumes of fluid and
  ///   grains go together. Cost: one solve of A. With shear viscous forces the velocities of the grains stay
  ///   unknowns beside the pressures, at about the same cost; with torques too, two to three times that.
  ///
  /// The result is valid until the next call. Throws InputError for a coupling that the model does not have.
  virtual const Forces& advance(const Packing& packing, double dt, const Step& step = {}) = 0;
  /// The coupling and the sub-stages of the last call.
  virtual Coupling coupling() const { return Coupling::explicit_step; }
  virtual int stages() const { return 1; }

  /// An explicit step, and the same without advancing anything.
  const Forces& step(const Packing& packing, double dt) { return advance(packing, dt); }
  const Forces& evaluate(const Packing& packing, double dt = 0.0) {
    return advance(packing, dt, Step::trial());
  }

  /// Discards what was derived from the packing; the next call makes it anew.
  virtual void rebuild() = 0;

  /// New positions, velocities or boundary values of faces, patches and regions. Values cost nothing;
  /// another kind of boundary, another wall type, or other extents than velocities explain lead to a rebuild. Positions
  /// that they explain take effect at the next rebuild.
  virtual void set_container(const Container& container) = 0;
  void set_box(const Box& box) { set_container(box); }
  virtual const Container& container() const = 0;
  virtual const Fluid& fluid() const = 0;

  virtual double time() const = 0;    ///< s, that was advanced
  virtual double strain() const = 0;  ///< pore strain since the last rebuild
  virtual FlowState state() const = 0;  ///< collective on several ranks
  /// Takes up a stored state. The next step throws InputError where its packing gives another number of pores
  /// than there are `pore_pressures`; none is a fluid that begins anew.
  virtual void set_state(FlowState state) = 0;

  // results of the last call
  virtual const Forces& forces() const = 0;
  virtual const std::vector<FaceResult>& faces() const = 0;
  /// Force of the fluid on each face alone, N: cheap enough for every step.
  virtual std::vector<Eigen::Vector3d> face_forces() const = 0;
  /// Pa, at a place (m). Throws InputError outside the container.
  virtual double pressure_at(const Eigen::Vector3d& place) const = 0;
  /// Mean pressure (Pa) over the plane (axis 0-2, position in m); NaN-free: throws InputError for a
  /// plane that cuts nothing.
  virtual double plane_pressure(int axis, double position) const = 0;
  /// Mean pressure over the fluid's volume, Pa.
  virtual double mean_pressure() const = 0;
  /// The limit of the explicit coupling, dt < 2 / lambda_max of the drag, s, by Lanczos' iteration on
  /// the kept factor (masses in kg, one a sphere of the last packing; faces that are pistons count with
  /// theirs; spheres of rigid bodies move with these, and their own masses are not read). Infinite where nothing
  /// resists.
  virtual double time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons = {},
                                 const std::vector<RigidBody>& bodies = {}) = 0;
  /// A bound from above of that limit: the largest that the pressure of one pore and the motion of one free grain give.
  /// Where a pore that nearly closes makes the limit it is within some per cent of it, else several times as much. Cost:
  /// two passes over the network. For a model that has no such bound infinite. Throws InputError where the number
  /// of masses is not that of the packing's spheres.
  virtual StiffestGrain stiffest_grain(const Eigen::VectorXd& /*masses*/) { return {}; }
  virtual std::int64_t retriangulations() const = 0;  ///< rebuilds after the first
  virtual std::vector<int> hidden() const = 0;  ///< columns of the packing that the fluid cannot see
  /// Hidden spheres plus those left out because their centre is outside the container.
  virtual std::int64_t hidden_or_outside() const = 0;

  /// Balances, permeability, counts, times of everything done so far.
  virtual Report report() const = 0;
  /// The fields of the last call, to be drawn or written.
  virtual FieldGrid fields() const = 0;
  /// What the cells of that grid are: "pores" or "cells".
  virtual const char* field_name() const = 0;
};

}  // namespace pfv

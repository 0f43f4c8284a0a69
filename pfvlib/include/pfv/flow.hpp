// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/fluid.hpp"
#include "pfv/network.hpp"
#include "pfv/options.hpp"
#include "pfv/packing.hpp"
#include "pfv/report.hpp"

#include <memory>
#include <vector>

namespace pfv {

/// Forces of the fluid on the grains, one column a sphere of the packing, in its order, N.
/// Hidden and left-out spheres get buoyancy (hidden ones) or nothing (left-out ones).
struct Forces {
  Eigen::Matrix3Xd total;     ///< pressure + viscous + buoyancy
  Eigen::Matrix3Xd pressure;  ///< with buoyancy; empty unless Options::split_forces
  Eigen::Matrix3Xd viscous;   ///< empty unless Options::split_forces
  Eigen::VectorXd sphere_pressure;  ///< Pa, mean over the sphere's surface; empty unless
                                    ///< Options::sphere_pressure; 0 for hidden and left-out spheres
};

/// What a Flow must remember to go on after a restart with the same packing, besides its settings.
struct FlowState {
  double time = 0.0;                       ///< s
  double strain = 0.0;                     ///< accumulated since the last triangulation
  std::int64_t retriangulations = 0;       ///< triangulations after the first
  std::vector<double> pore_pressures;      ///< Pa, in the order of the pores of the present network
};

/// What a staged step must know of the grains, one entry (or column) a sphere of the packing.
struct GrainDynamics {
  Eigen::Map<const Eigen::VectorXd> masses{nullptr, 0};  ///< kg, > 0; infinite: a grain whose velocity
                                                         ///< is prescribed (frozen, moved by force)
  Eigen::Map<const Eigen::Matrix3Xd> other_forces{nullptr, 3, 0};  ///< N: contacts, gravity, ...
};

struct FlowData;

/// Flow through the pores of a moving packing: the one owner of state, who alone knows what is stale.
///
///     pfv::Flow flow(box, fluid, options);
///     loop {
///       flow.set_box(box);                         // where faces, pressures or velocities changed
///       const pfv::Forces& f = flow.step(packing, dt);
///     }
///     flow.report();
///
/// The first call triangulates, orders, factors and solves. Later ones keep network, conductances,
/// factor, E and S, and cost one right-hand side, one pair of triangular solves and one S p, until
/// the accumulated pore strain passes Options::retriangulation_strain, until spheres appear, vanish,
/// enter or leave the box or change their radius by more than that strain / 3, until a sphere is
/// displaced by more than its radius, or until `rebuild` asks for it.
///
/// Every method throws InputError (bad packing, a pressure that nothing determines) or SolverError;
/// after a throw the Flow holds no result until the next successful call.
class Flow {
 public:
  Flow(Box box, Fluid fluid, Options options = {});
  ~Flow();
  Flow(Flow&&) noexcept;
  Flow& operator=(Flow&&) noexcept;

  /// Advances the fluid by `dt` > 0 (s) to the instant at which the grains are at `packing`.
  /// `packing.velocities` are the mean velocities over dt (method: backward Euler, thesis eq. 4.8).
  /// Advances time, strain and stored pressures. The result is valid until the next call.
  const Forces& step(const Packing& packing, double dt);

  /// The same advance where dt may exceed `time_step_limit`: the drag of the fluid is integrated over
  /// the step in Chebyshev sub-stages on the kept factor, with the other forces held, and the forces
  /// returned are their mean over the step. `packing.velocities` must be those of the instant from
  /// which the host will apply the forces over dt (leapfrog: v(n+1/2)). Below the limit this is
  /// `step`. Cost: about 1.6 sqrt(dt / limit) solves a step. Verwer 1996, eqs. of the first-order RKC.
  const Forces& step_staged(const Packing& packing, double dt, const GrainDynamics& grains);
  /// The same without advancing anything: the setup of a run.
  const Forces& evaluate_staged(const Packing& packing, double dt, const GrainDynamics& grains);
  /// Sub-stages of the last step.
  int stages() const;

  /// The same solve without advancing anything: a steady state, the setup of a run, a repeated
  /// timing. `dt` is needed (> 0) only for a compressible fluid.
  const Forces& evaluate(const Packing& packing, double dt = 0.0);

  /// Discards the network; the next call triangulates anew. Stored pressures are carried over so that
  /// the sum of fluid volume times pressure is conserved.
  void rebuild();

  /// New positions, velocities or boundary values of the faces and patches. Values cost nothing;
  /// another kind of boundary, another wall type, or other rectangles lead to a rebuild. Positions
  /// take effect at the next triangulation (between two, faces move with the network, like grains).
  void set_box(const Box& box);
  const Box& box() const;
  const Fluid& fluid() const;
  const Options& options() const;
  void set_retriangulation_strain(double strain);

  double time() const;
  double strain() const;
  FlowState state() const;
  /// Takes up a stored state; `pore_pressures` must belong to the network that the next packing gives.
  void set_state(FlowState state);

  // results of the last call
  const Forces& forces() const;
  /// Flux and force of each face. Cost, once a call: one solve (which takes the fluxes beyond the
  /// round-off of the pressures) and two passes over the throats.
  const std::array<FaceResult, 6>& faces() const;
  /// Force of the fluid on each face alone, N: cheap enough for every step.
  std::array<Eigen::Vector3d, 6> face_forces() const;
  /// Pa, one entry a pore of `network()`.
  const Eigen::VectorXd& pore_pressures() const;
  /// Pressure of the tetrahedron that contains the place (m). Throws InputError outside the box.
  double pressure_at(const Eigen::Vector3d& place) const;
  /// Mean pressure over the pores that the plane (axis 0-2, position in m) cuts; NaN-free: throws
  /// InputError when it cuts none.
  double plane_pressure(int axis, double position) const;
  /// Mean pressure over all pores, weighted with their volume, Pa.
  double mean_pressure() const;
  /// The limit of the explicit coupling, dt < 2 / lambda_max(M^-1 S G^-1 E), s, by power
  /// iteration on the kept factor (masses in kg, one a sphere of the last packing). Infinite where
  /// nothing is unknown. Cost: some 20 to 40 solves for a new network, none when it was asked before.
  double time_step_limit(const Eigen::VectorXd& masses);
  std::int64_t retriangulations() const;
  /// Hidden spheres plus those left out because their centre is outside the box.
  std::int64_t hidden_or_outside() const;

  /// The network in use: cells refer to spheres by their column in the packing it was built from.
  const PoreNetwork& network() const;
  /// Conductance g/L of each throat, m³/(Pa s).
  const std::vector<double>& throat_conductances() const;
  /// Flow rate of each throat, from its first pore to its second, m³/s. Cost: as faces().
  std::vector<double> throat_fluxes() const;
  /// Volume of each pore's fluid, m³.
  Eigen::VectorXd pore_volumes() const;

  /// Balances, permeability, counts, times of everything done so far. Cost: one pass over the network
  /// and, the first time after a triangulation, the exact union of the spheres.
  Report report() const;

 private:
  std::unique_ptr<FlowData> data_;
};

}  // namespace pfv

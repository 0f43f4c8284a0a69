// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow_model.hpp"
#include "pfv/network.hpp"

#include <memory>
#include <vector>

namespace pfv {

/// Of the fluid between two planes, weighted with the pores' volume.
struct SliceMeans {
  int pores = 0;
  double volume = 0.0;                                   ///< of the fluid in these pores, m³
  double pressure = 0.0;                                 ///< Pa
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< relative to the grains, m/s
};

/// Room without spheres, as the pores show it.
struct EmptySpace {
  /// A pore is large from this many mean sphere volumes on. Dense packings have none, loose ones (solid fraction
  /// 0.4) 2 % of their pore volume in them, suspensions of 0.2 17 %; a box around a cylinder 26 % and more.
  static constexpr double spheres_a_pore = 2.0;

  double part = 0.0;     ///< of the pore volume that large pores hold
  double largest = 0.0;  ///< volume of the largest pore, as a multiple of the spheres' mean volume
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< its centre, m
};
/// A sentence where there is much of it (more than 5 %), else nothing.
std::optional<std::string> warning_of(const EmptySpace& empty);

/// Places of a packing's spheres at two instants, a column each, m; in a periodic cell those without wrapping.
struct Displaced {
  Eigen::Matrix3Xd now;
  Eigen::Matrix3Xd before;  ///< not finite: the sphere was not there
  std::optional<Eigen::Vector3d> edges_before{};  ///< of a periodic cell, which cannot do without
  std::optional<Eigen::Vector3d> tilt_before{};   ///< likewise, where it is tilted now; else 0
};

/// Flow through the pores of a moving packing: the only owner of state, which alone knows what is out of date.
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
class Flow final : public FlowModel {
 public:
  /// `ranks` (pfv/mpi.hpp): those that share the packing, null for one that has it. Then each rank calls every method,
  /// in the same order, with its own part of the packing, and gets the forces on it; balances, faces and means are
  /// those of all, pore arrays this rank's. The solver is amg, steps are explicit or staged. Bytes are the same on the same
  /// number of ranks with the same parts.
  Flow(Container container, Fluid fluid, Options options = {}, std::shared_ptr<const Ranks> ranks = nullptr);
  ~Flow() override;
  Flow(Flow&&) noexcept;
  Flow& operator=(Flow&&) noexcept;

  const Forces& advance(const Packing& packing, double dt, const Step& step = {}) override;
  Coupling coupling() const override;
  int stages() const override;

  /// Discards the network; the next call triangulates anew. Stored pressures are carried over so that
  /// the sum of fluid volume times pressure is conserved.
  void rebuild() override;

  /// Between two triangulations faces move with the network, like grains; those that jump lead to a new one.
  void set_container(const Container& container) override;
  const Container& container() const override;
  const Fluid& fluid() const override;
  const Options& options() const;
  /// Another measure begins with a new network.
  void set_retriangulation(StrainMeasure measure, double strain);

  double time() const override;
  double strain() const override;
  FlowState state() const override;
  void set_state(FlowState state) override;

  // results of the last call
  const Forces& forces() const override;
  /// Cost, once a call: one solve (which takes the fluxes beyond the round-off of the pressures) and
  /// two passes over the throats.
  const std::vector<FaceResult>& faces() const override;
  std::vector<Eigen::Vector3d> face_forces() const override;
  /// Pa, one entry a pore of `network()`.
  const Eigen::VectorXd& pore_pressures() const;
  /// Pressure of the tetrahedron that contains the place.
  double pressure_at(const Eigen::Vector3d& place) const override;
  /// Mean over the pores that the plane cuts.
  double plane_pressure(int axis, double position) const override;
  /// Mean over all pores, weighted with their volume.
  double mean_pressure() const override;
  /// dt < 2 / lambda_max(M^-1 S G^-1 E). Cost: some 15 to 35 solves for a new network, none where the
  /// limit of this network is known.
  double time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons = {},
                         const std::vector<RigidBody>& bodies = {}) override;
  StiffestGrain stiffest_grain(const Eigen::VectorXd& masses) override;
  /// V^k of these spheres (columns of the packing): the fluid answers the velocity v of sphere k alone,
  /// all others, faces and imposed pressures held, with the force -V^k v on it, N s/m (thesis
  /// eqs. 4.10-4.16); 0 for hidden and left-out spheres. Cost: three solves a sphere, on the kept factor.
  /// Throws InputError for a column that the packing does not have.
  std::vector<Eigen::Matrix3d> viscosity_matrices(const std::vector<int>& columns) const;
  std::int64_t retriangulations() const override;
  /// Spheres whose power cell is empty.
  std::vector<int> hidden() const override;
  std::int64_t hidden_or_outside() const override;

  /// Mean velocity of the fluid in each pore relative to the grains, m/s: 3 x pores. Cost: as faces() and a
  /// pass over the facets, like all below down to slice_means.
  Eigen::Matrix3Xd pore_velocities() const;
  /// Of the pores around each sphere, weighted with their volume and solid angle, m/s: 3 x N; 0 for
  /// hidden and left-out spheres.
  Eigen::Matrix3Xd sphere_velocities() const;
  /// Mean stress (Pa, tension positive) that the fluid's tractions cause in each sphere, rows xx, yy, zz,
  /// xy, xz, yz: in an even pressure p it is -p, -p, -p, 0, 0, 0. 6 x N; 0 for hidden and left-out ones.
  Eigen::Matrix<double, 6, Eigen::Dynamic> sphere_stresses() const;
  /// Strain of the packing around each sphere (Catalano 2012, eqs. 2.20-2.21): the mean gradient of the displacement
  /// from `before` to `now` in the tetrahedra around it, whose outer facets join its neighbours' centres, taken from the
  /// displacements of these on the facets; symmetric part, over places before, extension positive. Rows xx, yy, zz,
  /// xy, xz, yz: 6 x N; exact where all moved affinely, however far. Tetrahedra with walls or spheres that were not
  /// there take no part; 0 where none is left, where the neighbours' tetrahedra have grown tenfold (they came from
  /// elsewhere), for hidden and left-out spheres. Cost: a pass over the cells. Collective on several ranks. Throws
  /// InputError where columns are not the packing's or a place now is not finite.
  Eigen::Matrix<double, 6, Eigen::Dynamic> sphere_strains(const Displaced& moved) const;
  /// The same as files have it: `strain`, in the order of Field, and `strain_deviator`, sqrt(2/3 e:e) of its part e
  /// without change of volume.
  std::vector<Field> strain_fields(const Displaced& moved) const;
  /// What the fluid does at each sphere, by name, a column a sphere of the packing: `fluid_velocity` (m/s),
  /// `fluid_stress` (Pa, in the order of Field) and `fluid_stress_deviator` (see stress_fields). Cost: as faces() and a
  /// pass over cells and facets.
  std::vector<Field> sphere_fields() const;
  /// Flow rate (m³/s, positive along the axis) between the pores on either side of a plane. In a steady flow
  /// with sealed sides it is the same for every plane. Throws InputError for a plane outside the box.
  double plane_flux(int axis, double position) const;
  /// Means over the pores with their centre in a slice. Throws InputError where there is none.
  SliceMeans slice_means(int axis, double lower, double upper) const;

  /// The network in use: cells refer to spheres by their column in the packing it was built from.
  const PoreNetwork& network() const;
  /// Conductance g/L of each throat, m³/(Pa s).
  const std::vector<double>& throat_conductances() const;
  /// Flow rate of each throat, from its first pore to its second, m³/s. Cost: as faces().
  std::vector<double> throat_fluxes() const;
  /// Volume of each pore's fluid, m³: the pore less the union of the spheres. Cost: a pass over the cells.
  Eigen::VectorXd pore_volumes() const;
  /// Pores that are large beside the spheres: water above a bed, room between a packing and walls that are not its
  /// own. They conduct without the resistance of grains.
  EmptySpace empty_space() const;

  /// Cost: one pass over the network and, the first time after a triangulation, the exact union of
  /// the spheres.
  Report report() const override;
  /// Pores as points, a cell each (pressure, volume of the fluid, velocity), and throats as lines (conductance,
  /// flux). On several ranks each has its own; the far ends of throats to others' pores are points without a cell and
  /// without a volume, so that sums over all ranks are those of the whole. Cost: as faces().
  FieldGrid fields() const override;
  const char* field_name() const override { return "pores"; }

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pfv

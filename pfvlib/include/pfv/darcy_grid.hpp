// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/darcy_options.hpp"
#include "pfv/flow_model.hpp"

#include <memory>
#include <optional>
#include <string>

namespace pfv {

struct DarcyData;

/// Darcy flow on a coarse grid of equal cells that fill the box: the other model of a fluid between
/// grains. Each cell has the porosity of the grains in it and a permeability from Kozeny-Carman;
/// finite volumes give its pressure; the velocity at its centre gives the drag on its grains. It
/// needs cells of several grains and knows pores by their share of the volume only
/// (doc/darcy_grid.md).
///
/// Porosity, permeability and factor are made at the first call and kept until `refresh_every`
/// steps have been taken, until spheres appear, vanish, enter or leave the box, or until `rebuild`
/// asks. In between a call costs one pass over the grains and, where rates or boundary values have
/// changed, one solve. A call after `rebuild` does not count as a step.
///
/// Of `Options` it takes solver, ordering, precision, threads, outside, forces, split_forces (the
/// viscous part is the drag), buoyancy and sphere_pressure; periodic axes are refused.
class DarcyGrid final : public FlowModel {
 public:
  DarcyGrid(Container box, Fluid fluid, DarcyOptions grid, Options options = {});
  ~DarcyGrid() override;
  DarcyGrid(DarcyGrid&&) noexcept;
  DarcyGrid& operator=(DarcyGrid&&) noexcept;

  /// Automatic coupling is explicit here; others are refused.
  const Forces& advance(const Packing& packing, double dt, const Step& step = {}) override;
  void rebuild() override;

  void set_container(const Container& box) override;
  const Container& container() const override;
  const Fluid& fluid() const override;
  const DarcyOptions& grid() const;

  double time() const override;
  double strain() const override { return 0.0; }  ///< the porosity is renewed by a count of steps
  FlowState state() const override;               ///< without pressures: the flow is steady
  void set_state(FlowState state) override;

  // results of the last call
  const Forces& forces() const override;
  const std::vector<FaceResult>& faces() const override;
  std::vector<Eigen::Vector3d> face_forces() const override;
  /// Linear in each cell.
  double pressure_at(const Eigen::Vector3d& place) const override;
  double plane_pressure(int axis, double position) const override;
  double mean_pressure() const override;
  /// With the drag of the last call, linearised. Cost: some 20 to 40 solves. It knows no bodies: the masses of
  /// their spheres are read, like others.
  double time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons = {},
                         const std::vector<RigidBody>& bodies = {}) override;
  /// How often the porosity was renewed after the first call.
  std::int64_t retriangulations() const override;
  std::vector<int> hidden() const override { return {}; }  ///< every grain displaces fluid
  std::int64_t hidden_or_outside() const override;

  // one entry (or column) a cell, x running fastest
  const Eigen::VectorXd& cell_pressures() const;      ///< Pa, at the centre
  const Eigen::VectorXd& cell_porosities() const;     ///< 1 - sum of the spheres' parts / volume
  const Eigen::VectorXd& cell_permeabilities() const; ///< m²
  Eigen::Matrix3Xd cell_velocities() const;  ///< m/s, of the fluid over the total area
  Eigen::Vector3d cell_lengths() const;  ///< m, edges of a cell
  Eigen::Vector3d lower_corner() const;  ///< m, of the first cell

  Report report() const override;
  /// Boxes with pressure, porosity, permeability and velocity.
  FieldGrid fields() const override;
  const char* field_name() const override { return "cells"; }

 private:
  std::unique_ptr<DarcyData> data_;
};

/// A `DarcyGrid` where there is a grid, else a `Flow`, which several ranks may share.
std::unique_ptr<FlowModel> make_flow(const Container& box, const Fluid& fluid, const Options& options,
                                     const std::optional<DarcyOptions>& grid,
                                     std::shared_ptr<const Ranks> ranks = nullptr);

}  // namespace pfv

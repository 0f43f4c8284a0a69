// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/grains.hpp"
#include "darcy_grid/grain_drag.hpp"
#include "darcy_grid/grid_flow.hpp"
#include "pfv/darcy_grid.hpp"
#include "work/work_record.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace pfv {

/// What one renewal of the porosity gives.
struct BuiltGrid {
  ActiveGrains grains;
  Eigen::Vector3d lower;  ///< corner of the box, m
  Grid grid;
  std::vector<GridFace> faces;  ///< on the box
  SolidOverlaps overlaps;
  Eigen::VectorXd porosity, permeability, mobility;
  SymmetricMatrix matrix;
  bool determined = false;  ///< some face has a pressure; else the pressure is 0 everywhere
};

/// What one call has found: a value, with the grid that it was found on.
struct GridSolution {
  Container box;                          ///< as it was then
  bool moving = false;
  double reference = 0.0;           ///< pressure that was subtracted before solving, Pa
  Eigen::VectorXd rates;            ///< m³/s, that moving grains push out of each cell
  Eigen::VectorXd right_side;       ///< m³/s
  Eigen::VectorXd relative;         ///< pressures less the reference, Pa
  GridFields fields;                ///< pressures relative to the reference
  CellState cells;
  Eigen::VectorXd coefficients;     ///< of the drag, one a part of the overlaps
  Eigen::VectorXd pressures;        ///< Pa
  Eigen::Vector3d grain_sum = Eigen::Vector3d::Zero();  ///< N, of the flow on all grains
  std::vector<FaceResult> faces;
};

/// The packing and the box of the last call.
struct SeenPacking {
  std::vector<std::int64_t> ids;
  Eigen::Matrix3Xd places;  ///< m
  Eigen::VectorXd radii;    ///< m
  Container box;
};

/// The state behind DarcyGrid.
struct DarcyData {
  Container box;
  Fluid fluid;
  DarcyOptions grid_options;
  Options options;

  std::unique_ptr<BuiltGrid> built;
  SeenPacking seen;
  std::unique_ptr<LinearSolver> solver;  ///< its ordering serves every renewal of the porosity
  bool stale = true;
  int steps_since_renewal = 0;
  double time = 0.0;
  std::int64_t renewals = 0;  ///< after the first
  WorkRecord work;

  // of the last call
  bool solved = false;
  GridSolution last;
  Forces forces;

  const Forces& compute(const Packing& packing, double at_time, bool advance);
  double time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons);
  void require_result() const;

 private:
  bool needs_renewal(const Packing& packing, bool advance) const;
  bool was_seen(const Packing& packing) const;
  void renew(const Packing& packing);
  void factor();
  void update_rates();
  void refuse_undetermined() const;
  void solve_pressures(double at_time);
  void compute_forces(const Packing& packing, const Eigen::Matrix3Xd& velocities);
  void sum_faces();
  void check_masses(const Eigen::VectorXd& masses) const;
  GridFields response_to(const Eigen::Matrix3Xd& velocities, const Container& moved, CellState& change);
};

/// Balances, counts and times, from the last call.
Report make_report(const DarcyData& flow);

}  // namespace pfv

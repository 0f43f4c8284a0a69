// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pfv {

/// What crosses a face and pushes on it.
struct FaceResult {
  std::string name;
  double flux = 0.0;                                          ///< m³/s, positive INTO the container
  Eigen::Vector3d force_pressure = Eigen::Vector3d::Zero();   ///< N, of the fluid on the face
  Eigen::Vector3d force_viscous = Eigen::Vector3d::Zero();    ///< N, of the fluid on the face
  /// N m, of both forces about the origin of the coordinates; about a place c it is this - c x force. Absent where the
  /// moments of viscous forces are not kept: in boxes without Options::torques, along periodic axes, for darcy_grid.
  std::optional<Eigen::Vector3d> moment;
};

/// What crosses a patch or enters a region.
struct OpeningResult {
  std::string name;                ///< "patch 1 on face zhi", "region 2"
  std::int64_t pores = 0;          ///< or faces of cells
  double flux = 0.0;               ///< m³/s, positive INTO the box
  std::optional<double> pressure;  ///< Pa, mean of its pores; absent without a pore
};

/// A mesh that stands in the fluid (pfv/obstacle.hpp); filled in by the host that put it there.
struct ObstacleResult {
  std::string name;
  std::int64_t spheres = 0;                      ///< in place of it, inside the box
  double volume = 0.0, union_volume = 0.0;       ///< of the mesh's closed parts and of all spheres, m³
  double recess = 0.0, protrusion = 0.0;         ///< m, the furthest that they stay behind it and stand out of it
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();  ///< N, N m about the centre
};

/// How often each piece of work was done since the Flow was made; nothing else was computed.
struct Counts {
  std::int64_t triangulate = 0, order = 0, factor = 0, solve = 0, force_matrix = 0, volume_rate = 0;
  /// Solves beside `solve`, which counts right-hand sides of steps: for what those left (refinement, balances),
  /// for limits of the time step, and for permeability tensors and viscosity matrices.
  std::int64_t correction_solve = 0, limit_solve = 0, query_solve = 0;
  std::int64_t background = 0;  ///< networks that were made beside the steps (Options::rebuild_lag)
  /// Of the present network: throats whose law needed the rule for phi <= 0, gamma <= 0 or A_f <= 0;
  /// tetrahedra that were merged into another pore; pores at rest without any way to a pressure.
  std::int64_t degenerate_throats = 0, merged_pores = 0, pinned_pores = 0;
  std::int64_t open_water = 0;  ///< of the present network: spheres that are braked as in open water
  /// Pores within one rigid body, which are no fluid; pores at bodies that overlaps have closed, which share the
  /// pressure of a neighbour.
  std::int64_t enclosed_pores = 0, joined_pores = 0;
};

/// CPU seconds of the process, all threads, summed over the life of the Flow.
struct Seconds {
  double read = 0, triangulate = 0, throats = 0, assemble = 0, order = 0, factor = 0, solve = 0,
         forces = 0, total = 0;
  std::optional<double> step;  ///< median of the repeated steps
};

struct WallSeconds {
  double total = 0;
  double waited = 0;  ///< of it, for networks that were not ready when their step had come
  std::optional<double> step;
};

/// What was done, how long it took and how well it balances; written as JSON by `write_report`
/// with these names (doc/conventions.md holds units and signs). Absent values mean "has no meaning".
struct Report {
  std::string model = "pfv";  ///< or "darcy_grid", whose pores are its cells
  std::int64_t spheres = 0, hidden = 0, outside = 0, pores = 0, unknowns = 0;
  double porosity = 0, pore_volume = 0, solid_area = 0;
  double inflow = 0, outflow = 0, volume_rate_sum = 0, storage_rate = 0;
  double mass_error = 0;
  /// The fluid in the box, as if it had no pressure: the box less the whole volumes of the grains with their
  /// centre in it; what came in since the first solve, less what left; and what is there beyond its value at
  /// the start, this and what is compressed, over the fluid's volume. Absent for darcy_grid.
  std::optional<double> fluid_volume, fluid_came_in, fluid_balance_error;
  std::optional<double> permeability;
  std::optional<Eigen::Matrix3d> permeability_tensor;  ///< m², periodic boxes; 0 along other axes
  /// Of the permeability, or of the tensor without one: Stokes flow is expected within a factor of 1 + this. Absent without
  /// one, where nothing flows, and where grains are cut by two opposite faces and a rule closed throats between them.
  std::optional<double> permeability_error;
  std::optional<double> degenerate_share;  ///< of the dissipation, in throats that a rule set
  std::vector<std::string> outside_range;  ///< why the estimate may not hold; none: it was checked
  /// rho u d / mu of the throats, with the velocity over their whole area: largest, and mean weighted with the power
  /// lost. The model is that of Stokes flow, below 1 or so. Absent for darcy_grid.
  std::optional<double> reynolds_largest, reynolds_mean;
  Eigen::Vector3d force_sum = Eigen::Vector3d::Zero();
  double force_balance_error = 0;
  double residual = 0;
  std::string solver, ordering, conductance;
  std::string solver_made_of;  ///< which code ordered, analysed, factored and solved
  std::vector<FaceResult> faces;
  std::vector<OpeningResult> openings;  ///< the patches, then the regions, in their order
  std::vector<ObstacleResult> obstacles;
  Counts counts;
  Seconds seconds;
  WallSeconds wall_seconds;
  int threads = 1;
  int ranks = 1;  ///< that shared the packing: seconds are the sum of theirs, wall time and memory those of the largest
  std::int64_t peak_memory_bytes = 0;
};

// The entries of a report, for whoever writes them: `see(name, value)` for each in the order of the file. What is
// not here is not written.
template <class See>
void for_each_entry(const Counts& counts, const See& see) {
  see("triangulate", counts.triangulate);
  see("order", counts.order);
  see("factor", counts.factor);
  see("solve", counts.solve);
  see("correction_solve", counts.correction_solve);
  see("limit_solve", counts.limit_solve);
  see("query_solve", counts.query_solve);
  see("background", counts.background);
  see("force_matrix", counts.force_matrix);
  see("volume_rate", counts.volume_rate);
  see("degenerate_throats", counts.degenerate_throats);
  see("merged_pores", counts.merged_pores);
  see("pinned_pores", counts.pinned_pores);
  see("open_water", counts.open_water);
  see("enclosed_pores", counts.enclosed_pores);
  see("joined_pores", counts.joined_pores);
}
template <class See>
void for_each_entry(const Seconds& seconds, const See& see) {
  see("read", seconds.read);
  see("triangulate", seconds.triangulate);
  see("throats", seconds.throats);
  see("assemble", seconds.assemble);
  see("order", seconds.order);
  see("factor", seconds.factor);
  see("solve", seconds.solve);
  see("forces", seconds.forces);
  see("total", seconds.total);
  see("step", seconds.step);
}
template <class See>
void for_each_entry(const WallSeconds& seconds, const See& see) {
  see("total", seconds.total);
  see("waited", seconds.waited);
  see("step", seconds.step);
}
/// Of a Report, what tells of the flow.
template <class See>
void for_each_flow_entry(const Report& report, const See& see) {
  see("inflow", report.inflow);
  see("outflow", report.outflow);
  see("volume_rate_sum", report.volume_rate_sum);
  see("storage_rate", report.storage_rate);
  see("mass_error", report.mass_error);
  see("fluid_volume", report.fluid_volume);
  see("fluid_came_in", report.fluid_came_in);
  see("fluid_balance_error", report.fluid_balance_error);
  see("permeability", report.permeability);
  see("permeability_tensor", report.permeability_tensor);
  see("permeability_error", report.permeability_error);
  see("degenerate_share", report.degenerate_share);
  see("outside_range", report.outside_range);
  see("reynolds_largest", report.reynolds_largest);
  see("reynolds_mean", report.reynolds_mean);
}
template <class See>
void for_each_entry(const Report& report, const See& see) {
  see("model", report.model);
  see("spheres", report.spheres);
  see("hidden", report.hidden);
  see("outside", report.outside);
  see("pores", report.pores);
  see("unknowns", report.unknowns);
  see("porosity", report.porosity);
  see("pore_volume", report.pore_volume);
  see("solid_area", report.solid_area);
  for_each_flow_entry(report, see);
  see("force_sum", report.force_sum);
  see("force_balance_error", report.force_balance_error);
  see("residual", report.residual);
  see("solver", report.solver);
  see("ordering", report.ordering);
  see("solver_made_of", report.solver_made_of);
  see("conductance", report.conductance);
  see("faces", report.faces);
  see("openings", report.openings);
  see("obstacles", report.obstacles);
  see("counts", report.counts);
  see("seconds", report.seconds);
  see("wall_seconds", report.wall_seconds);
  see("threads", report.threads);
  see("ranks", report.ranks);
  see("peak_memory_bytes", report.peak_memory_bytes);
}

}  // namespace pfv

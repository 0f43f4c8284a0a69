// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/forces.hpp"

#include "problem/container_geometry.hpp"
#include "step/operators.hpp"
#include "work/phase_clock.hpp"

#include <algorithm>

namespace pfv {

Eigen::Vector3d lift_of(const Problem& problem, const Packing& packing, int column) {
  return -problem.fluid.density * displaced_volume(packing, column) * problem.fluid.gravity;
}

namespace {

/// Columns of the active grains among those of the packing; zeros for the others.
template <class Columns>
void spread(const Columns& active, const std::vector<int>& columns, Eigen::Index size,
            Eigen::Matrix3Xd& all) {
  all.resize(3, size);
  const auto count = static_cast<Eigen::Index>(columns.size());
  if (count < size) all.setZero();
  for (Eigen::Index i = 0; i < count; ++i) all.col(columns[i]) = active.col(i);
}

void split(const BuiltNetwork& built, const Problem& problem, const Solution& solution,
           Forces& forces) {
  const Eigen::Vector3d& gradient = problem.container.pressure_gradient;
  Loads of_pressure;
  multiply(*built.operators.pressure_force_matrix, solution.relative_pressures, *problem.team,
           of_pressure);
  if (!gradient.isZero(0.0))
    of_pressure += gradient_forces(built.network, built.vertices, built.throats,
                                   built.operators.viscous_shares, built.grains.spheres.size(),
                                   {true, false, false}, gradient);
  spread(of_pressure.topRows<3>(), built.grains.columns, forces.total.cols(), forces.pressure);
  forces.viscous = forces.total - forces.pressure;
}

/// Of the velocities of the packing or, in stages, of their mean over the step: by linearity the mean
/// force.
void add_shear_forces(const BuiltNetwork& built, const Problem& problem, const Solution& solution,
                      Forces& forces) {
  if (!solution.moving) return;
  const Loads of_grains = shear_forces_of(built, problem.fluid.viscosity, solution.motion);
  const std::vector<int>& columns = built.grains.columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto column = of_grains.col(static_cast<Eigen::Index>(i)).head<3>();
    forces.total.col(columns[i]) += column;
    if (problem.options.split_forces) forces.viscous.col(columns[i]) += column;
  }
}

void add_lift(const BuiltNetwork& built, const Problem& problem, const Packing& packing,
              Forces& forces) {
  for (const int column : built.grains.columns) {
    const Eigen::Vector3d lift = lift_of(problem, packing, column);
    forces.total.col(column) += lift;
    if (problem.options.split_forces) forces.pressure.col(column) += lift;
  }
}

void find_sphere_pressures(const BuiltNetwork& built, const Problem& problem,
                           const Solution& solution, Eigen::Index size, Eigen::VectorXd& all) {
  const SurfacePressure& around = *built.operators.surface_pressure;
  Eigen::VectorXd means;
  multiply(around, solution.pressures, *problem.team, means);
  if (!problem.container.pressure_gradient.isZero(0.0))
    means -= around.offset.transpose() * problem.container.pressure_gradient;
  all.setZero(size);
  const std::vector<int>& columns = built.grains.columns;
  for (std::size_t i = 0; i < columns.size(); ++i)
    all[columns[i]] = means[static_cast<Eigen::Index>(i)];
}

}  // namespace

void find_forces(BuiltNetwork& built, const Problem& problem, const Packing& packing,
                 WorkRecord& work, Solution& solution, Forces& forces) {
  const PhaseClock clock(work.seconds.forces);
  const Options& options = problem.options;
  make_force_matrices(built, problem, work.counts);
  const std::vector<int>& columns = built.grains.columns;
  Loads& loads = solution.loads;
  multiply(*built.operators.force_matrix, solution.relative_pressures, *problem.team, loads);
  if (!problem.container.pressure_gradient.isZero(0.0)) loads += gradient_loads(built, problem);
  if (solution.moving) add_open_water_forces(built, solution.motion, loads);
  join_loads(built, loads);
  spread(loads.topRows<3>(), columns, packing.size(), forces.total);
  if (options.torques) spread(loads.bottomRows<3>(), columns, packing.size(), forces.torque);
  if (options.split_forces) split(built, problem, solution, forces);
  if (options.shear_viscous) add_shear_forces(built, problem, solution, forces);
  if (problem.lifts()) add_lift(built, problem, packing, forces);
  if (options.sphere_pressure)
    find_sphere_pressures(built, problem, solution, packing.size(), forces.sphere_pressure);
}

namespace {

/// Whether the viscous forces on walls have their moments; those in a periodic cell depend on which images are taken.
bool has_wall_moments(const BuiltNetwork& built, const Solution& solution) {
  const auto& periodic = solution.container.periodic;
  return solution.loads.cols() > 0 && built.operators.force_matrix && built.operators.force_matrix->wall_moments &&
         std::none_of(periodic.begin(), periodic.end(), [](bool axis) { return axis; });
}

/// `load`: force and moment about `origin`.
Eigen::Vector3d moment_about_zero(const Vector6d& load, const Eigen::Vector3d& origin) {
  return load.tail<3>() + origin.cross(load.head<3>());
}

}  // namespace

std::vector<FaceResult> face_forces(const BuiltNetwork& built, const Solution& solution) {
  const auto& contacts = built.boundaries.contacts;
  const int spheres = built.grains.spheres.size(), count = solution.container.face_count();
  Matrix6Xd pushes = Matrix6Xd::Zero(6, count);
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (contacts[c].face != PoreBoundaries::inside)
      pushes.col(contacts[c].face) += solution.relative_pressures[contacts[c].pore] *
                                      built.bases.load(static_cast<int>(c));
  if (built.share.ranks) built.share.ranks->add(pushes.data(), static_cast<std::size_t>(pushes.size()));
  const Matrix6Xd on_growth = forces_on_growth(solution.growth, built, solution.relative_pressures);
  const bool moments = has_wall_moments(built, solution);
  std::vector<FaceResult> faces(count);
  for (int f = 0; f < count; ++f) {
    faces[f].name = solution.container.faces[f].name;
    const Vector6d of_pressure =
        pushes.col(f) + on_growth.col(f) + solution.reference * solution.geometry.loads.col(f);
    faces[f].force_pressure = of_pressure.head<3>();
    if (solution.loads.cols() == 0) continue;
    // on a periodic face that moves the fluid's stress, whatever carries it
    const bool periodic = periodic_axis(solution.container, f) >= 0;
    (periodic ? faces[f].force_pressure : faces[f].force_viscous) += solution.loads.col(spheres + f).head<3>();
    if (moments) faces[f].moment = moment_about_zero(of_pressure + solution.loads.col(spheres + f), built.network.origin);
  }
  return faces;
}

}  // namespace pfv

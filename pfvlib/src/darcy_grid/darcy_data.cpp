// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/darcy_data.hpp"

#include "work/phase_clock.hpp"
#include "darcy_grid/kozeny_carman.hpp"
#include "network/pore_boundaries.hpp"
#include "parallel/team.hpp"
#include "pfv/error.hpp"
#include "physics/time_step_limit.hpp"
#include "problem/box_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

Eigen::Matrix3Xd cell_centres(const Grid& grid) {
  Eigen::Matrix3Xd centres(3, grid.size());
  for (int cell = 0; cell < grid.size(); ++cell) centres.col(cell) = grid.centre(cell);
  return centres;
}

/// Columns of the active grains back among those of the packing, zero for the others.
Eigen::Matrix3Xd spread(const Eigen::Matrix3Xd& active, const std::vector<int>& columns,
                        Eigen::Index size) {
  Eigen::Matrix3Xd all = Eigen::Matrix3Xd::Zero(3, size);
  for (std::size_t i = 0; i < columns.size(); ++i)
    all.col(columns[i]) = active.col(static_cast<Eigen::Index>(i));
  return all;
}

}  // namespace

const Forces& DarcyData::compute(const Packing& packing, double at_time, bool advance) {
  const double wall_start = wall_seconds();
  {
    const PhaseClock clock(work.seconds.total);
    solved = false;
    if (needs_renewal(packing, advance)) renew(packing);
    seen.places = packing.positions;
    seen.radii = packing.radii;
    seen.box = box;
    Eigen::Matrix3Xd velocities;
    gather_velocities(packing, built->grains.columns, velocities);
    last.moving = grid_options.grain_motion && !at_rest(packing, box);
    last.cells.carried = last.moving ? grain_velocities(built->overlaps, velocities)
                                     : Eigen::Matrix3Xd(Eigen::Matrix3Xd::Zero(3, built->grid.size()));
    update_rates();
    refuse_undetermined();
    solve_pressures(at_time);
    last.cells.gradient = last.fields.gradient;
    last.cells.discharge =
        -(last.fields.gradient.array().rowwise() * built->mobility.transpose().array());
    if (options.forces) compute_forces(packing, velocities);
    sum_faces();
    last.box = box;
    solved = true;
    time = at_time;
    if (advance) ++steps_since_renewal;
  }
  work.wall_seconds.total += wall_seconds() - wall_start;
  return forces;
}

void DarcyData::require_result() const {
  if (!solved)
    throw InputError("DarcyGrid holds no result: call step() or evaluate() first (the last call "
                     "failed, or there was none)");
}

bool DarcyData::was_seen(const Packing& packing) const {
  return packing.positions == seen.places && packing.radii == seen.radii && same_shape(box, seen.box);
}

/// Steps have the porosity renewed when their number says so; a look at grains or faces that are elsewhere is at those.
bool DarcyData::needs_renewal(const Packing& packing, bool advance) const {
  if (stale || !built || steps_since_renewal >= grid_options.refresh_every) return true;
  if (!same_grains(packing, box, seen.ids, built->grains.columns)) return true;
  if (!advance && !was_seen(packing)) return true;
  return !packing.velocities.allFinite();  // leads to a renewal, whose checks name the sphere
}

/// Porosity, permeability and the factor from the grains as they are now.
void DarcyData::renew(const Packing& packing) {
  check(box);
  auto fresh = std::make_unique<BuiltGrid>();
  {
    const PhaseClock clock(work.seconds.triangulate);
    fresh->grains = select_grains(packing, box, options.outside);
    fresh->lower = box.lower;
    fresh->grid = make_grid(box, grid_options.cells);
    fresh->faces = boundary_faces(fresh->grid, box);
    fresh->overlaps = solid_overlaps(fresh->grains.spheres, fresh->grid);
    ++work.counts.triangulate;
  }
  fresh->porosity = 1.0 - fresh->overlaps.solid.array() / fresh->grid.volume();
  const Spheres& spheres = fresh->grains.spheres;
  if (spheres.size() == 0)
    throw InputError("darcy_grid: there is no grain in the flow box, so that nothing tells the "
                     "permeability; put grains into it");
  const double diameter = 2.0 * spheres.radii.mean();
  fresh->permeability = fresh->porosity.unaryExpr(
      [&](double porosity) { return kozeny_carman(porosity, diameter); });
  fresh->mobility = fresh->permeability / fluid.viscosity;
  if (built) ++renewals;
  built = std::move(fresh);
  seen.ids.assign(packing.ids.data(), packing.ids.data() + packing.size());
  last.cells.porosity = built->porosity;
  last.cells.permeability = built->permeability;
  factor();
  stale = false;
  steps_since_renewal = 0;
}

void DarcyData::factor() {
  last.right_side.resize(0);
  built->determined = has_pressure(built->faces, box);
  {
    const PhaseClock clock(work.seconds.assemble);
    built->matrix = assemble(built->grid, built->faces, box, built->mobility);
  }
  if (!built->determined) return;
  if (!solver) {
    const PhaseClock clock(work.seconds.order);
    solver = make_solver(options, std::make_shared<Team>(options.threads));
    solver->order(built->matrix, cell_centres(built->grid));
    ++work.counts.order;
  }
  const PhaseClock clock(work.seconds.factor);
  solver->factor(built->matrix);
  ++work.counts.factor;
}

void DarcyData::update_rates() {
  const PhaseClock clock(work.seconds.assemble);
  last.rates = Eigen::VectorXd::Zero(built->grid.size());
  if (!last.moving) return;
  last.rates = volume_rates(built->grid, built->faces, box, built->overlaps, last.cells.carried);
  ++work.counts.volume_rate;
}

void DarcyData::refuse_undetermined() const {
  if (built->determined) return;
  bool flux = false;
  for (const GridFace& face : built->faces) {
    const Boundary& boundary = boundary_of(box, face.boundary);
    flux = flux || boundary.drives_flux();
  }
  if (last.moving || flux)
    throw InputError(std::string("darcy_grid: ") +
                     (flux ? "a flux is imposed" : "the grains or faces move") +
                     " and no face or patch has a pressure: nothing determines the pressure; give "
                     "a pressure to a face");
}

/// Solves anew only where rates or boundary values have changed.
void DarcyData::solve_pressures(double at_time) {
  const PhaseClock clock(work.seconds.solve);
  const BuiltGrid& b = *built;
  last.reference = reference_pressure(b.grid, b.faces, box, at_time);
  const GridDrive drive = drive_of(b.grid, b.faces, box, at_time, last.reference);
  const Eigen::VectorXd right =
      right_hand_side(b.grid, b.faces, box, b.mobility, drive, -last.rates);
  if (!b.determined) {
    last.relative = Eigen::VectorXd::Zero(b.grid.size());
    last.right_side = right;
  } else if (last.right_side.size() == 0 || right != last.right_side) {
    last.right_side = right;
    solver->solve(last.right_side, last.relative);
    ++work.counts.solve;
  }
  last.fields = fields_of(b.grid, b.faces, box, b.mobility, drive, last.relative);
  last.pressures = last.relative.array() + last.reference;
}

void DarcyData::compute_forces(const Packing& packing, const Eigen::Matrix3Xd& velocities) {
  const PhaseClock clock(work.seconds.forces);
  const BuiltGrid& b = *built;
  const Spheres& spheres = b.grains.spheres;
  last.coefficients =
      drag_coefficients(b.overlaps, spheres, fluid, grid_options.drag, last.cells, velocities);
  GrainForces grain = grain_forces(b.overlaps, last.coefficients, last.cells, velocities);
  last.grain_sum = grain.pressure.rowwise().sum() + grain.drag.rowwise().sum();
  if (options.buoyancy && !fluid.gravity.isZero(0.0))
    for (int i = 0; i < spheres.size(); ++i)
      grain.pressure.col(i) -=
          displaced_volume(packing, b.grains.columns[i]) * fluid.density * fluid.gravity;
  const Eigen::Index n = packing.size();
  forces.total = spread(grain.pressure + grain.drag, b.grains.columns, n);
  if (options.split_forces) {
    forces.pressure = spread(grain.pressure, b.grains.columns, n);
    forces.viscous = spread(grain.drag, b.grains.columns, n);
  }
  if (!options.sphere_pressure) return;
  forces.sphere_pressure = Eigen::VectorXd::Zero(n);
  for (int s = 0; s < b.overlaps.spheres(); ++s) {
    double sum = 0.0, volume = 0.0;
    for (int i = b.overlaps.begin[s]; i < b.overlaps.begin[s + 1]; ++i) {
      sum += b.overlaps.volume[i] * last.pressures[b.overlaps.cell[i]];
      volume += b.overlaps.volume[i];
    }
    if (volume > 0.0) forces.sphere_pressure[b.grains.columns[s]] = sum / volume;
  }
}

void DarcyData::sum_faces() {
  last.faces.assign(box.faces.size(), {});
  for (std::size_t f = 0; f < box.faces.size(); ++f) last.faces[f].name = box.faces[f].name;
  const BuiltGrid& b = *built;
  for (std::size_t f = 0; f < b.faces.size(); ++f) {
    const auto i = static_cast<Eigen::Index>(f);
    const Face face = b.faces[f].face;
    FaceResult& result = last.faces[static_cast<int>(face)];
    result.flux += last.fields.face_inflow[i];
    result.force_pressure += (last.fields.face_pressure[i] + last.reference) *
                             b.grid.face_area(axis_of(face)) * outward_normal(face);
  }
}

void DarcyData::check_masses(const Eigen::VectorXd& masses) const {
  if (masses.size() != static_cast<Eigen::Index>(seen.ids.size()))
    throw InputError("time step limit: " + std::to_string(masses.size()) + " masses for " +
                     std::to_string(seen.ids.size()) + " spheres; give one a sphere");
  if (!(masses.array() > 0.0).all())
    throw InputError("time step limit: a mass is not a positive number; give kg");
  if (!options.forces) throw InputError("time step limit: switch Options::forces on");
}

/// Change of the pressures where grains and faces of `moved` change their velocities, which `change` gets.
GridFields DarcyData::response_to(const Eigen::Matrix3Xd& velocities, const Container& moved,
                                  CellState& change) {
  const BuiltGrid& b = *built;
  const auto count = static_cast<Eigen::Index>(b.faces.size());
  const GridDrive none{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  Eigen::VectorXd response = Eigen::VectorXd::Zero(b.grid.size());
  change.carried.setZero();
  if (grid_options.grain_motion && b.determined) {
    change.carried = grain_velocities(b.overlaps, velocities);
    solver->solve(-volume_rates(b.grid, b.faces, moved, b.overlaps, change.carried), response);
    ++work.counts.limit_solve;
  }
  GridFields answer = fields_of(b.grid, b.faces, box, b.mobility, none, response);
  change.gradient = answer.gradient;
  change.discharge = -(change.gradient.array().rowwise() * b.mobility.transpose().array());
  return answer;
}

/// The drag of the last call as an operator on small changes of the velocities of grains and faces.
double DarcyData::time_step_limit(const Eigen::VectorXd& masses,
                                  const std::vector<Piston>& pistons) {
  check_masses(masses);
  const BuiltGrid& b = *built;
  const int spheres = b.grains.spheres.size();
  CellState change = last.cells;
  Container moved = box;
  const int face_count = box.face_count();
  const auto drag = [&](const Eigen::VectorXd& v) {
    const Eigen::Matrix3Xd velocities = v.head(3 * spheres).reshaped(3, spheres);
    for (int f = 0; f < face_count; ++f) moved.faces[f].velocity = v[3 * spheres + f] * box.faces[f].guide;
    const GridFields answer = response_to(velocities, moved, change);
    const GrainForces force = grain_forces(b.overlaps, last.coefficients, change, velocities);
    Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(v.size());
    for (int i = 0; i < spheres; ++i)
      acceleration.segment<3>(3 * i) =
          -(force.pressure.col(i) + force.drag.col(i)) / masses[b.grains.columns[i]];
    for (std::size_t f = 0; f < b.faces.size(); ++f) {
      const Face face = b.faces[f].face;
      acceleration[3 * spheres + static_cast<int>(face)] -=
          (is_upper(face) ? 1.0 : -1.0) * answer.face_pressure[static_cast<Eigen::Index>(f)] *
          b.grid.face_area(axis_of(face)) / piston_of(pistons, static_cast<int>(face)).mass;
    }
    return acceleration;
  };
  const double eigenvalue = largest_eigenvalue_of_any(drag, 3 * spheres + face_count);
  return eigenvalue > 0.0 ? 2.0 / eigenvalue : std::numeric_limits<double>::infinity();
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/grain_drag.hpp"

#include "darcy_grid/kozeny_carman.hpp"

#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

/// What flows past a grain, over the total area, m/s.
Eigen::Vector3d flow_past(const CellState& cells, int cell, const Eigen::Vector3d& velocity) {
  return cells.discharge.col(cell) +
         std::max(cells.porosity[cell], 0.0) * (cells.carried.col(cell) - velocity);
}

}  // namespace

Eigen::Matrix3Xd grain_velocities(const SolidOverlaps& overlaps,
                                  const Eigen::Matrix3Xd& velocities) {
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, overlaps.solid.size());
  for (int s = 0; s < overlaps.spheres(); ++s)
    for (int i = overlaps.begin[s]; i < overlaps.begin[s + 1]; ++i)
      sum.col(overlaps.cell[i]) += overlaps.volume[i] * velocities.col(s);
  for (Eigen::Index c = 0; c < overlaps.solid.size(); ++c)
    if (overlaps.solid[c] > 0.0) sum.col(c) /= overlaps.solid[c];
  return sum;
}

Eigen::VectorXd volume_rates(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                             const SolidOverlaps& overlaps,
                             const Eigen::Matrix3Xd& cell_velocities) {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(grid.size());
  for (const Face face : {Face::xhi, Face::yhi, Face::zhi}) {
    const int axis = axis_of(face);
    for (int cell = 0; cell < grid.size(); ++cell) {
      const int other = grid.neighbour(cell, face);
      if (other < 0) continue;
      const double solid = overlaps.solid[cell] + overlaps.solid[other];
      if (solid <= 0.0) continue;
      const double rate = grid.face_area(axis) / solid *
                          (overlaps.solid[cell] * cell_velocities(axis, cell) +
                           overlaps.solid[other] * cell_velocities(axis, other));
      rates[cell] += rate;
      rates[other] -= rate;
    }
  }
  for (const GridFace& face : faces)
    rates[face.cell] += (is_upper(face.face) ? 1.0 : -1.0) *
                        box.faces[static_cast<int>(face.face)].velocity[axis_of(face.face)] *
                        grid.face_area(axis_of(face.face));
  return rates;
}

double di_felice_drag(const Fluid& fluid, double radius, double porosity, double speed) {
  const double e = std::clamp(porosity, smallest_porosity, 1.0);
  const double reynolds = 2.0 * fluid.density * radius * speed / fluid.viscosity;
  const double chi =
      reynolds > 0.0 ? 3.7 - 0.65 * std::exp(-0.5 * std::pow(1.5 - std::log10(reynolds), 2)) : 3.7;
  // C_d rho U, which is finite at rest
  const double root = 0.63 * std::sqrt(fluid.density * speed) +
                      4.8 * std::sqrt(fluid.viscosity / (2.0 * radius));
  return 0.375 / radius * root * root * std::pow(e, -chi);
}

double kozeny_carman_drag(const Fluid& fluid, double permeability, double porosity) {
  return fluid.viscosity * std::max(porosity, 0.0) /
         (permeability * std::max(1.0 - porosity, 1.0 - largest_porosity));
}

Eigen::VectorXd drag_coefficients(const SolidOverlaps& overlaps, const Spheres& spheres,
                                  const Fluid& fluid, DragLaw law, const CellState& cells,
                                  const Eigen::Matrix3Xd& velocities) {
  Eigen::VectorXd coefficients(static_cast<Eigen::Index>(overlaps.cell.size()));
  for (int s = 0; s < overlaps.spheres(); ++s)
    for (int i = overlaps.begin[s]; i < overlaps.begin[s + 1]; ++i) {
      const int cell = overlaps.cell[i];
      const double porosity = cells.porosity[cell];
      coefficients[i] =
          law == DragLaw::kozeny_carman
              ? kozeny_carman_drag(fluid, cells.permeability[cell], porosity)
              : di_felice_drag(fluid, spheres.radii[s], porosity,
                               flow_past(cells, cell, velocities.col(s)).norm());
    }
  return coefficients;
}

GrainForces grain_forces(const SolidOverlaps& overlaps, const Eigen::VectorXd& coefficients,
                         const CellState& cells, const Eigen::Matrix3Xd& velocities) {
  GrainForces forces{Eigen::Matrix3Xd::Zero(3, overlaps.spheres()),
                     Eigen::Matrix3Xd::Zero(3, overlaps.spheres())};
  for (int s = 0; s < overlaps.spheres(); ++s)
    for (int i = overlaps.begin[s]; i < overlaps.begin[s + 1]; ++i) {
      const int cell = overlaps.cell[i];
      forces.pressure.col(s) -= overlaps.volume[i] * cells.gradient.col(cell);
      forces.drag.col(s) +=
          overlaps.volume[i] * coefficients[i] * flow_past(cells, cell, velocities.col(s));
    }
  return forces;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "darcy_grid/grid_flow.hpp"

#include "network/pore_boundaries.hpp"
#include "pfv/error.hpp"

namespace pfv {

namespace {


/// m³/(Pa s) from a cell's centre to its face.
double half_cell(const Grid& grid, int axis, double mobility) {
  return 2.0 * grid.face_area(axis) / grid.lengths[axis] * mobility;
}

double between(const Grid& grid, int axis, double one, double other) {
  return half_cell(grid, axis, one * other / (one + other));
}

double pressure_on(const Grid& grid, const GridFace& face, const Container& box, double time) {
  const Boundary& boundary = boundary_of(box, face.boundary);
  if (!boundary.profile) return boundary.value;
  return boundary.profile(box.lower + middle_of(grid, face), time);
}

}  // namespace

double reference_pressure(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                          double time) {
  double sum = 0.0;
  int count = 0;
  for (const GridFace& face : faces)
    if (boundary_of(box, face.boundary).imposes_pressure()) {
      sum += pressure_on(grid, face, box, time);
      ++count;
    }
  return count > 0 ? sum / count : 0.0;
}

bool has_pressure(const std::vector<GridFace>& faces, const Container& box) {
  for (const GridFace& face : faces)
    if (boundary_of(box, face.boundary).imposes_pressure()) return true;
  return false;
}

GridDrive drive_of(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                   double time, double reference) {
  const auto count = static_cast<Eigen::Index>(faces.size());
  GridDrive drive{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  std::vector<int> shares(first_region(box), 0);
  for (const GridFace& face : faces) ++shares[face.boundary];
  for (std::size_t b = 0; b < shares.size(); ++b) {
    const Boundary& boundary = boundary_of(box, static_cast<int>(b));
    if (boundary.drives_flux() && shares[b] == 0)
      throw InputError(boundary_name(box, static_cast<int>(b)) +
                       ": its flux has no cell to enter, since patches cover it; give the flux to "
                       "another face or use more cells");
  }
  for (Eigen::Index f = 0; f < count; ++f) {
    const Boundary& boundary = boundary_of(box, faces[f].boundary);
    if (boundary.imposes_pressure())
      drive.imposed[f] = pressure_on(grid, faces[f], box, time) - reference;
    if (boundary.imposes_flux())  // all faces of a boundary are equal: they share by number
      drive.inflow[f] = imposed_inflow(box, faces[f].boundary) / shares[faces[f].boundary];
  }
  return drive;
}

SymmetricMatrix assemble(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                         const Eigen::VectorXd& mobility) {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(grid.size());
  for (const GridFace& face : faces)
    if (boundary_of(box, face.boundary).imposes_pressure())
      diagonal[face.cell] += half_cell(grid, axis_of(face.face), mobility[face.cell]);
  // in ascending order of the neighbours' numbers
  constexpr std::array<Face, 3> before{Face::zlo, Face::ylo, Face::xlo};
  constexpr std::array<Face, 3> after{Face::xhi, Face::yhi, Face::zhi};
  SymmetricMatrix matrix;
  for (int cell = 0; cell < grid.size(); ++cell) {
    const auto add = [&](Face face) {
      const int other = grid.neighbour(cell, face);
      if (other < 0) return;
      const double c = between(grid, axis_of(face), mobility[cell], mobility[other]);
      matrix.column.push_back(other);
      matrix.value.push_back(-c);
      diagonal[cell] += c;
    };
    for (const Face face : before) add(face);
    const std::size_t place = matrix.value.size();
    matrix.column.push_back(cell);
    matrix.value.push_back(0.0);
    for (const Face face : after) add(face);
    matrix.value[place] = diagonal[cell];
    matrix.row_begin.push_back(static_cast<int>(matrix.column.size()));
  }
  return matrix;
}

Eigen::VectorXd right_hand_side(const Grid& grid, const std::vector<GridFace>& faces,
                                const Container& box, const Eigen::VectorXd& mobility, const GridDrive& drive,
                                const Eigen::VectorXd& sources) {
  Eigen::VectorXd b = sources;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto i = static_cast<Eigen::Index>(f);
    b[faces[f].cell] += drive.inflow[i];
    if (boundary_of(box, faces[f].boundary).imposes_pressure())
      b[faces[f].cell] +=
          half_cell(grid, axis_of(faces[f].face), mobility[faces[f].cell]) * drive.imposed[i];
  }
  return b;
}

GridFields fields_of(const Grid& grid, const std::vector<GridFace>& faces, const Container& box,
                     const Eigen::VectorXd& mobility, const GridDrive& drive,
                     const Eigen::VectorXd& pressures) {
  GridFields fields;
  fields.gradient = Eigen::Matrix3Xd::Zero(3, grid.size());
  for (const Face face : {Face::xhi, Face::yhi, Face::zhi}) {
    const int axis = axis_of(face);
    for (int cell = 0; cell < grid.size(); ++cell) {
      const int other = grid.neighbour(cell, face);
      if (other < 0) continue;
      const double pressure =
          (mobility[cell] * pressures[cell] + mobility[other] * pressures[other]) /
          (mobility[cell] + mobility[other]);
      fields.gradient(axis, cell) += pressure / grid.lengths[axis];
      fields.gradient(axis, other) -= pressure / grid.lengths[axis];
    }
  }
  fields.face_pressure.resize(static_cast<Eigen::Index>(faces.size()));
  fields.face_inflow.resize(fields.face_pressure.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto i = static_cast<Eigen::Index>(f);
    const int cell = faces[f].cell, axis = axis_of(faces[f].face);
    const double half = half_cell(grid, axis, mobility[cell]);
    const bool open = boundary_of(box, faces[f].boundary).imposes_pressure();
    fields.face_inflow[i] =
        open ? half * (drive.imposed[i] - pressures[cell]) : drive.inflow[i];
    fields.face_pressure[i] =
        open ? drive.imposed[i] : pressures[cell] + drive.inflow[i] / half;
    fields.gradient(axis, cell) +=
        (is_upper(faces[f].face) ? 1.0 : -1.0) * fields.face_pressure[i] / grid.lengths[axis];
  }
  return fields;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/error.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace pfv {

/// A named field: `values.rows()` components, a column for each point or cell. Six components are those of a
/// symmetric tensor in VTK's order: xx, yy, zz, xy, yz, xz.
struct Field {
  std::string name;
  Eigen::MatrixXd values;
};

/// A text for each cell.
struct TextField {
  std::string name;
  std::vector<std::string> values;
};

/// What can be drawn: an unstructured grid with fields on its points and cells.
struct FieldGrid {
  /// VTK's numbers of cells: a point; two points; corners of a face in order; eight of a box, x running fastest.
  enum CellType : std::uint8_t { vertex = 1, line = 3, polygon = 7, voxel = 11 };

  Eigen::Matrix3Xd points;                  ///< m
  std::vector<std::int64_t> connectivity;   ///< points of each cell
  std::vector<std::int64_t> ends;           ///< of each cell in `connectivity`
  std::vector<std::uint8_t> types;          ///< of each cell
  std::vector<std::int64_t> point_ids;      ///< written as `id`, unless there are none
  std::vector<Field> of_points, of_cells;
  std::vector<TextField> texts_of_cells;

  void add_cell(CellType type, const std::vector<std::int64_t>& corners) {
    connectivity.insert(connectivity.end(), corners.begin(), corners.end());
    ends.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

/// As a VTK unstructured grid (.vtu, appended binary), beside the target and renamed at the end: a file is
/// whole or absent. Throws FileError.
void write_fields(const std::string& path, const FieldGrid& grid);

class Ranks;
/// The grids of all ranks: each writes a piece, STEM_RANK.vtu, and one the head that names them, STEM.pvtu, once they
/// are there. They have the same fields. Throws FileError on all ranks, InputError for another ending. Collective.
void write_fields(const std::string& path, const FieldGrid& grid, const Ranks& ranks);

}  // namespace pfv

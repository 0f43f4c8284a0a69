// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "io/vtu_file.hpp"
#include "pfv/darcy_grid.hpp"

#include <vector>

namespace pfv {

namespace {

using detail::VtuFile;

constexpr std::uint8_t voxel_cell = 11;  // VTK_VOXEL: corners with x running fastest

std::int64_t node_number(const std::array<int, 3>& cells, int i, int j, int k) {
  return i + (cells[0] + 1) * (j + (cells[1] + 1) * static_cast<std::int64_t>(k));
}

Eigen::Matrix3Xd node_places(const DarcyGrid& flow) {
  const auto& cells = flow.grid().cells;
  Eigen::Matrix3Xd places(
      3, static_cast<Eigen::Index>(cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1));
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        places.col(node_number(cells, i, j, k)) =
            flow.lower_corner() + Eigen::Vector3d(i, j, k).cwiseProduct(flow.cell_lengths());
  return places;
}

void add_voxels(VtuFile& file, const std::array<int, 3>& cells) {
  std::vector<std::int64_t> connectivity, offsets;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) {
        for (int corner = 0; corner < 8; ++corner)
          connectivity.push_back(node_number(cells, i + (corner & 1), j + (corner >> 1 & 1),
                                             k + (corner >> 2)));
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
  const auto count = static_cast<std::int64_t>(offsets.size());
  const std::vector<std::uint8_t> types(offsets.size(), voxel_cell);
  file.begin("Cells");
  file.add("connectivity", connectivity.data(), 8 * count);
  file.add("offsets", offsets.data(), count);
  file.add("types", types.data(), count);
  file.end("Cells");
}

}  // namespace

void DarcyGrid::write_fields(const std::string& path) const {
  const Eigen::Matrix3Xd places = node_places(*this);
  const Eigen::Index cells = cell_pressures().size();
  VtuFile file(places.cols(), cells);
  file.begin("Points");
  file.add("Points", places.data(), places.cols(), 3);
  file.end("Points");
  add_voxels(file, grid().cells);
  const Eigen::Matrix3Xd velocities = cell_velocities();
  file.begin("CellData");
  file.add("pressure", cell_pressures().data(), cells);
  file.add("porosity", cell_porosities().data(), cells);
  file.add("permeability", cell_permeabilities().data(), cells);
  file.add("velocity", velocities.data(), cells, 3);
  file.end("CellData");
  detail::write_file(path, file.text());
}

}  // namespace pfv

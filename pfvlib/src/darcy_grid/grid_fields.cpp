// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/darcy_grid.hpp"

#include <vector>

namespace pfv {

FieldGrid DarcyGrid::fields() const {
  const auto& cells = grid().cells;
  const auto node = [&](int i, int j, int k) {
    return i + (cells[0] + 1) * (j + (cells[1] + 1) * static_cast<std::int64_t>(k));
  };
  FieldGrid drawn;
  drawn.points.resize(3, node(cells[0], cells[1], cells[2]) + 1);
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        drawn.points.col(node(i, j, k)) =
            lower_corner() + Eigen::Vector3d(i, j, k).cwiseProduct(cell_lengths());
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        drawn.add_cell(FieldGrid::voxel,
                       {node(i, j, k), node(i + 1, j, k), node(i, j + 1, k), node(i + 1, j + 1, k),
                        node(i, j, k + 1), node(i + 1, j, k + 1), node(i, j + 1, k + 1),
                        node(i + 1, j + 1, k + 1)});
  drawn.of_cells = {{"pressure", cell_pressures().transpose()},
                    {"porosity", cell_porosities().transpose()},
                    {"permeability", cell_permeabilities().transpose()},
                    {"velocity", cell_velocities()}};
  return drawn;
}

}  // namespace pfv

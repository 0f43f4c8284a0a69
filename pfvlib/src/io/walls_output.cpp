// SPDX-License-Identifier: GPL-3.0-or-later
// The walls of a container as ParaView draws them.
#include "io/atomic_file.hpp"
#include "pfv/fields.hpp"
#include "pfv/io.hpp"
#include "problem/wall_polygons.hpp"

#include <Eigen/Geometry>
#include <filesystem>

namespace pfv {

namespace {

const char* kind_of(const Boundary& boundary) {
  for (const BoundaryKind& one : boundary_kinds)
    if (one.kind == boundary.kind) return one.name;
  return "";
}

Eigen::Vector3d velocity_at(const ContainerFace& face, const Polygon3& corners) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) middle += corner / static_cast<double>(corners.size());
  return face.velocity + face.angular_velocity.cross(middle - face.pivot);
}

template <class ValueOf>
void add_field(FieldGrid& grid, const char* name, int rows, const std::vector<WallPolygon>& polygons,
               ValueOf&& value_of) {
  Field field{name, Eigen::MatrixXd(rows, static_cast<Eigen::Index>(polygons.size()))};
  for (Eigen::Index c = 0; c < field.values.cols(); ++c) field.values.col(c) << value_of(polygons[c]);
  grid.of_cells.push_back(std::move(field));
}

void add_results_of(FieldGrid& grid, const std::vector<WallPolygon>& polygons, const std::vector<FaceResult>& results) {
  using Vector = Eigen::Vector3d;
  const auto of = [&](const WallPolygon& p) -> const FaceResult& { return results[p.face]; };
  add_field(grid, "flux", 1, polygons, [&](const WallPolygon& p) { return of(p).flux; });
  add_field(grid, "force", 3, polygons,
            [&](const WallPolygon& p) { return Vector(of(p).force_pressure + of(p).force_viscous); });
  add_field(grid, "force_pressure", 3, polygons, [&](const WallPolygon& p) { return of(p).force_pressure; });
  add_field(grid, "force_viscous", 3, polygons, [&](const WallPolygon& p) { return of(p).force_viscous; });
}

}  // namespace

FieldGrid grid_of_walls(const Container& container, const std::vector<FaceResult>& results) {
  const std::vector<WallPolygon> polygons = wall_polygons(container);
  FieldGrid grid;
  Polygon3 points;
  TextField names{"name", {}}, walls{"wall", {}}, boundaries{"boundary", {}};
  for (const auto& [f, corners] : polygons) {
    std::vector<std::int64_t> cell;
    for (const Eigen::Vector3d& corner : corners) {
      cell.push_back(static_cast<std::int64_t>(points.size()));
      points.push_back(corner);
    }
    grid.add_cell(FieldGrid::polygon, cell);
    const ContainerFace& face = container.faces[f];
    names.values.push_back(face.name);
    walls.values.emplace_back(face.boundary.is_open() ? "open" : name_of(face.wall));
    boundaries.values.emplace_back(kind_of(face.boundary));
  }
  grid.points.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) grid.points.col(static_cast<Eigen::Index>(k)) = points[k];
  grid.texts_of_cells = {names, walls, boundaries};
  const std::vector<double> areas = face_areas(container);
  add_field(grid, "face", 1, polygons, [](const WallPolygon& p) { return static_cast<double>(p.face); });
  add_field(grid, "area", 1, polygons, [&](const WallPolygon& p) { return areas[p.face]; });
  add_field(grid, "velocity", 3, polygons,
            [&](const WallPolygon& p) { return velocity_at(container.faces[p.face], p.corners); });
  if (results.size() == container.faces.size()) add_results_of(grid, polygons, results);
  return grid;
}

std::optional<std::string> walls_beside(const std::string& path) {
  const std::filesystem::path file(path);
  if (file.extension() != ".vtu" && file.extension() != ".pvtu") return {};
  return path.substr(0, path.size() - file.extension().string().size()) + "_walls.vtu";
}

void write_walls_beside(const std::string& path, const Container& container, const std::vector<FaceResult>& results) {
  const auto walls = walls_beside(path);
  if (!walls) return;
  const FieldGrid drawn = grid_of_walls(container, results);
  if (drawn.types.empty()) detail::remove_file(*walls);
  else write_fields(*walls, drawn);
}

}  // namespace pfv

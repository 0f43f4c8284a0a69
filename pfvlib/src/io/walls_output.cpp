// SPDX-License-Identifier: GPL-3.0-or-later
// The walls of a container as ParaView draws them.
#include "geometry/pi.hpp"
#include "io/atomic_file.hpp"
#include "pfv/fields.hpp"
#include "pfv/io.hpp"
#include "problem/container_geometry.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

namespace pfv {

namespace {

using PolygonCorners = std::vector<Eigen::Vector3d>;

/// A polygon of a face, counterclockwise as seen from outside.
struct WallPolygon {
  int face;
  PolygonCorners corners;
};

constexpr int strips_around = 96;  // of a cylinder: its section's polygon has 0.07 % less area

/// A tilted periodic cell is the box sheared along its periodic axes.
std::vector<WallPolygon> polygons_of_box(const Container& container) {
  const Eigen::Vector3d edges = container.upper - container.lower;
  Eigen::Matrix3d sides = edges.asDiagonal();
  sides(0, 1) = container.tilt[0];
  sides(0, 2) = container.tilt[1];
  sides(1, 2) = container.tilt[2];
  std::vector<WallPolygon> polygons;
  for (int f = 0; f < container.face_count(); ++f) {
    const int axis = f / 2;
    if (container.periodic[axis]) continue;
    WallPolygon polygon{f, {}};
    for (const auto& [along, across] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      Eigen::Vector3d place;
      place[axis] = f % 2;
      place[(axis + 1) % 3] = f % 2 == 1 ? along : across;
      place[(axis + 2) % 3] = f % 2 == 1 ? across : along;
      polygon.corners.push_back(container.lower + sides * place);
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

std::vector<WallPolygon> polygons_of_cylinder(const Container& container) {
  const int round = *cylinder_of(container);
  const auto ends = ends_of_cylinder(container);
  const Surface& shell = container.faces[round].surface;
  const Eigen::Vector3d first = shell.axis.unitOrthogonal(), second = shell.axis.cross(first);
  std::array<PolygonCorners, 2> rings;
  for (int end = 0; end < 2; ++end) {
    const Surface& plane = container.faces[ends[end]].surface;
    const Eigen::Vector3d centre = shell.point + plane.distance(shell.point) * plane.normal;
    for (int i = 0; i < strips_around; ++i) {
      const double angle = 2.0 * pi * i / strips_around;
      rings[end].push_back(centre + shell.radius * (std::cos(angle) * first + std::sin(angle) * second));
    }
  }
  std::vector<WallPolygon> polygons{{ends[0], PolygonCorners(rings[0].rbegin(), rings[0].rend())}, {ends[1], rings[1]}};
  for (int i = 0; i < strips_around; ++i) {
    const int next = (i + 1) % strips_around;
    polygons.push_back({round, {rings[0][i], rings[0][next], rings[1][next], rings[1][i]}});
  }
  return polygons;
}

std::vector<WallPolygon> polygons_of(const Container& container) {
  if (container.is_box) return polygons_of_box(container);
  if (cylinder_of(container)) return polygons_of_cylinder(container);
  std::vector<WallPolygon> polygons;
  const std::vector<PolygonCorners> found = geometry_of(container, Eigen::Vector3d::Zero()).polygons;
  for (int f = 0; f < container.face_count(); ++f)
    if (found[f].size() > 2) polygons.push_back({f, found[f]});
  return polygons;
}

const char* kind_of(const Boundary& boundary) {
  for (const BoundaryKind& one : boundary_kinds)
    if (one.kind == boundary.kind) return one.name;
  return "";
}

Eigen::Vector3d velocity_at(const ContainerFace& face, const PolygonCorners& corners) {
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
  const std::vector<WallPolygon> polygons = polygons_of(container);
  FieldGrid grid;
  PolygonCorners points;
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

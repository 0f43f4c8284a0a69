// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "text/number_text.hpp"
#include "io/vtu_file.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <algorithm>

namespace pfv {
namespace {

using detail::VtuFile;

/// A cell for each point, so that points show.
void add_vertices(FieldGrid& grid) {
  for (Eigen::Index p = 0; p < grid.points.cols(); ++p) grid.add_cell(FieldGrid::vertex, {p});
}

template <class Number>
void add(VtuFile& file, const char* name, const std::vector<Number>& values) {
  file.add(name, values.data(), static_cast<std::int64_t>(values.size()));
}

void add(VtuFile& file, const std::vector<Field>& fields) {
  for (const Field& field : fields)
    file.add(field.name.c_str(), field.values.data(), field.values.cols(),
             static_cast<int>(field.values.rows()));
}

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : text) {
    if (c == '&') xml += "&amp;";
    else if (c == '<') xml += "&lt;";
    else if (c == '>') xml += "&gt;";
    else if (c == '"') xml += "&quot;";
    else xml += c;
  }
  return xml;
}

}  // namespace

void write_fields(const std::string& path, const FieldGrid& grid) {
  VtuFile file(grid.points.cols(), static_cast<std::int64_t>(grid.types.size()));
  file.begin("Points");
  file.add("Points", grid.points.data(), grid.points.cols(), 3);
  file.end("Points");
  file.begin("Cells");
  add(file, "connectivity", grid.connectivity);
  add(file, "offsets", grid.ends);
  add(file, "types", grid.types);
  file.end("Cells");
  if (!grid.point_ids.empty() || !grid.of_points.empty()) {
    file.begin("PointData");
    if (!grid.point_ids.empty()) add(file, "id", grid.point_ids);
    add(file, grid.of_points);
    file.end("PointData");
  }
  if (!grid.of_cells.empty()) {
    file.begin("CellData");
    add(file, grid.of_cells);
    file.end("CellData");
  }
  detail::write_file(path, file.text());
}

void write_spheres(const std::string& path, const Packing& packing, const Forces& forces,
                   const std::vector<Field>& more) {
  const Eigen::Index n = packing.size();
  FieldGrid grid;
  grid.points = packing.positions;
  add_vertices(grid);
  grid.point_ids.assign(packing.ids.data(), packing.ids.data() + n);
  grid.of_points.push_back({"radius", packing.radii.transpose()});
  // Zeros for grains at rest, so that every step of a collection has the same arrays.
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(3, n);
  if (packing.velocities.cols() == n) velocities = packing.velocities;
  grid.of_points.push_back({"velocity", velocities});
  const auto add_known = [&](const std::string& name, const Eigen::MatrixXd& values) {
    if (values.cols() == n) grid.of_points.push_back({name, values});
  };
  add_known("force", forces.total);
  add_known("pressure", forces.sphere_pressure.transpose());
  for (const Field& field : more) add_known(field.name, field.values);
  write_fields(path, grid);
}

void write_culprits(const std::string& path, const Packing& packing, const Culprits& culprits) {
  std::vector<double> radii;
  std::vector<Eigen::Vector3d> places;
  FieldGrid grid;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const auto& named = culprits.spheres;
    if (std::find(named.begin(), named.end(), packing.ids[k]) == named.end() ||
        !packing.positions.col(k).allFinite())
      continue;
    grid.point_ids.push_back(packing.ids[k]);
    radii.push_back(packing.radii[k]);
    places.push_back(packing.positions.col(k));
  }
  for (const auto& place : culprits.places) {
    grid.point_ids.push_back(-1);
    radii.push_back(0.0);
    places.emplace_back(place.data());
  }
  const auto n = static_cast<Eigen::Index>(radii.size());
  grid.points.resize(3, n);
  for (Eigen::Index k = 0; k < n; ++k) grid.points.col(k) = places[k];
  add_vertices(grid);
  grid.of_points.push_back({"radius", Eigen::Map<const Eigen::RowVectorXd>(radii.data(), n)});
  write_fields(path, grid);
}

void write_collection(const std::string& path, const std::vector<CollectionEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const CollectionEntry& entry : entries)
    text += "<DataSet timestep=\"" + detail::number_text(entry.time) + "\" part=\"" +
            std::to_string(entry.part) + "\" file=\"" + escaped(entry.file) + "\"/>\n";
  detail::write_file(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace pfv

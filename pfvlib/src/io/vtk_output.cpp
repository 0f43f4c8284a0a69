// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "text/number_text.hpp"
#include "io/vtu_file.hpp"
#include "parallel/ranks.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <algorithm>
#include <filesystem>

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

/// `with_ids`: also where there are no points to have one.
std::string text_of(const FieldGrid& grid, bool with_ids) {
  VtuFile file(grid.points.cols(), static_cast<std::int64_t>(grid.types.size()));
  file.begin("Points");
  file.add("Points", grid.points.data(), grid.points.cols(), 3);
  file.end("Points");
  file.begin("Cells");
  add(file, "connectivity", grid.connectivity);
  add(file, "offsets", grid.ends);
  add(file, "types", grid.types);
  file.end("Cells");
  if (with_ids || !grid.of_points.empty()) {
    file.begin("PointData");
    if (with_ids) add(file, "id", grid.point_ids);
    add(file, grid.of_points);
    file.end("PointData");
  }
  if (!grid.of_cells.empty() || !grid.texts_of_cells.empty()) {
    file.begin("CellData");
    add(file, grid.of_cells);
    for (const TextField& field : grid.texts_of_cells) file.add(field.name.c_str(), field.values);
    file.end("CellData");
  }
  return file.text();
}

}  // namespace

void write_fields(const std::string& path, const FieldGrid& grid) {
  detail::write_file(path, text_of(grid, !grid.point_ids.empty()));
}

namespace {

/// How an array of the pieces is told of in their head.
std::string told(const std::string& name, const char* type, Eigen::Index components) {
  return "<PDataArray type=\"" + std::string(type) + "\" Name=\"" + escaped(name) + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\"/>\n";
}

std::string told(const char* section, const std::vector<Field>& fields, const std::string& first = {}) {
  std::string text = first;
  for (const Field& field : fields) text += told(field.name, "Float64", field.values.rows());
  return text.empty() ? text : "<" + std::string(section) + ">\n" + text + "</" + section + ">\n";
}

std::string head_of_pieces(const FieldGrid& grid, const std::vector<std::string>& pieces, bool with_ids) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\">\n"
                     "<PUnstructuredGrid GhostLevel=\"0\">\n<PPoints>\n" + told("Points", "Float64", 3) + "</PPoints>\n" +
                     told("PPointData", grid.of_points, with_ids ? told("id", "Int64", 1) : "") +
                     told("PCellData", grid.of_cells);
  for (const std::string& piece : pieces) text += "<Piece Source=\"" + escaped(piece) + "\"/>\n";
  return text + "</PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

void write_fields(const std::string& path, const FieldGrid& grid, const Ranks& ranks) {
  const std::filesystem::path file(path);
  ranks.together([&] {
    if (file.extension() != ".pvtu") throw InputError("'" + path + "' does not end in .pvtu: each rank writes a piece, and that file names them");
  });
  const std::string stem = path.substr(0, path.rfind('.'));
  const auto piece_of = [](const std::string& of, int rank) { return of + "_" + std::to_string(rank) + ".vtu"; };
  const bool with_ids = ranks.any(!grid.point_ids.empty());
  ranks.together([&] { detail::write_file(piece_of(stem, ranks.own()), text_of(grid, with_ids)); });
  ranks.together([&] {
    if (ranks.own() != 0) return;
    std::vector<std::string> pieces;
    const std::string name = file.stem().string();
    for (int rank = 0; rank < ranks.count(); ++rank) pieces.push_back(piece_of(name, rank));
    detail::write_file(path, head_of_pieces(grid, pieces, with_ids));
  });
}

FieldGrid grid_of_spheres(const Packing& packing, const Forces& forces, const std::vector<Field>& more) {
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
  return grid;
}

void write_spheres(const std::string& path, const Packing& packing, const Forces& forces,
                   const std::vector<Field>& more) {
  write_fields(path, grid_of_spheres(packing, forces, more));
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

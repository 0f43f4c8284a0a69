// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "text/number_text.hpp"
#include "io/vtu_file.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <numeric>

namespace pfv {
namespace {

using detail::VtuFile;
using Numbers = std::vector<double>;
using Integers = std::vector<std::int64_t>;

constexpr std::uint8_t vertex_cell = 1, line_cell = 3;  // VTK_VERTEX, VTK_LINE

void add_points(VtuFile& file, const Eigen::Ref<const Eigen::Matrix3Xd>& points) {
  file.begin("Points");
  file.add("Points", points.data(), points.cols(), 3);
  file.end("Points");
}

void add_cells(VtuFile& file, const Integers& connectivity, const Integers& offsets,
               const std::vector<std::uint8_t>& types) {
  file.begin("Cells");
  file.add("connectivity", connectivity.data(), static_cast<std::int64_t>(connectivity.size()));
  file.add("offsets", offsets.data(), static_cast<std::int64_t>(offsets.size()));
  file.add("types", types.data(), static_cast<std::int64_t>(types.size()));
  file.end("Cells");
}

/// One vertex cell a pore, then one line cell a throat, from its first pore to its second.
void add_network_cells(VtuFile& file, const PoreNetwork& network) {
  const auto pores = static_cast<std::size_t>(network.pores());
  Integers connectivity(pores), offsets(pores);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::iota(offsets.begin(), offsets.end(), 1);
  std::vector<std::uint8_t> types(pores, vertex_cell);
  for (const auto& ends : network.throat_pores) {
    connectivity.insert(connectivity.end(), ends.begin(), ends.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(line_cell);
  }
  add_cells(file, connectivity, offsets, types);
}

/// What belongs to pores stands before what belongs to throats; a zero where it is the other's.
Numbers pores_then_throats(const Numbers& pores, const Numbers& throats) {
  Numbers both = pores;
  both.insert(both.end(), throats.begin(), throats.end());
  return both;
}

Numbers throat_pressures(const PoreNetwork& network, const Numbers& pressures) {
  Numbers means;
  means.reserve(network.throat_pores.size());
  for (const auto& [i, j] : network.throat_pores)
    means.push_back(0.5 * (pressures[i] + pressures[j]));
  return means;
}

void add_network_values(VtuFile& file, const Flow& flow) {
  const PoreNetwork& network = flow.network();
  const Eigen::VectorXd& p = flow.pore_pressures();
  const Eigen::VectorXd v = flow.pore_volumes();
  const Numbers pressures(p.begin(), p.end()), volumes(v.begin(), v.end());
  const Numbers no_pore(pressures.size(), 0.0), no_throat(network.throat_pores.size(), 0.0);
  file.begin("PointData");
  file.add("pressure", pressures.data(), p.size());
  file.add("volume", volumes.data(), v.size());
  const Eigen::Matrix3Xd velocities = flow.pore_velocities();
  file.add("velocity", velocities.data(), v.size(), 3);
  file.end("PointData");
  const auto add = [&](const char* name, const Numbers& pores, const Numbers& throats) {
    const Numbers values = pores_then_throats(pores, throats);
    file.add(name, values.data(), static_cast<std::int64_t>(values.size()));
  };
  file.begin("CellData");
  add("pressure", pressures, throat_pressures(network, pressures));
  add("volume", volumes, no_throat);
  add("conductance", no_pore, flow.throat_conductances());
  add("flux", no_pore, flow.throat_fluxes());
  file.end("CellData");
}

void add_vertex_cells(VtuFile& file, std::size_t points) {
  Integers connectivity(points), offsets(points);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::iota(offsets.begin(), offsets.end(), 1);
  add_cells(file, connectivity, offsets, std::vector<std::uint8_t>(points, vertex_cell));
}

void add_sphere_values(VtuFile& file, const Packing& packing, const Forces& forces,
                       const SphereFields& more) {
  const std::int64_t n = packing.size();
  // Zeros for grains at rest, so that every step of a collection has the same arrays.
  const Eigen::Matrix3Xd at_rest = Eigen::Matrix3Xd::Zero(3, n);
  const bool moving = packing.velocities.cols() == n;
  file.begin("PointData");
  file.add("id", packing.ids.data(), n);
  file.add("radius", packing.radii.data(), n);
  file.add("velocity", moving ? packing.velocities.data() : at_rest.data(), n, 3);
  if (forces.total.cols() == n) file.add("force", forces.total.data(), n, 3);
  if (forces.sphere_pressure.size() == n) file.add("pressure", forces.sphere_pressure.data(), n);
  if (more.displacement.cols() == n) file.add("displacement", more.displacement.data(), n, 3);
  if (more.fluid_velocity.cols() == n)
    file.add("fluid_velocity", more.fluid_velocity.data(), n, 3);
  if (more.fluid_stress.cols() == n) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> in_vtk_order = more.fluid_stress;  // ... xy, yz, xz
    in_vtk_order.row(4).swap(in_vtk_order.row(5));
    file.add("fluid_stress", in_vtk_order.data(), n, 6);
  }
  file.end("PointData");
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

void write_network(const std::string& path, const Flow& flow) {
  const PoreNetwork& network = flow.network();
  VtuFile file(network.pores(), network.pores() + network.throats());
  add_points(file, network.pore_centres.colwise() + network.origin);
  add_network_cells(file, network);
  add_network_values(file, flow);
  detail::write_file(path, file.text());
}

void write_spheres(const std::string& path, const Packing& packing, const Forces& forces,
                   const SphereFields& more) {
  const auto n = static_cast<std::size_t>(packing.size());
  VtuFile file(packing.size(), packing.size());
  add_points(file, packing.positions);
  add_vertex_cells(file, n);
  add_sphere_values(file, packing, forces, more);
  detail::write_file(path, file.text());
}

void write_culprits(const std::string& path, const Packing& packing, const Culprits& culprits) {
  Integers ids;
  Numbers radii;
  std::vector<Eigen::Vector3d> places;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const auto& named = culprits.spheres;
    if (std::find(named.begin(), named.end(), packing.ids[k]) == named.end() ||
        !packing.positions.col(k).allFinite())
      continue;
    ids.push_back(packing.ids[k]);
    radii.push_back(packing.radii[k]);
    places.push_back(packing.positions.col(k));
  }
  for (const auto& place : culprits.places) {
    ids.push_back(-1);
    radii.push_back(0.0);
    places.emplace_back(place.data());
  }
  const auto n = static_cast<std::int64_t>(ids.size());
  VtuFile file(n, n);
  add_points(file, Eigen::Map<const Eigen::Matrix3Xd>(
                       places.empty() ? nullptr : places.front().data(), 3, n));
  add_vertex_cells(file, ids.size());
  file.begin("PointData");
  file.add("id", ids.data(), n);
  file.add("radius", radii.data(), n);
  file.end("PointData");
  detail::write_file(path, file.text());
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

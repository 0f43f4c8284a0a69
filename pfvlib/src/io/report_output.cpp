// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/atomic_file.hpp"
#include "pfv/io.hpp"
#include "pfv/version.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace pfv {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value + 0.0) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }
Json vector(const Eigen::Vector3d& value) {
  return Json::array({number(value[0]), number(value[1]), number(value[2])});
}

Json faces(const Report& report) {
  Json json;
  for (const Face face : all_faces) {
    const FaceResult& result = report.faces[static_cast<std::size_t>(face)];
    json[name_of(face)] = {{"flux", number(result.flux)},
                           {"force_pressure", vector(result.force_pressure)},
                           {"force_viscous", vector(result.force_viscous)}};
  }
  return json;
}

Json openings(const Report& report) {
  Json json = Json::array();
  for (const OpeningResult& opening : report.openings)
    json.push_back({{"name", opening.name},
                    {"pores", opening.pores},
                    {"flux", number(opening.flux)},
                    {"pressure", number(opening.pressure)}});
  return json;
}

Json tensor(const std::optional<Eigen::Matrix3d>& tensor) {
  if (!tensor) return nullptr;
  return {vector(tensor->row(0)), vector(tensor->row(1)), vector(tensor->row(2))};
}

Json counts(const Counts& counts) {
  return {{"triangulate", counts.triangulate},
          {"order", counts.order},
          {"factor", counts.factor},
          {"solve", counts.solve},
          {"correction_solve", counts.correction_solve},
          {"limit_solve", counts.limit_solve},
          {"query_solve", counts.query_solve},
          {"background", counts.background},
          {"force_matrix", counts.force_matrix},
          {"volume_rate", counts.volume_rate},
          {"degenerate_throats", counts.degenerate_throats},
          {"merged_pores", counts.merged_pores},
          {"pinned_pores", counts.pinned_pores}};
}

Json seconds(const Seconds& seconds) {
  return {{"read", number(seconds.read)},         {"triangulate", number(seconds.triangulate)},
          {"throats", number(seconds.throats)},   {"assemble", number(seconds.assemble)},
          {"order", number(seconds.order)},       {"factor", number(seconds.factor)},
          {"solve", number(seconds.solve)},       {"forces", number(seconds.forces)},
          {"total", number(seconds.total)},       {"step", number(seconds.step)}};
}

Json wall_seconds(const WallSeconds& seconds) {
  return {{"total", number(seconds.total)}, {"step", number(seconds.step)}};
}

Json to_json(const Report& report) {
  return {{"version", version},
          {"model", report.model},
          {"spheres", report.spheres},
          {"hidden", report.hidden},
          {"outside", report.outside},
          {"pores", report.pores},
          {"unknowns", report.unknowns},
          {"porosity", number(report.porosity)},
          {"pore_volume", number(report.pore_volume)},
          {"solid_area", number(report.solid_area)},
          {"inflow", number(report.inflow)},
          {"outflow", number(report.outflow)},
          {"volume_rate_sum", number(report.volume_rate_sum)},
          {"storage_rate", number(report.storage_rate)},
          {"mass_error", number(report.mass_error)},
          {"fluid_volume", number(report.fluid_volume)},
          {"fluid_came_in", number(report.fluid_came_in)},
          {"fluid_balance_error", number(report.fluid_balance_error)},
          {"permeability", number(report.permeability)},
          {"permeability_tensor", tensor(report.permeability_tensor)},
          {"permeability_error", number(report.permeability_error)},
          {"degenerate_share", number(report.degenerate_share)},
          {"outside_range", report.outside_range},
          {"force_sum", vector(report.force_sum)},
          {"force_balance_error", number(report.force_balance_error)},
          {"residual", number(report.residual)},
          {"solver", report.solver},
          {"ordering", report.ordering},
          {"solver_made_of", report.solver_made_of},
          {"conductance", report.conductance},
          {"faces", faces(report)},
          {"openings", openings(report)},
          {"counts", counts(report.counts)},
          {"seconds", seconds(report.seconds)},
          {"wall_seconds", wall_seconds(report.wall_seconds)},
          {"threads", report.threads},
          {"peak_memory_bytes", report.peak_memory_bytes}};
}

}  // namespace

void write_report(const std::string& path, const Report& report) {
  detail::write_file(path, to_json(report).dump(2) + "\n");
}

}  // namespace pfv

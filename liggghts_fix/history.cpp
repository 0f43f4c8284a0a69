// SPDX-License-Identifier: GPL-3.0-or-later
#include "history.h"

#include <limits>
#include <optional>

namespace LAMMPS_NS {

namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// As a table writes it: in quotes where it holds what would end a field.
std::string quoted_name(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

void add(PfvNamedRow& row, const std::string& name, double value) {
  row.names += (row.names.empty() ? "" : ",") + quoted_name(name);
  row.values.push_back(value);
}

void add(PfvNamedRow& row, const std::string& name, const std::optional<double>& value) {
  add(row, name, value.value_or(absent));
}

void add_vector(PfvNamedRow& row, const std::string& name, const Eigen::Vector3d& value) {
  for (int axis = 0; axis < 3; ++axis) add(row, name + '_' + "xyz"[axis], value[axis]);
}

void add_balances(PfvNamedRow& row, const pfv::Report& report) {
  add(row, "inflow", report.inflow);
  add(row, "outflow", report.outflow);
  add(row, "volume_rate_sum", report.volume_rate_sum);
  add(row, "storage_rate", report.storage_rate);
  add(row, "mass_error", report.mass_error);
  add(row, "force_balance_error", report.force_balance_error);
  add(row, "fluid_balance_error", report.fluid_balance_error);
}

/// Of a box the coordinate of a face, of a container how far its plane is out along its normal; a cylinder has none.
std::optional<double> position_of(const pfv::Container& container, int face) {
  if (container.is_box) return (face % 2 == 0 ? container.lower : container.upper)[face / 2];
  const pfv::Surface& surface = container.faces[face].surface;
  return surface.is_plane() ? std::optional(surface.offset) : std::nullopt;
}

bool is_end_of_period(const pfv::Container& container, const pfv::Surface& surface) {
  for (int axis = 0; axis < 3; ++axis)
    if (container.periodic[axis] && surface.is_plane() && std::abs(surface.normal[axis]) == 1.0) return true;
  return false;
}

void add_face(PfvNamedRow& row, const pfv::Container& container, int number, const pfv::FaceResult& face) {
  if (const auto position = position_of(container, number)) add(row, face.name + "_position", *position);
  if (is_end_of_period(container, container.faces[number].surface)) return;  // nothing pushes on it
  add(row, face.name + "_flux", face.flux);
  add_vector(row, face.name + "_force", face.force_pressure + face.force_viscous);
}

}  // namespace

PfvNamedRow history_row(const pfv::FlowModel& flow, const pfv::Report& report, const PfvOfGrains& grains,
                        std::int64_t step, const PfvTaken& taken) {
  PfvNamedRow row;
  add(row, "step", static_cast<double>(step));
  add(row, "time", flow.time());
  add(row, "strain", flow.strain());
  add(row, "networks", static_cast<double>(flow.retriangulations()));
  add(row, "steps", static_cast<double>(taken.steps));
  add(row, "solves", static_cast<double>(taken.solves));
  add_balances(row, report);
  add(row, "mean_pressure", flow.mean_pressure());
  add(row, "porosity", report.porosity);
  add(row, "permeability", report.permeability);
  add(row, "hidden", static_cast<double>(grains.hidden));
  add(row, "stages", static_cast<double>(flow.stages()));
  add(row, "reynolds_largest", report.reynolds_largest);
  add(row, "reynolds_mean", report.reynolds_mean);
  add(row, "stokes_largest", grains.stokes.largest);
  add(row, "stokes_mean", grains.stokes.mean);
  add_vector(row, "force", grains.force);
  for (std::size_t f = 0; f < report.faces.size(); ++f)
    add_face(row, flow.container(), static_cast<int>(f), report.faces[f]);
  for (const pfv::OpeningResult& opening : report.openings) {
    add(row, opening.name + " flux", opening.flux);
    add(row, opening.name + " pressure", opening.pressure);
  }
  return row;
}

}  // namespace LAMMPS_NS

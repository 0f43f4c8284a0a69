// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sphere_fields.hpp"

#include "results/averages.hpp"

namespace pfv {
namespace {

Eigen::MatrixXd velocities(const SphereFieldSources& from) {
  return sphere_velocities(from.built, from.balance, from.packed);
}

Eigen::MatrixXd stresses(const SphereFieldSources& from) {
  Eigen::MatrixXd values = sphere_stresses(from.built, from.solution, from.packed);
  values.row(4).swap(values.row(5));  // VTK's order: ... xy, yz, xz
  return values;
}

struct SphereField {
  const char* name;
  Eigen::MatrixXd (*values)(const SphereFieldSources& from);
};

/// The one table: files, the fix and the Python module take what they write or hand out from it.
constexpr SphereField table[] = {{"fluid_velocity", velocities}, {"fluid_stress", stresses}};

}  // namespace

std::vector<Field> sphere_fields(const SphereFieldSources& from) {
  std::vector<Field> fields;
  for (const SphereField& field : table) fields.push_back({field.name, field.values(from)});
  return fields;
}

}  // namespace pfv

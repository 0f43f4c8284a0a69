// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sphere_fields.hpp"

#include "pfv/grain_stresses.hpp"
#include "results/averages.hpp"

#include <utility>

namespace pfv {
namespace {

std::vector<Field> velocities(const SphereFieldSources& from) {
  return {{"fluid_velocity", sphere_velocities(from.built, from.balance, from.packed)}};
}

std::vector<Field> stresses(const SphereFieldSources& from) {
  return stress_fields("fluid_stress", sphere_stresses(from.built, from.solution, from.packed));
}

/// The one table: files, the fix and the Python module take what they write or hand out from it.
constexpr std::vector<Field> (*table[])(const SphereFieldSources& from) = {velocities, stresses};

}  // namespace

std::vector<Field> sphere_fields(const SphereFieldSources& from) {
  std::vector<Field> fields;
  for (const auto fields_of : table)
    for (Field& field : fields_of(from)) fields.push_back(std::move(field));
  return fields;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/fluid_account.hpp"

#include "coupling/flow_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace pfv {

namespace {

double volume_of(double radius) {
  constexpr double pi = 3.14159265358979323846;
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

/// Ids and volumes, by id.
std::vector<std::pair<std::int64_t, double>> volumes_by_id(const Spheres& spheres) {
  std::vector<std::pair<std::int64_t, double>> volumes(spheres.size());
  for (int k = 0; k < spheres.size(); ++k) volumes[k] = {spheres.ids[k], volume_of(spheres.radii[k])};
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

/// Calls visit(volume before, volume now) for each grain in either; 0 where it is not.
template <class Visit>
void compare(const Spheres& before, const Spheres& now, Visit&& visit) {
  const auto old = volumes_by_id(before), fresh = volumes_by_id(now);
  auto a = old.begin();
  auto b = fresh.begin();
  while (a != old.end() || b != fresh.end()) {
    if (b == fresh.end() || (a != old.end() && a->first < b->first)) {
      visit(a++->second, 0.0);
    } else if (a == old.end() || b->first < a->first) {
      visit(0.0, b++->second);
    } else {
      visit(a->second, b->second);
      ++a, ++b;
    }
  }
}

}  // namespace

double fluid_space(double box_volume, const Spheres& spheres) {
  double space = box_volume;
  for (int k = 0; k < spheres.size(); ++k) space -= volume_of(spheres.radii[k]);
  return space;
}

double displaced_by_newcomers(const Spheres& before, const Spheres& now) {
  double sum = 0.0;
  compare(before, now, [&](double then, double volume) {
    if (then == 0.0 || volume == 0.0) sum += volume - then;
  });
  return sum;
}

double growth_of_grains(const Spheres& before, const Spheres& now) {
  double sum = 0.0;
  compare(before, now, [&](double then, double volume) {
    if (then != 0.0 && volume != 0.0) sum += volume - then;
  });
  return sum;
}

double FlowData::compressed_in(const BuiltNetwork& network, const Eigen::VectorXd& values) const {
  if (!fluid.bulk_modulus || values.size() == 0) return 0.0;
  return storage_volumes(network.throats).dot(values) / *fluid.bulk_modulus;
}

double FlowData::fluid_missing() const {
  return fluid_space(solved_box.volume(), built->grains.spheres) + account.ahead +
         compressed_in(*built, old_pressures) - account.at_start - account.came_in;
}

/// What the faces have swept in the step that has just ended, m³.
double FlowData::swept_volume(double step) const {
  Eigen::Vector3d before = box.upper - box.lower;
  for (int axis = 0; axis < 3; ++axis)
    before[axis] -= step * (box.faces[2 * axis + 1].velocity - box.faces[2 * axis].velocity);
  return box.volume() - before.prod();
}

/// Grains that came or went have pushed fluid out or let it in, and a host that asks for a new network has put
/// grains and faces elsewhere: that is flow. All else by which the space has changed beyond the volume
/// rates - grains that grew, what implicit steps left - a compressible fluid takes up: it is compressed.
void FlowData::settle_account(const Spheres* before, double swept) {
  const Spheres& now = built->grains.spheres;
  const double space = fluid_space(box.volume(), now);
  if (!account.open) {
    account = {true, space + compressed_in(*built, old_pressures) - swept, 0.0, 0.0};
    return;
  }
  if (!before) return;
  account.came_in -= displaced_by_newcomers(*before, now);
  const double growth = growth_of_grains(*before, now);
  double missing = space + account.ahead + compressed_in(*built, old_pressures) - account.at_start -
                   account.came_in - swept;
  if (moved_by_host) {
    account.came_in += missing + growth;
    missing = -growth;
  } else if (account.ahead != 0.0) {
    // where faces are within a long step is known up to a part of that step
    missing = volume_debt - growth;
  }
  if (!fluid.bulk_modulus) return;
  const double volume = storage_volumes(built->throats).sum();
  if (volume > 0.0) old_pressures.array() -= *fluid.bulk_modulus * missing / volume;
  volume_debt = debt_rate = 0.0;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/fluid_account.hpp"

#include "geometry/pi.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace pfv {

namespace {

double volume_of(const Spheres& spheres, int k) {
  if (spheres.displaced.size() > 0) return spheres.displaced[k];
  const double radius = spheres.radii[k];
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

/// Ids and volumes, by id.
std::vector<std::pair<std::int64_t, double>> volumes_by_id(const Spheres& spheres) {
  std::vector<std::pair<std::int64_t, double>> volumes(spheres.size());
  for (int k = 0; k < spheres.size(); ++k) volumes[k] = {spheres.ids[k], volume_of(spheres, k)};
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
  for (int k = 0; k < spheres.size(); ++k) space -= volume_of(spheres, k);
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

}  // namespace pfv

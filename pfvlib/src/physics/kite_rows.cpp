// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/kite_rows.hpp"

#include "network/disjoint_sets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace pfv {

namespace {

constexpr double least_cosine = 0.42;    // between the outward normals of planes at an obtuse edge: up to 65 degrees
constexpr double parallel_cosine = 0.7;  // between edges that run beside each other

struct Kite {
  int sphere;
  Vertex first, second;
  int facet, throat;
};

Eigen::Vector3d normal_of(Vertex wall, const Spheres& spheres) { return spheres.wall(wall).surface.normal; }

bool meet_obtusely(Vertex one, Vertex other, const Spheres& spheres) {
  return one != other && spheres.wall(one).is_plane() && spheres.wall(other).is_plane() &&
         normal_of(one, spheres).dot(normal_of(other, spheres)) > least_cosine;
}

bool any_meet_obtusely(const Spheres& spheres) {
  for (int one = 0; one < spheres.wall_count(); ++one)
    for (int other = 0; other < one; ++other)
      if (meet_obtusely(wall_vertex(one), wall_vertex(other), spheres)) return true;
  return false;
}

/// By sphere, and in the order of their throats.
std::vector<Kite> kites_on_obtuse_edges(const PoreNetwork& network, const Spheres& spheres) {
  std::vector<Kite> kites;
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      const auto& [sphere, first, second] = network.facet_vertices[f];
      if (is_wall(first) && meet_obtusely(first, second, spheres)) kites.push_back({sphere, first, second, f, t});
    }
  std::stable_sort(kites.begin(), kites.end(), [](const Kite& a, const Kite& b) { return a.sphere < b.sphere; });
  return kites;
}

bool share_a_cell(const Kite& a, const Kite& b, const PoreNetwork& network) {
  for (const int cell : network.facet_cells[a.facet])
    for (const int other : network.facet_cells[b.facet])
      if (cell >= 0 && cell == other) return true;
  return false;
}

/// Whether a plane lies between their edges. Edges that meet at a corner have a cell there.
bool are_beside(const Kite& a, const Kite& b, const PoreNetwork& network, const Spheres& spheres) {
  if (a.first != b.first && a.first != b.second && a.second != b.first && a.second != b.second) return false;
  const auto along = [&](const Kite& kite) {
    return normal_of(kite.first, spheres).cross(normal_of(kite.second, spheres)).normalized();
  };
  return std::abs(along(a).dot(along(b))) > parallel_cosine && !share_a_cell(a, b, network);
}

/// A throat belongs to one row: the first that takes it.
void add_row(KiteRows& result, const std::vector<Kite>& kites, const Spheres& spheres) {
  KiteRow row;
  row.sphere = kites.front().sphere;
  std::map<int, double> angles;  // of each throat
  std::map<Vertex, int> times;
  double sum = 0.0;
  for (const Kite& kite : kites) {
    ++times[kite.first];
    ++times[kite.second];
    if (result.row[kite.throat] >= 0) continue;
    const Eigen::Vector3d a = normal_of(kite.first, spheres), b = normal_of(kite.second, spheres);
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    angles[kite.throat] += angle;
    sum += angle;
  }
  std::vector<Vertex> ends;
  for (const auto& [wall, count] : times)
    if (count == 1) ends.push_back(wall);
  if (ends.size() == 2) row.ends = {ends[0], ends[1]};
  for (const auto& [t, angle] : angles) {
    row.throats.push_back(t);
    result.row[t] = static_cast<int>(result.rows.size());
    result.share[t] = angle / sum;
  }
  if (!row.throats.empty()) result.rows.push_back(std::move(row));
}

/// Of one sphere.
void add_rows(KiteRows& result, const Kite* kites, int count, const PoreNetwork& network, const Spheres& spheres) {
  DisjointSets sets(count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j)
      if (are_beside(kites[i], kites[j], network, spheres)) sets.join(i, j);
  std::map<int, std::vector<Kite>> rows;
  for (int i = 0; i < count; ++i) rows[sets.find(i)].push_back(kites[i]);
  for (const auto& [first, row] : rows)
    if (row.size() > 1) add_row(result, row, spheres);
}

}  // namespace

KiteRows find_kite_rows(const PoreNetwork& network, const Spheres& spheres) {
  KiteRows result;
  if (!any_meet_obtusely(spheres)) return result;
  result.row.assign(network.throats(), -1);
  result.share.assign(network.throats(), 0.0);
  const std::vector<Kite> kites = kites_on_obtuse_edges(network, spheres);
  for (std::size_t begin = 0; begin < kites.size();) {
    std::size_t end = begin + 1;
    while (end < kites.size() && kites[end].sphere == kites[begin].sphere) ++end;
    if (end - begin > 1) add_rows(result, &kites[begin], static_cast<int>(end - begin), network, spheres);
    begin = end;
  }
  return result;
}

}  // namespace pfv

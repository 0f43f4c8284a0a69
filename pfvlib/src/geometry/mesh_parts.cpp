// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace pfv {

namespace {

using Node = Eigen::Vector3d;
using Corners = std::array<int, 3>;
using Edge = std::pair<int, int>;  // its nodes, ascending

/// Corners that lie within `tolerance` of each other are one node.
class Nodes {
 public:
  explicit Nodes(double tolerance) : tolerance_(tolerance) {}
  int number_of(const Node& place) {
    const Cell home = cell_of(place);
    for (int n = 0; n < 27; ++n) {
      const Cell near{home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1};
      const auto found = in_cell_.find(near);
      if (found != in_cell_.end() && (places_[found->second] - place).norm() <= tolerance_) return found->second;
    }
    places_.push_back(place);
    in_cell_[home] = static_cast<int>(places_.size()) - 1;
    return in_cell_[home];
  }

 private:
  using Cell = std::array<long long, 3>;
  Cell cell_of(const Node& place) const {
    return {std::llround(place[0] / tolerance_), std::llround(place[1] / tolerance_), std::llround(place[2] / tolerance_)};
  }
  double tolerance_;
  std::vector<Node> places_;
  std::map<Cell, int> in_cell_;
};

int root_of(std::vector<int>& parents, int node) {
  while (parents[node] != node) node = parents[node] = parents[parents[node]];
  return node;
}

Edge edge_of(const Corners& corners, int side) {
  return std::minmax(corners[side], corners[(side + 1) % 3]);
}

/// 1 where the triangle runs along the edge from its lower node to its upper one, else -1.
int way_along(const Corners& corners, int side) { return corners[side] < corners[(side + 1) % 3] ? 1 : -1; }

struct Beside {
  int triangle, side;
};
using Neighbours = std::map<Edge, std::vector<Beside>>;

Neighbours neighbours_of(const std::vector<Corners>& corners) {
  Neighbours beside;
  for (int t = 0; t < static_cast<int>(corners.size()); ++t)
    for (int side = 0; side < 3; ++side) beside[edge_of(corners[t], side)].push_back({t, side});
  return beside;
}

/// Turns triangles so that neighbours run along their edge in opposite ways: false where that cannot be.
bool orient(std::vector<Corners>& corners, std::vector<Triangle>& triangles, const Neighbours& beside) {
  std::vector<char> done(corners.size(), 0);
  std::vector<int> waiting{0};
  done[0] = 1;
  while (!waiting.empty()) {
    const int t = waiting.back();
    waiting.pop_back();
    for (int side = 0; side < 3; ++side)
      for (const Beside& other : beside.at(edge_of(corners[t], side))) {
        if (other.triangle == t) continue;
        Corners& own = corners[other.triangle];
        int at = 0;  // where its side is now: it may have been turned
        while (edge_of(own, at) != edge_of(corners[t], side)) ++at;
        const bool fits = way_along(own, at) != way_along(corners[t], side);
        if (done[other.triangle] && !fits) return false;
        if (done[other.triangle]) continue;
        if (!fits) {
          std::swap(own[1], own[2]);
          triangles[other.triangle].col(1).swap(triangles[other.triangle].col(2));
        }
        done[other.triangle] = 1;
        waiting.push_back(other.triangle);
      }
  }
  return std::all_of(done.begin(), done.end(), [](char one) { return one != 0; });
}

/// Sums over the tetrahedra between the triangles and the part's first corner.
void measure(MeshPart& part) {
  const Node origin = part.triangles[0].col(0);
  Node of_area = Node::Zero(), of_volume = Node::Zero();
  for (const Triangle& triangle : part.triangles) {
    const Triangle from = triangle.colwise() - origin;
    const Node area = area_vector(triangle);
    part.area += area.norm();
    of_area += area.norm() * from.rowwise().mean();
    const double volume = area.dot(from.col(0)) / 3.0;
    part.volume += volume;
    of_volume += volume * 0.25 * from.rowwise().sum();
  }
  part.centre = origin + of_area / part.area;
  if (part.closed && part.volume != 0.0) part.centre = origin + of_volume / part.volume;
  if (!part.closed) part.volume = 0.0;
  if (part.volume >= 0.0) return;
  part.volume = -part.volume;
  for (Triangle& triangle : part.triangles) triangle.col(1).swap(triangle.col(2));
}

bool has_area(const Triangle& triangle) { return area_vector(triangle).norm() > 0.0; }

/// Whether the part ends at the edge or turns there.
bool is_sharp(const std::vector<Beside>& around, const std::vector<Corners>& corners,
              const std::vector<Triangle>& triangles) {
  constexpr double smooth = 0.866;  // cosine of 30 degrees
  if (around.size() != 2) return true;
  const auto [one, other] = std::pair(around[0], around[1]);
  const double way = way_along(corners[one.triangle], one.side) != way_along(corners[other.triangle], other.side) ? 1.0 : -1.0;
  const Node a = area_vector(triangles[one.triangle]), b = area_vector(triangles[other.triangle]);
  return way * a.dot(b) < smooth * a.norm() * b.norm();
}

MeshPart part_of(std::vector<Triangle> triangles, std::vector<Corners> corners) {
  MeshPart part;
  Neighbours beside = neighbours_of(corners);
  part.closed = std::all_of(beside.begin(), beside.end(), [](const auto& edge) { return edge.second.size() == 2; }) &&
                orient(corners, triangles, beside);
  beside = neighbours_of(corners);
  for (const auto& [edge, around] : beside) {
    if (!is_sharp(around, corners, triangles)) continue;
    const Triangle& triangle = triangles[around[0].triangle];
    part.edges.push_back({triangle.col(around[0].side), triangle.col((around[0].side + 1) % 3)});
  }
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), [](const Triangle& t) { return !has_area(t); }),
                  triangles.end());
  part.triangles = std::move(triangles);
  if (!part.triangles.empty()) measure(part);
  return part;
}

}  // namespace

Eigen::Vector3d area_vector(const Triangle& t) { return 0.5 * (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)); }

double size_of(const std::vector<Triangle>& triangles) {
  Node low = triangles[0].col(0), high = low;
  for (const Triangle& triangle : triangles) {
    low = low.cwiseMin(triangle.rowwise().minCoeff());
    high = high.cwiseMax(triangle.rowwise().maxCoeff());
  }
  return (high - low).maxCoeff();
}

std::vector<MeshPart> parts_of_mesh(const std::vector<Triangle>& triangles) {
  std::vector<MeshPart> parts;
  if (triangles.empty()) return parts;
  const double size = size_of(triangles);
  if (!(size > 0.0)) return parts;
  Nodes nodes(planarity * size);
  std::vector<Corners> corners;
  std::vector<Triangle> kept;
  for (const Triangle& triangle : triangles) {
    Corners own;
    for (int k = 0; k < 3; ++k) own[k] = nodes.number_of(triangle.col(k));
    if (own[0] == own[1] || own[1] == own[2] || own[2] == own[0]) continue;
    kept.push_back(triangle);
    corners.push_back(own);
  }
  std::vector<int> parents(kept.size());
  std::iota(parents.begin(), parents.end(), 0);
  for (const auto& [edge, around] : neighbours_of(corners))
    for (const Beside& one : around) parents[root_of(parents, one.triangle)] = root_of(parents, around[0].triangle);
  std::map<int, int> number;  // of the part, by its root; parts in the order of their first triangles
  std::vector<std::vector<int>> members;
  for (int t = 0; t < static_cast<int>(kept.size()); ++t) {
    const auto [found, fresh] = number.try_emplace(root_of(parents, t), static_cast<int>(members.size()));
    if (fresh) members.emplace_back();
    members[found->second].push_back(t);
  }
  for (const std::vector<int>& own : members) {
    std::vector<Triangle> of_part;
    std::vector<Corners> of_corners;
    for (const int t : own) {
      of_part.push_back(kept[t]);
      of_corners.push_back(corners[t]);
    }
    parts.push_back(part_of(std::move(of_part), std::move(of_corners)));
    if (parts.back().triangles.empty()) parts.pop_back();
  }
  return parts;
}

}  // namespace pfv

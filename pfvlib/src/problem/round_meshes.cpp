// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/round_meshes.hpp"

#include "geometry/pi.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pfv {

namespace {

using Vector = Eigen::Vector3d;
using InSection = Eigen::Vector2d;  // along the axis and away from it, m
using Triangles = std::vector<Triangle>;

// parts of the largest radius
constexpr double corners_stray = 0.005;  // corners from the surface of revolution
constexpr double middles_stray = 0.025;  // triangles from it, inwards: 16 flats around lie within 0.019
constexpr double at_first = 0.03;        // corners, before the axis is fitted
constexpr double disc_slope = 0.02;      // sine of the angle below which a triangle is square to the axis
constexpr double whole_turn = 0.95;      // part of the way around that the triangles cover at least
constexpr std::size_t most_sections = 3;

Vector area_of(const Triangle& t) { return 0.5 * (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)); }

struct Revolution {
  Vector axis = Vector::Zero(), point = Vector::Zero();  ///< unit; any point of the axis, m
  std::vector<int> sides, ends;                          ///< triangles
  std::vector<InSection> profile;                        ///< corners, in order along the axis

  InSection place_of(const Vector& x) const {
    const Vector from = x - point;
    const double along = axis.dot(from);
    return {along, (from - along * axis).norm()};
  }
  double largest() const {
    double radius = 0.0;
    for (const InSection& corner : profile) radius = std::max(radius, corner[1]);
    return radius;
  }
  std::size_t section_at(double along) const {
    std::size_t section = 0;
    while (section + 2 < profile.size() && along > profile[section + 1][0]) ++section;
    return section;
  }
  double radius_at(double along) const {
    const std::size_t k = section_at(along);
    const InSection way = profile[k + 1] - profile[k];
    return way[0] > 0.0 ? profile[k][1] + (along - profile[k][0]) / way[0] * way[1] : profile[k][1];
  }
};

/// Triangles that go around an axis, and those square to it; needles are neither.
Revolution about(const Vector& axis, const Triangles& triangles, double size) {
  Revolution result;
  result.axis = axis;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vector area = area_of(triangles[t]);
    if (!(area.norm() > 1e-12 * size * size)) continue;
    (area.normalized().cross(axis).norm() < disc_slope ? result.ends : result.sides).push_back(static_cast<int>(t));
  }
  return result;
}

/// Normals of a surface of revolution meet its axis: the point nearest to doing so for all.
bool find_point(Revolution& revolution, const Triangles& triangles) {
  Eigen::Matrix3d matrix = revolution.axis * revolution.axis.transpose();
  Vector right = Vector::Zero(), middle = Vector::Zero();
  for (const int t : revolution.sides) middle += triangles[t].rowwise().mean() / static_cast<double>(revolution.sides.size());
  double areas = 0.0;
  for (const int t : revolution.sides) areas += area_of(triangles[t]).norm();
  for (const int t : revolution.sides) {
    const Vector area = area_of(triangles[t]), across = revolution.axis.cross(area).normalized();
    const double weight = area.norm() / areas;
    matrix += weight * across * across.transpose();
    right += weight * across * across.dot(triangles[t].rowwise().mean() - middle);
  }
  const Eigen::LDLT<Eigen::Matrix3d> solved(matrix);
  if (solved.info() != Eigen::Success || !(solved.rcond() > 1e-6)) return false;
  revolution.point = middle + solved.solve(right);
  return true;
}

std::vector<InSection> places_of_sides(const Revolution& revolution, const Triangles& triangles) {
  std::vector<InSection> places;
  for (const int t : revolution.sides)
    for (int k = 0; k < 3; ++k) places.push_back(revolution.place_of(triangles[t].col(k)));
  return places;
}

double cross(const InSection& a, const InSection& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The upper hull of the places of all corners: the profile of a convex room.
std::vector<InSection> upper_hull(std::vector<InSection> places) {
  std::sort(places.begin(), places.end(),
            [](const InSection& a, const InSection& b) { return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]); });
  std::vector<InSection> hull;
  for (const InSection& place : places) {
    while (hull.size() > 1 && cross(hull.back() - hull[hull.size() - 2], place - hull.back()) >= 0.0) hull.pop_back();
    hull.push_back(place);
  }
  return hull;
}

/// Keeps the ends, and between them the corner furthest from the line as long as one is further than `allowed`.
void simplify(const std::vector<InSection>& line, std::size_t first, std::size_t last, double allowed, std::vector<InSection>& kept) {
  double furthest = allowed;
  std::size_t corner = first;
  const InSection way = (line[last] - line[first]).normalized();
  for (std::size_t i = first + 1; i < last; ++i)
    if (const double apart = std::abs(cross(way, line[i] - line[first])); apart > furthest) {
      furthest = apart;
      corner = i;
    }
  if (corner == first) return kept.push_back(line[last]);
  simplify(line, first, corner, allowed, kept);
  simplify(line, corner, last, allowed, kept);
}

bool find_profile(Revolution& revolution, const Triangles& triangles) {
  const std::vector<InSection> hull = upper_hull(places_of_sides(revolution, triangles));
  if (hull.size() < 2) return false;
  revolution.profile = hull;
  const double radius = revolution.largest();
  revolution.profile = {hull.front()};
  simplify(hull, 0, hull.size() - 1, 2.0 * corners_stray * radius, revolution.profile);
  return revolution.profile.size() <= most_sections + 1 && radius > 0.0;
}

double furthest_corner(const Revolution& revolution, const Triangles& triangles) {
  double furthest = 0.0;
  for (const InSection& place : places_of_sides(revolution, triangles))
    furthest = std::max(furthest, std::abs(place[1] - revolution.radius_at(place[0])));
  return furthest;
}

/// Least squares of the corners' distances from a cone in each section, all about one axis: how far it moves and tilts, then
/// offset and slope of each section's line. Empty where they do not follow from the corners.
Eigen::VectorXd fit_of(const Revolution& revolution, const Triangles& triangles, const Vector& u, const Vector& v, double size) {
  const Eigen::Index unknowns = 4 + 2 * (static_cast<Eigen::Index>(revolution.profile.size()) - 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns), row = right;
  for (const int t : revolution.sides) {
    const double middle = revolution.place_of(triangles[t].rowwise().mean())[0];
    const auto section = static_cast<Eigen::Index>(revolution.section_at(middle));
    for (int k = 0; k < 3; ++k) {
      const InSection place = revolution.place_of(triangles[t].col(k));
      if (!(place[1] > 0.0)) continue;
      const Vector out = (triangles[t].col(k) - revolution.point - place[0] * revolution.axis) / place[1];
      row.setZero();
      row.head<4>() << out.dot(u), out.dot(v), out.dot(u) * place[0] / size, out.dot(v) * place[0] / size;
      row[4 + 2 * section] = 1.0;
      row[5 + 2 * section] = place[0] / size;
      matrix += row * row.transpose();
      right += place[1] * row;
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solved(matrix);
  return solved.rank() < unknowns ? Eigen::VectorXd() : Eigen::VectorXd(solved.solve(right));
}

/// Moves the axis, tilts it and makes the sections' lines meet.
bool refine(Revolution& revolution, const Triangles& triangles) {
  const auto sections = static_cast<Eigen::Index>(revolution.profile.size()) - 1;
  const Vector u = revolution.axis.unitOrthogonal(), v = revolution.axis.cross(u);
  const double size = revolution.profile.back()[0] - revolution.profile.front()[0] + revolution.largest();
  const Eigen::VectorXd fit = fit_of(revolution, triangles, u, v, size);
  if (fit.size() == 0) return false;
  revolution.point += fit[0] * u + fit[1] * v;
  revolution.axis = (revolution.axis + (fit[2] * u + fit[3] * v) / size).normalized();
  std::vector<InSection>& profile = revolution.profile;
  const auto line = [&](Eigen::Index k) { return InSection(fit[4 + 2 * k], fit[5 + 2 * k] / size); };
  for (Eigen::Index k = 0; k + 1 < sections; ++k) {
    const InSection a = line(k), b = line(k + 1);
    if (!(a[1] > b[1])) return false;
    profile[k + 1][0] = (b[0] - a[0]) / (a[1] - b[1]);
  }
  for (Eigen::Index k = 0; k <= sections; ++k) {
    const InSection a = line(std::min(k, sections - 1));
    profile[k][1] = a[0] + a[1] * profile[k][0];
    if (k > 0 && !(profile[k][0] > profile[k - 1][0])) return false;
  }
  return true;
}

bool discs_are_at_its_ends(const Revolution& revolution, const Triangles& triangles) {
  const double allowed = corners_stray * revolution.largest();
  return std::all_of(revolution.ends.begin(), revolution.ends.end(), [&](int t) {
    for (int k = 0; k < 3; ++k) {
      const InSection place = revolution.place_of(triangles[t].col(k));
      const InSection &low = revolution.profile.front(), &high = revolution.profile.back();
      const bool at_low = std::abs(place[0] - low[0]) < allowed && place[1] < low[1] + allowed;
      const bool at_high = std::abs(place[0] - high[0]) < allowed && place[1] < high[1] + allowed;
      if (!at_low && !at_high) return false;
    }
    return true;
  });
}

/// The triangles' middles, as a part of the radius there, weighted with their areas; 0 where one lies too deep.
double mean_depth(const Revolution& revolution, const Triangles& triangles) {
  double sum = 0.0, areas = 0.0;
  for (const int t : revolution.sides) {
    const InSection place = revolution.place_of(triangles[t].rowwise().mean());
    const double radius = revolution.radius_at(place[0]), area = area_of(triangles[t]).norm();
    if (radius - place[1] > middles_stray * revolution.largest()) return 0.0;
    sum += area * (radius > 0.0 ? place[1] / radius : 1.0);
    areas += area;
  }
  double surface = 0.0;
  for (std::size_t k = 0; k + 1 < revolution.profile.size(); ++k) {
    const InSection &a = revolution.profile[k], &b = revolution.profile[k + 1];
    surface += pi * (a[1] + b[1]) * (b - a).norm();
  }
  return areas > whole_turn * surface ? sum / areas : 0.0;
}

std::optional<Revolution> fitted(const Vector& axis, const Triangles& triangles, double size) {
  Revolution revolution = about(axis, triangles, size);
  if (revolution.sides.size() < 16 || !find_point(revolution, triangles) || !find_profile(revolution, triangles)) return {};
  if (furthest_corner(revolution, triangles) > at_first * revolution.largest()) return {};
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round)
    if (!refine(revolution, triangles) || (round + 1 < rounds && !find_profile(revolution, triangles))) return {};
  if (furthest_corner(revolution, triangles) > corners_stray * revolution.largest()) return {};
  if (!discs_are_at_its_ends(revolution, triangles)) return {};
  return revolution;
}

/// Three corners far from each other, from which the mesh's place as a rigid body is read.
MeshAnchors anchors_of(const Triangles& triangles) {
  MeshAnchors anchors;
  anchors.places.col(0) = triangles[0].col(0);
  anchors.corners[0] = {0, 0};
  for (const int number : {1, 2}) {
    double furthest = -1.0;
    const Vector from = anchors.places.col(0), way = (anchors.places.col(1) - from).normalized();
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vector x = triangles[t].col(k) - from;
        const double apart = number == 1 ? x.norm() : way.cross(x).norm();
        if (!(apart > furthest)) continue;
        furthest = apart;
        anchors.corners[number] = {static_cast<int>(t), k};
      }
    anchors.places.col(number) = triangles[anchors.corners[number].first].col(anchors.corners[number].second);
  }
  return anchors;
}

/// Equal planes that touch a section. `start`: a direction that turns with the mesh.
std::vector<Surface> flats_of_section(const Revolution& revolution, std::size_t section, int count, double shrink,
                                      const Vector& start) {
  const double half = pi / count;
  const InSection &a = revolution.profile[section], &b = revolution.profile[section + 1];
  const InSection way(b[0] - a[0], shrink * (b[1] - a[1]));
  const Vector side = revolution.axis.cross(start);
  std::vector<Surface> flats;
  for (int k = 0; k < count; ++k) {
    const Vector out = std::cos((2 * k + 1) * half) * start + std::sin((2 * k + 1) * half) * side;
    flats.push_back(Surface::plane(way[0] * out - way[1] * revolution.axis,
                                   revolution.point + a[0] * revolution.axis + shrink * a[1] * out));
  }
  return flats;
}

void add_ends(std::vector<MeshWall>& walls, const Revolution& revolution, const Triangles& triangles) {
  for (const int way : {-1, 1}) {
    MeshWall end;
    const double along = way < 0 ? revolution.profile.front()[0] : revolution.profile.back()[0];
    for (const int t : revolution.ends)
      if (std::abs(revolution.place_of(triangles[t].col(0))[0] - along) < corners_stray * revolution.largest())
        end.triangles.push_back(t);
    if (end.triangles.empty()) continue;
    end.surface = Surface::plane(way * revolution.axis, revolution.point + along * revolution.axis);
    walls.push_back(std::move(end));
  }
}

std::vector<MeshWall> walls_around(const Revolution& revolution, const Triangles& triangles, RoundMeshes round, double depth) {
  const std::size_t sections = revolution.profile.size() - 1;
  const double radius = revolution.largest(), slope = revolution.profile[1][1] - revolution.profile[0][1];
  // N flats around: the middles of their triangles lie 4/9 (pi/N)^2 too deep, the circle of their area 1/3 (pi/N)^2
  const double shrink = 1.0 - 0.75 * (1.0 - depth);
  MeshWall wall;
  wall.deviation = std::max(furthest_corner(revolution, triangles), (1.0 - depth) * radius);
  std::vector<MeshWall> walls;
  if (sections == 1 && std::abs(slope) < corners_stray * radius && round == RoundMeshes::as_cylinders) {
    wall.triangles = revolution.sides;
    wall.surface = Surface::cylinder(revolution.axis, revolution.point, shrink * 0.5 * (revolution.profile[0][1] + revolution.profile[1][1]));
    walls.push_back(wall);
  } else {
    const Vector corner = triangles[revolution.sides[0]].col(0) - revolution.point;
    const Vector start = (corner - revolution.axis.dot(corner) * revolution.axis).normalized();
    const int count = sections == 1 ? 32 : sections == 2 ? 24 : 16;
    for (std::size_t section = 0; section < sections; ++section) {
      wall.triangles.clear();
      for (const int t : revolution.sides)
        if (revolution.section_at(revolution.place_of(triangles[t].rowwise().mean())[0]) == section) wall.triangles.push_back(t);
      for (const Surface& flat : flats_of_section(revolution, section, count, shrink, start)) {
        wall.surface = flat;
        walls.push_back(wall);
      }
    }
  }
  add_ends(walls, revolution, triangles);
  const MeshAnchors anchors = anchors_of(triangles);
  for (MeshWall& each : walls) each.anchors = anchors;
  return walls;
}

}  // namespace

std::optional<std::vector<MeshWall>> walls_of_revolution(const Triangles& triangles, RoundMeshes round) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Vector low = triangles[0].col(0), high = low;
  for (const Triangle& triangle : triangles) {
    const Vector area = area_of(triangle);
    if (area.norm() > 0.0) spread += area * area.transpose() / area.norm();
    low = low.cwiseMin(triangle.rowwise().minCoeff());
    high = high.cwiseMax(triangle.rowwise().maxCoeff());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(spread);
  for (int k = 0; k < 3; ++k) {
    const std::optional<Revolution> revolution = fitted(solved.eigenvectors().col(k), triangles, (high - low).maxCoeff());
    if (!revolution) continue;
    if (const double depth = mean_depth(*revolution, triangles); depth > 0.0)
      return walls_around(*revolution, triangles, round, depth);
  }
  return {};
}

}  // namespace pfv

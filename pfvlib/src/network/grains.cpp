// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/grains.hpp"

#include "geometry/pi.hpp"
#include "problem/container_geometry.hpp"
#include "text/number_text.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pfv {

namespace {

std::string place(const Eigen::Vector3d& x) {
  std::ostringstream text;
  text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

void check_shapes(const Packing& packing) {
  const Eigen::Index n = packing.size();
  if (packing.displaced_volumes.size() != n && packing.displaced_volumes.size() != 0)
    throw InputError("packing: " + std::to_string(packing.displaced_volumes.size()) +
                     " displaced volumes for " + std::to_string(n) + " spheres; give one a sphere");
  if (packing.bodies.size() != n && packing.bodies.size() != 0)
    throw InputError("packing: " + std::to_string(packing.bodies.size()) + " numbers of bodies for " +
                     std::to_string(n) + " spheres; give one a sphere, -1 where there is none");
  if (packing.positions.cols() != n || packing.radii.size() != n ||
      (packing.velocities.cols() != n && packing.velocities.cols() != 0))
    throw InputError("packing: ids, positions, radii and velocities have different lengths (" +
                     std::to_string(n) + ", " + std::to_string(packing.positions.cols()) + ", " +
                     std::to_string(packing.radii.size()) + ", " +
                     std::to_string(packing.velocities.cols()) + ")");
}

void check_values(const Packing& packing) {
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const std::string sphere = "sphere " + std::to_string(packing.ids[k]);
    if (!packing.positions.col(k).allFinite())
      throw InputError(sphere + ": its position " + place(packing.positions.col(k)) +
                           " is not finite",
                       {{packing.ids[k]}, {}});
    if (!(packing.radii[k] > 0.0) || !std::isfinite(packing.radii[k]))
      throw InputError(sphere + ": its radius " + detail::number_text(packing.radii[k]) +
                           " is not a positive number",
                       {{packing.ids[k]}, {}});
    if (packing.bodies.size() > 0 && packing.bodies[k] < -1)
      throw InputError(sphere + ": there is no rigid body " + std::to_string(packing.bodies[k]) +
                           "; they are counted from 0 on, -1 is none",
                       {{packing.ids[k]}, {}});
  }
}

/// Of a sphere some thousand boxes wide only its cap is in the box, as a difference of volumes whose
/// last digit is already as large as the box's seventh.
void refuse_giants(const Packing& packing, double volume) {
  const double largest = 1e3 * std::cbrt(volume);
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    if (packing.radii[k] > largest)
      throw InputError("sphere " + std::to_string(packing.ids[k]) + ": its radius " +
                       detail::number_text(packing.radii[k]) +
                           " m is more than a thousand times the size of the box; is it in metres?",
                       {{packing.ids[k]}, {}});
}

void refuse_repeated_ids(const Packing& packing) {
  std::vector<std::int64_t> ids(packing.ids.data(), packing.ids.data() + packing.size());
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw InputError("sphere id " + std::to_string(*twice) + " occurs twice; ids must be unique",
                     {{*twice}, {}});
}

}  // namespace

void check_motion(const Packing& packing) {
  const auto refuse = [&](Eigen::Index k, const std::string& what) {
    throw InputError("sphere " + std::to_string(packing.ids[k]) + ": its " + what + " is not finite", {{packing.ids[k]}, {}});
  };
  for (Eigen::Index k = 0; k < std::min(packing.velocities.cols(), packing.size()); ++k)
    if (!packing.velocities.col(k).allFinite()) refuse(k, "velocity " + place(packing.velocities.col(k)));
  for (Eigen::Index k = 0; k < std::min(packing.angular_velocities.cols(), packing.size()); ++k)
    if (!packing.angular_velocities.col(k).allFinite()) refuse(k, "spin " + place(packing.angular_velocities.col(k)));
  for (Eigen::Index k = 0; k < std::min(packing.displaced_volumes.size(), packing.size()); ++k)
    if (!std::isfinite(packing.displaced_volumes[k])) refuse(k, "displaced volume");
}

void check_spheres(const Packing& packing) {
  check_shapes(packing);
  check_values(packing);
  check_motion(packing);
  refuse_repeated_ids(packing);
}

std::string sphere_list(const Packing::Ids& ids, const std::vector<int>& columns) {
  constexpr std::size_t shown = 4;
  std::string text = columns.size() == 1 ? "sphere " : "spheres ";
  for (std::size_t i = 0; i < columns.size() && i < shown; ++i)
    text += (i ? ", " : "") + std::to_string(ids[columns[i]]);
  if (columns.size() > shown) text += " and " + std::to_string(columns.size() - shown) + " more";
  return text;
}

bool is_inside(const Packing& packing, Eigen::Index column, const Container& container) {
  for (int axis = 0; axis < 3; ++axis) {
    const double x = packing.positions(axis, column);
    if (!container.periodic[axis] && !(x > container.lower[axis] && x < container.upper[axis])) return false;
  }
  if (container.is_box) return true;
  for (int f = 0; f < container.face_count(); ++f)
    if (periodic_axis(container, f) < 0 && !(container.faces[f].surface.distance(packing.positions.col(column)) > 0.0))
      return false;
  return true;
}

std::vector<WallSurface> walls_of(const Container& container, const Eigen::Vector3d& origin) {
  std::vector<WallSurface> walls;
  for (const ContainerFace& face : container.faces) {
    WallSurface wall{face.surface};
    wall.surface.offset -= wall.surface.normal.dot(origin);
    wall.surface.point -= origin;
    wall.first = wall.surface.axis.unitOrthogonal();
    wall.second = wall.surface.axis.cross(wall.first);
    for (int axis = 0; axis < 3; ++axis)
      if (wall.is_plane() && std::abs(wall.surface.normal[axis]) == 1.0) {
        wall.axis = axis;
        wall.upper = wall.surface.normal[axis] > 0.0;
      }
    walls.push_back(wall);
  }
  return walls;
}

namespace {

InputError outside_of(const Container& container, const Packing& packing, Eigen::Index k) {
  const std::string text =
      "sphere " + std::to_string(packing.ids[k]) + ": its centre " + place(packing.positions.col(k));
  const Culprits culprit{{packing.ids[k]}, {}};
  if (container.is_box)
    return InputError(text + " is not inside the box from " + place(container.lower) + " to " +
                          place(container.upper) + "; enlarge the box or remove the sphere",
                      culprit);
  for (int f = 0; f < container.face_count(); ++f)
    if (periodic_axis(container, f) < 0 && !(container.faces[f].surface.distance(packing.positions.col(k)) > 0.0))
      return InputError(text + " is not inside the container: it stands beyond its face " + container.faces[f].name +
                            "; move that face or remove the sphere",
                        culprit);
  return InputError(text + " is not inside the container; remove the sphere", culprit);
}

/// These columns of the packing, from the corner `lower`, in the home period of a periodic cell.
void gather_spheres(const Packing& packing, const Eigen::Vector3d& lower, const std::vector<int>& columns,
                    Spheres& spheres) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  spheres.ids.resize(n);
  spheres.centres.resize(3, n);
  spheres.radii.resize(n);
  const bool tilted = !spheres.tilt.isZero(0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int k = columns[i];
    spheres.ids[i] = packing.ids[k];
    spheres.centres.col(i) = packing.positions.col(k) - lower;
    if (tilted) {
      const Lattice lattice = spheres.lattice();
      spheres.centres.col(i) -=
          lattice.displacement(lattice.periods(spheres.centres.col(i), [](double x) { return std::floor(x); }));
    }
    for (int axis = 0; axis < 3; ++axis)
      if (spheres.periodic[axis])
        spheres.centres(axis, i) -=
            spheres.edges[axis] * std::floor(spheres.centres(axis, i) / spheres.edges[axis]);
    spheres.radii[i] = packing.radii[k];
  }
}

}  // namespace

bool has_bodies(const Packing& packing) { return (packing.bodies.array() >= 0).any(); }

void note_bodies(ActiveGrains& grains, const Packing& packing) {
  grains.any_bodies = true;
  grains.held.resize(packing.size());
  for (Eigen::Index k = 0; k < packing.size(); ++k) grains.held[k] = body_of(packing, k);
  grains.body.clear();
  for (const int k : grains.columns) grains.body.push_back(grains.held[k]);
}

ActiveGrains select_grains(const Packing& packing, const Container& container, OutsideGrains outside) {
  check_spheres(packing);
  const double volume = volume_of(container);
  refuse_giants(packing, volume);
  if (packing.size() == 0 && outside == OutsideGrains::refuse)
    throw InputError("the packing has no spheres; give at least one");
  ActiveGrains grains;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    if (is_inside(packing, k, container)) {
      grains.columns.push_back(static_cast<int>(k));
    } else if (outside == OutsideGrains::refuse) {
      throw outside_of(container, packing, k);
    }
  }
  Spheres& spheres = grains.spheres;
  spheres.edges = container.upper - container.lower;
  spheres.walls = walls_of(container, container.lower);
  spheres.volume = volume;
  spheres.periodic = container.periodic;
  spheres.tilt = container.tilt;
  gather_spheres(packing, container.lower, grains.columns, spheres);
  if (spheres.size() > 0) spheres.mean_radius = spheres.radii.mean();
  if (packing.displaced_volumes.size() > 0) spheres.displaced = packing.displaced_volumes(grains.columns);
  if (has_bodies(packing)) note_bodies(grains, packing);
  return grains;
}

bool holds_the_same(const ActiveGrains& grains, const Packing& packing) {
  if (!grains.any_bodies) return !has_bodies(packing);
  if (packing.size() > grains.held.size()) return false;
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    if (body_of(packing, k) != grains.held[k]) return false;
  return true;
}

bool same_grains(const Packing& packing, const Container& container, const std::vector<std::int64_t>& ids,
                 const std::vector<int>& columns) {
  if (packing.size() != static_cast<Eigen::Index>(ids.size()) ||
      !std::equal(ids.begin(), ids.end(), packing.ids.data()))
    return false;
  std::size_t next = 0;
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const bool active = next < columns.size() && columns[next] == k;
    if (is_inside(packing, k, container) != active) return false;
    next += active;
  }
  return true;
}

void gather_velocities(const Packing& packing, const std::vector<int>& columns,
                       Eigen::Matrix3Xd& velocities) {
  velocities.resize(3, static_cast<Eigen::Index>(columns.size()));
  if (packing.velocities.cols() == 0)
    velocities.setZero();
  else
    for (std::size_t i = 0; i < columns.size(); ++i)
      velocities.col(static_cast<Eigen::Index>(i)) = packing.velocities.col(columns[i]);
}

double displaced_volume(const Packing& packing, Eigen::Index column) {
  if (packing.displaced_volumes.size() == packing.size()) return packing.displaced_volumes[column];
  const double r = packing.radii[column];
  return 4.0 / 3.0 * pi * r * r * r;
}

bool at_rest(const Packing& packing, const Container& container, bool spins) {
  for (const ContainerFace& face : container.faces)
    if (!face.velocity.isZero(0.0) || !face.angular_velocity.isZero(0.0)) return false;
  return (packing.velocities.array() == 0.0).all() &&
         (!spins || (packing.angular_velocities.array() == 0.0).all());
}

}  // namespace pfv

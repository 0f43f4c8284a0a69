// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"
#include "pfv/error.hpp"
#include "support/packings.hpp"

#include <cmath>
#include <string>
#include <vector>

/// Containers that are not boxes, and spheres inside them.
namespace support {

inline pfv::ContainerFace plane_face(const std::string& name, const Eigen::Vector3d& outward,
                                     const Eigen::Vector3d& through) {
  pfv::ContainerFace face;
  face.name = name;
  face.surface = pfv::Surface::plane(outward, through);
  face.guide = -face.surface.normal;
  return face;
}

inline pfv::ContainerFace cylinder_face(const std::string& name, const Eigen::Vector3d& axis,
                                        const Eigen::Vector3d& point, double radius) {
  pfv::ContainerFace face;
  face.name = name;
  face.surface = pfv::Surface::cylinder(axis, point, radius);
  return face;
}

/// The unit cube, turned about the origin, as six planes in the order xlo ... zhi.
inline pfv::Container turned_cube(const Eigen::Matrix3d& turn) {
  std::vector<pfv::ContainerFace> faces;
  for (const pfv::Face face : pfv::all_faces) {
    const Eigen::Vector3d normal = pfv::outward_normal(face);
    faces.push_back(plane_face(pfv::name_of(face), turn * normal, turn * normal.cwiseMax(0.0)));
  }
  return pfv::container_of(faces);
}

/// Sides around the z axis that lean outwards by `slope` (0: a prism), from z = 0 to 1.
inline pfv::Container frustum(int sides, double slope) {
  std::vector<pfv::ContainerFace> faces;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * pi * (i + 0.3) / sides;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    faces.push_back(plane_face("side" + std::to_string(i), out - slope * Eigen::Vector3d::UnitZ(), 0.6 * out));
  }
  faces.push_back(plane_face("bottom", {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}));
  faces.push_back(plane_face("top", {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}));
  return pfv::container_of(faces);
}

/// A regular prism about the z axis from z = 0, with a corner on the x axis.
inline pfv::Container prism(int sides, double apothem, double height) {
  std::vector<pfv::ContainerFace> faces;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * pi * (i + 0.5) / sides;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    faces.push_back(plane_face("side" + std::to_string(i), out, apothem * out));
  }
  faces.push_back(plane_face("bottom", {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}));
  faces.push_back(plane_face("top", {0.0, 0.0, 1.0}, {0.0, 0.0, height}));
  return pfv::container_of(faces);
}

/// Four sides that meet in a point at the bottom.
inline pfv::Container pyramid() {
  std::vector<pfv::ContainerFace> faces;
  for (int i = 0; i < 4; ++i) {
    const double angle = 2.0 * pi * (i + 0.2) / 4;
    faces.push_back(plane_face("side" + std::to_string(i), {std::cos(angle), std::sin(angle), -0.7}, {0.0, 0.0, 0.0}));
  }
  faces.push_back(plane_face("top", {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}));
  return pfv::container_of(faces);
}

inline pfv::Container wedge() {
  return pfv::container_of({plane_face("x0", {-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}),
                            plane_face("y0", {0.0, -1.0, 0.0}, {0.0, 0.0, 0.0}),
                            plane_face("y1", {0.0, 1.0, 0.0}, {0.0, 0.8, 0.0}),
                            plane_face("tilted", {std::cos(25.0 * pi / 180.0), 0.0, std::sin(25.0 * pi / 180.0)},
                                       {1.0, 0.0, 0.0}),
                            plane_face("bottom", {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}),
                            plane_face("top", {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0})});
}

inline pfv::Container cylinder(const Eigen::Vector3d& axis, const Eigen::Vector3d& point, double radius,
                               double length) {
  const Eigen::Vector3d along = axis.normalized();
  return pfv::container_of({plane_face("bottom", -along, point), plane_face("top", along, point + length * along),
                            cylinder_face("shell", along, point, radius)});
}

/// A closed set of random planes that touch the unit ball.
inline pfv::Container random_polyhedron(Random& random) {
  for (;;) {
    std::vector<pfv::ContainerFace> faces;
    const int count = 4 + static_cast<int>(random(0.0, 9.0));
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d out = random.in_cube().normalized();
      faces.push_back(plane_face("f" + std::to_string(i), out, out));
    }
    try {
      const pfv::Container container = pfv::container_of(faces);
      if ((container.upper - container.lower).maxCoeff() > 20.0) continue;
      pfv::check(container);
      return container;
    } catch (const pfv::InputError&) {
    }
  }
}

/// So many random spheres with their centres inside; neighbours may overlap.
inline pfv::PackingArrays spheres_in(const pfv::Container& container, int count, double largest, Random& random) {
  std::vector<Sphere> spheres;
  const Eigen::Vector3d edges = container.upper - container.lower;
  while (static_cast<int>(spheres.size()) < count) {
    const Eigen::Vector3d place = container.lower + edges.cwiseProduct(random.in_cube(0.0, 1.0));
    bool inside = true;
    for (const pfv::ContainerFace& face : container.faces) inside = inside && face.surface.distance(place) > 1e-6;
    if (inside) spheres.push_back({place[0], place[1], place[2], largest * random(0.3, 1.0)});
  }
  return packing_of(spheres);
}

inline Eigen::Matrix3d some_turn() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
}

}  // namespace support

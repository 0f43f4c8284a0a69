// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "support/packings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

/// Packings that look for trouble, in the unit cube: what a triangulation, a law or a solver may trip
/// over. Same random numbers, same packing.
namespace support {

inline int whole(Random& random, int low, int high) {
  return low + static_cast<int>(random(0.0, high - low + 1.0));
}
inline double logarithmic(Random& random, double low, double high) {
  return low * std::pow(high / low, random());
}
/// A displacement from nothing over round-off to a visible one.
inline double hair(Random& random) {
  static constexpr std::array<double, 6> hairs{0.0, 1e-17, 1e-15, 1e-12, 1e-9, 1e-5};
  return hairs[static_cast<std::size_t>(whole(random, 0, 5))];
}
inline Eigen::Vector3d direction(Random& random) {
  return (random.in_cube() + Eigen::Vector3d(1e-3, 0.0, 0.0)).normalized();
}
inline Sphere sphere_at(const Eigen::Vector3d& x, double radius) {
  return {x[0], x[1], x[2], radius};
}
inline Eigen::Vector3d centre_of(const Sphere& s) { return {s.x, s.y, s.z}; }

namespace adversarial {

using Spheres = std::vector<Sphere>;

inline Spheres few(Random& random) {
  Spheres spheres;
  for (int n = whole(random, 1, 5); n > 0; --n)
    spheres.push_back(sphere_at(random.in_cube(0.0, 1.0), logarithmic(random, 1e-3, 0.5)));
  return spheres;
}

inline Spheres overlapping(Random& random) {
  Spheres spheres;
  const double largest = logarithmic(random, 0.02, 0.4);
  for (int n = whole(random, 5, 60); n > 0; --n)
    spheres.push_back(sphere_at(random.in_cube(0.0, 1.0), largest * random(0.3, 1.0)));
  return spheres;
}

/// On a plane through the middle, straight or oblique, or off it by a hair.
inline Spheres coplanar(Random& random) {
  Eigen::Vector3d normal = Eigen::Vector3d::Unit(whole(random, 0, 2));
  if (random() < 0.5) normal = direction(random);
  const double off = hair(random), radius = logarithmic(random, 0.01, 0.15);
  Spheres spheres;
  for (int n = whole(random, 3, 40); n > 0; --n) {
    Eigen::Vector3d x = random.in_cube(-0.45, 0.45);
    x += (off * random(-1.0, 1.0) - normal.dot(x)) * normal;
    spheres.push_back(sphere_at(Eigen::Vector3d::Constant(0.5) + x, radius * random(0.5, 1.0)));
  }
  return spheres;
}

inline Spheres collinear(Random& random) {
  Eigen::Vector3d way = Eigen::Vector3d::Unit(whole(random, 0, 2));
  if (random() < 0.5) way = direction(random);
  const double off = hair(random);
  const int n = whole(random, 2, 25);
  Spheres spheres;
  for (int i = 0; i < n; ++i)
    spheres.push_back(sphere_at(Eigen::Vector3d::Constant(0.5) +
                                    0.9 * ((i + 0.5) / n - 0.5) * way + off * random.in_cube(),
                                random(0.2, 1.2) / n));
  return spheres;
}

/// Equal spheres on one sphere, often with one in its middle.
inline Spheres cospherical(Random& random) {
  const double distance = random(0.1, 0.4), off = hair(random);
  const double radius = distance * random(0.02, 0.9);
  const Eigen::Vector3d middle = random.in_cube(0.45, 0.55);
  Spheres spheres;
  if (random() < 0.5) spheres.push_back(sphere_at(middle, distance * random(0.01, 1.0)));
  for (int n = whole(random, 4, 40); n > 0; --n)
    spheres.push_back(
        sphere_at(middle + (distance + off * random(-1.0, 1.0)) * direction(random), radius));
  return spheres;
}

/// A piece of a cubic lattice, straight or turned, some sites empty, displaced by a hair.
inline Spheres lattice_fragment(Random& random) {
  const auto kind = static_cast<Lattice>(whole(random, 0, 2));
  const pfv::PackingArrays all = lattice(kind, whole(random, 1, 3), random(0.6, 1.3));
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (random() < 0.3)
    turn = Eigen::AngleAxisd(random(0.0, 3.0), direction(random)).toRotationMatrix();
  const double off = hair(random), kept = random() < 0.5 ? 1.0 : random(0.5, 1.0);
  Spheres spheres;
  for (int k = 0; k < all.radii.size(); ++k) {
    const Eigen::Vector3d x = all.positions.col(k) - Eigen::Vector3d::Constant(0.5);
    if (random() <= kept)
      spheres.push_back(sphere_at(
          Eigen::Vector3d::Constant(0.5) + turn * x + off * random.in_cube(), all.radii[k]));
  }
  return spheres;
}

/// Each sphere again, displaced by a hair that is not zero, with nearly its radius.
inline Spheres duplicates(Random& random) {
  Spheres spheres = overlapping(random);
  const auto n = spheres.size();
  for (std::size_t i = 0; i < n; ++i)
    spheres.push_back(sphere_at(
        centre_of(spheres[i]) + logarithmic(random, 1e-16, 1e-6) * direction(random),
        spheres[i].radius * (1.0 + hair(random) * random(-1.0, 1.0))));
  return spheres;
}

/// Spheres in spheres in spheres: most are hidden.
inline Spheres nested(Random& random) {
  Spheres spheres;
  for (int n = whole(random, 1, 8); n > 0; --n) {
    Eigen::Vector3d x = random.in_cube(0.1, 0.9);
    double radius = random(0.1, 0.4);
    for (int depth = whole(random, 1, 8); depth > 0; --depth) {
      spheres.push_back(sphere_at(x, radius));
      const double inner = radius * random(0.1, 0.95);
      x += (radius - inner) * random(0.5, 1.05) * direction(random);
      radius = inner;
    }
  }
  return spheres;
}

/// Few large spheres, small ones anywhere: in pores, on surfaces, hidden.
inline Spheres wide_ratio(Random& random) {
  const double ratio = logarithmic(random, 10.0, 1e6), large = random(0.1, 0.3);
  Spheres spheres;
  for (int n = whole(random, 1, 8); n > 0; --n)
    spheres.push_back(sphere_at(random.in_cube(0.0, 1.0), large * random(0.5, 1.0)));
  const auto big = spheres.size();
  for (int n = whole(random, 1, 40); n > 0; --n) {
    const double r = large / ratio * random(0.5, 1.0);
    const Sphere& host = spheres[static_cast<std::size_t>(whole(random, 0, int(big) - 1))];
    const bool on_it = random() < 0.4;
    spheres.push_back(sphere_at(
        on_it ? centre_of(host) + (host.radius + r * random(-1.0, 1.0)) * direction(random)
              : random.in_cube(0.0, 1.0), r));
  }
  return spheres;
}

/// Centres a hair from faces, edges and corners; spheres that touch or cross them.
inline Spheres at_walls(Random& random) {
  Spheres spheres = overlapping(random);
  for (Sphere& s : spheres) {
    Eigen::Vector3d x = centre_of(s);
    for (int axis = 0; axis < 3; ++axis) {
      const double choice = random();
      const double depth = choice < 0.3   ? logarithmic(random, 1e-17, 1e-3)
                           : choice < 0.6 ? s.radius * random(0.5, 1.0)
                           : choice < 0.7 ? s.radius
                                          : x[axis];
      x[axis] = random() < 0.5 ? depth : 1.0 - depth;
    }
    s = sphere_at(x, s.radius);
  }
  return spheres;
}

/// Radii far below the distances: almost all of the box is fluid.
inline Spheres dust(Random& random) {
  const double radius = logarithmic(random, 1e-9, 1e-3);
  Spheres spheres;
  for (int n = whole(random, 1, 60); n > 0; --n)
    spheres.push_back(sphere_at(random.in_cube(0.0, 1.0), radius * random(0.1, 1.0)));
  return spheres;
}

/// Spheres larger than the box: little or nothing is left for the fluid.
inline Spheres giants(Random& random) {
  Spheres spheres;
  for (int n = whole(random, 1, 6); n > 0; --n)
    spheres.push_back(sphere_at(random.in_cube(0.0, 1.0), logarithmic(random, 0.5, 1e4)));
  return spheres;
}

/// Coordinates and radii with few binary digits: predicates meet zero again and again.
inline Spheres coarse_numbers(Random& random) {
  Spheres spheres;
  const double step = std::exp2(-whole(random, 2, 4));
  for (int n = whole(random, 4, 60); n > 0; --n) {
    const Eigen::Vector3d x = (random.in_cube(0.0, 1.0) / step).array().round() * step;
    spheres.push_back(sphere_at(x, step * whole(random, 1, 6) / 4.0));
  }
  return spheres;
}

/// Dense clusters whose sizes and distances differ by orders of magnitude.
inline Spheres clusters(Random& random) {
  Spheres spheres;
  for (int n = whole(random, 2, 5); n > 0; --n) {
    const Eigen::Vector3d middle = random.in_cube(0.1, 0.9);
    const double size = logarithmic(random, 1e-8, 0.1);
    for (int m = whole(random, 4, 15); m > 0; --m)
      spheres.push_back(sphere_at(middle + size * random.in_cube(), size * random(0.2, 0.6)));
  }
  return spheres;
}

using Rule = Spheres (*)(Random&);
struct Named {
  const char* name;
  Rule rule;
};
inline constexpr std::array<Named, 15> kinds{{{"few", few},
                                              {"overlapping", overlapping},
                                              {"coplanar", coplanar},
                                              {"collinear", collinear},
                                              {"cospherical", cospherical},
                                              {"lattice fragment", lattice_fragment},
                                              {"duplicates", duplicates},
                                              {"nested", nested},
                                              {"wide ratio", wide_ratio},
                                              {"at walls", at_walls},
                                              {"dust", dust},
                                              {"giants", giants},
                                              {"coarse numbers", coarse_numbers},
                                              {"clusters", clusters},
                                              {"mixed", nullptr}}};

/// Spheres of a kind; "mixed" joins two others.
inline Spheres spheres_of(std::size_t kind, Random& random) {
  if (kinds[kind].rule) return kinds[kind].rule(random);
  Spheres spheres;
  for (int i = 0; i < 2; ++i) {
    const auto one = kinds[static_cast<std::size_t>(whole(random, 0, 13))].rule(random);
    spheres.insert(spheres.end(), one.begin(), one.end());
  }
  return spheres;
}

}  // namespace adversarial
}  // namespace support

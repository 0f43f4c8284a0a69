// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/io.hpp"
#include "pfv/packing.hpp"
#include "support/data_file.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

/// Packings for tests: made by rule or read from tests/data.
namespace support {

inline constexpr double pi = 3.14159265358979323846;

/// Uniform numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double operator()(double low = 0.0, double high = 1.0) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }
  Eigen::Vector3d in_cube(double low = -1.0, double high = 1.0) {
    const double x = (*this)(low, high), y = (*this)(low, high), z = (*this)(low, high);
    return {x, y, z};
  }

 private:
  std::mt19937_64 generator_;
};

struct Sphere {
  double x, y, z, radius;
};

/// Ids are 1, 2, 3, ...
inline pfv::PackingArrays packing_of(const std::vector<Sphere>& spheres) {
  pfv::PackingArrays packing;
  const auto n = static_cast<Eigen::Index>(spheres.size());
  packing.ids.setLinSpaced(n, 1, n);
  packing.positions.resize(3, n);
  packing.radii.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    packing.positions.col(k) << spheres[k].x, spheres[k].y, spheres[k].z;
    packing.radii[k] = spheres[k].radius;
  }
  return packing;
}

inline pfv::PackingArrays data_packing(const std::string& name) {
  return pfv::read_packing(data_file(name));
}

/// Spheres placed at random one after another (random sequential addition): they neither overlap
/// nor cross a face. Radii are spread evenly over their logarithm, large spheres first.
inline pfv::PackingArrays random_packing(int count, double smallest, double largest,
                                         std::uint64_t seed, const pfv::Box& box = {}) {
  Random random(seed);
  std::vector<Sphere> placed;
  for (int tries = 0; static_cast<int>(placed.size()) < count; ++tries) {
    if (tries > 2000000) throw std::logic_error("random_packing: too dense");
    const double share = count > 1 ? static_cast<double>(placed.size()) / (count - 1) : 0.0;
    const double r = largest * std::pow(smallest / largest, share);
    Eigen::Vector3d x;
    for (int axis = 0; axis < 3; ++axis)
      x[axis] = random(box.lower[axis] + r, box.upper[axis] - r);
    bool free = true;
    for (const Sphere& s : placed)
      free = free && (x - Eigen::Vector3d(s.x, s.y, s.z)).norm() > r + s.radius;
    if (free) placed.push_back({x[0], x[1], x[2], r});
  }
  return packing_of(placed);
}

enum class Lattice { sc, bcc, fcc };

/// n³ unit cells of edge 1/n in the unit cube, no centre on a face. Neighbours touch when
/// `scale` is 1.
inline pfv::PackingArrays lattice(Lattice kind, int n, double scale = 1.0) {
  std::vector<Eigen::Vector3d> base;
  double radius = 0.5;
  if (kind == Lattice::sc) base = {{0.5, 0.5, 0.5}};
  if (kind == Lattice::bcc) {
    base = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}};
    radius = std::sqrt(3.0) / 4.0;
  }
  if (kind == Lattice::fcc) {
    base = {{0.25, 0.25, 0.25}, {0.25, 0.75, 0.75}, {0.75, 0.25, 0.75}, {0.75, 0.75, 0.25}};
    radius = std::sqrt(2.0) / 4.0;
  }
  std::vector<Sphere> spheres;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const Eigen::Vector3d& b : base)
          spheres.push_back({(i + b[0]) / n, (j + b[1]) / n, (k + b[2]) / n, scale * radius / n});
  return packing_of(spheres);
}

/// Eight spheres of diameter 0.5 on a 2 x 2 x 2 cubic arrangement and, for d_over_D > 0, a ninth in
/// the middle (Chareyre et al. 2012, sec. 4.2). The ninth comes last.
inline pfv::PackingArrays nine_spheres(double d_over_D) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 8; ++i)
    spheres.push_back({0.25 + 0.5 * (i & 1), 0.25 + 0.5 * (i >> 1 & 1), 0.25 + 0.5 * (i >> 2),
                       0.25});
  if (d_over_D > 0.0) spheres.push_back({0.5, 0.5, 0.5, 0.25 * d_over_D});
  return packing_of(spheres);
}

inline double solid_volume(const pfv::PackingArrays& packing) {
  return 4.0 / 3.0 * pi * packing.radii.array().cube().sum();
}
inline double solid_surface(const pfv::PackingArrays& packing) {
  return 4.0 * pi * packing.radii.squaredNorm();
}

}  // namespace support

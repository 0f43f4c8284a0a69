// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/sphere_stresses.hpp"

#include "geometry/pi.hpp"
#include "geometry/solid_angle.hpp"
#include "geometry/tensor_rows.hpp"
#include "physics/pore_velocities.hpp"
#include "physics/macroscopic_gradient.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace pfv {

namespace {

/// Integral of n n^T over the spherical triangle of three directions. The surface divergence of n_i
/// e_j (projected) is delta_ij - 3 n_i n_j, so that the integral is the solid angle's third plus a
/// line integral over the edges, each in closed form: of n along the arc from a to b it is (a + b)
/// tan(arc / 2), and the outward conormal is constant.
Eigen::Matrix3d second_moment(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c) {
  const double angle = solid_angle(a, b, c);
  Eigen::Matrix3d sum = angle * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d corners[3] = {a.normalized(), b.normalized(), c.normalized()};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &from = corners[k], &to = corners[(k + 1) % 3];
    const Eigen::Vector3d cross = from.cross(to);
    const double sine = cross.norm();
    if (sine == 0.0) continue;
    const double half_tangent = sine / (1.0 + from.dot(to));
    // with the triangle to the left of from -> to the outward side is to the right
    sum += half_tangent / sine * (from + to) * cross.transpose();
  }
  return sum / 3.0;
}

}  // namespace

Stresses sphere_stresses(const PoreNetwork& network, const Throats& throats,
                         const ViscousShares& shares, const Spheres& vertices,
                         const Eigen::VectorXd& pressures, const Spheres& spheres,
                         const Eigen::Vector3d& gradient) {
  Stresses stresses = Stresses::Zero(6, spheres.size());
  for (int c = 0; c < network.cells(); ++c) {
    const auto& cell = network.cell_vertices[c];
    for (int i = 0; i < 4 && !is_wall(cell[i]); ++i) {
      const Eigen::Vector3d x = vertices.towards(cell[i], cell[(i + 1) % 4]),
                            y = vertices.towards(cell[i], cell[(i + 2) % 4]),
                            z = vertices.towards(cell[i], cell[(i + 3) % 4]);
      const bool positive = solid_angle(x, y, z) >= 0.0;
      const int sphere = network.vertex_sphere[cell[i]];
      const Eigen::Vector3d offset = vertices.centres.col(cell[i]) - spheres.centres.col(sphere);
      stresses.col(sphere) += tensor_rows(
          -3.0 / (4.0 * pi) * (pressures[network.cell_pore[c]] - gradient.dot(offset)) *
              (positive ? second_moment(x, y, z) : second_moment(x, z, y)));
    }
  }
  for (int t = 0; t < network.throats(); ++t) {
    const Eigen::Vector3d force = throats.fluid_area[t] *
                                  driving_pressure(network, t, pressures, gradient) *
                                  throats.normal.col(t);
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      const Eigen::Vector3d middle = facet_middle(network.facet_vertices[f], vertices);
      for (int k = 0; k < 3; ++k) {
        const Vertex vertex = network.facet_vertices[f][k];
        if (is_wall(vertex)) continue;
        const Eigen::Vector3d way = middle - vertices.centres.col(vertex);
        const double radius = vertices.radii[vertex], length = way.norm();
        if (!(length > 0.0)) continue;
        const double volume = 4.0 / 3.0 * pi * std::pow(radius, 3);
        stresses.col(network.vertex_sphere[vertex]) +=
            tensor_rows(shares[f][k] * radius / (length * volume) * force * way.transpose());
      }
    }
  }
  return stresses;
}

}  // namespace pfv

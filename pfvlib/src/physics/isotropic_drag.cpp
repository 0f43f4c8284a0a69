// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/isotropic_drag.hpp"

#include "geometry/pi.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pfv {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double least = 0.3, most = 3.0;  // of s
constexpr double undetermined = 1e-6;      // of the largest eigenvalue

/// n n^T, in coordinates in which the product of two matrices is that of the vectors.
Vector6 square_of(const Eigen::Vector3d& n) {
  const double root = std::sqrt(2.0);
  Vector6 square;
  square << n[0] * n[0], n[1] * n[1], n[2] * n[2], root * n[1] * n[2], root * n[0] * n[2], root * n[0] * n[1];
  return square;
}

const Vector6 unit_matrix = (Vector6() << 1.0, 1.0, 1.0, 0.0, 0.0, 0.0).finished();

int sphere_count(const PoreNetwork& network) {
  return network.vertex_sphere.empty()
             ? 0
             : 1 + *std::max_element(network.vertex_sphere.begin(), network.vertex_sphere.end());
}

/// Whether all facets of a sphere lie between it, its own images and walls.
std::vector<char> spheres_alone(const PoreNetwork& network) {
  std::vector<char> alone(sphere_count(network), 1);
  for (const auto& facet : network.facet_vertices)
    for (int k = 0; k < 3; ++k) {
      const Vertex one = facet[k], other = facet[(k + 1) % 3];
      if (is_wall(one) || is_wall(other) || network.vertex_sphere[one] == network.vertex_sphere[other]) continue;
      alone[network.vertex_sphere[one]] = alone[network.vertex_sphere[other]] = 0;
    }
  return alone;
}

/// Calls visit(throat, sphere, solid angle) for each sphere of each facet of a throat.
template <class Visit>
void for_each_view(const PoreNetwork& network, const Throats& throats, const Spheres& vertices, Visit&& visit) {
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        const Vertex vertex = network.facet_vertices[f][k];
        if (is_wall(vertex)) continue;
        const double radius = vertices.radii[vertex];
        visit(t, network.vertex_sphere[vertex], throats.facet_gamma[f][k] / (radius * radius));
      }
}

/// Of the domain of a throat. That of a pore beyond a wall, as beside one of many sides, is negative in both parts.
double solid_fraction_of(const Throats& throats, int t) {
  const double domain = domain_of(throats, t);
  return domain != 0.0 ? std::clamp(1.0 - throats.volume[t] / domain, 0.0, 1.0) : 1.0;
}

/// B, for the sum of Omega s n n^T to be 4 pi / 3.
Vector6 weights_for(const Matrix6& facets) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> parts(facets);
  const double bound = undetermined * parts.eigenvalues().cwiseAbs().maxCoeff();
  const Vector6 inverse =
      parts.eigenvalues().unaryExpr([=](double value) { return value > bound ? 1.0 / value : 0.0; });
  const Vector6 missing = 4.0 / 3.0 * pi * unit_matrix - facets * unit_matrix;
  return unit_matrix +
         parts.eigenvectors() * inverse.cwiseProduct(parts.eigenvectors().transpose() * missing);
}

}  // namespace

std::vector<double> solid_fractions_around(const PoreNetwork& network, const Throats& throats,
                                           const Spheres& vertices) {
  const int spheres = sphere_count(network);
  std::vector<double> sum(spheres, 0.0), angle(spheres, 0.0);
  for_each_view(network, throats, vertices, [&](int t, int k, double seen) {
    sum[k] += std::abs(seen) * solid_fraction_of(throats, t);
    angle[k] += std::abs(seen);
  });
  for (int k = 0; k < spheres; ++k) sum[k] = angle[k] > 0.0 ? sum[k] / angle[k] : 1.0;
  return sum;
}

void make_drag_isotropic(const PoreNetwork& network, const Throats& throats, const Spheres& vertices,
                         std::vector<double>& conductances) {
  std::vector<char> alone = spheres_alone(network);
  if (std::none_of(alone.begin(), alone.end(), [](char is) { return is; })) return;
  const std::vector<double> fractions = solid_fractions_around(network, throats, vertices);
  std::vector<int> place(fractions.size(), -1);
  int count = 0;
  for (std::size_t k = 0; k < fractions.size(); ++k)
    if (alone[k] && fractions[k] < open_fraction) place[k] = count++;
  std::vector<Matrix6> facets(count, Matrix6::Zero());
  for_each_view(network, throats, vertices, [&](int t, int k, double seen) {
    if (place[k] < 0) return;
    const Vector6 square = square_of(throats.normal.col(t));
    facets[place[k]] += seen * square * square.transpose();
  });
  std::vector<Vector6> weights(count);
  std::transform(facets.begin(), facets.end(), weights.begin(), weights_for);
  for (int t = 0; t < network.throats(); ++t) {
    const Vector6 square = square_of(throats.normal.col(t));
    double excess = 0.0, surface = 0.0;
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
      for (int k = 0; k < 3; ++k) {
        const Vertex vertex = network.facet_vertices[f][k];
        const double gamma = std::abs(throats.facet_gamma[f][k]);
        surface += gamma;
        if (is_wall(vertex)) continue;
        if (const int i = place[network.vertex_sphere[vertex]]; i >= 0)
          excess += gamma * (std::clamp(weights[i].dot(square), least, most) - 1.0);
      }
    if (excess != 0.0 && surface > 0.0) conductances[t] /= 1.0 + excess / surface;
  }
}

}  // namespace pfv

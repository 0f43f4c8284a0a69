// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled so that sqrt sets no errno: its loops then become vector instructions.
#include "physics/facet_shapes.hpp"

#include "geometry/arctangent.hpp"

#include <cmath>

namespace pfv {
namespace {

using Lane = double[facet_batch];

/// A batch of facets, component by component.
struct Batch {
  Lane corner[3][3], centre[2][3];
  Lane normal[3], twice_area, side[3], angle[3], height[2], solid_angle[3][2];
};

// The thread sanitizer's runtime is not there yet when the clone is chosen.
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define PFV_FOR_EACH_PROCESSOR \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PFV_FOR_EACH_PROCESSOR
#endif

// One function, long as it is: the loop becomes vector instructions as a whole.
PFV_FOR_EACH_PROCESSOR void measure(Batch& b) {
  for (int i = 0; i < facet_batch; ++i) {
    double e[3][3], n[3];  // from corner k to the next one
    for (int a = 0; a < 3; ++a) {
      e[0][a] = b.corner[1][a][i] - b.corner[0][a][i];
      e[1][a] = b.corner[2][a][i] - b.corner[1][a][i];
      e[2][a] = b.corner[0][a][i] - b.corner[2][a][i];
    }
    n[0] = e[2][1] * e[0][2] - e[2][2] * e[0][1];
    n[1] = e[2][2] * e[0][0] - e[2][0] * e[0][2];
    n[2] = e[2][0] * e[0][1] - e[2][1] * e[0][0];
    const double twice = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double scale = twice > 0.0 ? 1.0 / twice : 0.0;
    double l[3], d[3];
    for (int k = 0; k < 3; ++k)
      l[k] = std::sqrt(e[k][0] * e[k][0] + e[k][1] * e[k][1] + e[k][2] * e[k][2]);
    for (int k = 0; k < 3; ++k) {
      const int before = (k + 2) % 3;
      d[k] = -(e[k][0] * e[before][0] + e[k][1] * e[before][1] + e[k][2] * e[before][2]);
      b.angle[k][i] = arctangent(twice, d[k]);
      b.side[k][i] = l[k];
      b.normal[k][i] = scale * n[k];
    }
    b.twice_area[i] = twice;
    for (int s = 0; s < 2; ++s) {
      double determinant = 0.0;
      for (int k = 0; k < 3; ++k) {
        const int before = (k + 2) % 3;
        double c[3];
        for (int a = 0; a < 3; ++a) c[a] = b.centre[s][a][i] - b.corner[k][a][i];
        const double lc = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        const double with_next = e[k][0] * c[0] + e[k][1] * c[1] + e[k][2] * c[2];
        const double with_last =
            -(e[before][0] * c[0] + e[before][1] * c[1] + e[before][2] * c[2]);
        const double out = n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
        determinant = k == 0 ? (s == 0 ? -out : out) : determinant;
        b.solid_angle[k][s][i] =
            2.0 * arctangent(determinant, l[k] * l[before] * lc + d[k] * lc + with_last * l[k] +
                                              with_next * l[before]);
      }
      b.height[s][i] = scale * determinant;
    }
  }
}

}  // namespace

void measure_facets(const PoreNetwork& network, const Spheres& spheres, const int* facets,
                    const int* throats, int count, FacetShape* shapes) {
  Batch batch;
  for (int i = 0; i < facet_batch; ++i) {
    const int own = i < count ? i : 0;  // lanes that are not filled repeat the first
    const auto& facet = network.facet_vertices[facets[own]];
    const auto& pores = network.throat_pores[throats[own]];
    const Eigen::Vector3d offset = network.throat_offset(throats[own]);
    for (int a = 0; a < 3; ++a) {
      for (int k = 0; k < 3; ++k) batch.corner[k][a][i] = spheres.centres(a, facet[k]);
      batch.centre[0][a][i] = network.pore_centres(a, pores[0]);
      batch.centre[1][a][i] = network.pore_centres(a, pores[1]) + offset[a];
    }
  }
  measure(batch);
  for (int i = 0; i < count; ++i) {
    FacetShape& shape = shapes[i];
    shape.area = 0.5 * batch.twice_area[i];
    for (int k = 0; k < 3; ++k) {
      shape.normal[k] = batch.normal[k][i];
      shape.side[k] = batch.side[k][i];
      shape.angle[k] = batch.angle[k][i];
      for (int s = 0; s < 2; ++s) shape.solid_angle[k][s] = batch.solid_angle[k][s][i];
    }
    for (int s = 0; s < 2; ++s) shape.height[s] = batch.height[s][i];
  }
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/permeability_error.hpp"

#include "physics/open_throat.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace pfv {

namespace {

constexpr double base_error = 0.055;
constexpr double blend_error = 0.06;
constexpr double wall_error = 0.05;
constexpr double hidden_error = 0.8;
constexpr double rule_error = 0.5;
constexpr double sampling_error = 1.7;
constexpr double first_order_error = 0.05;  // of ln K, by what d ln K leaves out of a large change

// What the anchors span.
constexpr double smallest_solid_fraction = 5e-4;  // simple cubic, radii x 0.1
constexpr double largest_solid_fraction = 0.745;  // FCC, touching
constexpr double largest_size_ratio = 10.0;       // nine spheres, d/D 0.1
constexpr double largest_hidden_share = 0.17;     // simple cubic, radii x 1.06
constexpr double largest_wall_share = 0.40;       // nine spheres, d/D 0.72
// Shares of the dissipation beyond which what was not compared matters.
constexpr double notable_degenerate = 0.01, notable_ratio = 0.05;

/// Means over the throats, weighted with their dissipation.
struct Means {
  double error = 0.0, bias = 0.0, degenerate = 0.0, hidden = 0.0, walls = 0.0, unlike = 0.0, drag = 0.0;
  double square = 0.0;               ///< of the weights themselves
  double shape = 0.0, shape2 = 0.0;  ///< of ln(mu g / S²), and of its square
};

/// What throats err by on their own where spheres are apart, over as few as the flow takes. None in a lattice, whose
/// throats are alike.
double scatter(const Means& means) {
  const double spread = std::sqrt(std::max(0.0, means.shape2 - means.shape * means.shape));
  return sampling_error * means.drag * spread * std::sqrt(means.square);
}

double throat_error(const OpenThroat& throat) {
  return base_error + blend_error * throat.drag_share * (1.0 - throat.drag_share) +
         wall_error * throat.wall_share + hidden_error * throat.hidden_share;
}

/// Largest over smallest sphere of a facet of the throat.
double size_ratio(const PoreNetwork& network, const Spheres& spheres, int t) {
  double ratio = 1.0;
  for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f)
    for (const Vertex a : network.facet_vertices[f])
      for (const Vertex b : network.facet_vertices[f])
        if (!is_wall(a) && !is_wall(b))
          ratio = std::max(ratio, spheres.radii[a] / spheres.radii[b]);
  return ratio;
}

/// All but `square`, which goes with the square of the weights.
std::array<double*, 9> sums_of_weights(Means& sums) {
  return {&sums.error, &sums.bias, &sums.degenerate, &sums.hidden, &sums.walls, &sums.unlike, &sums.drag, &sums.shape, &sums.shape2};
}

/// Sums with the weights of all ranks -> means.
Means means_of(Means sums, double total) {
  for (double* part : sums_of_weights(sums)) *part /= total;
  sums.square /= total * total;
  return sums;
}

void add_shape(Means& sums, double weight, double conductance, double area) {
  if (!(conductance > 0.0 && area > 0.0)) return;
  const double shape = std::log(conductance / (area * area));
  sums.shape += weight * shape;
  sums.shape2 += weight * shape * shape;
}

std::string percent(const char* what, double share, double checked) {
  return std::string(what) + ' ' + detail::percent_text(share) + " (compared up to " + detail::percent_text(checked) + ")";
}

std::vector<std::string> outside_range(const Means& means, double solid_fraction) {
  std::vector<std::string> outside;
  if (solid_fraction < smallest_solid_fraction || solid_fraction > largest_solid_fraction) {
    char text[80];
    std::snprintf(text, sizeof text, "the solid fraction is %.3g (compared from 0.0005 to 0.74)", solid_fraction);
    outside.push_back(text);
  }
  if (means.hidden > largest_hidden_share)
    outside.push_back(percent("overlaps hide, of the solid surface beside the flow (a mean over its dissipation),",
                              means.hidden, largest_hidden_share));
  if (means.walls > largest_wall_share)
    outside.push_back(percent("no-slip walls make up, of the solid surface beside the flow (a mean over its "
                              "dissipation),", means.walls, largest_wall_share));
  if (means.unlike > notable_ratio)
    outside.push_back(percent("throats of spheres with a size ratio above 10 take, of the flow's "
                              "dissipation,", means.unlike, notable_ratio));
  if (means.degenerate > notable_degenerate)
    outside.push_back(percent("degenerate throats take, of the flow's dissipation,",
                              means.degenerate, notable_degenerate));
  return outside;
}

}  // namespace

PermeabilityError permeability_error(const PoreNetwork& network, const Throats& throats,
                                     const Spheres& spheres, ConductanceLaw law, double viscosity,
                                     const Conductances& conductances,
                                     const std::vector<double>& dissipation,
                                     double solid_fraction, const Share& share) {
  Means sums;
  double total = 0.0;
  for (int t = 0; t < network.throats(); ++t) {
    const double weight = dissipation[t];
    if (!(weight > 0.0)) continue;
    total += weight;
    const OpenThroat throat = open_throat(network, throats, spheres, t);
    const bool degenerate = throat.by_rule || throat.at_bound || throat.value <= 0.0 ||
                            throats.volume[t] <= 0.0 || throats.gamma[t] <= 0.0;
    sums.error += weight * (degenerate ? rule_error : throat_error(throat));
    if (degenerate) sums.degenerate += weight;
    if (law != ConductanceLaw::open_throat && throat.value > 0.0)
      sums.bias += weight * std::log(conductances.value[t] * viscosity * throats.length[t] /
                                     throat.value);
    add_shape(sums, weight, throat.value, throats.area[t]);
    sums.drag += weight * throat.drag_share;
    sums.square += weight * weight;
    sums.hidden += weight * throat.hidden_share;
    sums.walls += weight * throat.wall_share;
    if (size_ratio(network, spheres, t) > largest_size_ratio * (1.0 + 1e-9)) sums.unlike += weight;
  }
  for (double* part : sums_of_weights(sums)) *part = share.sum(*part);
  for (double* part : {&sums.square, &total}) *part = share.sum(*part);
  if (!(total > 0.0)) return {};
  const Means means = means_of(sums, total);
  PermeabilityError result;
  result.relative = std::expm1(std::hypot(means.error, scatter(means)) + (1.0 + first_order_error) * std::abs(means.bias));
  result.degenerate_share = means.degenerate;
  result.outside_range = outside_range(means, solid_fraction);
  return result;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// Boundaries and motions that leave the pressure undetermined: refused before anything is solved.
#include "step/solvability.hpp"

#include "network/facets.hpp"
#include "pfv/error.hpp"
#include "physics/cell_stretching.hpp"
#include "step/network_builder.hpp"
#include "step/operators.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace pfv {

namespace {

bool any_boundary(const Container& container, bool (Boundary::*is)() const) {
  for (int b = 0; b < boundary_count(container); ++b)
    if ((boundary_of(container, b).*is)()) return true;
  return false;
}

std::string place_of(const BuiltNetwork& built, int pore) {
  const Eigen::Vector3d x = built.network.origin + built.network.pore_centres.col(pore);
  std::ostringstream text;
  text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

/// Spheres of the packing around a set of pores, ascending.
std::vector<int> spheres_around(const BuiltNetwork& built, const std::vector<int>& pores) {
  std::vector<int> spheres;
  for (int c = 0; c < built.network.cells(); ++c)
    if (std::binary_search(pores.begin(), pores.end(), built.network.cell_pore[c]))
      for (const Vertex vertex : built.network.cell_vertices[c])
        if (!is_wall(vertex)) spheres.push_back(built.network.vertex_sphere[vertex]);
  std::sort(spheres.begin(), spheres.end());
  spheres.erase(std::unique(spheres.begin(), spheres.end()), spheres.end());
  return spheres;
}

Culprits culprits_of(const BuiltNetwork& built, const std::vector<int>& spheres,
                     const std::vector<int>& pores) {
  Culprits culprits;
  for (const int sphere : spheres) culprits.spheres.push_back(built.grains.spheres.ids[sphere]);
  for (const int pore : pores) {
    const Eigen::Vector3d x = built.network.origin + built.network.pore_centres.col(pore);
    culprits.places.push_back({x[0], x[1], x[2]});
  }
  return culprits;
}

std::vector<int> spheres_at(const PoreNetwork& network, int throat) {
  std::vector<int> spheres;
  for (const Vertex vertex : network.facet_vertices[network.throat_facets[throat]])
    if (!is_wall(vertex)) spheres.push_back(network.vertex_sphere[vertex]);
  return spheres;
}

}  // namespace

namespace {

/// What the surface of each pore leaves open: the sum of its area vectors, m².
Eigen::Matrix3Xd openings_in(const BuiltNetwork& built) {
  const PoreNetwork& network = built.network;
  Eigen::Matrix3Xd open = Eigen::Matrix3Xd::Zero(3, network.pores());
  for (int t = 0; t < network.throats(); ++t)
    for (int f = network.throat_facets[t]; f < network.throat_facets[t + 1]; ++f) {
      const Eigen::Vector3d area = area_vector(network.facet_vertices[f], built.vertices);
      open.col(network.throat_pores[t][0]) += area;
      open.col(network.throat_pores[t][1]) -= area;
    }
  for (int b = 0; b < built.bases.size(); ++b)
    if (built.bases.face[b] >= 0) open.col(built.bases.pore[b]) += built.bases.load(b).head<3>();
  return open;
}

}  // namespace

void refuse_open_pores(const BuiltNetwork& built) {
  constexpr double round_off = 1e-9;
  const Share& share = built.share;
  const auto& walls = built.vertices.walls;
  if ((!share.ranks && built.network.pores() == 0) ||
      std::all_of(walls.begin(), walls.end(), [](const WallSurface& wall) { return wall.is_plane(); }))
    return;
  const Eigen::VectorXd open = openings_in(built).colwise().norm();
  const std::vector<double>& areas = built.geometry.areas;
  int pore = -1;
  for (int p = 0; p < open.size(); ++p)
    if (share.owns_pore(p) && (pore < 0 || open[p] > open[pore])) pore = p;
  const double here = pore < 0 ? 0.0 : open[pore] / *std::max_element(areas.begin(), areas.end());
  double volume = 0.0;
  for (const double own : built.throats.pore_volume) volume += own;
  const double worst = share.largest(here);
  if (worst <= round_off && std::abs(share.sum(volume) / built.geometry.volume - 1.0) <= round_off) return;
  share.together([&] {
    if (pore < 0 || here < worst) return;
    const std::vector<int> spheres = spheres_around(built, {pore});
    throw InputError("the spheres are too few, or too unlike, for a cylinder: pores reach around its axis (near " +
                         place_of(built, pore) + ", between " + sphere_list(built.grains.spheres.ids, spheres) +
                         "); take planes around it in the place of the cylinder (container file: \"flats\": 32; for a mesh "
                         "of the fix: `container flats`), or more spheres",
                     culprits_of(built, spheres, {pore}));
  });
}

namespace {

/// What goes in comes out, and something does.
bool fluxes_balance(const Container& container) {
  double sum = 0.0, largest = 0.0;
  for (int b = 0; b < boundary_count(container); ++b) {
    const double inflow = imposed_inflow(container, b);
    sum += inflow;
    largest = std::max(largest, std::abs(inflow));
  }
  return largest > 0.0 && std::abs(sum) <= 1e-9 * largest;
}

/// Empty where something determines the pressure.
std::string what_is_undetermined(const Problem& problem, bool moving) {
  const Container& container = problem.container;
  // a cell that repeats in itself keeps its volume: its pressure is determined but for the level
  if (problem.fluid.bulk_modulus || container.any_periodic() || any_boundary(container, &Boundary::imposes_pressure)) return {};
  if (moving)
    return "the grains or faces move, the fluid is incompressible, and no face, patch "
           "or region has a pressure: nothing determines the pressure; give a pressure to a face, "
           "or a bulk modulus";
  if (fluxes_balance(container))
    return "fluxes are imposed that balance, the fluid is incompressible, and no face, patch or region has a "
           "pressure: its level is not determined; give one of the faces a pressure in place of its flux";
  if (any_boundary(container, &Boundary::drives_flux))
    return "a flux is imposed, the fluid is incompressible, and no face, patch or region has a "
           "pressure: the fluid cannot leave; give a pressure to a face, or a bulk "
           "modulus";
  return {};
}

}  // namespace

void refuse_undetermined(const Problem& problem, bool moving) {
  const std::string text = what_is_undetermined(problem, moving);
  if (text.empty()) return;  // on all ranks alike
  const auto refuse = [&text] { throw InputError(text); };
  if (problem.ranks) problem.ranks->together(refuse);
  else refuse();
}

/// The factor needs the digits by which what leaves a group of pores differs from what its own throats
/// could carry: with fewer than sixteen there are none left.
SolverError too_far_apart(const BuiltNetwork& built, const Fluid& fluid,
                          const std::string& reason) {
  const PoreNetwork& network = built.network;
  const std::vector<double>& c = built.conductances.value;
  int weakest = -1, strongest = -1;
  for (int t = 0; t < network.throats(); ++t) {
    if (!(c[t] > 0.0)) continue;
    if (weakest < 0 || c[t] < c[weakest]) weakest = t;
    if (strongest < 0 || c[t] > c[strongest]) strongest = t;
  }
  if (weakest < 0) return SolverError(reason);
  std::vector<int> named, pores;
  const auto name = [&](int t) {
    const std::vector<int> spheres = spheres_at(network, t);
    named.insert(named.end(), spheres.begin(), spheres.end());
    pores.push_back(network.throat_pores[t][0]);
    std::ostringstream text;
    text << c[t] << " m3/(Pa s) near " << place_of(built, network.throat_pores[t][0]) << " at "
         << sphere_list(built.grains.spheres.ids, spheres);
    return text.str();
  };
  std::string text =
      "the conductances of the throats reach from " + name(weakest) + " to " + name(strongest) +
      (fluid.bulk_modulus ? ", and the fluid stores little in a time step" : "") +
      ": too far apart for sixteen digits; remove spheres that nearly coincide or close their "
      "pores" + (fluid.bulk_modulus ? ", or take a shorter time step" : "");
  if (!reason.empty()) text += " (" + reason + ")";
  return SolverError(text, culprits_of(built, named, pores));
}

namespace {

/// Where grains and faces move all alike, every rate is the round-off (m³/s) of what cancels in it. A cell that
/// is stretched at constant volume has lengths that are known to their own round-off.
double rounding_of_rates(const BuiltNetwork& built, const Solution& solution) {
  constexpr double round_off = 1e-13;
  if (!solution.moving) return 0.0;
  const Eigen::VectorXd gross = gross_rates(built, solution.motion);
  const double of_sums = round_off * built.share.largest(gross.size() > 0 ? gross.maxCoeff() : 0.0);
  if (!(solution.dt > 0.0) || !stretches(solution.container)) return of_sums;
  return of_sums + round_off * solution.geometry.volume / solution.dt;
}

/// What must leave an isolated set of pores, m³/s, and what it is the sum of.
struct Forced {
  double net = 0.0, gross = 0.0;
};

Forced forced_out(const BuiltNetwork& built, const Solution& solution, const Isolated& isolated) {
  Forced forced;
  for (const int pore : isolated.pores) {
    forced.net -= solution.rates[pore];
    forced.gross += std::abs(solution.rates[pore]);
  }
  for (std::size_t b = 0; b < built.unknowns.fed_by.size(); ++b) {
    const int fed = built.unknowns.fed_by[b];
    if (fed < 0 || std::find(isolated.pores.begin(), isolated.pores.end(), fed) == isolated.pores.end()) continue;
    const double flux = imposed_inflow(solution.container, static_cast<int>(b));
    forced.net += flux;
    forced.gross += std::abs(flux);
  }
  forced.net = built.share.sum(forced.net);
  forced.gross = built.share.sum(forced.gross);
  return forced;
}

InputError cut_off(const BuiltNetwork& built, const Isolated& isolated, double pores, double net) {
  std::ostringstream text;
  const std::vector<int> spheres = spheres_around(built, isolated.pores);
  text << pores << " pore(s) ";
  text << "near " << place_of(built, isolated.pores.front()) << " between "
       << sphere_list(built.grains.spheres.ids, spheres) << " are cut off from every pressure, but " << net
       << " m3/s (imposed flux less change of volume) must leave them; give the fluid a bulk modulus, or reduce the "
          "overlaps";
  return InputError(text.str(), culprits_of(built, spheres, isolated.pores));
}

}  // namespace

void refuse_isolated(const BuiltNetwork& built, const Solution& solution,
                     const std::vector<Isolated>& held) {
  if (held.empty()) return;
  const Share& share = built.share;
  // rates are sums of area times velocity: their own round-off is no change of volume
  const double noise =
      1e-12 * share.largest(solution.rates.size() > 0 ? solution.rates.cwiseAbs().maxCoeff() : 0.0);
  std::optional<double> rounding;  // seldom needed
  for (const Isolated& isolated : held) {
    const auto [net, gross] = forced_out(built, solution, isolated);
    if (std::abs(net) <= 1e-10 * gross + noise) continue;
    if (!rounding) rounding = rounding_of_rates(built, solution);
    if (std::abs(net) <= *rounding) continue;
    const double pores = share.sum(static_cast<double>(isolated.pores.size()));
    share.together([&] {
      if (!isolated.pores.empty()) throw cut_off(built, isolated, pores, net);
    });
  }
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/averages.hpp"

#include "geometry/pi.hpp"
#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "physics/pore_velocities.hpp"
#include "physics/sphere_stresses.hpp"
#include "step/carried_pressures.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace pfv {

namespace {

/// Of ghosts as their owners have them, where these have all their throats; else of what is here.
Eigen::Matrix3Xd integrals_of(const BuiltNetwork& built, const Balance& balance) {
  Eigen::Matrix3Xd integrals = velocity_integrals(built.network, built.vertices, built.boundaries,
                                                  balance.throat_fluxes, balance.contact_inflows);
  if (built.share.ranks) built.share.pores.refresh(*built.share.ranks, integrals);
  return integrals;
}

/// Of all pores, ghosts among them.
Eigen::VectorXd volumes_of(const BuiltNetwork& built) {
  Eigen::VectorXd volumes = storage_volumes(built.throats);
  if (built.share.ranks) built.share.pores.refresh(*built.share.ranks, volumes);
  return volumes;
}

}  // namespace

void require_axis(int axis) {
  if (axis < 0 || axis > 2) throw InputError("axis " + std::to_string(axis) + ": give 0, 1 or 2 for x, y or z");
}

Eigen::Matrix3Xd pore_velocities(const BuiltNetwork& built, const Balance& balance) {
  Eigen::Matrix3Xd velocities = integrals_of(built, balance);
  const Eigen::VectorXd volumes = volumes_of(built);
  for (Eigen::Index p = 0; p < volumes.size(); ++p)
    if (volumes[p] > 0.0) velocities.col(p) /= volumes[p];
    else velocities.col(p).setZero();
  return velocities;
}

Eigen::Matrix3Xd sphere_velocities(const BuiltNetwork& built, const Balance& balance,
                                   Eigen::Index packed) {
  const Eigen::Matrix3Xd integrals = integrals_of(built, balance);
  const Eigen::VectorXd volumes = volumes_of(built);
  const int active = built.grains.spheres.size();
  const SurfacePressure around = built.operators.surface_pressure
                                     ? *built.operators.surface_pressure
                                     : surface_pressure(built.network, built.vertices, built.grains.spheres);
  Eigen::Matrix3Xd result = Eigen::Matrix3Xd::Zero(3, packed);
  for (int sphere = 0; sphere < active; ++sphere) {
    if (!built.share.owns_sphere(sphere)) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double volume = 0.0;
    for (int e = around.row_begin[sphere]; e < around.row_begin[sphere + 1]; ++e) {
      sum += around.weight[e] * integrals.col(around.pore[e]);
      volume += around.weight[e] * volumes[around.pore[e]];
    }
    if (volume > 0.0) result.col(built.grains.columns[sphere]) = sum / volume;
  }
  return result;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> sphere_stresses(const BuiltNetwork& built,
                                                         const Solution& solution,
                                                         Eigen::Index packed) {
  const int active = built.grains.spheres.size();
  const Stresses stresses =
      pfv::sphere_stresses(built.network, built.throats, built.operators.viscous_shares, built.vertices,
                           solution.pressures, built.grains.spheres,
                           solution.container.pressure_gradient);
  Stresses result = Stresses::Zero(6, packed);
  for (int sphere = 0; sphere < active; ++sphere)
    if (built.share.owns_sphere(sphere)) result.col(built.grains.columns[sphere]) = stresses.col(sphere);
  return result;
}

double plane_flux(const BuiltNetwork& built, const Solution& solution, const Balance& balance,
                  int axis, double position) {
  require_axis(axis);
  const PoreNetwork& network = built.network;
  if (solution.container.periodic[axis])
    throw InputError("the flux through a plane normal to a periodic axis is the superficial velocity "
                     "times the area: see the permeability tensor");
  const double relative = position - network.origin[axis], end = built.grains.spheres.edges[axis];
  if (!(relative >= 0.0 && relative <= end))
    throw InputError("the plane at " + detail::number_text(position) + " m is outside the box");
  // a centre may lie outside the container, its pore does not
  const auto beyond = [&](int pore) {
    return relative <= 0.0 || (relative < end && network.pore_centres(axis, pore) > relative) ? 1.0 : 0.0;
  };
  double flux = 0.0;
  for (int t = 0; t < network.throats(); ++t)
    if (built.share.owns_pore(network.throat_pores[t][0]))
      flux += balance.throat_fluxes[t] *
              (beyond(network.throat_pores[t][1]) - beyond(network.throat_pores[t][0]));
  // what enters through the two faces crosses the plane on its way to pores on the other side
  const auto& contacts = built.boundaries.contacts;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].face == PoreBoundaries::inside) continue;
    const Surface& surface = solution.container.faces[contacts[c].face].surface;
    if (!surface.is_plane()) continue;
    if (surface.normal[axis] == -1.0) flux += balance.contact_inflows[c] * beyond(contacts[c].pore);
    if (surface.normal[axis] == 1.0)
      flux -= balance.contact_inflows[c] * (1.0 - beyond(contacts[c].pore));
  }
  return built.share.sum(flux);
}

namespace {

void add_up(SliceMeans& means, const Share& share) {
  Eigen::VectorXd sums(6);
  sums << means.pores, means.volume, means.pressure, means.velocity;
  share.add(sums);
  means.pores = static_cast<int>(sums[0]);
  means.volume = sums[1];
  means.pressure = sums[2];
  means.velocity = sums.tail<3>();
}

}  // namespace

SliceMeans slice_means(const BuiltNetwork& built, const Solution& solution, const Balance& balance,
                       int axis, double lower, double upper) {
  require_axis(axis);
  const Eigen::Matrix3Xd integrals = integrals_of(built, balance);
  const Eigen::VectorXd volumes = storage_volumes(built.throats);
  SliceMeans means;
  for (int p = 0; p < built.network.pores(); ++p) {
    if (!built.share.owns_pore(p)) continue;
    const double place = built.network.pore_centres(axis, p) + built.network.origin[axis];
    if (!(place >= lower && place < upper)) continue;
    ++means.pores;
    means.volume += volumes[p];
    means.pressure += volumes[p] * solution.pressures[p];
    means.velocity += integrals.col(p);
  }
  add_up(means, built.share);
  if (means.pores == 0)
    throw InputError("no pore has its centre between " + detail::number_text(lower) + " and " +
                     detail::number_text(upper) + " m");
  means.pressure /= means.volume;
  means.velocity /= means.volume;
  return means;
}

namespace {

/// In the part of this rank.
FormerPlaces::Found own_pressure_at(const BuiltNetwork& built, const Solution& solution, const Eigen::Vector3d& relative) {
  if (built.network.cells() == 0) return {std::numeric_limits<double>::infinity(), 0.0};
  if (std::any_of(built.vertices.periodic.begin(), built.vertices.periodic.end(), [](bool is) { return is; }) &&
      walk_to(built.network, built.vertices, relative, 0) < 0)  // it may lie in the image of a cell
    return FormerPlaces({&built, solution.pressures}, solution.container.pressure_gradient).at(built.network.origin + relative);
  const int cell = locate(built.network, built.vertices, relative, 0), pore = built.network.cell_pore[cell];
  const bool is_own = !built.share.ranks || built.share.whole_pores[pore];
  return {is_own ? std::max(0.0, distance_outside(built.network, built.vertices, relative, cell))
                 : std::numeric_limits<double>::infinity(),
          solution.pressures[pore]};
}

/// Of the lowest rank in whose part the place lies.
double shared_pressure_at(const BuiltNetwork& built, const Solution& solution, const Eigen::Vector3d& relative) {
  const auto [outside, pressure] = own_pressure_at(built, solution, relative);
  const bool tells = built.share.is_lowest(-built.share.largest(-outside) == outside);
  return built.share.sum(tells ? pressure : 0.0);
}

}  // namespace

double pressure_at(const BuiltNetwork& built, const Solution& solution,
                   const Eigen::Vector3d& place) {
  const Spheres& spheres = built.vertices;
  const Eigen::Vector3d relative = place - built.network.origin;
  bool within = built.share.any(built.network.cells() > 0) && (relative.array() >= 0.0).all() &&
                (relative.array() <= spheres.edges.array()).all();
  const double round_off = -1e-9 * spheres.edges.maxCoeff();
  for (const WallSurface& wall : spheres.walls)  // a plane normal to an axis is a bound of the edges
    within = within && (wall.axis >= 0 || wall.surface.distance(relative) >= round_off);
  if (!within)
    throw InputError("no pressure at (" + detail::number_text(place[0]) + ", " + detail::number_text(place[1]) + ", " +
                     detail::number_text(place[2]) + "): the place is outside the container, or that has no grains; give "
                     "one within");
  return built.share.ranks ? shared_pressure_at(built, solution, relative) : own_pressure_at(built, solution, relative).pressure;
}

namespace {

/// Sum, with `raised` (Pa) on each, and number of the pressures of own pores that have cells where a plane is.
void add_pores_across(const BuiltNetwork& built, const Solution& solution, const CellExtents& extents, double position,
                      double raised, Eigen::VectorXd& sums) {
  std::vector<char> counted(built.network.pores(), 0);  // a pore may have several cells
  for (int c = 0; c < built.network.cells(); ++c) {
    if (!(extents.low[c] <= position && position <= extents.high[c])) continue;
    const int pore = built.network.cell_pore[c];
    if (counted[pore] || !built.share.owns_pore(pore)) continue;
    counted[pore] = 1;
    sums += Eigen::Vector2d(solution.pressures[pore] + raised, 1.0);
  }
}

}  // namespace

double plane_pressure(BuiltNetwork& built, const Solution& solution, int axis, double position) {
  const double relative = position - built.network.origin[axis];
  std::optional<CellExtents>& extents = built.operators.cell_extents[axis];
  if (!extents) extents = cell_extents(built.network, built.vertices, axis);
  const Lattice lattice = built.vertices.lattice();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(2);
  const int beyond = lattice.periodic[axis] ? 1 : 0;  // images of cells that reach across a side
  for (int period = -beyond; period <= beyond; ++period) {
    Lattice::Shift shift = Lattice::here;
    shift[axis] = period;
    const Eigen::Vector3d way = lattice.displacement(shift);
    add_pores_across(built, solution, *extents, relative + way[axis], -solution.container.pressure_gradient.dot(way), sums);
  }
  built.share.add(sums);
  if (sums[1] == 0.0)
    throw InputError("the plane at " + detail::number_text(position) + " m cuts no pore");
  return sums[0] / sums[1];
}

double mean_pressure(const BuiltNetwork& built, const Solution& solution) {
  const Eigen::VectorXd volumes = storage_volumes(built.throats);
  const double volume = built.share.sum(volumes.sum()), sum = built.share.sum(volumes.dot(solution.pressures));
  return volume > 0.0 ? sum / volume : 0.0;
}

std::optional<std::string> warning_of(const EmptySpace& empty) {
  constexpr double noticed = 0.05;
  if (!(empty.part > noticed)) return {};
  std::ostringstream text;
  text.precision(2);
  text << detail::percent_text(empty.part) << " of the pore volume is in pores larger than two grains; the largest, of "
       << empty.largest << " grains, is at (" << empty.place[0] << ", " << empty.place[1] << ", " << empty.place[2]
       << ") m: water there flows without the resistance of grains; where it should not be, draw faces and walls "
          "closer to the grains";
  return text.str();
}

namespace {

/// Place and volume of the largest pore of all ranks.
void find_largest(const BuiltNetwork& built, double sphere, EmptySpace& empty) {
  const std::vector<double>& volumes = built.throats.pore_fluid_volume;
  int found = -1;
  for (int pore = 0; pore < built.network.pores(); ++pore)
    if (built.share.owns_pore(pore) && (found < 0 || volumes[pore] > volumes[found])) found = pore;
  const double here = found < 0 ? -std::numeric_limits<double>::infinity() : volumes[found];
  const double largest = built.share.largest(here);
  empty.largest = largest / sphere;
  Eigen::VectorXd place = Eigen::VectorXd::Zero(3);
  if (built.share.is_lowest(found >= 0 && here == largest))
    place = built.network.pore_centres.col(found) + built.network.origin;
  built.share.add(place);
  empty.place = place;
}

}  // namespace

EmptySpace empty_space(const BuiltNetwork& built) {
  const std::vector<double>& volumes = built.throats.pore_fluid_volume;
  const Spheres& spheres = built.grains.spheres;
  EmptySpace empty;
  Eigen::VectorXd cubes = Eigen::VectorXd::Zero(2);
  for (int k = 0; k < spheres.size(); ++k)
    if (built.share.owns_sphere(k)) {
      cubes[0] += std::pow(spheres.radii[k], 3);
      ++cubes[1];
    }
  built.share.add(cubes);
  if (pore_count(built) == 0 || cubes[1] == 0.0) return empty;
  const double sphere = 4.0 / 3.0 * pi * cubes[0] / cubes[1];
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(2);
  for (const double volume : volumes) {
    sums[0] += volume;
    if (volume > EmptySpace::spheres_a_pore * sphere) sums[1] += volume;
  }
  built.share.add(sums);
  empty.part = sums[0] > 0.0 ? sums[1] / sums[0] : 0.0;
  find_largest(built, sphere, empty);
  return empty;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/periodic_network.hpp"

#include "distributed/image_halo.hpp"
#include "distributed/pore_owners.hpp"
#include "distributed/wanted_cells.hpp"
#include "network/periodic_images.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pfv {

namespace {

/// Of the first halo's width the part within which own images around the cell are taken, beside the largest grains.
constexpr double margin_in_widths = 0.7;

/// What is the same for all that is tried.
struct Task {
  const Container& container;
  const Ranks& ranks;
  double spacing;  ///< mean distance of the spheres of all ranks, m
  double spread;   ///< of the images that one rank would begin with, m
};

/// A triangulation of images, and what of it is wanted: around own grains where they are, and around all their images
/// near the cell.
struct ImageCells {
  ActiveGrains grains;
  Images images;
  Cells cells;
  Wanted at_home, around;
  std::vector<char> in_cell;  ///< cells of pores in the periodic cell, or nearly so
};

double spread_of_images(const ActiveGrains& own, double margin, const Ranks& ranks) {
  Eigen::VectorXd most = Eigen::VectorXd::Constant(6, -std::numeric_limits<double>::infinity());
  if (own.spheres.size() > 0) {
    const Eigen::Matrix3Xd centres = replicate(own.spheres, margin).spheres.centres;
    most << centres.rowwise().maxCoeff(), -centres.rowwise().minCoeff();
  }
  ranks.take_largest(most.data(), 6);
  return (most.head<3>() + most.tail<3>()).maxCoeff();
}

Images images_seen(const ImageHalo& halo, const ActiveGrains& grains, Eigen::Index columns, double spread) {
  std::vector<int> sphere(static_cast<std::size_t>(columns), -1);
  for (std::size_t i = 0; i < grains.columns.size(); ++i) sphere[grains.columns[i]] = static_cast<int>(i);
  std::vector<SphereImage> list;
  for (const GrainImage& image : halo.images()) list.push_back({sphere[image.column], image.shift});
  Images images = images_of(grains.spheres, list);
  images.spheres.spread = spread;
  return images;
}

/// All cells of a pore where one has its centre in the periodic cell.
std::vector<char> cells_in_period(const ImageCells& found, const std::vector<int>& first) {
  constexpr double slack = 1e-3;
  const Lattice lattice = found.images.spheres.lattice();
  const auto whole = [](double x) { return x >= -slack && x <= 1.0 + slack ? 0.0 : std::floor(x); };
  std::vector<char> pores(first.size(), 0), cells(first.size());
  for (std::size_t c = 0; c < first.size(); ++c)
    if (lattice.periods(found.cells.centres.places.col(static_cast<Eigen::Index>(c)), whole) == Lattice::here) pores[first[c]] = 1;
  for (std::size_t c = 0; c < first.size(); ++c) cells[c] = pores[first[c]];
  return cells;
}

/// Cells that have to be those of all grains.
std::vector<char> certain_cells(const ImageCells& found) {
  std::vector<char> certain = found.at_home.cells;
  for (std::size_t c = 0; c < certain.size(); ++c) {
    if (!found.in_cell[c] || !found.around.cells[c]) continue;
    certain[c] = 1;
    for (const int neighbour : found.cells.triangulation.neighbours[c])
      if (neighbour >= 0) certain[neighbour] = 1;
  }
  return certain;
}

ImageCells certain_image_cells(Halo& halo, ImageHalo& images, const Task& task) {
  ImageCells found;
  for (bool more = true; more;) {
    std::vector<Halo::Query> queries;
    task.ranks.together([&] {
      found.grains = halo.active_grains(task.container);
      found.images = images_seen(images, found.grains, halo.seen().size(), task.spread);
      std::vector<char> is_home, is_near;
      for (const GrainImage& image : images.images()) {
        is_near.push_back(image.is_near);
        is_home.push_back(image.is_near && image.shift == Lattice::here);
      }
      const Spheres& spheres = found.images.spheres;
      found.cells = {};
      if (!halo.places()[task.ranks.own()].is_empty()) found.cells = find_cells(spheres);
      const std::vector<int> first = first_cells(found.cells, spheres, task.spacing);
      found.at_home = wanted_cells(found.cells.triangulation, first, is_home);
      found.around = wanted_cells(found.cells.triangulation, first, is_near);
      found.in_cell = cells_in_period(found, first);
      const std::vector<char> certain = certain_cells(found);
      const double largest = halo.totals().largest_radius;
      for (std::size_t c = 0; c < certain.size(); ++c) {
        if (!certain[c]) continue;
        const Halo::Query ball = ball_of(found.cells, c, spheres, largest);
        if (!images.is_known(ball.centre, reach_of(ball, largest))) queries.push_back(ball);
      }
    });
    more = images.ask(queries);
  }
  return found;
}

/// Whether images stand beyond all facets of what is wanted; only a corner of a box has nothing there.
bool is_surrounded(const ImageCells& found) {
  const Triangulation& triangulation = found.cells.triangulation;
  for (std::size_t c = 0; c < found.in_cell.size(); ++c) {
    if (!found.at_home.whole_cells[c] && !(found.in_cell[c] && found.around.whole_cells[c])) continue;
    for (int i = is_wall(triangulation.vertices[c][1]) ? 1 : 0; i < 4; ++i)
      if (triangulation.neighbours[c][i] < 0) return false;
  }
  return true;
}

/// One period of it.
struct Period {
  PoreNetwork network;
  std::vector<char> whole;  ///< pores
};

/// An image, by its sphere.
using SphereShift = std::pair<int, Lattice::Shift>;

SphereShift image_of(const ImageCells& found, Vertex v) {
  const int sphere = found.images.original[v];
  const Eigen::Vector3d way = found.images.spheres.centres.col(v) - found.grains.spheres.centres.col(sphere);
  return {sphere, found.images.spheres.lattice().nearest(way)};
}

/// Whether all that is wanted around own grains where they are is there where its images stand in the cell: spheres with
/// all their cells. Pores are not compared: where spheres nearly coincide, images may be joined into others.
bool is_complete_at_home(const ImageCells& found, const PoreNetwork& all) {
  std::vector<SphereShift> complete;
  for (int v = 0; v < found.images.spheres.size(); ++v)
    if (found.around.whole_spheres[v]) complete.push_back(image_of(found, v));
  std::sort(complete.begin(), complete.end());
  int cell = -1;
  for (std::size_t c = 0; c < found.around.cells.size(); ++c) {
    if (!found.around.cells[c]) continue;
    ++cell;
    if (!found.at_home.whole_cells[c]) continue;
    const Lattice::Shift away = shift_of(all.pore_centres.col(all.cell_pore[cell]), found.images.spheres);
    if (away == Lattice::here) continue;
    for (const Vertex v : all.cell_vertices[cell]) {
      if (is_wall(v) || !found.at_home.whole_spheres[v]) continue;
      SphereShift image = image_of(found, v);
      for (int axis = 0; axis < 3; ++axis) image.second[axis] -= away[axis];
      if (!std::binary_search(complete.begin(), complete.end(), image)) return false;
    }
  }
  return true;
}

/// False where images are missing.
bool cut_period(const ImageCells& found, double spacing, Period& period) {
  if (!is_surrounded(found)) return false;
  std::vector<int> same(static_cast<std::size_t>(found.images.spheres.size()));
  std::iota(same.begin(), same.end(), 0);
  const PoreNetwork all =
      network_of(kept_cells(found.cells, found.around.cells, same), found.images.spheres, spacing);
  if (!is_complete_at_home(found, all)) return false;
  std::vector<char> whole(static_cast<std::size_t>(all.pores()), 0);
  int cell = 0;
  for (std::size_t c = 0; c < found.around.cells.size(); ++c)
    if (found.around.cells[c]) whole[all.cell_pore[cell++]] = found.around.whole_cells[c];
  return fold_part(all, found.images, found.grains.spheres, spacing, whole, period.network, period.whole);
}

/// Vertices by the numbers of those that cells have, in their order; -1 for the others.
std::vector<int> number_vertices(const PoreNetwork& network, const Images& images) {
  std::vector<int> number(images.original.size(), -1);
  for (const auto& cell : network.cell_vertices)
    for (const Vertex v : cell)
      if (!is_wall(v)) number[v] = 0;
  int count = 0;
  for (int& own : number)
    if (own == 0) own = count++;
  return number;
}

/// Leaves of the images those that cells have. `sphere`: new numbers of the spheres.
void drop_unused_images(Period& period, Images& images, const std::vector<int>& sphere) {
  PoreNetwork& network = period.network;
  const std::vector<int> number = number_vertices(network, images);
  std::vector<int> kept;
  network.vertex_sphere.clear();
  for (int v = 0; v < images.spheres.size(); ++v) {
    if (number[v] < 0) continue;
    kept.push_back(v);
    network.vertex_sphere.push_back(sphere[images.original[v]]);
  }
  const auto renumber = [&](auto& lists) {
    for (auto& vertices : lists)
      for (Vertex& v : vertices)
        if (!is_wall(v)) v = number[v];
  };
  renumber(network.cell_vertices);
  renumber(network.facet_vertices);
  images.spheres.ids = Packing::Ids(images.spheres.ids(kept));
  images.spheres.centres = Eigen::Matrix3Xd(images.spheres.centres(Eigen::all, kept));
  images.spheres.radii = Eigen::VectorXd(images.spheres.radii(kept));
}

/// Spheres that a kept cell has, whatever image of them, and own ones.
std::vector<char> used_spheres(const ImageCells& found, const Period& period, const Halo& halo) {
  std::vector<char> used = own_spheres(found.grains, halo);
  for (const auto& cell : period.network.cell_vertices)
    for (const Vertex v : cell)
      if (!is_wall(v)) used[found.images.original[v]] = 1;
  return used;
}

/// Own spheres that no cell has, by ids.
std::vector<int> hidden_spheres(const PoreNetwork& network, const Spheres& spheres, const Share& share) {
  std::vector<char> seen(static_cast<std::size_t>(spheres.size()), 0);
  for (const auto& cell : network.cell_vertices)
    for (const Vertex v : cell)
      if (!is_wall(v)) seen[network.vertex_sphere[v]] = 1;
  std::vector<int> hidden;
  for (int k = 0; k < spheres.size(); ++k)
    if (!seen[k] && share.own_spheres[k]) hidden.push_back(k);
  std::sort(hidden.begin(), hidden.end(), [&](int a, int b) { return spheres.ids[a] < spheres.ids[b]; });
  return hidden;
}

void note_spheres(const ImageCells& found, const std::vector<int>& sphere, SharedNetwork& shared) {
  Share& share = shared.share;
  share.own_spheres = own_spheres(shared.grains, shared.halo);
  share.whole_spheres.assign(share.own_spheres.size(), 0);
  for (std::size_t v = 0; v < found.images.original.size(); ++v)
    if (const int k = sphere[found.images.original[v]]; k >= 0 && found.at_home.whole_spheres[v]) share.whole_spheres[k] = 1;
}

ImageCells period_of_all(Halo& halo, const Container& container, double spacing, const Ranks& ranks, Period& period) {
  const ActiveGrains own = halo.active_grains(container);
  const Lattice lattice = own.spheres.lattice();
  const Halo::Totals& totals = halo.totals();
  const double least = least_margin(spacing, totals.largest_radius);
  if (totals.active > 0.0)
    ranks.together([&] { refuse_endless_images(lattice, totals.active, totals.largest_radius, least, least, true); });
  const Task task{container, ranks, spacing, spread_of_images(own, least, ranks)};
  const double width = halo.first_width(container);
  for (double growth = 1.0;; growth *= 1.5) {
    const ImageHalo::Reach reach{growth * (margin_in_widths * width + 2.0 * totals.largest_radius), growth * width};
    ImageHalo images(halo, own, reach, ranks);
    ImageCells found = certain_image_cells(halo, images, task);
    bool complete = true;
    ranks.together([&] { complete = cut_period(found, spacing, period); });
    if (!ranks.any(!complete)) return found;
    ranks.together([&] {
      refuse_endless_images(lattice, totals.active, totals.largest_radius, reach.margin, reach.margin + reach.width, false);
    });
  }
}

}  // namespace

SharedNetwork build_periodic_network(const Packing& own, const Container& container, OutsideGrains outside,
                                     std::shared_ptr<const Ranks> ranks) {
  SharedNetwork shared{Halo(own, container, outside, *ranks), {}, {}, {}};
  const double spacing = std::cbrt(volume_of(container) / std::max(1.0, shared.halo.totals().active));
  Period period;
  ImageCells found = period_of_all(shared.halo, container, spacing, *ranks, period);
  const std::vector<int> sphere =
      keep_spheres(used_spheres(found, period, shared.halo), shared.halo, container, found.grains);
  shared.grains = std::move(found.grains);
  shared.share.ranks = ranks;
  note_spheres(found, sphere, shared);
  drop_unused_images(period, found.images, sphere);
  period.network.hidden = hidden_spheres(period.network, shared.grains.spheres, shared.share);
  period.network.origin = container.lower;
  shared.space = {std::move(period.network), std::move(found.images.spheres)};
  find_owners(shared.space, shared.grains, shared.halo, period.whole, shared.share);
  return shared;
}

}  // namespace pfv

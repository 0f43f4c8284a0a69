// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/periodic_images.hpp"

#include "network/canonical_order.hpp"
#include "network/facets.hpp"
#include "pfv/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

namespace pfv {

Lattice::Shift shift_of(const Eigen::Vector3d& place, const Spheres& spheres) {
  return spheres.lattice().periods(place, [](double x) { return std::floor(x + 1e-6); });
}

namespace {

/// A pore in units of the spacing may be displaced by this much by rounding and by the choice of the
/// cell that names its centre.
constexpr double same_place = 1e-5;

/// What leaves the cell and what comes in may differ by this part of the largest throat.
constexpr double same_area = 1e-9;

Eigen::Vector3d displacement(const std::array<int, 3>& shift, const Spheres& spheres) {
  return spheres.lattice().displacement(shift);
}

/// Finds the home pore at a place.
class PoreFinder {
 public:
  PoreFinder(const PoreNetwork& all, const std::vector<int>& home, double spacing)
      : all_(all), size_(0.1 * spacing), reach_(same_place * spacing) {
    for (int pore = 0; pore < all.pores(); ++pore)
      if (home[pore] >= 0) bins_[bin(all.pore_centres.col(pore))].push_back(pore);
  }

  /// The pore of `all`, or -1.
  int find(const Eigen::Vector3d& place) const {
    int best = -1;
    double least = reach_;
    const std::array<long, 3> middle = bin(place);
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        for (long dz = -1; dz <= 1; ++dz) {
          const auto found = bins_.find({middle[0] + dx, middle[1] + dy, middle[2] + dz});
          if (found == bins_.end()) continue;
          for (const int pore : found->second) {
            const double distance = (all_.pore_centres.col(pore) - place).norm();
            if (distance > least) continue;
            least = distance;
            best = pore;
          }
        }
    return best;
  }

 private:
  std::array<long, 3> bin(const Eigen::Vector3d& place) const {
    return {std::lround(place[0] / size_), std::lround(place[1] / size_),
            std::lround(place[2] / size_)};
  }
  const PoreNetwork& all_;
  double size_, reach_;
  std::map<std::array<long, 3>, std::vector<int>> bins_;
};

/// True when no sphere outside the replicated region could reach into the cell's power sphere, nor
/// stand behind one of its facets where the region ends (only a corner of the box has nothing there).
bool is_settled(const PoreNetwork& all, const Images& images, const Spheres& spheres, int cell) {
  for (int i = is_wall(all.cell_vertices[cell][1]) ? 1 : 0; i < 4; ++i)
    if (all.cell_neighbours[cell][i] < 0) return false;
  const Eigen::Vector3d centre = all.cell_centres.col(cell);
  const int base = all.cell_vertices[cell][0];
  const double radius = images.spheres.radii[base];
  const double power =
      (centre - images.spheres.centres.col(base)).squaredNorm() - radius * radius;
  const double largest = spheres.radii.maxCoeff();
  const double reach = std::sqrt(std::max(0.0, power) + largest * largest);
  for (int axis = 0; axis < 3; ++axis)
    if (spheres.periodic[axis] &&
        (centre[axis] - reach < -images.margin ||
         centre[axis] + reach > spheres.edges[axis] + images.margin))
      return false;
  return true;
}

/// Where a pore of the full network lies: the home pore that it is or is an image of.
struct PoreImage {
  int pore = -1;
  std::array<int, 3> shift{0, 0, 0};
};

/// Way from one home pore to an image of another.
struct Way {
  int from, to;
  std::array<int, 3> shift;
  bool operator<(const Way& other) const {
    return std::tie(from, to, shift) < std::tie(other.from, other.to, other.shift);
  }
  Way back() const { return {to, from, {-shift[0], -shift[1], -shift[2]}}; }
};

/// Where the pores of the full network are in one period.
struct Folding {
  std::vector<int> home;      ///< number of each pore that lies in the period, or -1
  std::vector<char> needed;   ///< it lies there, or is a neighbour of one that does
  std::vector<PoreImage> places;  ///< of the needed ones
  std::vector<char> whole;    ///< home pores with all their throats; empty: all are
  bool is_whole(int home_pore) const { return whole.empty() || whole[home_pore]; }
};

/// True when each throat that leaves the cell comes in again as large on the other side. Where spheres
/// nearly coincide their images may be joined into pores in different ways.
bool repeats(const PoreNetwork& all, const Spheres& images, const Folding& folding) {
  const std::vector<int>& home = folding.home;
  const std::vector<PoreImage>& places = folding.places;
  std::map<Way, Eigen::Vector3d> areas;
  double largest = 0.0;
  for (int t = 0; t < all.throats(); ++t) {
    const auto [i, j] = all.throat_pores[t];
    if (home[i] < 0 && home[j] < 0) continue;
    if (!folding.needed[i] || !folding.needed[j] || !folding.is_whole(places[i].pore) || !folding.is_whole(places[j].pore))
      continue;
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (int f = all.throat_facets[t]; f < all.throat_facets[t + 1]; ++f)
      area += area_vector(all.facet_vertices[f], images);
    largest = std::max(largest, area.norm());
    const auto add = [&](const Way& way, const Eigen::Vector3d& outwards) {
      areas.emplace(way, Eigen::Vector3d::Zero()).first->second += outwards;
    };
    if (home[i] >= 0) add({home[i], places[j].pore, places[j].shift}, area);
    if (home[j] >= 0) add({home[j], places[i].pore, places[i].shift}, -area);
  }
  for (const auto& [way, area] : areas) {
    const auto back = areas.find(way.back());
    if (back == areas.end() || (area + back->second).norm() > same_area * largest) return false;
  }
  return true;
}

struct FoldedThroat {
  int throat;  ///< of the full network
  bool turned;
  Way way;
  bool operator<(const FoldedThroat& other) const {
    return std::tie(way, throat) < std::tie(other.way, other.throat);
  }
};

void copy_throats(const PoreNetwork& all, const std::vector<FoldedThroat>& throats,
                  const std::vector<int>& home_cell, const Spheres& spheres,
                  PoreNetwork& network) {
  network.throat_offsets.resize(3, static_cast<Eigen::Index>(throats.size()));
  network.throat_facets = {0};
  const auto cell = [&](int c) { return home_cell[c]; };
  for (const FoldedThroat& throat : throats) {
    network.throat_offsets.col(network.throats()) = displacement(throat.way.shift, spheres);
    network.throat_pores.push_back({throat.way.from, throat.way.to});
    for (int f = all.throat_facets[throat.throat]; f < all.throat_facets[throat.throat + 1]; ++f) {
      const auto& facet = all.facet_vertices[f];
      const auto& cells = all.facet_cells[f];
      network.facet_vertices.push_back(throat.turned ? reversed(facet) : facet);
      network.facet_cells.push_back({cell(cells[throat.turned ? 1 : 0]),
                                     cell(cells[throat.turned ? 0 : 1])});
    }
    network.throat_facets.push_back(network.facets());
  }
}

void copy_pores_and_cells(const PoreNetwork& all, const std::vector<int>& home,
                          std::vector<int>& home_cell, PoreNetwork& network) {
  std::vector<int> pores, cells;
  for (int pore = 0; pore < all.pores(); ++pore)
    if (home[pore] >= 0) pores.push_back(pore);
  for (int c = 0; c < all.cells(); ++c)
    if (home[all.cell_pore[c]] >= 0) {
      home_cell[c] = static_cast<int>(cells.size());
      cells.push_back(c);
    }
  network.pore_centres.resize(3, static_cast<Eigen::Index>(pores.size()));
  for (std::size_t p = 0; p < pores.size(); ++p) {
    network.pore_centres.col(static_cast<Eigen::Index>(p)) = all.pore_centres.col(pores[p]);
    network.pore_faces.push_back(all.pore_faces[pores[p]]);
  }
  network.cell_centres.resize(3, static_cast<Eigen::Index>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int c = cells[i];
    network.cell_centres.col(static_cast<Eigen::Index>(i)) = all.cell_centres.col(c);
    network.cell_vertices.push_back(all.cell_vertices[c]);
    network.cell_pore.push_back(home[all.cell_pore[c]]);
    auto neighbours = all.cell_neighbours[c];
    for (int& neighbour : neighbours) neighbour = neighbour < 0 ? -1 : home_cell[neighbour];
    network.cell_neighbours.push_back(neighbours);
  }
}

void find_hidden(const Images& images, const Spheres& spheres, PoreNetwork& network) {
  network.vertex_sphere = images.original;
  std::vector<char> seen(spheres.size(), 0);
  for (const auto& cell : network.cell_vertices)
    for (const Vertex vertex : cell)
      if (!is_wall(vertex)) seen[images.original[vertex]] = 1;
  for (int k = 0; k < spheres.size(); ++k)
    if (!seen[k]) network.hidden.push_back(k);
  sort_by_ids(network.hidden, spheres);
}

}  // namespace

namespace {

/// Number of periods along each axis within which the images lie that are up to `margin` outside the cell.
std::array<int, 3> periods_within(const Spheres& spheres, double margin) {
  std::array<int, 3> reach{0, 0, 0};
  Eigen::Vector3d leaning = Eigen::Vector3d::Zero();  // of all the images so far, along the axes that come next
  for (int axis = 2; axis >= 0; --axis) {
    if (!spheres.periodic[axis]) continue;
    reach[axis] = static_cast<int>(std::ceil((margin + leaning[axis]) / spheres.edges[axis]));
    if (axis == 2) leaning += reach[2] * Eigen::Vector3d(std::abs(spheres.tilt[1]), std::abs(spheres.tilt[2]), 0.0);
    if (axis == 1) leaning[0] += reach[1] * std::abs(spheres.tilt[0]);
  }
  return reach;
}

}  // namespace

Lattice::Shift periods_of(const PoreNetwork& network, const Spheres& spheres, const Spheres& vertices, Vertex vertex) {
  return spheres.lattice().nearest(vertices.centres.col(vertex) -
                                   spheres.centres.col(network.vertex_sphere[vertex]));
}

Images images_of(const Spheres& spheres, const std::vector<SphereImage>& list) {
  Images images;
  const auto n = static_cast<Eigen::Index>(list.size());
  images.spheres.edges = spheres.edges;
  images.spheres.walls = spheres.walls;
  images.spheres.volume = spheres.volume;
  images.spheres.mean_radius = spheres.mean_radius;
  images.spheres.periodic = spheres.periodic;
  images.spheres.tilt = spheres.tilt;
  images.spheres.ids.resize(n);
  images.spheres.centres.resize(3, n);
  images.spheres.radii.resize(n);
  images.original.reserve(list.size());
  for (const auto& [sphere, shift] : list) {
    const auto i = static_cast<Eigen::Index>(images.original.size());
    images.original.push_back(sphere);
    images.spheres.ids[i] = spheres.ids[sphere];
    images.spheres.centres.col(i) = spheres.centres.col(sphere) + displacement(shift, spheres);
    images.spheres.radii[i] = spheres.radii[sphere];
  }
  return images;
}

std::vector<SphereImage> images_within(const Spheres& spheres, double margin) {
  const std::array<int, 3> reach = periods_within(spheres, margin);
  std::vector<SphereImage> list;
  for (int x = -reach[0]; x <= reach[0]; ++x)
    for (int y = -reach[1]; y <= reach[1]; ++y)
      for (int z = -reach[2]; z <= reach[2]; ++z)
        for (int k = 0; k < spheres.size(); ++k) {
          const Eigen::Vector3d centre =
              spheres.centres.col(k) + displacement({x, y, z}, spheres);
          const bool near =
              (centre.array() >= -margin).all() &&
              (centre.array() <= spheres.edges.array() + margin).all();
          if (near) list.push_back({k, {x, y, z}});
        }
  return list;
}

Images replicate(const Spheres& spheres, double margin) {
  Images images = images_of(spheres, images_within(spheres, margin));
  images.margin = margin;
  return images;
}

/// An empty ball between images is no wider than the box's diagonal: a margin of twice that never
/// helps. A slender cell with few spheres would need images without number from the beginning, one whose pores come out
/// otherwise in each image in the end.
void refuse_endless_images(const Lattice& lattice, double spheres, double largest_radius, double margin, double reach,
                           bool first) {
  const double most_images = 5e4 + 30.0 * spheres;
  double images = spheres;
  for (int axis = 0; axis < 3; ++axis)
    if (lattice.periodic[axis]) images *= 1.0 + 2.0 * reach / lattice.edges[axis];
  const bool endless = images > most_images;
  if (endless && first)
    throw InputError("the periodic cell is so slender, its spheres so few or so large, that its "
                     "network would need more than " +
                     std::to_string(static_cast<int>(most_images)) +
                     " images; repeat the packing along the short edges of the cell");
  if (endless || margin > 2.0 * lattice.edges.norm() + 4.0 * largest_radius)
    throw InputError("the pores of the periodic cell do not repeat: spheres that nearly coincide, or of a cubic lattice that "
                     "is off by some millionths of its spacing, make other pores in each image; remove or move duplicates, "
                     "and leave a lattice as it is or move its spheres by a thousandth of the spacing or more");
}

namespace {

/// Numbers the pores that lie in the period.
std::vector<int> home_pores(const PoreNetwork& all, const Spheres& spheres) {
  std::vector<int> home(all.pores(), -1);
  int pores = 0;
  for (int pore = 0; pore < all.pores(); ++pore)
    if (shift_of(all.pore_centres.col(pore), spheres) == std::array<int, 3>{0, 0, 0}) home[pore] = pores++;
  return home;
}

/// The pore of `all` in the period that `pore` is an image of, with its shift; -1: none there.
PoreImage home_of(const PoreNetwork& all, const Spheres& spheres, const PoreFinder& finder, int pore) {
  const Eigen::Vector3d centre = all.pore_centres.col(pore);
  const std::array<int, 3> shift = shift_of(centre, spheres);
  return {finder.find(centre - displacement(shift, spheres)), shift};
}

/// False where an image of a needed pore is not found, but for throats between pores that are not whole.
bool find_places(const PoreNetwork& all, const Spheres& spheres, double spacing, Folding& folding) {
  folding.needed.assign(all.pores(), 0);
  folding.places.resize(all.pores());
  const PoreFinder finder(all, folding.home, spacing);
  for (const auto& both : all.throat_pores) {
    const bool wanted = (folding.home[both[0]] >= 0 && folding.is_whole(folding.home[both[0]])) ||
                        (folding.home[both[1]] >= 0 && folding.is_whole(folding.home[both[1]]));
    if (folding.home[both[0]] < 0 && folding.home[both[1]] < 0) continue;
    for (const int pore : both) {
      if (folding.needed[pore]) continue;
      PoreImage place = home_of(all, spheres, finder, pore);
      if (place.pore >= 0) place.pore = folding.home[place.pore];
      if (place.pore < 0 && wanted) return false;
      folding.places[pore] = place;
      folding.needed[pore] = place.pore >= 0;
    }
  }
  return true;
}

/// Of all images of a throat the one that starts at home in the smaller pore, or forwards in one pore.
std::vector<FoldedThroat> fold_throats(const PoreNetwork& all, const Folding& folding) {
  std::vector<FoldedThroat> throats;
  constexpr Lattice::Shift here = Lattice::here;
  for (int t = 0; t < all.throats(); ++t) {
    const auto [i, j] = all.throat_pores[t];
    if (!folding.needed[i] || !folding.needed[j]) continue;
    for (const bool turned : {false, true}) {
      const PoreImage& first = folding.places[turned ? j : i];
      const PoreImage& second = folding.places[turned ? i : j];
      if (first.shift != here || first.pore > second.pore ||
          (first.pore == second.pore && second.shift <= here))
        continue;
      throats.push_back({t, turned, {first.pore, second.pore, second.shift}});
      break;
    }
  }
  std::sort(throats.begin(), throats.end());  // images stand elsewhere in the full network
  return throats;
}

}  // namespace

bool fold(const PoreNetwork& all, const Images& images, const Spheres& spheres, double spacing,
          PoreNetwork& network) {
  network = {};
  Folding folding;
  folding.home = home_pores(all, spheres);
  if (!find_places(all, spheres, spacing, folding)) return false;
  for (int c = 0; c < all.cells(); ++c)
    if (folding.needed[all.cell_pore[c]] && !is_settled(all, images, spheres, c)) return false;
  if (!repeats(all, images.spheres, folding)) return false;
  const std::vector<FoldedThroat> throats = fold_throats(all, folding);
  std::vector<int> home_cell(all.cells(), -1);
  copy_pores_and_cells(all, folding.home, home_cell, network);
  copy_throats(all, throats, home_cell, spheres, network);
  find_hidden(images, spheres, network);
  return true;
}

namespace {

/// Whether each whole pore has as many throats as its pore of the full network.
bool has_all_throats(const PoreNetwork& all, const Folding& folding, const std::vector<FoldedThroat>& throats) {
  std::vector<int> missing(folding.whole.size(), 0);
  for (const auto& both : all.throat_pores)
    for (const int pore : both)
      if (folding.home[pore] >= 0) ++missing[folding.home[pore]];
  for (const FoldedThroat& throat : throats) {
    --missing[throat.way.from];
    --missing[throat.way.to];
  }
  for (std::size_t pore = 0; pore < missing.size(); ++pore)
    if (folding.whole[pore] && missing[pore] != 0) return false;
  return true;
}

}  // namespace

bool fold_part(const PoreNetwork& all, const Images& images, const Spheres& spheres, double spacing,
               const std::vector<char>& whole_pores, PoreNetwork& network, std::vector<char>& whole) {
  network = {};
  Folding folding;
  folding.home = home_pores(all, spheres);
  for (int pore = 0; pore < all.pores(); ++pore)
    if (folding.home[pore] >= 0) folding.whole.push_back(whole_pores[pore]);
  if (!find_places(all, spheres, spacing, folding) || !repeats(all, images.spheres, folding)) return false;
  const std::vector<FoldedThroat> throats = fold_throats(all, folding);
  if (!has_all_throats(all, folding, throats)) return false;
  std::vector<int> home_cell(all.cells(), -1);
  copy_pores_and_cells(all, folding.home, home_cell, network);
  copy_throats(all, throats, home_cell, spheres, network);
  network.vertex_sphere = images.original;
  whole = std::move(folding.whole);
  return true;
}

}  // namespace pfv

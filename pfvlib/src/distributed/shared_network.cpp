// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/shared_network.hpp"

#include "distributed/periodic_network.hpp"
#include "distributed/pore_owners.hpp"
#include "distributed/wanted_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pfv {

namespace {

/// What to ask for: cells whose ball leaves the place where all grains are known.
std::vector<Halo::Query> queries_of(const Cells& cells, const std::vector<char>& wanted, const Spheres& spheres,
                                    const Halo& halo) {
  const double widest = halo.totals().largest_radius;
  const Bounds& known = halo.known();
  std::vector<Halo::Query> queries;
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    if (!wanted[c]) continue;
    const Halo::Query ball = ball_of(cells, c, spheres, widest);
    const double reach = reach_of(ball, widest);
    const bool inside = (ball.centre.array() - reach >= known.lower.array()).all() &&
                        (ball.centre.array() + reach <= known.upper.array()).all();
    if (!inside) queries.push_back(ball);
  }
  return queries;
}

/// A triangulation that holds for all grains where it is wanted.
struct Certified {
  ActiveGrains grains;
  Cells cells;
  Wanted wanted;
};

Certified certified_cells(Halo& halo, const Container& container, double spacing, const Ranks& ranks) {
  Certified found;
  for (bool more = true; more;) {
    std::vector<Halo::Query> queries;
    ranks.together([&] {
      found.grains = halo.active_grains(container);
      const Spheres& spheres = found.grains.spheres;
      found.cells = {};
      if (!halo.places()[ranks.own()].is_empty()) found.cells = find_cells(spheres);
      found.wanted = wanted_cells(found.cells.triangulation, first_cells(found.cells, spheres, spacing),
                                  own_spheres(found.grains, halo));
      queries = queries_of(found.cells, found.wanted.cells, spheres, halo);
    });
    more = halo.ask(queries);
  }
  return found;
}

/// Spheres that a kept cell has, and own ones.
std::vector<char> used_spheres(const Certified& found, const Halo& halo) {
  std::vector<char> used = own_spheres(found.grains, halo);
  for (std::size_t c = 0; c < found.wanted.cells.size(); ++c)
    if (found.wanted.cells[c])
      for (const Vertex v : found.cells.triangulation.vertices[c])
        if (!is_wall(v)) used[v] = 1;
  return used;
}

}  // namespace

SharedNetwork build_shared_network(const Packing& own, const Container& container, OutsideGrains outside,
                                   std::shared_ptr<const Ranks> ranks) {
  if (container.any_periodic()) return build_periodic_network(own, container, outside, std::move(ranks));
  SharedNetwork shared{Halo(own, container, outside, *ranks), {}, {}, {}};
  const double spacing = std::cbrt(volume_of(container) / std::max(1.0, shared.halo.totals().active));
  Certified found = certified_cells(shared.halo, container, spacing, *ranks);
  const std::vector<int> number = keep_spheres(used_spheres(found, shared.halo), shared.halo, container, found.grains);
  shared.grains = std::move(found.grains);
  Share& share = shared.share;
  share.ranks = ranks;
  share.own_spheres = own_spheres(shared.grains, shared.halo);
  share.whole_spheres.assign(share.own_spheres.size(), 0);
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] >= 0) share.whole_spheres[number[i]] = found.wanted.whole_spheres[i];
  ranks->together([&] {
    shared.space.network = network_of(kept_cells(found.cells, found.wanted.cells, number), shared.grains.spheres, spacing);
    shared.space.spheres = shared.grains.spheres;
    shared.space.network.origin = container.lower;
  });
  std::vector<char> whole(shared.space.network.pores(), 0);
  int cell = 0;
  for (std::size_t c = 0; c < found.wanted.cells.size(); ++c)
    if (found.wanted.cells[c]) whole[shared.space.network.cell_pore[cell++]] = found.wanted.whole_cells[c];
  find_owners(shared.space, shared.grains, shared.halo, whole, share);
  return shared;
}

}  // namespace pfv

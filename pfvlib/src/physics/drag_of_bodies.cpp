// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/drag_of_bodies.hpp"

#include "geometry/pi.hpp"
#include "physics/bead_mobility.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace pfv {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One sphere of a body, on its way to the rank that looks at the body.
struct Bead {
  std::int64_t body, id;
  double centre[3], radius, walls[9], known[9];
};

/// What is known of a body's pores.
struct Source {
  std::int64_t body, pore;
  double value[3];
};
struct Drain {
  std::int64_t body;
  PoresAround::Throat throat;
};

/// A body as one rank sees it: all of it, in the end.
struct Body {
  std::vector<Bead> beads;
  std::vector<std::pair<int, int>> from;  ///< of each: the rank, and its place among those of that
  PoresAround pores;
};

/// Of each body, over all ranks: its spheres, and those of them in open water.
struct Census {
  Eigen::VectorXd spheres, open;

  bool takes(int body) const { return open[body] > 0.0 && spheres[body] > 1.0 && spheres[body] <= most_beads; }
};

Census census_of(const std::vector<int>& body, const std::vector<char>& open, const Share& share) {
  double most = -1.0;
  for (const int one : body) most = std::max(most, static_cast<double>(one));
  const auto count = static_cast<Eigen::Index>(share.largest(most)) + 1;
  Census census{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  for (std::size_t k = 0; k < body.size(); ++k) {
    if (body[k] < 0 || !share.owns_sphere(static_cast<int>(k))) continue;
    ++census.spheres[body[k]];
    census.open[body[k]] += open[k];
  }
  share.add(census.spheres);
  share.add(census.open);
  return census;
}

Bead bead_of(const Spheres& spheres, int k, int body, const Matrix3d& walls, const Matrix3d& known) {
  Bead bead{};
  bead.body = body;
  bead.id = spheres.ids[k];
  std::copy_n(spheres.centres.col(k).data(), 3, bead.centre);
  bead.radius = spheres.radii[k];
  std::copy_n(walls.data(), 9, bead.walls);
  std::copy_n(known.data(), 9, bead.known);
  return bead;
}

/// What each of the beads lacks: its part, by its own drag, of what they lack together.
std::vector<Matrix3d> missing_of(const Body& body, double viscosity) {
  const auto count = static_cast<Eigen::Index>(body.beads.size());
  Spheres spheres;
  spheres.centres.resize(3, count);
  spheres.radii.resize(count);
  std::vector<int> members;
  for (Eigen::Index i = 0; i < count; ++i) {
    spheres.centres.col(i) = Eigen::Map<const Vector3d>(body.beads[i].centre);
    spheres.radii[i] = body.beads[i].radius;
    members.push_back(static_cast<int>(i));
  }
  const std::vector<Matrix3d> unbounded = drags_of_beads(spheres, members);
  Matrix3d missing = -drag_of(body.pores);
  double traces = 0.0;
  for (std::size_t i = 0; i < body.beads.size(); ++i) {
    const Eigen::Map<const Matrix3d> walls(body.beads[i].walls), known(body.beads[i].known);
    missing += 3.0 * pi * viscosity * (walls * unbounded[i] + unbounded[i] * walls);
    missing -= known;
    traces += unbounded[i].trace();
  }
  std::vector<Matrix3d> parts;
  for (const Matrix3d& drag : unbounded) parts.push_back(drag.trace() / traces * missing);
  return parts;
}

/// The messages about bodies to those who look at them, one a rank.
struct Messages {
  explicit Messages(int ranks) : beads(ranks), sources(ranks), drains(ranks) {}
  std::vector<Ranks::Bytes> beads, sources, drains;
};

void tell(const PoresAround& pores, int body, int rank, Messages& to) {
  for (const auto& [pore, value] : pores.sources) {
    const Source source{body, pore, {value[0], value[1], value[2]}};
    append(to.sources[rank], &source, 1);
  }
  for (const PoresAround::Throat& throat : pores.throats) {
    const Drain drain{body, throat};
    append(to.drains[rank], &drain, 1);
  }
}

/// The bodies that this rank looks at, from what each rank has told.
std::map<int, Body> bodies_told(const Messages& to, const Share& share) {
  const auto handed_over = [&](const std::vector<Ranks::Bytes>& messages) {
    return share.ranks ? share.ranks->hand_over(messages) : messages;
  };
  const auto beads = handed_over(to.beads), sources = handed_over(to.sources), drains = handed_over(to.drains);
  std::map<int, Body> bodies;
  for (std::size_t rank = 0; rank < beads.size(); ++rank) {
    int place = 0;
    for (const Bead& bead : values_in<Bead>(beads[rank])) {
      bodies[static_cast<int>(bead.body)].beads.push_back(bead);
      bodies[static_cast<int>(bead.body)].from.push_back({static_cast<int>(rank), place++});
    }
    // the throats of a pore come with it, from whoever tells of it first
    std::map<int, std::map<std::int64_t, bool>> is_new;
    for (const Source& source : values_in<Source>(sources[rank])) {
      auto& all = bodies[static_cast<int>(source.body)].pores.sources;
      const auto [found, fresh] = all.emplace(source.pore, Vector3d::Zero());
      found->second += Eigen::Map<const Vector3d>(source.value);
      is_new[static_cast<int>(source.body)][source.pore] = fresh;
    }
    for (const Drain& drain : values_in<Drain>(drains[rank]))
      if (is_new[static_cast<int>(drain.body)][drain.throat.pore])
        bodies[static_cast<int>(drain.body)].pores.throats.push_back(drain.throat);
  }
  return bodies;
}

/// Beads by their ids, so that nothing depends on who told first.
void sort_beads(Body& body) {
  std::vector<std::size_t> order(body.beads.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return body.beads[a].id < body.beads[b].id; });
  const Body given = body;
  for (std::size_t i = 0; i < order.size(); ++i) {
    body.beads[i] = given.beads[order[i]];
    body.from[i] = given.from[order[i]];
  }
}

/// What each rank is told of its beads, in the order in which it told of them.
std::vector<Ranks::Bytes> replies_of(std::map<int, Body>& bodies, double viscosity, int ranks) {
  std::vector<std::vector<Matrix3d>> replies(ranks);
  for (auto& [number, body] : bodies) {
    sort_beads(body);
    const std::vector<Matrix3d> parts = missing_of(body, viscosity);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      auto& own = replies[body.from[i].first];
      own.resize(std::max(own.size(), static_cast<std::size_t>(body.from[i].second) + 1));
      own[body.from[i].second] = parts[i];
    }
  }
  std::vector<Ranks::Bytes> bytes(ranks);
  for (int r = 0; r < ranks; ++r) append(bytes[r], replies[r].data(), replies[r].size());
  return bytes;
}

}  // namespace

std::vector<char> spheres_alone(int spheres, const std::vector<int>& body, const Share& share) {
  const Census census = census_of(body, std::vector<char>(body.size(), 0), share);
  std::vector<char> alone(spheres, 1);
  for (std::size_t k = 0; k < body.size(); ++k) alone[k] = body[k] < 0 || census.spheres[body[k]] == 1.0;
  return alone;
}

std::vector<MissingDrag> missing_drags_of_bodies(const PoreSources& pores, const Spheres& spheres,
                                                 const std::vector<int>& body, const std::vector<char>& open,
                                                 double viscosity, const std::function<Matrix3d(int)>& walls,
                                                 const std::vector<Matrix3d>& known, const Share& share) {
  const int ranks = share.ranks ? share.ranks->count() : 1;
  const Census census = census_of(body, open, share);
  Messages to(ranks);
  std::vector<std::vector<int>> told(ranks);
  std::map<int, PoresAround> around;
  for (int k = 0; k < static_cast<int>(body.size()); ++k) {
    if (body[k] < 0 || !share.owns_sphere(k) || !census.takes(body[k])) continue;
    const int rank = body[k] % ranks;
    const Bead bead = bead_of(spheres, k, body[k], walls(k), known[k]);
    append(to.beads[rank], &bead, 1);
    told[rank].push_back(k);
    pores.add(k, around[body[k]]);
  }
  for (const auto& [number, own] : around) tell(own, number, number % ranks, to);
  std::map<int, Body> bodies = bodies_told(to, share);
  std::vector<Ranks::Bytes> replies = replies_of(bodies, viscosity, ranks);
  if (share.ranks) replies = share.ranks->hand_over(replies);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(10, spheres.size());
  for (int r = 0; r < ranks; ++r) {
    const std::vector<Matrix3d> parts = values_in<Matrix3d>(replies[r]);
    for (std::size_t i = 0; i < parts.size(); ++i) all.col(told[r][i]) << 1.0, parts[i].reshaped();
  }
  if (share.ranks) share.spheres.refresh(*share.ranks, all);
  std::vector<MissingDrag> missing;
  for (int k = 0; k < spheres.size(); ++k)
    if (all(0, k) > 0.0 && share.is_whole(k)) missing.push_back({k, all.col(k).tail<9>().reshaped(3, 3)});
  return missing;
}

}  // namespace pfv

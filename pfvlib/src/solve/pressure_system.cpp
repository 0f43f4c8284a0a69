// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/pressure_system.hpp"

#include "network/disjoint_sets.hpp"
#include "pfv/error.hpp"
#include "solve/row_share.hpp"

#include <algorithm>

namespace pfv {

namespace {

/// The boundary whose shared pressure the pore takes among its contacts, or -1.
struct PoreCondition {
  bool pressure = false;
  int flux_boundary = -1;
};

std::vector<PoreCondition> conditions_of_pores(const PoreNetwork& network,
                                               const PoreBoundaries& boundaries, const Container& container) {
  std::vector<PoreCondition> conditions(network.pores());
  for (const auto& contact : boundaries.contacts) {
    PoreCondition& condition = conditions[contact.pore];
    const Boundary& boundary = boundary_of(container, contact.boundary);
    if (boundary.imposes_pressure()) condition.pressure = true;
    if (boundary.imposes_flux() && condition.flux_boundary < 0)
      condition.flux_boundary = contact.boundary;
  }
  return conditions;
}

struct Triplets {
  std::vector<int> row, column;
  std::vector<double> value;
  void add(int r, int c, double v) {
    row.push_back(r);
    column.push_back(c);
    value.push_back(v);
  }
};

/// Compressed rows with sorted columns; entries of one place are added.
SymmetricMatrix compress(const Triplets& triplets, const std::vector<double>& diagonal) {
  const int n = static_cast<int>(diagonal.size());
  std::vector<int> begin(n + 1, 0);
  for (const int r : triplets.row) ++begin[r + 1];
  for (int r = 0; r < n; ++r) begin[r + 1] += begin[r];
  std::vector<std::pair<int, double>> entries(triplets.row.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t e = 0; e < triplets.row.size(); ++e)
    entries[next[triplets.row[e]]++] = {triplets.column[e], triplets.value[e]};

  SymmetricMatrix matrix;
  matrix.row_begin.reserve(n + 1);
  matrix.column.reserve(entries.size() + n);
  matrix.value.reserve(entries.size() + n);
  std::vector<std::pair<int, double>> row;
  for (int r = 0; r < n; ++r) {
    row.assign(entries.begin() + begin[r], entries.begin() + begin[r + 1]);
    row.emplace_back(r, diagonal[r]);
    std::stable_sort(row.begin(), row.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::size_t first = matrix.column.size();
    for (const auto& [column, value] : row) {
      if (matrix.column.size() > first && matrix.column.back() == column) {
        matrix.value.back() += value;
      } else {
        matrix.column.push_back(column);
        matrix.value.push_back(value);
      }
    }
    matrix.row_begin.push_back(static_cast<int>(matrix.column.size()));
  }
  return matrix;
}

}  // namespace

/// Sets of unknowns that open throats join; those that touch an imposed pressure are not isolated.
std::vector<Isolated> find_isolated(const PoreNetwork& network,
                                    const std::vector<double>& conductances,
                                    const Unknowns& unknowns) {
  DisjointSets sets(unknowns.count);
  std::vector<char> anchored(unknowns.count, 0);
  for (int pass = 0; pass < 2; ++pass)
    for (int t = 0; t < network.throats(); ++t) {
      if (conductances[t] <= 0.0) continue;
      const int i = unknowns.of_pore[network.throat_pores[t][0]];
      const int j = unknowns.of_pore[network.throat_pores[t][1]];
      if (pass == 0 && i >= 0 && j >= 0) sets.join(i, j);
      if (pass == 1 && (i < 0) != (j < 0)) anchored[sets.find(std::max(i, j))] = 1;
    }
  std::vector<int> place(unknowns.count, -1);
  std::vector<Isolated> isolated;
  for (int pore = 0; pore < network.pores(); ++pore) {
    const int unknown = unknowns.of_pore[pore];
    if (unknown < 0) continue;
    const int root = sets.find(unknown);
    if (anchored[root]) continue;
    if (place[root] < 0) {
      place[root] = static_cast<int>(isolated.size());
      isolated.push_back({{}, unknown, 0.0});
    }
    isolated[place[root]].pores.push_back(pore);
  }
  return isolated;
}

namespace {

}  // namespace

/// Not by ghosts whose throats are not all here: these may belong to a patch of which their place does not tell.
Eigen::VectorXd flux_boundaries_reached(const Unknowns& unknowns, const Share& share) {
  std::vector<char> has_pore(static_cast<std::size_t>(unknowns.count), 0);
  for (std::size_t pore = 0; pore < unknowns.of_pore.size(); ++pore)
    if (unknowns.of_pore[pore] >= 0 && share.has_whole(static_cast<int>(pore))) has_pore[unknowns.of_pore[pore]] = 1;
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.of_boundary.size()));
  for (std::size_t b = 0; b < unknowns.of_boundary.size(); ++b)
    if (const int unknown = unknowns.of_boundary[b]; unknown >= 0) reached[static_cast<Eigen::Index>(b)] = has_pore[unknown];
  if (share.ranks) share.ranks->take_largest(reached.data(), unknowns.of_boundary.size());
  return reached;
}

namespace {

/// A flux counts once, whatever ranks have pores at its boundary.
void leave_to_lowest_rank(std::vector<int>& fed_by, const Share& share) {
  if (!share.ranks) return;
  for (int& pore : fed_by)
    if (!share.is_lowest(pore >= 0)) pore = -1;
}

/// What is imposed where no pore is would be left out without a word: a flux, or the pressure of a face that is smaller
/// than what the triangulation sees. A face whose pores belong to its patches has nothing to lose, nor has one of a room
/// without grains, and so without pores.
void refuse_lost_boundaries(const Unknowns& unknowns, const PoreBoundaries& boundaries, const Container& container,
                            const Share& share) {
  const bool any_pore = share.any(!boundaries.contacts.empty());
  std::vector<char> touched(container.faces.size(), 0);
  for (const auto& contact : boundaries.contacts)
    if (contact.face != PoreBoundaries::inside) touched[contact.face] = 1;
  const Eigen::VectorXd reached = flux_boundaries_reached(unknowns, share);
  for (int b = 0; b < static_cast<int>(unknowns.of_boundary.size()); ++b) {
    const Boundary& boundary = boundary_of(container, b);
    const bool loses_flux = boundary.drives_flux() && reached[b] == 0.0;
    const bool loses_pressure = b < container.face_count() && boundary.imposes_pressure() && any_pore &&
                                !share.any(touched[b] != 0) && face_areas(container)[b] > 0.0;
    share.together([&] {
      if (loses_flux)
        throw InputError(boundary_name(container, b) +
                         ": its flux has no pore to enter (all its pores carry an imposed pressure, "
                         "or it has none); give the flux to another face or enlarge the patch or region");
      if (loses_pressure)
        throw InputError(boundary_name(container, b) +
                         ": its pressure has no pore to act on, since the face is too small beside the faces around it; "
                         "give the pressure to one of those, or to a patch");
    });
  }
}

}  // namespace

Unknowns number_unknowns(const PoreNetwork& network, const PoreBoundaries& boundaries,
                         const Container& container, const Share& share) {
  const auto conditions = conditions_of_pores(network, boundaries, container);
  Unknowns unknowns;
  unknowns.of_pore.assign(network.pores(), Unknowns::imposed);
  unknowns.of_boundary.assign(boundary_count(container), -1);
  unknowns.fed_by.assign(boundary_count(container), -1);
  for (int pore = 0; pore < network.pores(); ++pore) {
    if (conditions[pore].pressure) {
      unknowns.imposed_pores.push_back(pore);
      continue;
    }
    if (conditions[pore].flux_boundary < 0) {
      unknowns.of_pore[pore] = unknowns.count++;
      continue;
    }
    int& shared = unknowns.of_boundary[conditions[pore].flux_boundary];
    if (shared < 0) shared = unknowns.count++;
    unknowns.of_pore[pore] = shared;
    int& fed = unknowns.fed_by[conditions[pore].flux_boundary];
    if (fed < 0 && share.owns_pore(pore)) fed = pore;
  }
  leave_to_lowest_rank(unknowns.fed_by, share);
  refuse_lost_boundaries(unknowns, boundaries, container, share);
  return unknowns;
}

void impose_pressures(const PoreNetwork& network, const PoreBoundaries& boundaries, const Container& container,
                      double time, Eigen::VectorXd& pressures) {
  const auto& contacts = boundaries.contacts;  // those of one pore stand together
  for (std::size_t first = 0, last = 0; first < contacts.size(); first = last) {
    const int pore = contacts[first].pore;
    double sum = 0.0;
    int count = 0;
    for (last = first; last < contacts.size() && contacts[last].pore == pore; ++last) {
      const Boundary& boundary = boundary_of(container, contacts[last].boundary);
      if (!boundary.imposes_pressure()) continue;
      sum += boundary.profile
                 ? boundary.profile(network.origin + network.pore_centres.col(pore), time)
                 : boundary.value;
      ++count;
    }
    if (count > 0) pressures[pore] = sum / count;
  }
}

PressureSystem assemble(const PoreNetwork& network, const std::vector<double>& conductances,
                        const Unknowns& unknowns, const std::optional<Eigen::VectorXd>& storage, const Share& share,
                        const RowShare* rows) {
  PressureSystem system;
  std::vector<double> diagonal(unknowns.count, 0.0);
  Triplets off_diagonal;
  for (int t = 0; t < network.throats(); ++t) {
    const double c = conductances[t];
    if (c <= 0.0) continue;
    const auto [p, q] = network.throat_pores[t];
    const int i = unknowns.of_pore[p], j = unknowns.of_pore[q];
    if (i == j) continue;  // two without unknowns, or one shared unknown
    const auto add_row = [&](int pore, int row, int other, int column) {
      if (row < 0 || !share.owns_pore(pore)) return;
      diagonal[row] += c;
      if (column >= 0) off_diagonal.add(row, column, -c);
      else system.couplings.push_back({row, other, c});
    };
    add_row(p, i, q, j);
    add_row(q, j, p, i);
  }
  if (storage) {
    for (int pore = 0; pore < network.pores(); ++pore)
      if (unknowns.of_pore[pore] >= 0) diagonal[unknowns.of_pore[pore]] += (*storage)[pore];
  } else {
    system.isolated = rows ? find_isolated(network, conductances, unknowns, share, *rows)
                           : find_isolated(network, conductances, unknowns);
    for (Isolated& isolated : system.isolated) {
      if (isolated.unknown < 0) continue;  // held on another rank
      double& d = diagonal[isolated.unknown];
      isolated.pin = d > 0.0 ? d : 1.0;
      d += isolated.pin;
    }
  }
  system.matrix = compress(off_diagonal, diagonal);
  if (rows) collect_rows(system.matrix, *rows);
  return system;
}

void right_hand_side(const PressureSystem& system, const Unknowns& unknowns, const Container& container,
                     const Eigen::VectorXd& sources, const Eigen::VectorXd& imposed,
                     Eigen::VectorXd& b) {
  b.setZero(unknowns.count);
  for (std::size_t pore = 0; pore < unknowns.of_pore.size(); ++pore)
    if (unknowns.of_pore[pore] >= 0)
      b[unknowns.of_pore[pore]] += sources[static_cast<Eigen::Index>(pore)];
  for (std::size_t boundary = 0; boundary < unknowns.of_boundary.size(); ++boundary)
    if (unknowns.fed_by[boundary] >= 0)
      b[unknowns.of_boundary[boundary]] += imposed_inflow(container, static_cast<int>(boundary));
  for (const auto& coupling : system.couplings)
    b[coupling.unknown] += coupling.conductance * imposed[coupling.pore];
}

}  // namespace pfv

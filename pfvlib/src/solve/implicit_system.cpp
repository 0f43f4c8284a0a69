// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/implicit_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace pfv {

namespace {

/// S^T B^1/2 by unknowns: the rows of S that yield, with the pores of one unknown added up, and the
/// same entries once more by unknown.
struct YieldingRows {
  struct Entry {
    int index;  ///< unknown, or row
    Vector6d value;
  };
  std::vector<std::vector<Entry>> of_row;
  std::vector<std::vector<Entry>> of_unknown;
};

/// Adds the entries of one row that yields, those of one unknown summed up.
void add_row(YieldingRows& rows, std::vector<YieldingRows::Entry>& entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.index < b.index; });
  auto& merged = rows.of_row.emplace_back();
  for (const auto& entry : entries) {
    if (!merged.empty() && merged.back().index == entry.index)
      merged.back().value += entry.value;
    else
      merged.push_back(entry);
  }
  const int number = static_cast<int>(rows.of_row.size()) - 1;
  for (const auto& entry : merged) rows.of_unknown[entry.index].push_back({number, entry.value});
}

YieldingRows yielding_rows(const Unknowns& unknowns, const ForceMatrix& forces, const Bases& bases,
                           const Matrix6Xd& yielding) {
  const int spheres = forces.spheres;
  YieldingRows rows;
  rows.of_unknown.resize(unknowns.count);
  std::vector<YieldingRows::Entry> entries;
  for (int row = 0; row < forces.rows(); ++row) {
    if (!(yielding.col(row).array() > 0.0).any()) continue;
    const Vector6d root = yielding.col(row).cwiseSqrt();
    entries.clear();
    const auto add = [&](int pore, const Vector6d& load) {
      if (unknowns.of_pore[pore] != Unknowns::imposed)
        entries.push_back({unknowns.of_pore[pore], root.cwiseProduct(load)});
    };
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
      add(forces.pore[e], forces.value.col(e));
    for (int b = 0; row >= spheres && b < bases.size(); ++b)
      if (bases.face[b] == row - spheres) add(bases.pore[b], bases.load(b));
    add_row(rows, entries);
  }
  return rows;
}

/// Whether a uniform pressure in the set would move something: it does not where the set surrounds what
/// yields on all sides.
bool yields_to(const Isolated& isolated, const Unknowns& unknowns, const YieldingRows& rows) {
  std::vector<int> members;
  for (const int pore : isolated.pores) members.push_back(unknowns.of_pore[pore]);
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  std::map<int, std::pair<Vector6d, double>> sums;  // by row: the sum and its largest part
  for (const int unknown : members)
    for (const auto& entry : rows.of_unknown[unknown]) {
      auto& [sum, largest] =
          sums.try_emplace(entry.index, Vector6d::Zero(), 0.0).first->second;
      sum += entry.value;
      largest = std::max(largest, entry.value.norm());
    }
  return std::any_of(sums.begin(), sums.end(), [](const auto& row) {
    constexpr double round_off = 1e-10;
    return row.second.first.norm() > round_off * row.second.second;
  });
}

/// G + S^T B S without the pins, row by row.
SymmetricMatrix sum_of(const SymmetricMatrix& g, const std::vector<double>& pins,
                       const YieldingRows& rows) {
  constexpr std::size_t denser = 14;  // entries than G, about
  const int count = g.size();
  SymmetricMatrix a;
  a.row_begin.reserve(g.row_begin.size());
  a.column.reserve(denser * g.column.size());
  a.value.reserve(denser * g.column.size());
  std::vector<double> sum(count, 0.0);
  std::vector<int> touched, last_row(count, -1);
  for (int i = 0; i < count; ++i) {
    touched.clear();
    const auto add = [&](int j, double value) {
      if (last_row[j] != i) {
        last_row[j] = i;
        sum[j] = 0.0;
        touched.push_back(j);
      }
      sum[j] += value;
    };
    for (int k = g.row_begin[i]; k < g.row_begin[i + 1]; ++k) add(g.column[k], g.value[k]);
    add(i, -pins[i]);
    for (const auto& mine : rows.of_unknown[i])
      for (const auto& other : rows.of_row[mine.index])
        add(other.index, mine.value.dot(other.value));
    std::sort(touched.begin(), touched.end());
    for (const int j : touched) {
      a.column.push_back(j);
      a.value.push_back(sum[j]);
    }
    a.row_begin.push_back(static_cast<int>(a.column.size()));
  }
  return a;
}

/// Whether one pressure in all of them would move something.
bool level_moves(const std::vector<Isolated>& isolated, const Unknowns& unknowns, const YieldingRows& rows) {
  Isolated all{{}, -1, 0.0};
  for (const Isolated& set : isolated) all.pores.insert(all.pores.end(), set.pores.begin(), set.pores.end());
  return yields_to(all, unknowns, rows);
}

/// Keeps the pins of sets that nothing yields to, and that of the fluid itself where grains yield to no more than what
/// it is above trapped pores. Says which sets it keeps.
std::vector<double> freed_pins(const PressureSystem& system, const Unknowns& unknowns, const YieldingRows& rows,
                               std::vector<Isolated>& held) {
  std::vector<double> pins(unknowns.count, 0.0);
  for (const Isolated& isolated : system.isolated) {
    if (yields_to(isolated, unknowns, rows) &&
        (!isolated.main || level_moves(system.isolated, unknowns, rows)))
      pins[isolated.unknown] = isolated.pin;
    else
      held.push_back(isolated);
  }
  return pins;
}

}  // namespace

Matrix6Xd of_faces(Matrix6Xd yielding, int spheres, int bodies) {
  yielding.leftCols(spheres).setZero();
  yielding.rightCols(bodies).setZero();
  return yielding;
}

namespace {

using Velocity = ImplicitSystem::Velocity;

/// M/dt + R, row by row.
using SparseRows = std::vector<std::map<int, double>>;

/// Of the spheres and, behind the faces, of the bodies.
std::vector<Velocity> unknown_velocities(const Matrix6Xd& yielding, int spheres, int bodies) {
  std::vector<Velocity> velocities;
  const int columns = static_cast<int>(yielding.cols());
  for (int k = 0; k < columns; ++k)
    for (int c = 0; c < 6; ++c)
      if ((k < spheres || k >= columns - bodies) && yielding(c, k) > 0.0) velocities.push_back({k, c});
  return velocities;
}

/// A sphere's velocity as a sum of unknown ones, each with its direction.
struct Carrier {
  int unknown;
  Eigen::Vector3d direction;
};

/// Of each sphere: its own velocity, or what its body's gives it.
std::vector<std::vector<Carrier>> carriers_of(const std::vector<Velocity>& velocities, int spheres,
                                              const RigidBodies* bodies) {
  std::vector<std::vector<Carrier>> carriers(spheres);
  std::vector<std::vector<int>> of_body(bodies ? bodies->count() : 0);
  for (int i = 0; i < static_cast<int>(velocities.size()); ++i) {
    const auto [mover, component] = velocities[i];
    if (mover >= spheres)
      of_body[mover - bodies->first].push_back(i);
    else if (component < 3)
      carriers[mover].push_back({i, Eigen::Vector3d::Unit(component)});
  }
  for (std::size_t m = 0; bodies && m < bodies->members.size(); ++m) {
    const auto& member = bodies->members[m];
    for (const int i : of_body[member.body])
      carriers[member.sphere].push_back(
          {i, bodies->of_sphere(member, Vector6d::Unit(velocities[i].component)).head<3>()});
  }
  return carriers;
}

SparseRows resistances(const std::vector<Velocity>& velocities, const Matrix6Xd& yielding, int spheres,
                       const std::vector<ResistanceBlock>& resistance, const RigidBodies* bodies) {
  const auto carriers = carriers_of(velocities, spheres, bodies);
  SparseRows rows(velocities.size());
  for (int i = 0; i < static_cast<int>(velocities.size()); ++i)
    rows[i][i] = 1.0 / yielding(velocities[i].component, velocities[i].mover);
  for (const auto& [of, by, block] : resistance)
    for (const Carrier& row : carriers[of])
      for (const Carrier& column : carriers[by])
        rows[row.unknown][column.unknown] += row.direction.dot(block * column.direction);
  return rows;
}

void end_row(SymmetricMatrix& matrix) { matrix.row_begin.push_back(static_cast<int>(matrix.column.size())); }

void add_entry(SymmetricMatrix& matrix, int column, double value) {
  matrix.column.push_back(column);
  matrix.value.push_back(value);
}

/// [ -a  -S^T ]   `loads`: S of the grains and bodies that yield, by row and by unknown; `first`: where the velocities of
/// [ -S   h   ]   each of these rows begin.
SymmetricMatrix joined(const SymmetricMatrix& a, const YieldingRows& loads, const std::vector<int>& first,
                       const std::vector<Velocity>& velocities, const SparseRows& h) {
  SymmetricMatrix m;
  for (int i = 0; i < a.size(); ++i) {
    for (int k = a.row_begin[i]; k < a.row_begin[i + 1]; ++k) add_entry(m, a.column[k], -a.value[k]);
    for (const auto& [row, load] : loads.of_unknown[i])
      for (int v = first[row]; v < first[row + 1]; ++v) add_entry(m, a.size() + v, -load[velocities[v].component]);
    end_row(m);
  }
  for (std::size_t row = 0; row + 1 < first.size(); ++row)
    for (int v = first[row]; v < first[row + 1]; ++v) {
      for (const auto& [unknown, load] : loads.of_row[row]) add_entry(m, unknown, -load[velocities[v].component]);
      for (const auto& [other, value] : h[v]) add_entry(m, a.size() + other, value);
      end_row(m);
    }
  return m;
}

/// Where the velocities of each mover among them begin, and their end.
std::vector<int> begins_of(const std::vector<Velocity>& velocities) {
  std::vector<int> first;
  for (int v = 0; v < static_cast<int>(velocities.size()); ++v)
    if (v == 0 || velocities[v].mover != velocities[v - 1].mover) first.push_back(v);
  first.push_back(static_cast<int>(velocities.size()));
  return first;
}

}  // namespace

ImplicitSystem assemble_implicit(const PressureSystem& system, const Unknowns& unknowns, const ForceMatrix& forces,
                               const Bases& bases, const Matrix6Xd& yielding,
                               const std::vector<ResistanceBlock>& resistance, const RigidBodies* bodies) {
  const int spheres = forces.spheres;
  ImplicitSystem result;
  result.pressures = unknowns.count;
  result.velocities = unknown_velocities(yielding, spheres, forces.bodies);
  const std::vector<double> pins =
      freed_pins(system, unknowns, yielding_rows(unknowns, forces, bases, yielding), result.isolated);
  for (int k = 0; k < unknowns.count; ++k)
    if (pins[k] != 0.0) result.last.push_back(k);
  const YieldingRows faces = yielding_rows(unknowns, forces, bases, of_faces(yielding, spheres, forces.bodies));
  Matrix6Xd grains = Matrix6Xd::Zero(6, yielding.cols());
  for (const auto& [mover, component] : result.velocities) grains(component, mover) = 1.0;
  result.matrix = joined(sum_of(system.matrix, pins, faces), yielding_rows(unknowns, forces, bases, grains),
                         begins_of(result.velocities), result.velocities,
                         resistances(result.velocities, yielding, spheres, resistance, bodies));
  result.signs.assign(result.matrix.size(), 1.0);
  std::fill_n(result.signs.begin(), result.pressures, -1.0);
  return result;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/volume_rates.hpp"

#include "network/facets.hpp"
#include "physics/cell_volumes.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pfv {

VolumeRateMatrix volume_rate_matrix(const PoreNetwork& network, const Spheres& spheres) {
  VolumeRateMatrix matrix;
  std::vector<int>& begin = matrix.row_begin;
  begin.assign(network.pores() + 1, 0);
  for (const int sphere : network.vertex_sphere) matrix.spheres = std::max(matrix.spheres, sphere + 1);
  for (const int pore : network.cell_pore) begin[pore + 1] += 4;
  for (int pore = 0; pore < network.pores(); ++pore) begin[pore + 1] += begin[pore];
  std::vector<int> next(begin.begin(), begin.end() - 1);
  matrix.mover.resize(begin.back());
  matrix.area.resize(3, begin.back());
  for (int c = 0; c < network.cells(); ++c) {
    const auto& vertices = network.cell_vertices[c];
    const auto gradient = cell_volume(vertices, spheres).gradient;
    for (int i = 0; i < 4; ++i) {
      const int entry = next[network.cell_pore[c]]++;
      matrix.mover[entry] =
          is_wall(vertices[i]) ? vertices[i] : network.vertex_sphere[vertices[i]];
      matrix.area.col(entry) = gradient[i];
    }
  }
  return matrix;
}

namespace {

/// `spheres`: columns of the motion before those of the faces.
Eigen::Index column_of(Vertex mover, int spheres) { return is_wall(mover) ? spheres + wall_number(mover) : mover; }


}  // namespace

void volume_rates(const VolumeRateMatrix& matrix, const Motion& motion, Team& team,
                  Eigen::VectorXd& rates) {
  rates.resize(matrix.rows());
  const int* const begin = matrix.row_begin.data();
  team.run_rows(begin, matrix.rows(), [&](int first, int last) {
    for (int pore = first; pore < last; ++pore) {
      double rate = 0.0;
      for (int e = begin[pore]; e < begin[pore + 1]; ++e)
        rate += matrix.area.col(e).dot(motion.col(column_of(matrix.mover[e], matrix.spheres)).head<3>());
      rates[pore] = rate;
    }
  });
}

Eigen::VectorXd gross_rates(const VolumeRateMatrix& matrix, const Motion& motion) {
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(matrix.rows());
  for (int pore = 0; pore < matrix.rows(); ++pore)
    for (int e = matrix.row_begin[pore]; e < matrix.row_begin[pore + 1]; ++e)
      gross[pore] += matrix.area.col(e).norm() *
                     motion.col(column_of(matrix.mover[e], matrix.spheres)).head<3>().norm();
  return gross;
}

namespace {

/// What a cell rests on at its plane wall i: the corners of the facet opposite it put on the wall, where walls are
/// square to each other; else feet, edges and the corner of the walls.
FacetCorners base_corners(const std::array<Vertex, 4>& cell, int i, const Spheres& spheres) {
  const Vertex wall = cell[i];
  const std::array<Vertex, 3> facet = facet_opposite(cell, i);
  FacetCorners base = corners_of(facet, spheres);
  const auto is_square = [&](Vertex other) {
    return !is_wall(other) || spheres.wall(other).surface.normal.dot(spheres.wall(wall).surface.normal) == 0.0;
  };
  if (is_square(facet[1]) && is_square(facet[2])) {
    for (int corner = 0; corner < base.count; ++corner)
      base.at[corner] = put_on(spheres.wall(wall), base.at[corner]);
    return base;
  }
  const auto edge = [&](int k, Vertex other) -> Eigen::Vector3d {
    return spheres.centres.col(k) + WallPair(k, wall, other, spheres).to_edge();
  };
  base.at[0] = foot_on(wall, facet[0], spheres);
  base.at[1] = is_wall(facet[1]) ? edge(facet[0], facet[1]) : foot_on(wall, facet[1], spheres);
  base.at[2] = is_wall(facet[1]) ? corner_of_walls(wall, facet[1], facet[2], spheres) : edge(facet[1], facet[2]);
  base.at[3] = edge(facet[0], facet[2]);
  return base;
}

WallPart base_of(const std::array<Vertex, 4>& cell, int i, const CellVolume& volume, const Spheres& spheres) {
  if (round_corner(cell, spheres) > 0) return round_base(cell, i, spheres);
  // dV / d(position of the wall) is the area of the cell's base; the facet's normal points away from the wall
  const Eigen::Vector3d& normal = spheres.wall(cell[i]).surface.normal;
  const double area = volume.gradient[i].dot(normal);
  return {area, area * normal, -moment_vector(base_corners(cell, i, spheres))};
}

}  // namespace

Bases measure_bases(const PoreNetwork& network, const PoreBoundaries& boundaries,
                    const Spheres& spheres) {
  const auto& contacts = boundaries.contacts;
  Bases bases;
  bases.area.assign(contacts.size(), 0.0);
  bases.loads = Matrix6Xd::Zero(6, static_cast<Eigen::Index>(contacts.size()));
  for (const auto& contact : contacts) {
    bases.pore.push_back(contact.pore);
    bases.face.push_back(contact.face);
  }
  for (int c = 0; c < network.cells(); ++c) {
    const auto& vertices = network.cell_vertices[c];
    if (!is_wall(vertices[3])) continue;  // walls come last
    const CellVolume cell = cell_volume(vertices, spheres);
    for (int i = 1; i < 4; ++i) {
      if (!is_wall(vertices[i])) continue;
      const int contact = boundaries.contact_of(network.cell_pore[c], wall_number(vertices[i]));
      const WallPart base = base_of(vertices, i, cell, spheres);
      bases.area[contact] += base.area;
      bases.loads.col(contact).head<3>() += base.vector;
      bases.loads.col(contact).tail<3>() += base.moment;
    }
  }
  return bases;
}

namespace {

template <class Visit>
void for_each_row(const ForceMatrix& forces, const SumOrder& order, Visit&& visit) {
  if (order.rows.empty())
    for (int row = 0; row < forces.rows(); ++row) visit(row);
  else
    for (const int row : order.rows) visit(row);
}

void scatter(const ForceMatrix& forces, const SumOrder& order, const Motion& motion,
             Eigen::VectorXd& rates) {
  for_each_row(forces, order, [&](int row) {
    const Vector6d own = motion.col(row);
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
      rates[forces.pore[e]] += forces.value.col(e).dot(own);
  });
}

void share(const ForceMatrix& forces, const SumOrder& order, const Motion& motion, Team& team,
           Eigen::VectorXd& rates) {
  std::vector<double> products(forces.pore.size());
  team.run_rows(forces.row_begin.data(), forces.rows(), [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      const Vector6d own = motion.col(row);
      for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
        products[e] = forces.value.col(e).dot(own);
    }
  });
  team.run_rows(order.begin.data(), static_cast<int>(rates.size()), [&](int first, int last) {
    for (int pore = first; pore < last; ++pore)
      for (int e = order.begin[pore]; e < order.begin[pore + 1]; ++e)
        rates[pore] += products[order.entry[e]];
  });
}

}  // namespace

SumOrder sum_order(const ForceMatrix& forces, const Packing::Ids& ids, int pores, const Team& team) {
  SumOrder order;
  if (!std::is_sorted(ids.data(), ids.data() + forces.spheres)) {
    order.rows.resize(forces.rows());
    std::iota(order.rows.begin(), order.rows.end(), 0);
    std::sort(order.rows.begin(), order.rows.begin() + forces.spheres,
              [&](int a, int b) { return ids[a] < ids[b]; });
  }
  if (team.threads() == 1) return order;
  order.begin.assign(pores + 1, 0);
  for (const int pore : forces.pore) ++order.begin[pore + 1];
  for (int pore = 0; pore < pores; ++pore) order.begin[pore + 1] += order.begin[pore];
  std::vector<int> next(order.begin.begin(), order.begin.end() - 1);
  order.entry.resize(forces.pore.size());
  for_each_row(forces, order, [&](int row) {
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
      order.entry[next[forces.pore[e]]++] = e;
  });
  return order;
}

void reciprocal_rates(const ForceMatrix& forces, const SumOrder& order, const Bases& bases,
                      const Motion& motion, Team& team, Eigen::VectorXd& rates) {
  rates.setZero();
  if (team.threads() == 1)
    scatter(forces, order, motion, rates);
  else
    share(forces, order, motion, team, rates);
  for (int b = 0; b < bases.size(); ++b)
    if (bases.face[b] >= 0) rates[bases.pore[b]] += bases.load(b).dot(motion.col(forces.spheres + bases.face[b]));
}

Eigen::VectorXd gross_rates(const ForceMatrix& forces, const Bases& bases, const Motion& motion,
                            int pores) {
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(pores);
  for (int row = 0; row < forces.rows(); ++row) {
    const Vector6d own = motion.col(row).cwiseAbs();
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
      gross[forces.pore[e]] += forces.value.col(e).cwiseAbs().dot(own);
  }
  for (int b = 0; b < bases.size(); ++b)
    if (bases.face[b] >= 0)
      gross[bases.pore[b]] +=
          bases.load(b).cwiseAbs().dot(motion.col(forces.spheres + bases.face[b]).cwiseAbs());
  return gross;
}

}  // namespace pfv

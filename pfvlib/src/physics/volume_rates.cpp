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

Eigen::Index column_of(Vertex mover, const Motion& motion) {
  return is_wall(mover) ? spheres_in(motion) + wall_number(mover) : Eigen::Index(mover);
}

}  // namespace

void volume_rates(const VolumeRateMatrix& matrix, const Motion& motion, Team& team,
                  Eigen::VectorXd& rates) {
  rates.resize(matrix.rows());
  const int* const begin = matrix.row_begin.data();
  team.run_rows(begin, matrix.rows(), [&](int first, int last) {
    for (int pore = first; pore < last; ++pore) {
      double rate = 0.0;
      for (int e = begin[pore]; e < begin[pore + 1]; ++e)
        rate += matrix.area.col(e).dot(motion.col(column_of(matrix.mover[e], motion)).head<3>());
      rates[pore] = rate;
    }
  });
}

Eigen::VectorXd gross_rates(const VolumeRateMatrix& matrix, const Motion& motion) {
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(matrix.rows());
  for (int pore = 0; pore < matrix.rows(); ++pore)
    for (int e = matrix.row_begin[pore]; e < matrix.row_begin[pore + 1]; ++e)
      gross[pore] += matrix.area.col(e).norm() *
                     motion.col(column_of(matrix.mover[e], motion)).head<3>().norm();
  return gross;
}

Vector6d Bases::load(int base) const {
  Vector6d load;
  load.head<3>() = area[base] * outward_normal(static_cast<Face>(face[base]));
  load.tail<3>() = moment.col(base);
  return load;
}

Bases measure_bases(const PoreNetwork& network, const PoreBoundaries& boundaries,
                    const Spheres& spheres) {
  const auto& contacts = boundaries.contacts;
  Bases bases;
  bases.area.assign(contacts.size(), 0.0);
  bases.moment = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(contacts.size()));
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
      const int face = wall_number(vertices[i]), axis = face / 2;
      const std::pair<int, int> key{network.cell_pore[c], face};
      const auto found = std::lower_bound(
          contacts.begin(), contacts.end(), key,
          [](const auto& a, const auto& b) { return std::make_pair(a.pore, a.face) < b; });
      const auto contact = found - contacts.begin();
      // dV / d(position of the wall) is the area of the cell's base
      bases.area[contact] += cell.gradient[i].dot(outward_normal(static_cast<Face>(face)));
      FacetCorners base = corners_of(facet_opposite(vertices, i), spheres);
      for (int corner = 0; corner < base.count; ++corner)
        base.at[corner][axis] = face % 2 ? spheres.edges[axis] : 0.0;
      bases.moment.col(contact) -= moment_vector(base);  // that facet's normal points away from the wall
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
  const int spheres = forces.rows() - face_count;
  if (!std::is_sorted(ids.data(), ids.data() + spheres)) {
    order.rows.resize(forces.rows());
    std::iota(order.rows.begin(), order.rows.end(), 0);
    std::sort(order.rows.begin(), order.rows.end() - face_count,
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
  const Eigen::Index spheres = spheres_in(motion);
  for (int b = 0; b < bases.size(); ++b)
    if (bases.face[b] >= 0) rates[bases.pore[b]] += bases.load(b).dot(motion.col(spheres + bases.face[b]));
}

Eigen::VectorXd gross_rates(const ForceMatrix& forces, const Bases& bases, const Motion& motion,
                            int pores) {
  Eigen::VectorXd gross = Eigen::VectorXd::Zero(pores);
  for (int row = 0; row < forces.rows(); ++row) {
    const Vector6d own = motion.col(row).cwiseAbs();
    for (int e = forces.row_begin[row]; e < forces.row_begin[row + 1]; ++e)
      gross[forces.pore[e]] += forces.value.col(e).cwiseAbs().dot(own);
  }
  const Eigen::Index spheres = spheres_in(motion);
  for (int b = 0; b < bases.size(); ++b)
    if (bases.face[b] >= 0)
      gross[bases.pore[b]] +=
          bases.load(b).cwiseAbs().dot(motion.col(spheres + bases.face[b]).cwiseAbs());
  return gross;
}

}  // namespace pfv

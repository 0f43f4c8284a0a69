// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/fill_reducing_ordering.hpp"

#include "sparse/ordering.hpp"

namespace pfv {

std::vector<int> fill_reducing_ordering(OrderingKind kind, const SymmetricMatrix& matrix,
                                        const Eigen::Matrix3Xd& coordinates, Team& team) {
  if (kind == OrderingKind::automatic) {
    kind = coordinates.cols() > 0 ? OrderingKind::geometric : OrderingKind::metis;
  }
  if (kind == OrderingKind::geometric) return geometric_ordering(matrix, coordinates, team);
  if (kind == OrderingKind::metis) return metis_ordering(matrix);
  return {};
}

std::vector<int> fill_reducing_ordering(OrderingKind kind, const SymmetricMatrix& matrix,
                                        const Eigen::Matrix3Xd& coordinates) {
  Team alone;
  return fill_reducing_ordering(kind, matrix, coordinates, alone);
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/dense_packing.hpp"
#include "solve/linear_solver.hpp"
#include "support/stages.hpp"

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

/// Matrices for tests of orderings and solvers.
namespace support {

using Rows = std::vector<std::map<int, double>>;

inline pfv::SymmetricMatrix compressed(const Rows& rows) {
  pfv::SymmetricMatrix matrix;
  for (const auto& row : rows) {
    for (const auto& [column, value] : row) {
      matrix.column.push_back(column);
      matrix.value.push_back(value);
    }
    matrix.row_begin.push_back(static_cast<int>(matrix.column.size()));
  }
  return matrix;
}

inline void connect(Rows& rows, int i, int j, double conductance) {
  rows[i][i] += conductance;
  rows[j][j] += conductance;
  rows[i][j] -= conductance;
  rows[j][i] -= conductance;
}

/// -u'' = f on n inner points of a line: 2 on the diagonal, -1 beside it.
inline Rows line(int n) {
  Rows rows(n);
  for (int i = 0; i < n; ++i) {
    rows[i][i] = 2.0;
    if (i > 0) rows[i][i - 1] = rows[i - 1][i] = -1.0;
  }
  return rows;
}

/// Conductances over four decades on a cube of edge^3 pores; `ground` ties its two end layers to an
/// imposed pressure.
inline pfv::SymmetricMatrix lattice(int edge, double ground = 1.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  const auto conductance = [&] { return std::pow(10.0, 4.0 * random() / random.max() - 2.0); };
  Rows rows(edge * edge * edge);
  const auto pore = [&](int i, int j, int k) { return i + edge * (j + edge * k); };
  for (int k = 0; k < edge; ++k) {
    for (int j = 0; j < edge; ++j) {
      for (int i = 0; i < edge; ++i) {
        const int here = pore(i, j, k);
        if (i + 1 < edge) connect(rows, here, pore(i + 1, j, k), conductance());
        if (j + 1 < edge) connect(rows, here, pore(i, j + 1, k), conductance());
        if (k + 1 < edge) connect(rows, here, pore(i, j, k + 1), conductance());
        if (k == 0 || k + 1 == edge) rows[here][here] += ground * conductance();
      }
    }
  }
  return compressed(rows);
}

inline Eigen::VectorXd right_side(int n) {
  return Eigen::VectorXd::LinSpaced(n, 1.0, 3.0).array().sin();
}

inline double residual(const pfv::SymmetricMatrix& matrix, const Eigen::VectorXd& x,
                       const Eigen::VectorXd& b) {
  return (pfv::multiply(matrix, x) - b).norm() / b.norm();
}

inline Eigen::VectorXd solution(pfv::LinearSolver& solver, const pfv::SymmetricMatrix& matrix,
                                const Eigen::VectorXd& b) {
  Eigen::VectorXd x;
  solver.order(matrix);
  solver.factor(matrix);
  solver.solve(b, x);
  return x;
}

template <class Failure, class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Failure& error) {
    return error.what();
  }
  return "nothing was thrown";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The pressure system of a dense packing between two faces of imposed pressure.
struct PackingSystem {
  pfv::SymmetricMatrix matrix;
  Eigen::Matrix3Xd places;
};

inline const PackingSystem& packing_system() {
  static const PackingSystem made = [] {
    pfv::Box box;
    box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(0.0);
    box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(1.0);
    const Stages stages = stages_of(pfv::dense_packing(1000, 0.6, 0.2, 1, 60), box);
    const pfv::Unknowns unknowns = pfv::number_unknowns(stages.network, stages.boundaries, box);
    const auto conductances =
        pfv::conductances(pfv::ConductanceLaw::hydraulic_radius, 1e-3, stages.network,
                          stages.throats, stages.spheres);
    PackingSystem packing{pfv::assemble(stages.network, conductances.value, unknowns, {}).matrix,
                          Eigen::Matrix3Xd(3, unknowns.count)};
    for (int pore = 0; pore < stages.network.pores(); ++pore) {
      const int unknown = unknowns.of_pore[pore];
      if (unknown >= 0) packing.places.col(unknown) = stages.network.pore_centres.col(pore);
    }
    return packing;
  }();
  return made;
}

}  // namespace support

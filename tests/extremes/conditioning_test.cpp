// SPDX-License-Identifier: GPL-3.0-or-later
// Conductances that span many decades: what is left of the digits of pressures and forces, against a
// solution of the same network in extended precision.
#include "pfv/pfv.hpp"
#include "physics/force_matrix.hpp"
#include "support/boxes.hpp"
#include "support/extreme_record.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <queue>

namespace conditioning_test {
namespace {

using namespace support;
using Extended = long double;
using Matrix = Eigen::Matrix<Extended, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Extended, Eigen::Dynamic, 1>;

/// Pores that open throats join to zlo or zhi.
std::vector<char> anchored(const pfv::PoreNetwork& network, const std::vector<double>& c) {
  std::vector<std::vector<int>> beside(static_cast<std::size_t>(network.pores()));
  for (int t = 0; t < network.throats(); ++t)
    if (c[t] > 0.0)
      for (const int side : {0, 1})
        beside[network.throat_pores[t][side]].push_back(network.throat_pores[t][1 - side]);
  std::vector<char> reached(beside.size(), 0);
  std::queue<int> next;
  const auto reach = [&](int pore) {
    if (!reached[pore]) next.push(pore);
    reached[pore] = 1;
  };
  for (int pore = 0; pore < network.pores(); ++pore)
    if (network.pore_faces[pore] >> 4) reach(pore);
  for (; !next.empty(); next.pop())
    for (const int pore : beside[next.front()]) reach(pore);
  return reached;
}

/// Pressures with 1 Pa on zlo and 0 on zhi: a Cholesky factor and refinement with residuals that are sums
/// of differences, all in extended precision. Pores without a way to a pressure are left at 0.
Vector extended_pressures(const pfv::PoreNetwork& network, const std::vector<double>& c,
                          const std::vector<char>& reached) {
  std::vector<int> unknown(reached.size(), -1);
  int count = 0;
  Vector p = Vector::Zero(static_cast<Eigen::Index>(reached.size()));
  for (int pore = 0; pore < network.pores(); ++pore) {
    const int faces = network.pore_faces[pore] >> 4;
    if (faces == 0 && reached[pore]) unknown[pore] = count++;
    if (faces == 1) p[pore] = 1.0L;
    if (faces == 3) p[pore] = 0.5L;
  }
  Matrix matrix = Matrix::Zero(count, count);
  for (int t = 0; t < network.throats(); ++t) {
    const int i = unknown[network.throat_pores[t][0]], j = unknown[network.throat_pores[t][1]];
    if (i == j) continue;
    if (i >= 0) matrix(i, i) += c[t];
    if (j >= 0) matrix(j, j) += c[t];
    if (i >= 0 && j >= 0) matrix(std::max(i, j), std::min(i, j)) -= c[t];
  }
  const Eigen::LLT<Matrix> factor(matrix);
  for (int sweep = 0; sweep < 5; ++sweep) {
    Vector defect = Vector::Zero(count);
    for (int t = 0; t < network.throats(); ++t) {
      const auto [i, j] = network.throat_pores[t];
      const Extended flux = c[t] * (p[i] - p[j]);
      if (unknown[i] >= 0) defect[unknown[i]] -= flux;
      if (unknown[j] >= 0) defect[unknown[j]] += flux;
    }
    const Vector correction = factor.solve(defect);
    for (int pore = 0; pore < network.pores(); ++pore)
      if (unknown[pore] >= 0) p[pore] += correction[unknown[pore]];
  }
  return p;
}

constexpr double refined_to = 1e-10;  // 2e-12 was measured

struct Conditioning {
  double span;          ///< largest over smallest conductance that is not 0
  int throats, closed;  ///< all; those that discs cover
  int by_rule;          ///< closed because the law has no meaning or round-off hides their flow
  double plain_error;   ///< of pressures solved once, of the imposed difference
  double error, force_error;  ///< of Flow's pressures; of its forces, of the largest force
  pfv::Report report;
};

Conditioning conditioning(const pfv::PackingArrays& packing) {
  Conditioning result{};
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  const Stages s = stages_of(packing, box);
  pfv::Flow flow(box, viscosity_one());
  const Eigen::Matrix3Xd forces = flow.evaluate(packing.view()).total;
  result.report = flow.report();
  record_balances(result.report);
  const std::vector<double>& c = flow.throat_conductances();
  double least = 1e300, most = 0.0;
  result.throats = s.network.throats();
  for (int t = 0; t < s.network.throats(); ++t) {
    if (c[t] > 0.0) {
      least = std::min(least, c[t]);
      most = std::max(most, c[t]);
    } else {
      ++(pfv::is_closed(s.throats, t) ? result.closed : result.by_rule);
    }
  }
  result.span = most / least;
  const std::vector<char> reached = anchored(s.network, c);
  const Vector exact = extended_pressures(s.network, c, reached);
  const Eigen::VectorXd plain =
      pressures_of(s, c, Eigen::VectorXd::Zero(s.network.pores()));
  Eigen::VectorXd wrong = Eigen::VectorXd::Zero(s.network.pores());
  for (int pore = 0; pore < s.network.pores(); ++pore) {
    if (!reached[pore]) continue;
    wrong[pore] = static_cast<double>(flow.pore_pressures()[pore] - exact[pore]);
    result.plain_error = std::max(
        result.plain_error, std::abs(static_cast<double>(plain[pore] - exact[pore])));
  }
  result.error = wrong.cwiseAbs().maxCoeff();
  const auto shares =
      pfv::viscous_shares(flow.options().conductance, s.network, s.throats, s.spheres);
  const pfv::ForceMatrix matrix =
      pfv::force_matrix(s.network, s.spheres, s.throats, shares, s.spheres.size(), {});
  result.force_error = pfv::multiply(matrix, wrong).topLeftCorner(3, s.spheres.size()).colwise().norm()
                           .maxCoeff() / forces.colwise().norm().maxCoeff();
  return result;
}

/// A bed in which each sphere has a second one beside it, a hair away (in radii).
pfv::PackingArrays pairs(double hair) {
  const auto single = random_packing(60, 0.06, 0.1, 14);
  std::vector<Sphere> spheres;
  Random random(3);
  for (int k = 0; k < single.radii.size(); ++k) {
    const Eigen::Vector3d x = single.positions.col(k);
    const Eigen::Vector3d y = x + hair * single.radii[k] * random.in_cube().normalized();
    spheres.push_back({x[0], x[1], x[2], single.radii[k]});
    spheres.push_back({y[0], y[1], y[2], single.radii[k]});
  }
  return packing_of(spheres);
}

void report(const std::string& name, const Conditioning& c) {
  std::ostringstream text;
  text << c.span << '|' << c.throats << '|' << c.closed << '|' << c.by_rule << '|'
       << c.report.counts.degenerate_throats << '|' << c.report.counts.merged_pores << '|'
       << c.report.residual << '|' << c.plain_error << '|' << c.error << '|' << c.force_error;
  testing::Test::RecordProperty(name, text.str());
}

// Swollen until discs close most throats: those that are left span ever more decades.
TEST(Conditioning, OfSwollenBeds) {
  for (const double swelling : {1.0, 1.3, 1.5, 1.7, 1.9}) {
    auto packing = random_packing(150, 0.05, 0.08, 14);
    packing.radii *= swelling;
    const Conditioning c = conditioning(packing);
    report("beds swollen by " + std::to_string(std::lround(100 * (swelling - 1.0))) + " %", c);
    EXPECT_LT(c.error, refined_to);
    EXPECT_LT(c.force_error, refined_to);
  }
}

TEST(Conditioning, OfSpheresThatNearlyCoincide) {
  for (const double hair : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    const Conditioning c = conditioning(pairs(hair));
    std::ostringstream name;
    name << "pairs " << hair << " of a radius apart";
    report(name.str(), c);
    EXPECT_LT(c.error, refined_to);
    EXPECT_LT(c.force_error, refined_to);
  }
}

}  // namespace
}  // namespace conditioning_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "selftest_command.hpp"

#include "geometry/pi.hpp"
#include "pfv/pfv.hpp"

#include <cmath>
#include <functional>
#include <iomanip>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace pfv::app {
namespace {

struct Check {
  std::string what;
  double found, expected, tolerance;  ///< |found - expected| <= tolerance passes
};

PackingArrays packing_of(const std::vector<Eigen::Vector3d>& centres,
                         const std::function<double(std::size_t)>& radius) {
  PackingArrays packing;
  const auto n = static_cast<Eigen::Index>(centres.size());
  packing.ids = Packing::Ids::LinSpaced(n, 1, n);
  packing.positions.resize(3, n);
  packing.radii.resize(n);
  for (std::size_t k = 0; k < centres.size(); ++k) {
    packing.positions.col(static_cast<Eigen::Index>(k)) = centres[k];
    packing.radii[static_cast<Eigen::Index>(k)] = radius(k);
  }
  return packing;
}

/// Grains dropped at random where there is room.
PackingArrays random_packing(int spheres, double radius) {
  std::mt19937_64 generator(2012);
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  std::vector<Eigen::Vector3d> centres;
  while (static_cast<int>(centres.size()) < spheres) {
    const Eigen::Vector3d place =
        Eigen::Vector3d(uniform(), uniform(), uniform()) * (1.0 - 2.0 * radius) +
        Eigen::Vector3d::Constant(radius);
    bool free = true;
    for (const Eigen::Vector3d& other : centres)
      free = free && (place - other).norm() > 2.0 * radius;
    if (free) centres.push_back(place);
  }
  return packing_of(centres, [&](std::size_t) { return radius; });
}

Fluid unit_viscosity() {
  Fluid fluid;
  fluid.viscosity = 1.0;
  return fluid;
}

Box vertical_flow(Wall wall) {
  Box box;
  for (FaceCondition& face : box.faces) face.wall = wall;
  box[Face::zlo].boundary = Boundary::pressure(1.0);
  box[Face::zhi].boundary = Boundary::pressure(0.0);
  return box;
}

/// Drag of touching arrays (Zick & Homsy 1982): k = L³ / (6 pi a K n).
void lattices(std::vector<Check>& checks) {
  struct Lattice {
    const char* name;
    std::vector<Eigen::Vector3d> centres;
    double radius, drag;
  };
  const std::vector<Lattice> all{
      {"simple cubic", {{.5, .5, .5}}, 0.5, 42.1},
      {"body-centred cubic", {{.25, .25, .25}, {.75, .75, .75}}, std::sqrt(3.0) / 4.0, 162.9},
      {"face-centred cubic",
       {{.25, .25, .25}, {.75, .75, .25}, {.75, .25, .75}, {.25, .75, .75}},
       std::sqrt(2.0) / 4.0, 435.0}};
  for (const Lattice& lattice : all) {
    const PackingArrays packing =
        packing_of(lattice.centres, [&](std::size_t) { return lattice.radius; });
    Box box;
    box.periodic = {true, true, true};
    Flow flow(box, unit_viscosity());
    flow.evaluate(packing.view());
    const Eigen::Matrix3d tensor = *flow.report().permeability_tensor;
    const double exact = 1.0 / (6.0 * pi * lattice.radius * lattice.drag *
                                static_cast<double>(lattice.centres.size()));
    checks.push_back({std::string(lattice.name) + ": permeability / Zick & Homsy",
                      tensor(0, 0) / exact, 1.0, 0.1});
    checks.push_back({std::string(lattice.name) + ": anisotropy",
                      (tensor - tensor(0, 0) * Eigen::Matrix3d::Identity()).norm() / tensor(0, 0),
                      0.0, 1e-10});
  }
}

/// Chareyre et al. 2012, sec. 4: eight spheres and a ninth between them (finite elements, d/D = 0.72).
void nine_spheres(std::vector<Check>& checks) {
  std::vector<Eigen::Vector3d> centres;
  for (int corner = 0; corner < 8; ++corner)
    centres.emplace_back(corner & 1 ? .75 : .25, corner & 2 ? .75 : .25, corner & 4 ? .75 : .25);
  const auto radius = [](std::size_t k) { return k < 8 ? 0.25 : 0.72 * 0.25; };

  const PackingArrays eight = packing_of(centres, radius);
  Flow without(vertical_flow(Wall::symmetry), unit_viscosity());
  const Eigen::MatrixXd forces = without.evaluate(eight.view()).total;
  double worst = 0.0;
  for (Eigen::Index k = 0; k < forces.cols(); ++k)
    worst = std::max(worst, std::abs(forces(2, k) - 0.125));
  checks.push_back({"eight spheres: force on each - dp S / 8", worst, 0.0, 1e-10});

  centres.emplace_back(.5, .5, .5);
  const PackingArrays nine = packing_of(centres, radius);
  Flow with(vertical_flow(Wall::symmetry), unit_viscosity());
  with.evaluate(nine.view());
  checks.push_back({"nine spheres: permeability / finite elements",
                    *with.report().permeability / 4.94274e-4, 1.0, 0.05});
}

/// Mass and forces on a random packing that is squeezed by a drained piston.
void balances(std::vector<Check>& checks) {
  PackingArrays packing = random_packing(400, 0.055);
  packing.velocities = Eigen::Matrix3Xd::Zero(3, packing.ids.size());
  packing.velocities.row(2) = -packing.positions.row(2);
  Box box = vertical_flow(Wall::no_slip);
  box[Face::zhi].velocity = -1.0;
  Flow flow(box, unit_viscosity());
  flow.evaluate(packing.view());
  const Report report = flow.report();
  checks.push_back({"moving packing: volume rate / (area times piston velocity)",
                    -report.volume_rate_sum, 1.0, 1e-12});
  checks.push_back({"moving packing: mass error", report.mass_error, 0.0, 1e-10});
  checks.push_back({"moving packing: force balance error", report.force_balance_error, 0.0, 1e-10});
  checks.push_back({"moving packing: residual", report.residual, 0.0, 1e-11});
}

/// Degree of consolidation of a layer drained on both faces (Terzaghi).
double terzaghi(double time_factor) {
  double sum = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double m = pi * (2 * k + 1) / 2.0;
    sum += 2.0 / (m * m) * std::exp(-m * m * time_factor);
  }
  return 1.0 - sum;
}

/// A compressible fluid in a rigid packing obeys p_t = (k K_f / (mu n)) p_zz: after a step of pressure
/// on both ends of a column the mean pressure follows Terzaghi's curve. A regular column, so that no
/// heterogeneity of the packing stands between the two.
void consolidation(std::vector<Check>& checks) {
  constexpr int width = 3, height = 30;
  std::vector<Eigen::Vector3d> centres;
  for (int x = 0; x < width; ++x)
    for (int y = 0; y < width; ++y)
      for (int z = 0; z < height; ++z) centres.emplace_back(x + 0.5, y + 0.5, z + 0.5);
  const PackingArrays packing = packing_of(centres, [](std::size_t) { return 0.5; });
  Box box = vertical_flow(Wall::symmetry);
  box.upper = {width, width, height};
  Flow steady(box, unit_viscosity());
  steady.evaluate(packing.view());
  const Report report = steady.report();

  box[Face::zhi].boundary = Boundary::pressure(1.0);
  Fluid fluid = unit_viscosity();
  fluid.bulk_modulus = 1.0;
  Options options;
  options.forces = false;
  Flow flow(box, fluid, options);
  constexpr int steps = 500;
  constexpr double end = 0.5;  // time factor
  const double half = 0.5 * height, diffusivity = *report.permeability / report.porosity;
  const double dt = end * half * half / diffusivity / steps;
  double worst = 0.0;
  for (int step = 1; step <= steps; ++step) {
    flow.step(packing.view(), dt);
    const double time_factor = end * step / steps;
    if (time_factor >= 0.02)
      worst = std::max(worst, std::abs(flow.mean_pressure() - terzaghi(time_factor)));
  }
  checks.push_back({"consolidation: mean pressure - Terzaghi, worst", worst, 0.0, 0.01});
}

bool passes(const Check& check) {
  return std::abs(check.found - check.expected) <= check.tolerance;  // false for what is no number
}

}  // namespace

bool selftest(std::ostream& out) {
  std::vector<Check> checks;
  lattices(checks);
  nine_spheres(checks);
  balances(checks);
  consolidation(checks);
  bool all = true;
  out << std::left << std::setw(60) << "check" << std::setw(16) << "found" << std::setw(10)
      << "expected" << std::setw(12) << "tolerance" << "result\n";
  for (const Check& check : checks) {
    all = all && passes(check);
    out << std::left << std::setprecision(6) << std::setw(60) << check.what << std::setw(16)
        << check.found << std::setw(10) << check.expected << std::setw(12) << check.tolerance
        << (passes(check) ? "pass" : "FAIL") << '\n';
  }
  return all;
}

}  // namespace pfv::app

// SPDX-License-Identifier: GPL-3.0-or-later
// fuzz --count N --seed S [--first K] (support/fuzzing.hpp): N packings that look for trouble, each under boundaries,
// fluid and options of its own, at rest and moving.
#include "pfv/pfv.hpp"
#include "support/long_steps.hpp"
#include "support/adversarial.hpp"
#include "support/fuzzing.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace support;

struct Case {
  std::size_t kind;
  pfv::PackingArrays packing;
  pfv::Box box;
  pfv::Fluid fluid;
  pfv::Options options;
  double dt;
  bool implicit = false;
  bool staged;
};

// ------------------------------------------------------------------------------------- the cases

pfv::Boundary random_boundary(Random& random) {
  static constexpr std::array<double, 6> pressures{0.0, 1e-12, 1.0, 1e5, 1e12, -5.0};
  const double choice = random();
  if (choice < 0.45) return pfv::Boundary::sealed();
  if (choice < 0.55) return pfv::Boundary::flux(logarithmic(random, 1e-12, 1e3));
  return pfv::Boundary::pressure(pressures[static_cast<std::size_t>(whole(random, 0, 5))]);
}

pfv::Box random_box(Random& random) {
  pfv::Box box;
  const double size = random() < 0.3 ? logarithmic(random, 1e-9, 1e3) : 1.0;
  for (int axis = 0; axis < 3; ++axis)
    box.upper[axis] = size * (random() < 0.1 ? logarithmic(random, 1.0, 1e3) : 1.0);
  if (random() < 0.1) {
    const Eigen::Vector3d shift = size * logarithmic(random, 1.0, 1e6) * random.in_cube();
    box.lower += shift;
    box.upper += shift;
  }
  const bool plain = random() < 0.5;  // a pressure difference along z
  for (const pfv::Face face : pfv::all_faces) {
    box[face].wall = random() < 0.5 ? pfv::Wall::no_slip : pfv::Wall::symmetry;
    if (!plain) box[face].boundary = random_boundary(random);
  }
  if (plain) {
    box[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1.0);
    box[pfv::Face::zhi].boundary = pfv::Boundary::pressure(0.0);
  }
  return box;
}

void make_periodic(pfv::Box& box, Random& random) {
  for (int axis = 0; axis < 3; ++axis) {
    if (random() < 0.4) continue;
    box.periodic[axis] = true;
    box.pressure_gradient[axis] = random() < 0.5 ? 1.0 : 0.0;
    box.faces[2 * axis] = box.faces[2 * axis + 1] = {};
  }
}

void add_patch(pfv::Box& box, Random& random) {
  pfv::Patch patch;
  patch.face = pfv::all_faces[static_cast<std::size_t>(whole(random, 0, 5))];
  const int axis = pfv::axis_of(patch.face);
  if (box.periodic[axis]) return;
  const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
  const double a = random(0.0, 0.9), b = random(0.0, 0.9), size = logarithmic(random, 1e-6, 0.5);
  const auto at = [&](int along, double share) {
    return box.lower[along] + share * (box.upper[along] - box.lower[along]);
  };
  patch.rectangle = {at(first, a), at(first, a + size), at(second, b), at(second, b + size)};
  patch.boundary = random_boundary(random);
  box.patches.push_back(patch);
}

pfv::Fluid random_fluid(Random& random) {
  pfv::Fluid fluid;
  fluid.viscosity = logarithmic(random, 1e-6, 1e9);
  if (random() < 0.5) fluid.gravity = {0.0, 0.0, -9.81};
  if (random() < 0.3) fluid.bulk_modulus = logarithmic(random, 1e3, 1e12);
  return fluid;
}

pfv::Options random_options(Random& random) {
  pfv::Options options;
  options.conductance = static_cast<pfv::ConductanceLaw>(whole(random, 0, 2));
  if (random() < 0.05) options.partition = pfv::Partition::yade;
  if (random() < 0.2) options.solver = pfv::SolverKind::klu2;
  else if (random() < 0.3) options.ordering = pfv::OrderingKind::amd;
  if (random() < 0.9) options.outside = pfv::OutsideGrains::leave_out;
  options.split_forces = random() < 0.3;
  options.sphere_pressure = random() < 0.3;
  return options;
}

/// Velocities of one length a second, from a rigid one to a random one; none for a third.
Eigen::Matrix3Xd random_velocities(const pfv::PackingArrays& packing, const pfv::Box& box,
                                   Random& random) {
  const double choice = random(), size = (box.upper - box.lower).minCoeff();
  const Eigen::Index n = packing.radii.size();
  if (choice < 0.33) return Eigen::Matrix3Xd(3, 0);
  if (choice < 0.4) return (size * direction(random)).replicate(1, n);
  if (choice < 0.6) return (packing.positions.colwise() - box.lower) * random(-1.0, 1.0);
  Eigen::Matrix3Xd velocities(3, n);
  for (Eigen::Index k = 0; k < n; ++k) velocities.col(k) = size * random.in_cube();
  return velocities;
}

Case case_number(std::uint64_t seed, std::uint64_t number) {
  Random random(seed * 1000003ULL + number);
  Case c;
  c.kind = static_cast<std::size_t>(number % adversarial::kinds.size());
  c.box = random_box(random);
  if (random() < 0.12) make_periodic(c.box, random);
  if (random() < 0.15) add_patch(c.box, random);
  c.fluid = random_fluid(random);
  c.options = random_options(random);
  auto spheres = adversarial::spheres_of(c.kind, random);
  const Eigen::Vector3d edges = c.box.upper - c.box.lower;
  for (Sphere& s : spheres)
    s = sphere_at(c.box.lower + centre_of(s).cwiseProduct(edges), s.radius * edges.minCoeff());
  c.packing = packing_of(spheres);
  c.packing.velocities = random_velocities(c.packing, c.box, random);
  c.dt = logarithmic(random, 1e-9, 1.0);  // up to a jump of the whole packing
  c.staged = random() < 0.15;
  c.implicit = random() < 0.15;
  if (c.packing.velocities.cols() > 0 && random() < 0.5) {
    c.packing.angular_velocities = c.packing.velocities;
    for (Eigen::Index k = 0; k < c.packing.radii.size(); ++k)
      c.packing.angular_velocities.col(k) = 3.0 * random.in_cube();
  }
  if (random() < 0.2 && !c.box.periodic[0]) c.box[pfv::Face::xhi].sliding = {0.0, 1.0, -2.0};
  if (random() < 0.1 && !c.box.periodic[1]) c.box[pfv::Face::ylo].spin = 1.0;
  c.options.torques = random() < 0.5;
  if (random() < 0.05 || c.options.partition == pfv::Partition::yade) {
    c.options.volume_rates = pfv::VolumeRates::geometric;
    c.options.torques = false;
    c.staged = c.implicit = false;
  }
  return c;
}

/// In one line, with the options of `pfv solve`.
std::string description(const Case& c) {
  std::ostringstream text;
  text << adversarial::kinds[c.kind].name << ", " << c.packing.radii.size() << " spheres, box "
       << c.box.lower.transpose() << " to " << c.box.upper.transpose() << ", periodic "
       << c.box.periodic[0] << c.box.periodic[1] << c.box.periodic[2] << ", "
       << pfv::name_of(c.options.conductance) << ", " << pfv::name_of(c.options.partition) << ", "
       << pfv::name_of(c.options.solver);
  for (const pfv::Face face : pfv::all_faces) {
    const pfv::FaceCondition& condition = c.box[face];
    static constexpr std::array<const char*, 3> kinds{"sealed", "pressure=", "flux="};
    text << ", " << pfv::name_of(face) << (condition.wall == pfv::Wall::symmetry ? "*:" : ":")
         << kinds[static_cast<std::size_t>(condition.boundary.kind)];
    if (condition.boundary.is_open()) text << condition.boundary.value;
  }
  if (!c.box.patches.empty()) text << ", a patch";
  if (c.fluid.bulk_modulus) text << ", bulk modulus " << *c.fluid.bulk_modulus;
  text << ", dt " << c.dt << (c.packing.velocities.cols() ? ", moving" : ", still")
       << (c.staged ? ", staged" : c.implicit ? ", implicit" : "") << ", "
       << pfv::name_of(c.options.volume_rates);
  return text.str();
}

// ------------------------------------------------------------------------------------- the checks

using fuzzing::all_finite;
using fuzzing::Outcome;

/// Without motion, fluxes or storage no pressure leaves the range of those imposed.
void check_range(const Case& c, const pfv::Flow& flow, Outcome& outcome) {
  double low = 1e300, high = -1e300;
  const auto extend = [&](const pfv::Boundary& b) {
    if (b.imposes_flux()) low = -1e300, high = 1e300;
    if (!b.imposes_pressure()) return;
    low = std::min(low, b.value);
    high = std::max(high, b.value);
  };
  for (const pfv::FaceCondition& face : c.box.faces) extend(face.boundary);
  for (const pfv::Patch& patch : c.box.patches) extend(patch.boundary);
  if (low > high || flow.pore_pressures().size() == 0) return;
  const double hair = 1e-9 * std::max({std::abs(low), std::abs(high), high - low});
  if (flow.pore_pressures().minCoeff() < low - hair ||
      flow.pore_pressures().maxCoeff() > high + hair)
    outcome.fail("a pressure outside the range of those imposed");
}

void check_result(const Case& c, const pfv::Flow& flow, bool at_rest, Outcome& outcome) {
  const pfv::Forces& forces = flow.forces();
  if (!forces.total.allFinite() || !forces.torque.allFinite() || !forces.viscous.allFinite() ||
      !forces.sphere_pressure.allFinite())
    outcome.fail("a force that is not finite");
  if (!flow.pore_pressures().allFinite()) outcome.fail("a pressure that is not finite");
  const pfv::Report report = flow.report();
  if (!all_finite(report)) outcome.fail("a number in the report that is not finite");
  const double volume = (c.box.upper - c.box.lower).prod();
  if (!(report.pore_volume >= -1e-12 * volume && report.pore_volume <= (1.0 + 1e-12) * volume))
    outcome.fail("a pore volume of " + std::to_string(report.porosity) + " of the box");
  if (at_rest && !c.fluid.bulk_modulus && !c.box.any_periodic()) check_range(c, flow, outcome);
  outcome.mass = std::max(outcome.mass, std::abs(report.mass_error));
  if (c.options.partition != pfv::Partition::yade)  // YADE's own forces do not balance
    outcome.balance = std::max(outcome.balance, report.force_balance_error);
}

void run_flow(Case& c, Outcome& outcome) {
  pfv::Flow flow(c.box, c.fluid, c.options);
  pfv::PackingArrays still = c.packing;
  still.velocities.resize(3, 0);
  still.angular_velocities.resize(3, 0);
  flow.evaluate(still.view(), c.dt);
  check_result(c, flow, c.box[pfv::Face::xhi].sliding.isZero() && c.box[pfv::Face::ylo].spin == 0.0,
               outcome);
  const Eigen::Vector3d place = c.box.lower + 0.37 * (c.box.upper - c.box.lower);
  if (flow.network().cells() > 0 && !std::isfinite(flow.pressure_at(place)))
    outcome.fail("a pressure at a place that is not finite");
  const Eigen::VectorXd masses = c.packing.radii.array().cube() * 4e3;
  const double limit = flow.time_step_limit(masses);
  if (!(limit > 0.0)) outcome.fail("a time step limit of " + std::to_string(limit));
  if (c.staged || c.implicit) c.dt = std::min(c.dt, 1e3 * limit);
  if (c.packing.velocities.cols() == 0) return;
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, masses.size());
  const pfv::GrainDynamics grains{{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  for (int step = 0; step < 3; ++step) {
    c.packing.positions += c.dt * c.packing.velocities;
    if (c.staged)
      step_staged(flow, c.packing.view(), c.dt, grains);
    else if (c.implicit)
      step_implicit(flow, c.packing.view(), c.dt, grains);
    else
      flow.step(c.packing.view(), c.dt);
    check_result(c, flow, false, outcome);
  }
}

/// Conductances may span 25 decades here: a direct solve then keeps this much of the mass, and what
/// would lose more is refused. Forces balance to round-off whatever the pressures are.
constexpr double largest_mass_error = 1e-3;
constexpr double largest_balance_error = 1e-12;
/// Images of one pore may be joined with flat cells in different ways, as long as what leaves the cell and
/// what comes in differ by no more of the largest throat (same_area in periodic_images.cpp).
constexpr double largest_periodic_balance_error = 1e-9;

Outcome examine(Case c) {
  Outcome outcome = fuzzing::examine([&](Outcome& of) { run_flow(c, of); });
  if (outcome.mass > largest_mass_error)
    outcome.fail("mass error " + std::to_string(outcome.mass));
  if (outcome.balance >
      (c.box.any_periodic() ? largest_periodic_balance_error : largest_balance_error))
    outcome.fail("unbalanced forces, " + std::to_string(outcome.balance));
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> kinds;
  for (const auto& kind : adversarial::kinds) kinds.emplace_back(kind.name);
  return fuzzing::run(argc, argv, kinds, case_number, examine, description);
}

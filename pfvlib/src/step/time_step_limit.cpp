// SPDX-License-Identifier: GPL-3.0-or-later
#include "step/time_step_limit.hpp"

#include "pfv/error.hpp"
#include "physics/time_step_limit.hpp"
#include "step/long_step.hpp"
#include "step/operators.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace pfv {

namespace {

double limit_of(double eigenvalue) {
  return eigenvalue > 0.0 ? 2.0 / eigenvalue : std::numeric_limits<double>::infinity();
}

/// 1 / sqrt(m) of each degree of freedom; faces are guided along axes. Wide where there are bodies.
Matrix6Xd inverse_roots(const BuiltNetwork& built, const Container& container, const Eigen::VectorXd& masses,
                        const std::vector<RigidBody>& bodies) {
  const int spheres = built.grains.spheres.size(), faces = container.face_count();
  Matrix6Xd root = no_motion(spheres, faces + static_cast<Eigen::Index>(bodies.size()));
  for (int i = 0; i < spheres; ++i) {
    if (!built.share.owns_sphere(i)) continue;  // its owner counts it
    const double mass = masses[built.grains.columns[i]];
    root.col(i).head<3>().setConstant(1.0 / std::sqrt(mass));
    root.col(i).tail<3>().setConstant(
        1.0 / std::sqrt(inertia_of(mass, built.grains.spheres.radii[i])));
  }
  const Eigen::Index packed = masses.size() - faces;
  if (built.operators.bodies) {
    const Matrix6Xd yielding = yielding_of_bodies(bodies, 1.0);
    root.rightCols(yielding.cols()) = yielding.cwiseSqrt();
    for (const auto& member : built.operators.bodies->members) root.col(member.sphere).setZero();
  }
  for (int f = 0; f < faces; ++f)
    if (std::isfinite(masses[packed + f]))
      root(guided_axis(container, f), spheres + f) = 1.0 / std::sqrt(masses[packed + f]);
  return root;
}

/// Where the iteration begins: on several ranks from numbers that a sphere's id makes, whoever has it.
Eigen::VectorXd start_of(const BuiltNetwork& built, Eigen::Index columns) {
  if (!built.share.ranks) return pseudo_random(6 * columns);
  Matrix6Xd start(6, columns);
  const Packing::Ids& ids = built.grains.spheres.ids;
  for (Eigen::Index i = 0; i < columns; ++i) {
    std::mt19937_64 generator(static_cast<std::uint64_t>(i < ids.size() ? ids[i] : i - ids.size()));
    for (int k = 0; k < 6; ++k) start(k, i) = static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5;
    if (i < ids.size() && !built.share.owns_sphere(static_cast<int>(i))) start.col(i).setZero();
  }
  return start.reshaped();
}

/// Of what all ranks have: spheres where they are owned, faces once.
double product_of(const BuiltNetwork& built, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (!built.share.ranks) return a.dot(b);
  const Eigen::Index of_spheres = 6 * built.grains.spheres.size(), others = a.size() - of_spheres;
  return built.share.sum(a.head(of_spheres).dot(b.head(of_spheres))) + a.tail(others).dot(b.tail(others));
}

/// Largest eigenvalue of M^-1 S G^-1 S^T, 1/s (with geometric rates E in place of S^T). The operator is
/// similar to it and, but for those, symmetric.
double largest_drag(const BuiltNetwork& built, const Problem& problem,
                    const Eigen::VectorXd& masses, const std::vector<RigidBody>& bodies, std::int64_t& solves) {
  const Share& share = built.share;
  const int spheres = built.grains.spheres.size();
  if (!share.any(spheres > 0)) return 0.0;
  const std::optional<RigidBodies>& held = built.operators.bodies;
  const Matrix6Xd root = inverse_roots(built, problem.container, masses, bodies);
  Eigen::VectorXd opened;
  const auto drag = [&](const Eigen::VectorXd& u) {
    Motion v = (u.reshaped(6, root.cols()).array() * root.array()).matrix();
    if (held) v = held->spread(v);
    if (share.ranks) share.spheres.refresh(*share.ranks, v);
    rates_of(built, v, *problem.team, opened);
    Loads load = loads_of(built, homogeneous_pressures(built, opened, solves)) -
                 resisting_forces(built, problem.fluid.viscosity, v);
    join_loads(built, load);
    if (held) load = held->gathered(load);
    return Eigen::VectorXd((load.array() * root.array()).matrix().reshaped());
  };
  if (built.operators.geometric_rates) return largest_eigenvalue_of_any(drag, root.size());
  return largest_eigenvalue(drag, start_of(built, root.cols()), [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return product_of(built, a, b);
  });
}

/// Of spheres and faces, then those and the inertias of bodies. Throws InputError.
Eigen::VectorXd all_masses(const BuiltNetwork& built, Eigen::Index spheres, int faces, const Eigen::VectorXd& masses,
                           const std::vector<Piston>& pistons, const std::vector<RigidBody>& bodies) {
  Eigen::VectorXd all(spheres + faces + 6 * static_cast<Eigen::Index>(bodies.size()));
  built.share.together([&] {
    if (masses.size() != spheres)
      throw InputError("time step limit: " + std::to_string(masses.size()) + " masses for " +
                       std::to_string(spheres) + " spheres; give one a sphere");
    check_bodies(bodies, built);
    all.head(spheres) = masses;
    all.tail(all.size() - spheres - faces) = yielding_of_bodies(bodies, 1.0).reshaped();
    for (int f = 0; f < faces; ++f) all[spheres + f] = piston_of(pistons, f).mass;
    if (!(all.head(spheres + faces).array() > 0.0).all())
      throw InputError("time step limit: a mass is not a positive number; give kg");
  });
  return all;
}

}  // namespace

double TimeStepLimit::of(BuiltNetwork& built, const Problem& problem, Eigen::Index spheres,
                         const Eigen::VectorXd& masses, const std::vector<Piston>& pistons,
                         const std::vector<RigidBody>& bodies, WorkRecord& work) {
  const int faces = problem.container.face_count();
  const Eigen::VectorXd all = all_masses(built, spheres, faces, masses, pistons, bodies);
  const bool still = is_still(problem.container);
  const bool is_known = limit_ && all.size() == masses_.size() && all == masses_ && still == still_water_;
  if (!built.share.any(!is_known)) return *limit_;
  limit_.reset();
  still_water_ = still;
  make_force_matrices(built, problem, work.counts);
  make_volume_rates(built, problem, work.counts);
  take_bodies(built, problem, bodies);
  masses_ = all;
  limit_ = limit_of(largest_drag(built, problem, all.head(spheres + faces), bodies, work.counts.limit_solve));
  return *limit_;
}

}  // namespace pfv

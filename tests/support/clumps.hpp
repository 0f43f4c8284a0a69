// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow.hpp"
#include "support/packings.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace support {

/// Rigid bodies of spheres among single ones, moved as a host moves them, by so little that the network stays.
struct Clumps {
  pfv::PackingArrays packing;
  Eigen::VectorXd masses;  ///< of the spheres, kg
  Eigen::Matrix3Xd others, other_torques;
  std::vector<pfv::RigidBody> bodies;
  std::vector<std::vector<int>> members;
  Eigen::Matrix3Xd velocities, spins;  ///< of the bodies

  /// `shape`: places of a body's spheres about their middle (one: a single sphere); `single`: every how manyth is one.
  Clumps(const Eigen::Matrix3Xd& shape, double radius, int cells, int single, std::uint64_t seed = 3) {
    Random random(seed);
    std::vector<Sphere> spheres;
    std::vector<int> body;
    for (int cell = 0; cell < cells * cells * cells; ++cell) {
      const Eigen::Vector3d place = ((Eigen::Vector3d(cell % cells, cell / cells % cells, cell / cells / cells)
                                          .array() + 0.5) / cells).matrix() + 0.01 * random.in_cube();
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(random(0.0, pi), random.in_cube().normalized()).toRotationMatrix();
      if (single > 0 && cell % single == 0) {
        spheres.push_back({place[0], place[1], place[2], 1.2 * radius});
        body.push_back(-1);
        continue;
      }
      members.emplace_back();
      for (Eigen::Index i = 0; i < shape.cols(); ++i) {
        const Eigen::Vector3d x = place + turn * shape.col(i);
        members.back().push_back(static_cast<int>(spheres.size()));
        spheres.push_back({x[0], x[1], x[2], radius});
        body.push_back(static_cast<int>(members.size()) - 1);
      }
    }
    packing = packing_of(spheres);
    packing.bodies = Eigen::Map<Eigen::VectorXi>(body.data(), static_cast<Eigen::Index>(body.size()));
    masses = 2600.0 * 4.0 / 3.0 * pi * packing.radii.array().cube();
    others = other_torques = Eigen::Matrix3Xd::Zero(3, masses.size());
    packing.velocities = packing.angular_velocities = others;
    for (const auto& own : members) add_body(own);
    velocities = spins = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(bodies.size()));
  }

  void add_body(const std::vector<int>& own) {
    pfv::RigidBody body;
    const Eigen::Matrix3Xd x = packing.positions(Eigen::all, own);
    const Eigen::Vector3d centre = x.rowwise().mean();
    body.arms = x.colwise() - centre;
    const double mass = masses(own).sum();
    body.masses.setConstant(mass);
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Eigen::Vector3d r = body.arms.col(static_cast<Eigen::Index>(i));
      inertia += masses[own[i]] * ((r.squaredNorm() + 0.4 * std::pow(packing.radii[own[i]], 2)) *
                                       Eigen::Matrix3d::Identity() - r * r.transpose());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
    body.inertias = principal.eigenvalues();
    body.axes = principal.eigenvectors();
    bodies.push_back(body);
  }

  pfv::GrainDynamics dynamics() const {
    return {{masses.data(), masses.size()},
            {others.data(), 3, others.cols()},
            {},
            {other_torques.data(), 3, other_torques.cols()},
            {nullptr, 0},
            bodies};
  }

  /// Spheres of bodies as these move.
  void follow() {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (std::size_t i = 0; i < members[b].size(); ++i) {
        const auto own = static_cast<Eigen::Index>(b);
        packing.angular_velocities.col(members[b][i]) = spins.col(own);
        packing.velocities.col(members[b][i]) =
            velocities.col(own) +
            Eigen::Vector3d(spins.col(own)).cross(Eigen::Vector3d(bodies[b].arms.col(static_cast<Eigen::Index>(i))));
      }
  }
  void stir(double speed, std::uint64_t seed = 5) {
    Random random(seed);
    for (Eigen::Index b = 0; b < velocities.cols(); ++b) {
      velocities.col(b) = speed * random.in_cube();
      spins.col(b) = 10.0 * speed * random.in_cube();
    }
    for (Eigen::Index k = 0; k < packing.velocities.cols(); ++k)
      if (packing.bodies[k] < 0) packing.velocities.col(k) = speed * random.in_cube();
    follow();
  }

  /// Force and moment about its centre of mass on body b.
  Eigen::Matrix<double, 6, 1> on_body(const pfv::Forces& forces, std::size_t b) const {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < members[b].size(); ++i) {
      const int k = members[b][i];
      const Eigen::Vector3d force = forces.total.col(k) + others.col(k);
      const Eigen::Vector3d arm = bodies[b].arms.col(static_cast<Eigen::Index>(i));
      sum.head<3>() += force;
      sum.tail<3>() += arm.cross(force) + Eigen::Vector3d(other_torques.col(k));
      if (forces.torque.cols() > 0) sum.tail<3>() += forces.torque.col(k);
    }
    sum.head<3>() += bodies[b].other_force;
    sum.tail<3>() += bodies[b].other_torque;
    return sum;
  }

  /// What the host makes of the forces over dt, or over `part` of it.
  void move(const pfv::Forces& forces, double dt, double part = 1.0) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const auto own = static_cast<Eigen::Index>(b);
      const auto load = on_body(forces, b);
      velocities.col(own).array() += part * dt * load.head<3>().array() / bodies[b].masses.array();
      const Eigen::Vector3d turn = bodies[b].axes.transpose() * load.tail<3>();
      spins.col(own) += bodies[b].axes * (part * dt * turn.array() / bodies[b].inertias.array()).matrix();
    }
    for (Eigen::Index k = 0; k < masses.size(); ++k)
      if (packing.bodies[k] < 0)
        packing.velocities.col(k) += part * dt / masses[k] * (forces.total.col(k) + others.col(k));
    follow();
  }

  /// Kinetic energy without a factor.
  double energy() const {
    double sum = 0.0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const auto own = static_cast<Eigen::Index>(b);
      sum += (bodies[b].masses.array() * velocities.col(own).array().square()).sum();
      sum += (bodies[b].inertias.array() * (bodies[b].axes.transpose() * spins.col(own)).array().square()).sum();
    }
    for (Eigen::Index k = 0; k < masses.size(); ++k)
      if (packing.bodies[k] < 0) sum += masses[k] * packing.velocities.col(k).squaredNorm();
    return sum;
  }
};

/// A pair whose centres are `distance` apart.
inline Eigen::Matrix3Xd pair_shape(double distance) {
  Eigen::Matrix3Xd shape(3, 2);
  shape << -0.5 * distance, 0.5 * distance, 0, 0, 0, 0;
  return shape;
}

/// A regular tetrahedron of this edge.
inline Eigen::Matrix3Xd tetrahedron_shape(double edge) {
  Eigen::Matrix3Xd shape(3, 4);
  shape << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  return shape * edge / std::sqrt(8.0);
}

}  // namespace support

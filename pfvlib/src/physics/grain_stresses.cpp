// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/grain_stresses.hpp"

#include "geometry/pi.hpp"
#include "geometry/tensor_rows.hpp"
#include "pfv/error.hpp"

#include <cmath>
#include <string>

namespace pfv {
namespace {

double volume_of(double radius) { return 4.0 / 3.0 * pi * std::pow(radius, 3); }

void require_contacts(const ContactForces& contacts, Eigen::Index spheres) {
  const Eigen::Index count = contacts.spheres.size();
  if (contacts.points.cols() != count || contacts.forces.cols() != count)
    throw InputError("contact_stresses: " + std::to_string(count) + " spheres, " +
                     std::to_string(contacts.points.cols()) + " points and " + std::to_string(contacts.forces.cols()) +
                     " forces; give one of each for each contact");
  if (count > 0 && (contacts.spheres.minCoeff() < 0 || contacts.spheres.maxCoeff() >= spheres))
    throw InputError("contact_stresses: a contact of a sphere that is none of the packing's " +
                     std::to_string(spheres) + "; count from 0");
  if (!contacts.points.allFinite() || !contacts.forces.allFinite())
    throw InputError("contact_stresses: a point or force is not finite");
}

void require_masses(const Packing& packing, const Eigen::Ref<const Eigen::VectorXd>& masses) {
  if (masses.size() != packing.size() || !masses.allFinite())
    throw InputError("inertial_stresses: " + std::to_string(masses.size()) + " masses of " +
                     std::to_string(packing.size()) + " spheres; give a finite one for each");
}

}  // namespace

SphereTensors contact_stresses(const Packing& packing, const ContactForces& contacts) {
  require_contacts(contacts, packing.size());
  SphereTensors stresses = SphereTensors::Zero(6, packing.size());
  for (Eigen::Index c = 0; c < contacts.spheres.size(); ++c) {
    const std::int64_t k = contacts.spheres[c];
    const Eigen::Vector3d arm = contacts.points.col(c) - packing.positions.col(k);
    stresses.col(k) += tensor_rows(arm * contacts.forces.col(c).transpose()) / volume_of(packing.radii[k]);
  }
  return stresses;
}

SphereTensors inertial_stresses(const Packing& packing, const Eigen::Ref<const Eigen::VectorXd>& masses,
                                const Eigen::Vector3d& frame) {
  require_masses(packing, masses);
  SphereTensors stresses = SphereTensors::Zero(6, packing.size());
  for (Eigen::Index k = 0; k < packing.velocities.cols(); ++k) {
    const Eigen::Vector3d velocity = packing.velocities.col(k) - frame;
    stresses.col(k) = -masses[k] / volume_of(packing.radii[k]) * tensor_rows(velocity * velocity.transpose());
  }
  return stresses;
}

Eigen::Vector3d mean_velocity(const Packing& packing, const Eigen::Ref<const Eigen::VectorXd>& masses) {
  require_masses(packing, masses);
  const double mass = masses.sum();
  if (packing.velocities.cols() == 0 || !(mass > 0.0)) return Eigen::Vector3d::Zero();
  return packing.velocities * masses / mass;
}

}  // namespace pfv

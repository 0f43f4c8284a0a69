// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/volume_rates.hpp"
#include "support/stages.hpp"

namespace support {

/// These velocities of the spheres, which do not spin, and the faces as the box says.
inline pfv::Motion motion_of(const Eigen::Matrix3Xd& velocities, const pfv::Container& box) {
  pfv::Motion motion = pfv::Motion::Zero(6, velocities.cols() + box.face_count());
  motion.topLeftCorner(3, velocities.cols()) = velocities;
  pfv::set_faces(motion, box, box.lower);
  return motion;
}

inline pfv::ForceMatrix force_matrix_of(
    const Stages& s, pfv::ConductanceLaw law = pfv::ConductanceLaw::open_throat,
    pfv::ForceParts parts = {}) {
  return pfv::force_matrix(s.network, s.spheres, s.throats,
                           pfv::viscous_shares(law, s.network, s.throats, s.spheres),
                           s.spheres.size(), parts);
}

inline pfv::Bases bases_of(const Stages& s) {
  return pfv::measure_bases(s.network, s.boundaries, s.spheres);
}

/// dV/dt by S^T.
inline Eigen::VectorXd reciprocal_rates(const Stages& s, const pfv::Motion& motion) {
  pfv::Team alone;
  Eigen::VectorXd rates(s.network.pores());
  pfv::reciprocal_rates(force_matrix_of(s), {}, bases_of(s), motion, alone, rates);
  return rates;
}

/// dV/dt by E.
inline Eigen::VectorXd geometric_rates(const Stages& s, const Eigen::Matrix3Xd& velocities,
                                       const pfv::Container& box) {
  pfv::Team alone;
  Eigen::VectorXd rates;
  pfv::volume_rates(pfv::volume_rate_matrix(s.network, s.spheres), motion_of(velocities, box), alone,
                    rates);
  return rates;
}

}  // namespace support

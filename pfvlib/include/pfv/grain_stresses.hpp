// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/fields.hpp"
#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace pfv {

/// A symmetric tensor for each sphere, a column each: xx, yy, zz, xy, xz, yz.
using SphereTensors = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Forces on spheres where others or walls touch them, a column each. A contact of two spheres is two of them, with
/// opposite forces; across a periodic side each has its point beside the sphere that it acts on.
struct ContactForces {
  Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1> spheres;  ///< the column of the packing that it acts on
  Eigen::Matrix3Xd points;  ///< m
  Eigen::Matrix3Xd forces;  ///< N
};

/// Mean stress that the contacts cause in each sphere (Pa, tension positive): the moment of the forces about the centre
/// over the sphere's volume, symmetric part (Catalano 2012, eq. 2.18). With what the fluid causes
/// (Flow::sphere_stresses) it is the stress of a sphere in equilibrium; times the solid fraction its mean over a
/// region is the effective stress there (eq. 2.19). Summed over all spheres, times their volumes, it is the moment of
/// the walls' forces less that of the spheres' resultants of contact forces in their centres. 0 without contacts.
/// Throws InputError for arrays that do not go together, a column that the packing does not have or a number that is
/// not finite.
SphereTensors contact_stresses(const Packing& packing, const ContactForces& contacts);

/// What the motion of each sphere adds to the stress of the packing (Pa): -m v v^T over the sphere's volume, v relative
/// to `frame`, m/s, for instance mean_velocity(). Its spin adds nothing: the momentum that it carries, -(m r^2/5)
/// (w^2 1 - w w^T), is the tension that it causes within the sphere. 0 without velocities. `masses`: kg, of each.
/// Throws InputError where these are not finite or not as many.
SphereTensors inertial_stresses(const Packing& packing, const Eigen::Ref<const Eigen::VectorXd>& masses,
                                const Eigen::Vector3d& frame);

/// Of the centre of mass, m/s; 0 without velocities or masses.
Eigen::Vector3d mean_velocity(const Packing& packing, const Eigen::Ref<const Eigen::VectorXd>& masses);

/// As files have them: `name`, in the order of Field, and `name_deviator`, sqrt(3/2 s:s) of the part s without its
/// mean: the difference of the axial and the radial stress of a triaxial test.
std::vector<Field> stress_fields(const std::string& name, SphereTensors stresses);

}  // namespace pfv

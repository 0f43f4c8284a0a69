// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

namespace pfv {

/// The pore fluid. Pressures everywhere are the piezometric excess
/// p = p_abs - density gravity . x  (x measured from the origin of the coordinates).
struct Fluid {
  double viscosity = 1e-3;                             ///< Pa s, > 0
  double density = 1000.0;                             ///< kg/m³, >= 0; used only with gravity
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();   ///< m/s²; zero: no buoyancy is computed
  std::optional<double> bulk_modulus;                  ///< Pa, > 0; absent: incompressible
};

/// Throws InputError for a value that is not finite or out of range.
void check(const Fluid& fluid);

}  // namespace pfv

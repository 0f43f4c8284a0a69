// SPDX-License-Identifier: GPL-3.0-or-later
// What the loads of a solve hang on beside the places of the grains and the values at boundaries.
#ifndef LMP_PFV_PRESENT_H
#define LMP_PFV_PRESENT_H

#include "pfv/solve_plan.hpp"

#include <Eigen/Core>
#include <mpi.h>
#include <vector>

namespace LAMMPS_NS {

/// Of all ranks, and the same on each.
struct PfvPresent {
  double motion = 0.0;     ///< sum of |v| r² of the grains, m³/s
  double grains = 0.0;     ///< number
  double newcomers = 0.0;  ///< that the last solve has not seen
  double volume = 0.0;     ///< sum of r³, m³
  double grown = 0.0;      ///< sum of its changes since the last solve, one way or the other
  /// Of each mesh whose motion the script prescribes, m³/s: what it sweeps by its motion along its normal, with and
  /// without sign, and in all, and the integral of the velocity.
  std::vector<Eigen::Matrix<double, 6, 1>> meshes;

  /// Of the grains' sizes since the last solve, over their volume; infinite where other grains are there.
  double change_of_grains(const PfvPresent& then) const;
  /// Whether a mesh moves otherwise than it did `then`, at the last solve, beyond what its loads bear.
  bool meshes_have_jumped(const PfvPresent& then, const pfv::NextSolve& last, double tolerance) const;
};

/// The grains of `groupbit`, whose radii at the last solve (0: not seen) stand in a column of a per-atom array, and these
/// meshes. Collective.
PfvPresent present_of(class Atom* atom, int groupbit, double** per_atom, int column,
                      const std::vector<class FixMeshSurface*>& meshes, MPI_Comm world);

}  // namespace LAMMPS_NS

#endif

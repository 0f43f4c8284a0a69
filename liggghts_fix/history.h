// SPDX-License-Identifier: GPL-3.0-or-later
// What a row of the file of `fix pfv ... history` holds. Knows nothing of LIGGGHTS' objects.
#ifndef LMP_PFV_HISTORY_H
#define LMP_PFV_HISTORY_H

#include "pfv/flow_model.hpp"
#include "pfv/stokes_numbers.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Time steps and flow steps of all runs, those before a restart included.
struct PfvTaken {
  std::int64_t steps = 0, solves = 0;
};

/// Values under their names. NaN stands for what has no value.
struct PfvNamedRow {
  std::string names;  ///< separated by commas
  std::vector<double> values;
};

/// Of the grains alone, where obstacles are spheres of the flow as well.
struct PfvOfGrains {
  std::int64_t hidden = 0;  ///< or outside
  Eigen::Vector3d force;    ///< of the fluid on all of them, N
  pfv::StokesNumbers stokes;
};

/// The flow after its last step: counts, balances, forces, then its faces and openings.
PfvNamedRow history_row(const pfv::FlowModel& flow, const pfv::Report& report, const PfvOfGrains& grains,
                        std::int64_t step, const PfvTaken& taken);

}  // namespace LAMMPS_NS

#endif

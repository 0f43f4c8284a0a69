// SPDX-License-Identifier: GPL-3.0-or-later
// What `fix pfv` puts into a restart file, as one array of numbers.
#ifndef LMP_PFV_RESTART_RECORD_H
#define LMP_PFV_RESTART_RECORD_H

#include "grain_exchange.h"
#include "result_files.h"

#include "pfv/flow_model.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

struct PfvRestartRecord {
  std::int64_t step = 0;
  pfv::FlowState flow;
  int steps_since_flow = 0;
  double elapsed = 0.0;  ///< s, since the last flow step
  std::vector<double> last_positions;  ///< of the faces
  /// Of meshes that are faces or obstacles: places at the last flow step (m), motions; none: not known.
  struct Meshes {
    std::vector<double> last_pivots, motions_of_faces, motions_of_obstacles;
  };
  std::optional<Meshes> meshes;
  PfvCellRates cell_rates{};           ///< m/s, over the last interval
  PfvSnapshot last_grains;
  PfvTaken taken;
  std::vector<PfvWrittenStep> written;
  std::vector<double> obstacles;  ///< PfvObstacles::record, or nothing
  std::optional<std::uint64_t> left;  ///< fingerprint of grains and periodic sides; none: not known
};

std::vector<double> pack(const PfvRestartRecord& record);
/// Throws pfv::InputError for numbers that another version of the fix has written.
PfvRestartRecord unpack(const char* bytes);

}  // namespace LAMMPS_NS

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
// What `fix pfv` writes itself: the fields for ParaView and the pressure profile. Rank 0 only.
#ifndef LMP_PFV_RESULT_FILES_H
#define LMP_PFV_RESULT_FILES_H

#include "arguments.h"

#include "pfv/flow_model.hpp"

#include <cstdint>
#include <fstream>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

/// Says when a file is due: at the first asked step that reaches a new multiple of `every`.
class PfvSchedule {
 public:
  explicit PfvSchedule(int every = 1) : every_(every) {}
  bool due(std::int64_t step);
  void resume_after(std::int64_t step) { last_ = step; }

 private:
  std::int64_t every_;
  std::optional<std::int64_t> last_;
};

/// One instant of the .pvd collection.
struct PfvWrittenStep {
  std::int64_t step;
  double time;  ///< of the flow, s
};

class PfvResultFiles {
 public:
  /// Throws pfv::InputError where a folder is missing or cannot be written.
  explicit PfvResultFiles(const PfvSettings& settings);

  /// Goes on with the files of the run that wrote the restart file at `step` and flow time `time`.
  void resume(std::int64_t step, double time, std::vector<PfvWrittenStep> written);
  const std::vector<PfvWrittenStep>& written() const { return written_; }

  /// Writes what is due after a flow step, at the flow's own time: LIGGGHTS' `time` begins anew at
  /// each restart. Throws pfv::FileError.
  void write(const pfv::FlowModel& flow, const pfv::Packing& packing, std::int64_t step);

 private:
  void write_fields(const pfv::FlowModel& flow, const pfv::Packing& packing, std::int64_t step);
  void write_profile_row(const pfv::FlowModel& flow);
  void open_profile();

  std::optional<PfvFieldOutput> fields_;
  std::optional<PfvProfileOutput> profile_;
  PfvSchedule field_schedule_, profile_schedule_;
  std::vector<PfvWrittenStep> written_;
  std::optional<double> resumed_time_;
  std::ofstream profile_file_;
};

}  // namespace LAMMPS_NS

#endif

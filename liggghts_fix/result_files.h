// SPDX-License-Identifier: GPL-3.0-or-later
// What `fix pfv` writes itself: the fields for ParaView, rows of planes and places, its history.
#ifndef LMP_PFV_RESULT_FILES_H
#define LMP_PFV_RESULT_FILES_H

#include "arguments.h"
#include "flow_ranks.h"
#include "grain_exchange.h"
#include "history.h"

#include "pfv/flow.hpp"
#include "pfv/io.hpp"

#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>
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

/// The grains where the flow has them, as files tell of them.
struct PfvWrittenGrains {
  pfv::Packing packing;
  const Eigen::Matrix3Xd& unwrapped;  ///< places without the wrapping of periodic axes, which displacements take
  Eigen::MatrixXd stresses;  ///< 12 rows: of contacts, of motion (PfvContactForces::rows); no columns: not asked for
};

/// One instant of the .pvd collection.
struct PfvWrittenStep {
  std::int64_t step;
  double time;  ///< of the flow, s
};

/// A file of comma-separated rows that a restarted run goes on with.
class PfvRowFile {
 public:
  /// `is_written`: on this rank. Throws pfv::InputError where the folder is missing or cannot be written.
  PfvRowFile(std::string path, int every, bool is_written);

  /// Keeps the rows that the run before has written up to the flow time `time`.
  void resume(std::int64_t step, double time);
  bool due(std::int64_t step) { return schedule_.due(step); }
  /// The names are those of every row; NaN leaves a field empty. Throws pfv::FileError.
  void write_row(const PfvNamedRow& row);

 private:
  void begin(const std::string& header);

  std::string path_;
  bool is_written_;
  PfvSchedule schedule_;
  std::optional<double> resumed_time_;
  std::ofstream file_;
};

class PfvResultFiles {
 public:
  /// `are_written`: on this rank; others that hold the flow ask it for the same. Throws pfv::InputError where a folder
  /// is missing or cannot be written.
  PfvResultFiles(const PfvSettings& settings, bool are_written);

  /// Goes on with the files of the run that wrote the restart file at `step` and flow time `time`.
  void resume(std::int64_t step, double time, std::vector<PfvWrittenStep> written);
  const std::vector<PfvWrittenStep>& written() const { return written_; }

  /// Writes what is due after a flow step, at the flow's own time: LIGGGHTS' `time` begins anew at
  /// each restart. Throws pfv::FileError.
  /// `ranks`: those that hold the flow; collective among them.
  void write(const pfv::FlowModel& flow, const PfvWrittenGrains& grains, std::int64_t step, const PfvFlowRanks& ranks);
  /// Whether the fields will be written at this step.
  bool fields_due(std::int64_t step) const { return fields_ && PfvSchedule(field_schedule_).due(step); }
  /// Where these grains were when they were first written, for grains that are dealt anew.
  PfvSnapshot first_places() const;
  void set_first_places(const PfvSnapshot& places);
  bool history_due(std::int64_t step) { return history_file_ && history_file_->due(step); }
  void write_history(const PfvNamedRow& row) { history_file_->write_row(row); }

 private:
  void write_fields(const pfv::FlowModel& flow, const PfvWrittenGrains& grains, std::int64_t step,
                    const PfvFlowRanks& ranks);
  PfvNamedRow profile_row(const pfv::FlowModel& flow) const;
  PfvNamedRow flux_row(const pfv::FlowModel& flow) const;
  PfvNamedRow sensor_row(const pfv::FlowModel& flow) const;
  std::vector<pfv::Field> sphere_fields(const pfv::FlowModel& flow, const PfvWrittenGrains& grains);
  Eigen::Matrix3Xd displacements(const pfv::Packing& packing, const Eigen::Matrix3Xd& unwrapped);
  pfv::Displaced displaced(const pfv::Packing& packing, const Eigen::Matrix3Xd& unwrapped,
                           const Eigen::Matrix3Xd& displacements) const;

  bool are_written_;
  std::optional<PfvFieldOutput> fields_;
  std::optional<PfvProfileOutput> profile_, flux_profile_;
  std::optional<PfvSensorOutput> sensors_;
  PfvSchedule field_schedule_;
  std::vector<PfvWrittenStep> written_;
  std::optional<PfvRowFile> profile_file_, flux_file_, sensor_file_, history_file_;
  std::map<std::int64_t, Eigen::Vector3d> first_places_;  ///< by tag
  /// When grains were first written: the edges of the container, m, and the highest tag on any rank. Grains that
  /// come later have higher ones.
  struct First {
    Eigen::Vector3d edges;
    std::int64_t last_tag;
  };
  std::optional<First> first_;
};

}  // namespace LAMMPS_NS

#endif

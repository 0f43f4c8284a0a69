// SPDX-License-Identifier: GPL-3.0-or-later
#include "result_files.h"

#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <cstdlib>
#include <iomanip>
#include <sstream>
#include <string>

namespace LAMMPS_NS {

namespace {

double relative_position(const PfvProfileOutput& profile, int plane) {
  return (plane + 0.5) / profile.planes;
}

std::string header_of(const PfvProfileOutput& profile) {
  std::ostringstream header;
  header << "time" << std::setprecision(10);
  for (int plane = 0; plane < profile.planes; ++plane)
    header << ',' << relative_position(profile, plane);
  return header.str();
}

/// The rows of a profile that an earlier run has written up to `time`; none where the file is
/// absent or of another kind.
std::string rows_until(const std::string& path, const std::string& header, double time) {
  std::ifstream file(path);
  std::string line, rows;
  if (!std::getline(file, line) || line != header) return rows;
  while (std::getline(file, line) && std::strtod(line.c_str(), nullptr) <= time)
    rows += line + '\n';
  return rows;
}

std::string file_name_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

}  // namespace

bool PfvSchedule::due(std::int64_t step) {
  const bool first = !last_ || step < *last_;  // reset_timestep may turn the steps back
  const bool due = first ? step % every_ == 0 : step / every_ > *last_ / every_;
  last_ = step;
  return due;
}

PfvResultFiles::PfvResultFiles(const PfvSettings& settings)
    : fields_(settings.fields), profile_(settings.profile) {
  if (fields_) {
    pfv::require_folder_of(fields_->path);
    field_schedule_ = PfvSchedule(fields_->every);
  }
  if (profile_) {
    pfv::require_folder_of(profile_->path);
    profile_schedule_ = PfvSchedule(profile_->every);
  }
}

void PfvResultFiles::resume(std::int64_t step, double time, std::vector<PfvWrittenStep> written) {
  written_ = std::move(written);
  resumed_time_ = time;
  field_schedule_.resume_after(step);
  profile_schedule_.resume_after(step);
}

void PfvResultFiles::write(const pfv::FlowModel& flow, const pfv::Packing& packing,
                           std::int64_t step) {
  if (fields_ && field_schedule_.due(step)) write_fields(flow, packing, step);
  if (profile_ && profile_schedule_.due(step)) write_profile_row(flow);
}

void PfvResultFiles::write_fields(const pfv::FlowModel& flow, const pfv::Packing& packing,
                                  std::int64_t step) {
  const std::string base = fields_->path.substr(0, fields_->path.rfind(".pvd"));
  const auto fluid = [&](const std::string& stem, std::int64_t s) {
    return stem + "_" + flow.field_name() + "_" + std::to_string(s) + ".vtu";
  };
  const auto grains = [](const std::string& stem, std::int64_t s) {
    return stem + "_grains_" + std::to_string(s) + ".vtu";
  };
  flow.write_fields(fluid(base, step));
  pfv::write_spheres(grains(base, step), packing, flow.forces());
  written_.push_back({step, flow.time()});

  std::vector<pfv::CollectionEntry> entries;
  const std::string name = file_name_of(base);
  for (const PfvWrittenStep& one : written_) {
    entries.push_back({one.time, 0, fluid(name, one.step)});
    entries.push_back({one.time, 1, grains(name, one.step)});
  }
  pfv::write_collection(fields_->path, entries);
}

void PfvResultFiles::open_profile() {
  const std::string header = header_of(*profile_);
  const std::string rows =
      resumed_time_ ? rows_until(profile_->path, header, *resumed_time_) : std::string();
  profile_file_.open(profile_->path, std::ios::trunc);
  profile_file_ << header << '\n' << rows << std::setprecision(12);
}

void PfvResultFiles::write_profile_row(const pfv::FlowModel& flow) {
  if (!profile_file_.is_open()) open_profile();
  const pfv::Box& box = flow.box();
  const double lower = box.lower[profile_->axis], upper = box.upper[profile_->axis];
  profile_file_ << flow.time();
  for (int plane = 0; plane < profile_->planes; ++plane) {
    const double place = lower + relative_position(*profile_, plane) * (upper - lower);
    profile_file_ << ',' << flow.plane_pressure(profile_->axis, place);
  }
  profile_file_ << '\n' << std::flush;
  if (!profile_file_)
    throw pfv::FileError("'" + profile_->path + "' cannot be written; is the disk full?");
}

}  // namespace LAMMPS_NS

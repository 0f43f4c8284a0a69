// SPDX-License-Identifier: GPL-3.0-or-later
#include "result_files.h"

#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "pfv/grain_stresses.hpp"
#include "pfv/io.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

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

/// Places with more digits than a file's name would show; they are only read by eye and by scripts.
std::string header_of(const PfvSensorOutput& sensors) {
  std::ostringstream header;
  header << "time" << std::setprecision(6);
  for (const Eigen::Vector3d& place : sensors.places)
    header << ',' << place.x() << ' ' << place.y() << ' ' << place.z();
  return header.str();
}

/// The value of the column `time` in a row.
double time_in(const std::string& row, const std::string& header) {
  const auto columns_before = std::count(header.begin(), header.begin() + header.find("time"), ',');
  std::size_t begin = 0;
  for (int column = 0; column < columns_before; ++column) begin = row.find(',', begin) + 1;
  return std::strtod(row.c_str() + begin, nullptr);
}

/// The rows of a file that an earlier run has written up to `time`, whole ones; none where the file is
/// absent or of another kind.
std::string rows_until(const std::string& path, const std::string& header, double time) {
  std::ifstream file(path);
  std::string line, rows;
  if (!std::getline(file, line) || line != header) return rows;
  while (std::getline(file, line) && !file.eof() && time_in(line, header) <= time)
    rows += line + '\n';
  return rows;
}

/// The time, then the quantity on each plane.
template <class Quantity>
PfvNamedRow plane_row(const pfv::FlowModel& flow, const PfvProfileOutput& profile, const Quantity& quantity) {
  const pfv::Container& box = flow.container();
  const double lower = box.lower[profile.axis], upper = box.upper[profile.axis];
  PfvNamedRow row{header_of(profile), {flow.time()}};
  for (int plane = 0; plane < profile.planes; ++plane)
    row.values.push_back(quantity(lower + relative_position(profile, plane) * (upper - lower)));
  return row;
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

PfvRowFile::PfvRowFile(std::string path, int every, bool is_written)
    : path_(std::move(path)), is_written_(is_written), schedule_(every) {
  if (is_written_) pfv::require_folder_of(path_);
}

void PfvRowFile::resume(std::int64_t step, double time) {
  schedule_.resume_after(step);
  resumed_time_ = time;
}

/// The rows that stay are in the file at each moment, also of a run that is stopped here.
void PfvRowFile::begin(const std::string& header) {
  pfv::write_text(path_, header + '\n' + (resumed_time_ ? rows_until(path_, header, *resumed_time_) : ""));
  file_.open(path_, std::ios::app);
  file_ << std::setprecision(12);
}

void PfvRowFile::write_row(const PfvNamedRow& row) {
  if (!is_written_) return;
  if (!file_.is_open()) begin(row.names);
  const char* separator = "";
  for (const double value : row.values) {
    file_ << separator;
    if (!std::isnan(value)) file_ << value;
    separator = ",";
  }
  file_ << '\n' << std::flush;
  if (!file_) throw pfv::FileError("'" + path_ + "' cannot be written; is the disk full?");
}

namespace {

void refuse_one_file_for_two(const PfvSettings& settings) {
  std::map<std::string, std::string> words;  // by the file that each writes
  const auto take = [&](const char* word, const auto& file) {
    if (!file) return;
    const auto [other, is_new] = words.emplace(std::filesystem::absolute(file->path).lexically_normal(), word);
    if (!is_new) throw pfv::InputError(other->second + " and " + word + " write to one file, '" + file->path + "'; give each its own");
  };
  take("output", settings.fields);
  take("profile", settings.profile);
  take("flux_profile", settings.flux_profile);
  take("sensors", settings.sensors);
  take("history", settings.history);
}

}  // namespace

PfvResultFiles::PfvResultFiles(const PfvSettings& settings, bool are_written)
    : are_written_(are_written), fields_(settings.fields), profile_(settings.profile),
      flux_profile_(settings.flux_profile), sensors_(settings.sensors) {
  refuse_one_file_for_two(settings);
  if (settings.culprits && are_written) pfv::require_folder_of(*settings.culprits);
  if (fields_) {
    if (are_written) pfv::require_folder_of(fields_->path);
    field_schedule_ = PfvSchedule(fields_->every);
  }
  if (profile_) profile_file_.emplace(profile_->path, profile_->every, are_written);
  if (flux_profile_) flux_file_.emplace(flux_profile_->path, flux_profile_->every, are_written);
  if (sensors_) sensor_file_.emplace(sensors_->path, sensors_->every, are_written);
  if (settings.history) history_file_.emplace(settings.history->path, settings.history->every, are_written);
}

void PfvResultFiles::resume(std::int64_t step, double time, std::vector<PfvWrittenStep> written) {
  written_ = std::move(written);
  field_schedule_.resume_after(step);
  for (auto* file : {&profile_file_, &flux_file_, &sensor_file_, &history_file_})
    if (*file) (*file)->resume(step, time);
}

void PfvResultFiles::write(const pfv::FlowModel& flow, const PfvWrittenGrains& grains, std::int64_t step,
                           const PfvFlowRanks& ranks) {
  if (fields_ && field_schedule_.due(step)) write_fields(flow, grains, step, ranks);
  if (profile_file_ && profile_file_->due(step)) profile_file_->write_row(profile_row(flow));
  if (flux_file_ && flux_file_->due(step)) flux_file_->write_row(flux_row(flow));
  if (sensor_file_ && sensor_file_->due(step)) sensor_file_->write_row(sensor_row(flow));
}

namespace {

/// How the files of these steps are called; after a reset_timestep one may come again: 10, then 10_2.
std::vector<std::string> labels_of(const std::vector<PfvWrittenStep>& written) {
  std::map<std::int64_t, int> times;
  std::vector<std::string> labels;
  for (const PfvWrittenStep& one : written) {
    const int time = ++times[one.step];
    labels.push_back(std::to_string(one.step) + (time > 1 ? "_" + std::to_string(time) : ""));
  }
  return labels;
}

std::string file_of(const std::string& stem, const std::string& label, const std::string& what, const char* ending) {
  return stem + "_" + what + "_" + label + ending;
}

/// The file of a step that has been written, as the collection names it: that of one rank, or the head of pieces. A
/// run may have been continued on another number of ranks.
std::string head_of(const std::string& stem, const std::string& label, const std::string& what) {
  const char* ending = std::filesystem::exists(file_of(stem, label, what, ".pvtu")) ? ".pvtu" : ".vtu";
  return file_name_of(file_of(stem, label, what, ending));
}

}  // namespace

void PfvResultFiles::write_fields(const pfv::FlowModel& flow, const PfvWrittenGrains& grains, std::int64_t step,
                                  const PfvFlowRanks& ranks) {
  const pfv::Packing& packing = grains.packing;
  const std::string stem = fields_->path.substr(0, fields_->path.rfind(".pvd")), fluid = flow.field_name();
  written_.push_back({step, flow.time()});
  const std::vector<std::string> labels = labels_of(written_);
  const std::string& label = labels.back();
  const auto write = [&](const std::string& what, const pfv::FieldGrid& grid) {
    const std::string alone = file_of(stem, label, what, ".vtu"), head = file_of(stem, label, what, ".pvtu");
    if (ranks.are_all()) pfv::write_fields(head, grid, *ranks.library());
    else pfv::write_fields(alone, grid);
    if (are_written_) std::filesystem::remove(ranks.are_all() ? alone : head);  // an earlier run's
  };
  write(fluid, flow.fields());
  if (!first_) {
    double last = packing.size() > 0 ? static_cast<double>(packing.ids.maxCoeff()) : 0.0;
    ranks.take_largest(&last, 1);
    first_ = First{flow.container().upper - flow.container().lower, static_cast<std::int64_t>(last)};
  }
  write("grains", pfv::grid_of_spheres(packing, flow.forces(), sphere_fields(flow, grains)));
  const std::vector<pfv::FaceResult>& faces = flow.faces();
  if (!are_written_) return;
  const pfv::FieldGrid walls = pfv::grid_of_walls(flow.container(), faces);
  const std::string of_walls = file_of(stem, label, "walls", ".vtu");
  if (walls.types.empty()) std::filesystem::remove(of_walls);  // an earlier run's
  else pfv::write_fields(of_walls, walls);
  std::vector<pfv::CollectionEntry> entries;
  for (std::size_t k = 0; k < written_.size(); ++k) {
    entries.push_back({written_[k].time, 0, head_of(stem, labels[k], fluid)});
    entries.push_back({written_[k].time, 1, head_of(stem, labels[k], "grains")});
    const std::string drawn = file_of(stem, labels[k], "walls", ".vtu");
    if (std::filesystem::exists(drawn)) entries.push_back({written_[k].time, 2, file_name_of(drawn)});
  }
  pfv::write_collection(fields_->path, entries);
}

PfvSnapshot PfvResultFiles::first_places() const {
  PfvSnapshot places;
  for (const auto& [tag, place] : first_places_) {
    places.tags.push_back(tag);
    places.places.insert(places.places.end(), place.begin(), place.end());
  }
  return places;
}

void PfvResultFiles::set_first_places(const PfvSnapshot& places) {
  first_places_.clear();
  for (std::size_t k = 0; k < places.tags.size(); ++k)
    first_places_[places.tags[k]] = Eigen::Map<const Eigen::Vector3d>(&places.places[3 * k]);
}

/// From where each grain was when it was first written, m.
Eigen::Matrix3Xd PfvResultFiles::displacements(const pfv::Packing& packing, const Eigen::Matrix3Xd& unwrapped) {
  Eigen::Matrix3Xd moved(3, packing.size());
  for (Eigen::Index k = 0; k < packing.size(); ++k) {
    const Eigen::Vector3d place = unwrapped.col(k);
    moved.col(k) = place - first_places_.try_emplace(packing.ids[k], place).first->second;
  }
  return moved;
}

/// For strains; grains that came after the first ones have no place before that would go with theirs.
pfv::Displaced PfvResultFiles::displaced(const pfv::Packing& packing, const Eigen::Matrix3Xd& unwrapped,
                                         const Eigen::Matrix3Xd& displacements) const {
  pfv::Displaced moved{unwrapped, unwrapped - displacements, first_->edges};
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    if (packing.ids[k] > first_->last_tag) moved.before.col(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  return moved;
}

namespace {

/// Of contacts and of motion; 0 for the spheres of obstacles, which stand behind the grains.
void add_stresses(const PfvWrittenGrains& grains, std::vector<pfv::Field>& fields) {
  if (grains.stresses.rows() == 0) return;
  pfv::SphereTensors all = pfv::SphereTensors::Zero(6, grains.packing.size());
  int row = 0;
  for (const char* name : {"contact_stress", "inertial_stress"}) {
    all.leftCols(grains.stresses.cols()) = grains.stresses.middleRows<6>(row);
    for (pfv::Field& field : pfv::stress_fields(name, all)) fields.push_back(std::move(field));
    row += 6;
  }
}

}  // namespace

/// Displacements, stresses where they are asked for, and what the model with pores knows of each sphere.
std::vector<pfv::Field> PfvResultFiles::sphere_fields(const pfv::FlowModel& flow, const PfvWrittenGrains& grains) {
  const Eigen::Matrix3Xd moved = displacements(grains.packing, grains.unwrapped);
  std::vector<pfv::Field> fields{{"displacement", moved}};
  add_stresses(grains, fields);
  const auto* pores = dynamic_cast<const pfv::Flow*>(&flow);
  if (!pores) return fields;
  for (auto& more : {pores->sphere_fields(), pores->strain_fields(displaced(grains.packing, grains.unwrapped, moved))})
    fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

PfvNamedRow PfvResultFiles::profile_row(const pfv::FlowModel& flow) const {
  return plane_row(flow, *profile_, [&](double place) {
    return flow.plane_pressure(profile_->axis, place);
  });
}

/// Only the model with pores comes here.
PfvNamedRow PfvResultFiles::flux_row(const pfv::FlowModel& flow) const {
  const auto& pores = dynamic_cast<const pfv::Flow&>(flow);
  return plane_row(flow, *flux_profile_, [&](double place) {
    return pores.plane_flux(flux_profile_->axis, place);
  });
}

namespace {

/// The place of a container that is nearest to one outside it, or nearly so where two walls meet; along periodic axes
/// the image in the cell.
Eigen::Vector3d moved_inside(const pfv::Container& container, Eigen::Vector3d place) {
  constexpr int rounds = 20;
  for (int round = 0; round < rounds && !container.is_box; ++round)
    for (const pfv::ContainerFace& face : container.faces)
      if (const double distance = face.surface.distance(place); distance < 0.0)
        place += distance * face.surface.outward_at(place);
  for (int axis = 0; axis < 3; ++axis) {
    if (!container.periodic[axis]) continue;
    const double length = container.upper[axis] - container.lower[axis];
    place[axis] -= length * std::floor((place[axis] - container.lower[axis]) / length);
  }
  return place.cwiseMax(container.lower).cwiseMin(container.upper);
}

}  // namespace

/// A sensor outside the flow box, which may shrink below it, reads the pressure of the nearest place.
PfvNamedRow PfvResultFiles::sensor_row(const pfv::FlowModel& flow) const {
  const pfv::Container& box = flow.container();
  PfvNamedRow row{header_of(*sensors_), {flow.time()}};
  for (const Eigen::Vector3d& place : sensors_->places)
    row.values.push_back(flow.pressure_at(moved_inside(box, place)));
  return row;
}

}  // namespace LAMMPS_NS

// SPDX-License-Identifier: GPL-3.0-or-later
#include "restart_record.h"

#include "pfv/error.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace LAMMPS_NS {

namespace {

constexpr double format_number = 11.0;
constexpr double without_service = 10.0;
constexpr double without_meshes = 9.0;
constexpr double without_fingerprint = 8.0;
constexpr double without_obstacles = 7.0;
constexpr double without_counts = 6.0;      // of steps and solves
constexpr double without_cell_rates = 5.0;  // nor these: of a periodic cell

class Reader {
 public:
  explicit Reader(const char* bytes) : bytes_(bytes) {}

  double next() {
    double value;
    std::memcpy(&value, bytes_, sizeof value);  // LIGGGHTS does not promise alignment
    bytes_ += sizeof value;
    return value;
  }

  template <typename T>
  std::vector<T> list(std::size_t entries) {
    std::vector<T> values(entries);
    for (T& value : values) value = static_cast<T>(next());
    return values;
  }
  std::size_t count() { return static_cast<std::size_t>(next()); }

 private:
  const char* bytes_;
};

/// A double holds no more than 53 bits: whether it is known, and twice 32 of them.
std::array<double, 3> halves(const std::optional<std::uint64_t>& left) {
  if (!left) return {};
  return {1.0, static_cast<double>(*left >> 32), static_cast<double>(*left & 0xffffffffu)};
}

std::optional<std::uint64_t> joined(const std::vector<double>& halves) {
  if (halves[0] == 0.0) return {};
  return static_cast<std::uint64_t>(halves[1]) << 32 | static_cast<std::uint64_t>(halves[2]);
}

PfvRestartRecord::Meshes meshes_of(Reader& reader) {
  PfvRestartRecord::Meshes meshes;
  for (auto* list : {&meshes.last_pivots, &meshes.motions_of_faces, &meshes.motions_of_obstacles})
    *list = reader.list<double>(reader.count());
  return meshes;
}

/// What came last into the record, as far as the form `found` has it.
void read_newest(Reader& reader, double found, PfvRestartRecord& record) {
  if (found >= without_meshes) record.left = joined(reader.list<double>(3));
  if (found >= without_service) record.meshes = meshes_of(reader);
  if (found == format_number) record.flow.served_by_last_network = reader.next();
}

}  // namespace

std::vector<double> pack(const PfvRestartRecord& record) {
  std::vector<double> data{format_number,
                           static_cast<double>(record.step),
                           record.flow.time,
                           record.flow.strain,
                           static_cast<double>(record.flow.retriangulations),
                           static_cast<double>(record.steps_since_flow),
                           record.elapsed};
  const auto append = [&data](const auto& values) {
    data.insert(data.end(), values.begin(), values.end());
  };
  data.push_back(static_cast<double>(record.last_positions.size()));
  append(record.last_positions);
  append(record.cell_rates);
  append(std::array<double, 3>{record.flow.volume_debt, record.flow.fluid_at_start,
                               record.flow.fluid_came_in});
  data.push_back(static_cast<double>(record.flow.pore_pressures.size()));
  append(record.flow.pore_pressures);
  data.push_back(static_cast<double>(record.last_grains.tags.size()));
  append(record.last_grains.tags);
  append(record.last_grains.places);
  data.push_back(static_cast<double>(record.written.size()));
  for (const PfvWrittenStep& one : record.written) {
    data.push_back(static_cast<double>(one.step));
    data.push_back(one.time);
  }
  append(std::array<std::int64_t, 2>{record.taken.steps, record.taken.solves});
  data.push_back(static_cast<double>(record.obstacles.size()));
  append(record.obstacles);
  append(halves(record.left));
  const PfvRestartRecord::Meshes meshes = record.meshes.value_or(PfvRestartRecord::Meshes());
  for (const auto* list : {&meshes.last_pivots, &meshes.motions_of_faces, &meshes.motions_of_obstacles}) {
    data.push_back(static_cast<double>(list->size()));
    append(*list);
  }
  data.push_back(record.flow.served_by_last_network);
  return data;
}

PfvRestartRecord unpack(const char* bytes) {
  Reader reader(bytes);
  const double found = reader.next();
  if (found != std::floor(found) || found < without_cell_rates || found > format_number)
    throw pfv::InputError("the restart file holds this fix in form " +
                          std::to_string(static_cast<int>(found)) + " of another version, this one reads the "
                          "forms " + std::to_string(static_cast<int>(without_cell_rates)) + " to " +
                          std::to_string(static_cast<int>(format_number)) +
                          "; give the fix another ID to start the flow anew");
  PfvRestartRecord record;
  record.step = static_cast<std::int64_t>(reader.next());
  record.flow.time = reader.next();
  record.flow.strain = reader.next();
  record.flow.retriangulations = static_cast<std::int64_t>(reader.next());
  record.steps_since_flow = static_cast<int>(reader.next());
  record.elapsed = reader.next();
  record.last_positions = reader.list<double>(reader.count());
  if (found != without_cell_rates)
    for (double& rate : record.cell_rates) rate = reader.next();
  record.flow.volume_debt = reader.next();
  record.flow.fluid_at_start = reader.next();
  record.flow.fluid_came_in = reader.next();
  record.flow.pore_pressures = reader.list<double>(reader.count());
  const std::size_t grains = reader.count();
  record.last_grains.tags = reader.list<std::int64_t>(grains);
  record.last_grains.places = reader.list<double>(3 * grains);
  record.written.resize(reader.count());
  for (PfvWrittenStep& one : record.written) {
    one.step = static_cast<std::int64_t>(reader.next());
    one.time = reader.next();
  }
  if (found >= without_obstacles) {
    record.taken.steps = static_cast<std::int64_t>(reader.next());
    record.taken.solves = static_cast<std::int64_t>(reader.next());
  }
  if (found >= without_fingerprint) record.obstacles = reader.list<double>(reader.count());
  read_newest(reader, found, record);
  return record;
}

}  // namespace LAMMPS_NS

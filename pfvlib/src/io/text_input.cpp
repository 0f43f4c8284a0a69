// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/number_text.hpp"
#include "text/text_lines.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

namespace pfv {
namespace {

using detail::quoted;
using detail::TextLines;
using Words = std::vector<std::string_view>;

enum Column { id, x, y, z, radius, vx, vy, vz, omegax, omegay, omegaz, column_count };
constexpr std::array<const char*, column_count> column_names{
    "id", "x", "y", "z", "radius", "vx", "vy", "vz", "omegax", "omegay", "omegaz"};

/// Where in a line each column stands.
struct Columns {
  std::array<int, column_count> place;
  std::size_t fields = 0;
  bool velocities() const { return place[vx] >= 0; }
  bool spins() const { return place[omegax] >= 0; }
  /// Those that are read.
  bool read(int column) const {
    return column < vx || (column < omegax ? velocities() : spins());
  }
};

Columns find_columns(const TextLines& lines, const Words& names) {
  Columns columns;
  columns.place.fill(-1);
  columns.fields = names.size();
  for (std::size_t field = 0; field < names.size(); ++field)
    for (int column = 0; column < column_count; ++column)
      if (names[field] == column_names[column]) {
        if (columns.place[column] >= 0)
          lines.fail(std::string("column ") + column_names[column] +
                     " is named twice: keep one of them");
        columns.place[column] = static_cast<int>(field);
      }
  // velocities and spins come all three or not at all
  const auto any_of = [&](int first) {
    return std::any_of(columns.place.begin() + first, columns.place.begin() + first + 3,
                       [](int place) { return place >= 0; });
  };
  const bool moving = any_of(vx), spinning = any_of(omegax);
  for (int column = 0; column < column_count; ++column)
    if (columns.place[column] < 0 &&
        (column < vx || (column < omegax ? moving : spinning)))
      lines.fail(std::string("column ") + column_names[column] +
                 " is missing: the columns id, x, y, z, radius (and vx, vy, vz together, or "
                 "omegax, omegay, omegaz) must be named here, not " + quoted(lines.line()));
  return columns;
}

/// Spheres as they are read, one by one.
class SphereTable {
 public:
  explicit SphereTable(Columns columns) : columns_(columns) {}

  void reserve(std::size_t spheres) {
    ids_.reserve(spheres);
    line_numbers_.reserve(spheres);
    values_.reserve(spheres * values_a_sphere());
  }

  void add(const TextLines& lines, const Words& fields) {
    if (fields.size() != columns_.fields)
      lines.fail("has " + std::to_string(fields.size()) + " fields instead of " +
                 std::to_string(columns_.fields) + ": give one for each column");
    const std::string_view text = fields[columns_.place[id]];
    const auto number = detail::integer(text);
    if (!number) lines.fail("id is " + quoted(text) + ": give a whole number");
    ids_.push_back(*number);
    line_numbers_.push_back(lines.number());
    for (int column = x; column < column_count; ++column)
      if (columns_.read(column)) values_.push_back(value(lines, fields, column));
  }

  PackingArrays arrays(const std::string& path) const {
    if (ids_.empty())
      throw InputError(path + ": holds no spheres: give at least one line below the header");
    refuse_equal_ids(path);
    const auto n = static_cast<Eigen::Index>(ids_.size());
    const auto rows = static_cast<Eigen::Index>(values_a_sphere());
    const Eigen::Map<const Eigen::MatrixXd> values(values_.data(), rows, n);
    PackingArrays packing;
    packing.ids = Eigen::Map<const Packing::Ids>(ids_.data(), n);
    packing.positions = values.topRows<3>();
    packing.radii = values.row(3).transpose();
    if (columns_.velocities()) packing.velocities = values.middleRows<3>(4);
    if (columns_.spins()) packing.angular_velocities = values.bottomRows<3>();
    return packing;
  }

 private:
  std::size_t values_a_sphere() const {
    return 4 + 3 * columns_.velocities() + 3 * columns_.spins();
  }

  double value(const TextLines& lines, const Words& fields, int column) const {
    const std::string_view text = fields[columns_.place[column]];
    const auto number = detail::finite_number(text);
    if (!number)
      lines.fail(std::string(column_names[column]) + " is " + quoted(text) +
                 ": give a finite number");
    if (column == radius && *number <= 0)
      lines.fail("radius is " + quoted(text) + ": give a number > 0");
    return *number;
  }

  void refuse_equal_ids(const std::string& path) const {
    std::vector<std::pair<std::int64_t, std::size_t>> order(ids_.size());
    for (std::size_t k = 0; k < ids_.size(); ++k) order[k] = {ids_[k], line_numbers_[k]};
    std::sort(order.begin(), order.end());
    const auto twin = std::adjacent_find(order.begin(), order.end(), [](auto& a, auto& b) {
      return a.first == b.first;
    });
    if (twin != order.end())
      throw InputError(path + ":" + std::to_string((twin + 1)->second) + ": id " +
                       std::to_string(twin->first) + " stands in line " +
                       std::to_string(twin->second) + " too: give each sphere its own");
  }

  Columns columns_;
  std::vector<std::int64_t> ids_;
  std::vector<std::size_t> line_numbers_;
  std::vector<double> values_;  // those read, of one sphere after the other
};

std::string whole_file(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  const auto fail = [&](int error) {
    throw InputError("cannot read packing " + quoted(path) + ": " + std::strerror(error) +
                     ": give a CSV file or a LIGGGHTS dump");
  };
  if (!file) fail(errno);
  std::string text;
  std::size_t used = 0;
  do {
    text.resize(std::max<std::size_t>(2 * used, 1 << 16));
    used += std::fread(&text[used], 1, text.size() - used, file.get());
    if (std::ferror(file.get())) fail(errno);
  } while (!std::feof(file.get()));
  text.resize(used);
  return text;
}

PackingArrays read_csv(const std::string& path, std::string_view text) {
  TextLines lines(path, text);
  if (!lines.next_filled())
    throw InputError(path + ": is empty: give a header id,x,y,z,radius and one line a sphere");
  Words fields;
  detail::split(lines.line(), ',', fields);
  SphereTable table(find_columns(lines, fields));
  table.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
  while (lines.next_filled()) {
    detail::split(lines.line(), ',', fields);
    table.add(lines, fields);
  }
  return table.arrays(path);
}

constexpr std::string_view item = "ITEM:";
constexpr std::string_view snapshot_start = "ITEM: TIMESTEP";

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

[[noreturn]] void fail_cut_off(const TextLines& lines, const std::string& what) {
  lines.fail("the last snapshot is cut off " + what +
             ": remove it, or write the dump to its end");
}

std::int64_t read_number_of_atoms(TextLines& lines) {
  if (!lines.next()) fail_cut_off(lines, "before its number of atoms");
  const auto number = detail::integer(lines.line());
  if (!number || *number < 0)
    lines.fail("number of atoms is " + quoted(lines.line()) + ": give a whole number >= 0");
  return *number;
}

SphereTable read_atoms(TextLines& lines, std::int64_t atoms, std::size_t characters) {
  constexpr std::string_view heading = "ITEM: ATOMS";
  Words fields;
  detail::split_words(lines.line().substr(heading.size()), fields);
  SphereTable table(find_columns(lines, fields));
  // A garbled number of atoms must not ask for more memory than the file can fill.
  table.reserve(std::min(static_cast<std::size_t>(atoms), characters / 10));
  for (std::int64_t atom = 0; atom < atoms; ++atom) {
    if (!lines.next() || lines.line().empty())
      fail_cut_off(lines, "after " + std::to_string(atom) + " of " + std::to_string(atoms) +
                              " atoms");
    detail::split_words(lines.line(), fields);
    table.add(lines, fields);
  }
  return table;
}

PackingArrays read_dump(const std::string& path, std::string_view text) {
  const std::size_t start = text.rfind(snapshot_start);
  const auto lines_before =
      static_cast<std::size_t>(std::count(text.begin(), text.begin() + start, '\n'));
  const std::string_view snapshot = text.substr(start);
  TextLines lines(path, snapshot, lines_before);
  std::int64_t atoms = -1;
  while (lines.next()) {
    if (starts_with(lines.line(), "ITEM: NUMBER OF ATOMS")) atoms = read_number_of_atoms(lines);
    if (!starts_with(lines.line(), "ITEM: ATOMS")) continue;
    if (atoms < 0) lines.fail("no ITEM: NUMBER OF ATOMS before this line: write the dump anew");
    const SphereTable table = read_atoms(lines, atoms, snapshot.size());
    if (lines.next_filled()) {
      if (starts_with(item, lines.line()) || starts_with(lines.line(), item))
        fail_cut_off(lines, "in its first line");
      lines.fail("more lines than the " + std::to_string(atoms) +
                 " atoms that the snapshot names: write the dump anew");
    }
    return table.arrays(path);
  }
  fail_cut_off(lines, "before its ITEM: ATOMS");
}

}  // namespace

PackingArrays read_packing(const std::string& path) {
  const std::string content = whole_file(path);
  std::string_view text = content;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (starts_with(text, byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool dump = first != std::string_view::npos &&
                    starts_with(text.substr(first), snapshot_start);
  return dump ? read_dump(path, text) : read_csv(path, text);
}

}  // namespace pfv

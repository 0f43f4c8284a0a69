// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres as columns of a file: which column is what, and their values line by line.
#pragma once

#include "parallel/ranks.hpp"
#include "pfv/packing.hpp"
#include "text/text_lines.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pfv::detail {

using Words = std::vector<std::string_view>;

enum Column { id, x, y, z, radius, vx, vy, vz, omegax, omegay, omegaz, column_count };

/// How a file gives places.
enum class Places {
  plain,
  scaled,             ///< parts of the room's edges
  unwrapped,          ///< beyond a periodic room, where a sphere has crossed it
  scaled_unwrapped
};

/// Where in a line each column stands; -1: nowhere.
struct Columns {
  std::array<int, column_count> place;
  std::size_t fields = 0;
  bool diameters = false;  ///< in place of radii
  int diameter = -1;       ///< where they stand beside radii, which they must agree with
  Places places = Places::plain;

  bool ids() const { return place[id] >= 0; }
  bool velocities() const { return place[vx] >= 0; }
  bool spins() const { return place[omegax] >= 0; }
  /// Those that are read beside the id.
  bool read(int column) const { return column < vx || (column < omegax ? velocities() : spins()); }
};

/// Who names the columns.
enum class Naming {
  free,
  dump  ///< a dump's v_NAME is a variable of the script
};

/// The columns that these names stand for. Throws InputError for the line that `lines` is at, where one is missing
/// or named twice.
Columns find_columns(const TextLines& lines, const Words& names, Naming naming = Naming::free);

/// Without quotes and with `[m]` or `(m)` at its end cut off, in small letters.
std::string plain_name(std::string_view name);

/// The unit in brackets at the end of a name, or nothing.
std::string_view unit_in(std::string_view name);

/// Spheres as they are read, one by one.
class SphereTable {
 public:
  explicit SphereTable(Columns columns) : columns_(columns) {}

  void reserve(std::size_t spheres);
  void add(const TextLines& lines, const Words& fields);
  bool has_ids() const { return columns_.ids(); }
  /// Throws InputError where no rank has any, and for an id that comes twice. Without ids the spheres of all ranks are
  /// numbered from 1. Collective.
  PackingArrays arrays(const std::string& path, const Ranks& ranks) const;

 private:
  std::size_t values_a_sphere() const { return 4 + 3 * columns_.velocities() + 3 * columns_.spins(); }
  double value(const TextLines& lines, const Words& fields, int column) const;
  void require_equal_sizes(const TextLines& lines, const Words& fields) const;

  Columns columns_;
  std::vector<std::int64_t> ids_;
  std::vector<std::size_t> line_numbers_;
  std::vector<double> values_;  // those read, of one sphere after the other
};

/// Throws InputError where two spheres, of whatever ranks, have one id; `lines`: where in the file each stands, or empty.
/// Collective.
void refuse_equal_ids(const std::string& path, const std::vector<std::int64_t>& ids,
                      const std::vector<std::size_t>& lines, const Ranks& ranks);

}  // namespace pfv::detail

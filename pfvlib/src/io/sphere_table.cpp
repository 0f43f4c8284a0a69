// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sphere_table.hpp"

#include "distributed/even_rows.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <utility>

namespace pfv::detail {
namespace {

constexpr std::array<const char*, column_count> column_names{
    "id", "x", "y", "z", "radius", "vx", "vy", "vz", "omegax", "omegay", "omegaz"};

/// Other names of a column, from the most to the least usual: of LIGGGHTS, YADE, ParaView's tables, notebooks.
std::vector<std::string> other_names(int column) {
  const auto of_vector = [&](std::initializer_list<const char*> stems) {
    std::vector<std::string> names;
    const int axis = column < vx ? column - x : (column - vx) % 3;
    for (const std::string stem : stems)
      for (const char* link : {"", "_", ":"})
        for (const std::string& component : {std::string(1, "xyz"[axis]), std::to_string(axis)})
          if (*link || component[0] > '9') names.push_back(stem + link + component);
    return names;
  };
  if (column == id) return {"tag", "particle_id", "particleid", "particle id", "atom_id"};
  if (column == radius) return {"r", "rad", "radii"};
  if (column < radius) return of_vector({"pos", "position", "points", "center", "centre", "p"});
  if (column < omegax) return of_vector({"v", "vel", "velocity", "linvel"});
  return of_vector({"omega", "w", "angvel", "angular_velocity"});
}

int place_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Places under the names of a dump's other kinds of coordinates.
void find_other_places(Columns& columns, const std::vector<std::string>& names) {
  struct Kind {
    const char* ending;
    Places places;
  };
  for (const Kind kind : {Kind{"s", Places::scaled}, {"u", Places::unwrapped}, {"su", Places::scaled_unwrapped}}) {
    std::array<int, 3> found{};
    for (int axis = 0; axis < 3; ++axis) found[axis] = place_of(names, std::string(1, "xyz"[axis]) + kind.ending);
    if (found[0] < 0 || found[1] < 0 || found[2] < 0) continue;
    std::copy(found.begin(), found.end(), columns.place.begin() + x);
    columns.places = kind.places;
    return;
  }
}

/// After the radii under any name.
void find_diameters(Columns& columns, const std::vector<std::string>& names) {
  for (const char* name : {"diameter", "d", "diam"})
    if (columns.diameter < 0) columns.diameter = place_of(names, name);
  if (columns.place[radius] >= 0 || columns.diameter < 0) return;
  std::swap(columns.place[radius], columns.diameter);
  columns.diameters = true;
}

void require_all(const TextLines& lines, const Columns& columns) {
  // velocities and spins come all three or not at all
  const auto any_of = [&](int first) {
    return std::any_of(columns.place.begin() + first, columns.place.begin() + first + 3,
                       [](int place) { return place >= 0; });
  };
  const bool moving = any_of(vx), spinning = any_of(omegax);
  for (int column = x; column < column_count; ++column)
    if (columns.place[column] < 0 && (column < vx || (column < omegax ? moving : spinning)))
      lines.fail(std::string("column ") + column_names[column] +
                 " is missing: the columns id, x, y, z, radius (and vx, vy, vz together, or "
                 "omegax, omegay, omegaz) must be named here, not " + detail::quoted(lines.line()));
}

}  // namespace

std::string_view unit_in(std::string_view name) {
  while (!name.empty() && (name.back() == '"' || name.back() == '\'')) name.remove_suffix(1);
  if (name.empty() || (name.back() != ']' && name.back() != ')')) return {};
  const std::size_t begin = name.find_last_of(name.back() == ']' ? '[' : '(');
  if (begin == std::string_view::npos || begin == 0) return {};
  return trimmed(name.substr(begin + 1, name.size() - begin - 2));
}

std::string plain_name(std::string_view name) {
  name = trimmed(name);
  if (name.size() > 1 && (name.front() == '"' || name.front() == '\'') && name.back() == name.front())
    name = trimmed(name.substr(1, name.size() - 2));
  if (!unit_in(name).empty()) name = trimmed(name.substr(0, name.find_last_of("[(")));
  std::string plain(name);
  for (char& c : plain) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return plain;
}

Columns find_columns(const TextLines& lines, const Words& names, Naming naming) {
  Columns columns;
  columns.place.fill(-1);
  columns.fields = names.size();
  std::vector<std::string> plain;
  for (const std::string_view name : names) plain.push_back(plain_name(name));
  for (int column = 0; column < column_count; ++column) {
    columns.place[column] = place_of(plain, column_names[column]);
    if (std::count(plain.begin(), plain.end(), column_names[column]) > 1)
      lines.fail(std::string("column ") + column_names[column] + " is named twice: keep one of them");
  }
  if (columns.place[x] < 0 && columns.place[y] < 0 && columns.place[z] < 0) find_other_places(columns, plain);
  for (int column = 0; column < column_count; ++column)
    for (const std::string& name : other_names(column))
      if (columns.place[column] < 0 && !(naming == Naming::dump && name.rfind("v_", 0) == 0))
        columns.place[column] = place_of(plain, name);
  find_diameters(columns, plain);
  require_all(lines, columns);
  return columns;
}

void SphereTable::reserve(std::size_t spheres) {
  ids_.reserve(spheres);
  line_numbers_.reserve(spheres);
  values_.reserve(spheres * values_a_sphere());
}

void SphereTable::add(const TextLines& lines, const Words& fields) {
  if (fields.size() < columns_.fields && !lines.ended())
    lines.fail("the file is cut off inside this line, after " + std::to_string(fields.size()) + " of " +
               std::to_string(columns_.fields) + " fields");
  if (fields.size() != columns_.fields)
    lines.fail("has " + std::to_string(fields.size()) + " fields instead of " +
               std::to_string(columns_.fields) + ": give one for each column");
  std::int64_t number = 0;
  if (columns_.ids()) {
    const std::string_view text = fields[columns_.place[id]];
    const auto given = integer(text);
    if (!given) lines.fail("id is " + detail::quoted(text) + ": give a whole number");
    number = *given;
  }
  ids_.push_back(number);
  line_numbers_.push_back(lines.number());
  for (int column = x; column < column_count; ++column)
    if (columns_.read(column)) values_.push_back(value(lines, fields, column));
  if (columns_.diameter >= 0) require_equal_sizes(lines, fields);
}

/// To the few digits that files are written with.
void SphereTable::require_equal_sizes(const TextLines& lines, const Words& fields) const {
  constexpr double few_digits = 1e-3;
  const std::string_view text = fields[columns_.diameter];
  const double own_radius = value(lines, fields, radius);
  const auto diameter = finite_number(text);
  if (diameter && std::abs(*diameter - 2.0 * own_radius) <= few_digits * 2.0 * own_radius) return;
  lines.fail("radius is " + detail::quoted(fields[columns_.place[radius]]) + " and diameter is " + detail::quoted(text) +
             ": keep the column that is meant, or name the other differently");
}

namespace {

/// Of spheres of which each rank has so many, those of rank 0 first.
Packing::Ids numbers_from_one(Eigen::Index own, const Ranks& ranks) {
  Packing::Ids ids(own);
  std::iota(ids.begin(), ids.end(), rows_before(own, ranks) + 1);
  return ids;
}

}  // namespace

PackingArrays SphereTable::arrays(const std::string& path, const Ranks& ranks) const {
  const bool any = ranks.any(!ids_.empty());
  ranks.together([&] {
    if (!any) throw InputError(path + ": holds no spheres: give at least one line below the header");
  });
  if (has_ids()) refuse_equal_ids(path, ids_, line_numbers_, ranks);
  const auto n = static_cast<Eigen::Index>(ids_.size());
  const auto rows = static_cast<Eigen::Index>(values_a_sphere());
  const Eigen::Map<const Eigen::MatrixXd> values(values_.data(), rows, n);
  PackingArrays packing;
  packing.ids = has_ids() ? Packing::Ids(Eigen::Map<const Packing::Ids>(ids_.data(), n)) : numbers_from_one(n, ranks);
  packing.positions = values.topRows<3>();
  packing.radii = values.row(3).transpose();
  if (columns_.velocities()) packing.velocities = values.middleRows<3>(4);
  if (columns_.spins()) packing.angular_velocities = values.bottomRows<3>();
  return packing;
}

double SphereTable::value(const TextLines& lines, const Words& fields, int column) const {
  const std::string_view text = fields[columns_.place[column]];
  const std::string name = column == radius && columns_.diameters ? "diameter" : column_names[column];
  const auto number = finite_number(text);
  if (!number && text.find(',') != std::string_view::npos)
    lines.fail(name + " is " + detail::quoted(text) + ": a number with a comma; write a decimal point");
  if (!number) lines.fail(name + " is " + detail::quoted(text) + ": give a finite number");
  if (column == radius && *number <= 0) lines.fail(name + " is " + detail::quoted(text) + ": give a number > 0");
  return column == radius && columns_.diameters ? 0.5 * *number : *number;
}

namespace {

/// An id and its place in the file.
struct PlacedId {
  std::int64_t id;
  std::size_t place;
  bool operator<(const PlacedId& other) const { return id != other.id ? id < other.id : place < other.place; }
};

/// Sorted; on several ranks each rank has all of an id that any has read, and about as many ids as the others.
std::vector<PlacedId> sorted(const std::vector<std::int64_t>& ids, const std::vector<std::size_t>& lines,
                             const Ranks& ranks) {
  std::vector<PlacedId> order;
  const auto placed = [&](std::size_t k) { return PlacedId{ids[k], lines.empty() ? k : lines[k]}; };
  if (ranks.count() == 1) {
    order.resize(ids.size());
    for (std::size_t k = 0; k < ids.size(); ++k) order[k] = placed(k);
  } else {
    std::vector<Ranks::Bytes> to(ranks.count());
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const PlacedId one = placed(k);
      append(to[static_cast<std::uint64_t>(one.id) % to.size()], &one, 1);
    }
    to = ranks.hand_over(to);
    for (const Ranks::Bytes& bytes : to) {
      const std::vector<PlacedId> part = values_in<PlacedId>(bytes);
      order.insert(order.end(), part.begin(), part.end());
    }
  }
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace

void refuse_equal_ids(const std::string& path, const std::vector<std::int64_t>& ids,
                      const std::vector<std::size_t>& lines, const Ranks& ranks) {
  const std::vector<PlacedId> order = sorted(ids, lines, ranks);
  const auto twin = std::adjacent_find(order.begin(), order.end(), [](auto& a, auto& b) { return a.id == b.id; });
  Ranks::Bytes bytes;
  if (twin != order.end()) append(bytes, &*twin, 2);
  std::vector<std::array<PlacedId, 2>> twins;
  for (const Ranks::Bytes& found : ranks.gather(bytes))
    for (const auto& two : values_in<std::array<PlacedId, 2>>(found)) twins.push_back(two);
  ranks.together([&] {
    if (twins.empty()) return;
    const auto [first, second] = *std::min_element(twins.begin(), twins.end());
    const std::string number = std::to_string(first.id);
    if (lines.empty()) throw InputError(path + ": id " + number + " comes twice: give each sphere its own");
    throw InputError(path + ":" + std::to_string(second.place) + ": id " + number + " stands in line " +
                     std::to_string(first.place) + " too: give each sphere its own");
  });
}

}  // namespace pfv::detail

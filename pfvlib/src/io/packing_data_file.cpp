// SPDX-License-Identifier: GPL-3.0-or-later
// LIGGGHTS' and LAMMPS' data files, as write_data writes them and read_data reads them.
#include "io/packing_formats.hpp"
#include "io/sphere_table.hpp"
#include "parallel/one_rank.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <map>
#include <optional>

namespace pfv::detail {
namespace {

/// The part before a comment.
std::string_view without_comment(std::string_view line) { return trimmed(line.substr(0, line.find('#'))); }

bool is_section(const Words& words) {
  return !words.empty() && words[0].front() >= 'A' && words[0].front() <= 'Z' && words.size() <= 3;
}

struct Header {
  std::int64_t atoms = -1;
  PackingBounds bounds{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {}};
  bool tilted = false;
  std::string style;  ///< of `Atoms # style`, or empty
};

void read_bounds(const TextLines& lines, const Words& words, Header& header) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string lower = {"xyz"[axis], 'l', 'o'};
    if (words.size() < 4 || words[2] != lower) continue;
    const auto low = finite_number(words[0]), high = finite_number(words[1]);
    if (!low || !high) lines.fail("bounds are " + detail::quoted(lines.line()) + ": give two numbers");
    header.bounds.lower[axis] = *low;
    header.bounds.upper[axis] = *high;
  }
}

/// Up to the line `Atoms`.
Header read_header(TextLines& lines) {
  Header header;
  lines.next();  // a comment, whatever it says
  Words words;
  while (lines.next()) {
    const std::string_view line = without_comment(lines.line());
    split_words(line, words);
    if (words.size() == 2 && words[1] == "atoms") {
      const auto atoms = integer(words[0]);
      if (!atoms || *atoms < 0) lines.fail("number of atoms is " + detail::quoted(words[0]) + ": give a whole number >= 0");
      header.atoms = *atoms;
    }
    read_bounds(lines, words, header);
    if (words.size() == 6 && words[3] == "xy") header.tilted = words[0] != "0" || words[1] != "0" || words[2] != "0";
    if (!is_section(words) || words[0] != "Atoms") continue;
    if (const std::size_t mark = lines.line().find('#'); mark != std::string_view::npos)
      header.style = std::string(trimmed(lines.line().substr(mark + 1)));
    return header;
  }
  lines.fail("there is no section Atoms: give a data file with spheres");
}

/// id type diameter density x y z [three image numbers]
Columns granular_columns(const TextLines& lines, const Header& header, std::size_t fields) {
  if (!header.style.empty() && header.style != "granular" && header.style != "sphere")
    lines.fail("its atoms are of style " + detail::quoted(header.style) + ", which has no radii in this file: use granular or sphere");
  if (fields != 7 && fields != 10)
    lines.fail("has " + std::to_string(fields) + " fields; atoms of style granular have id, type, diameter, density, "
               "x, y, z and perhaps three image numbers");
  Columns columns;
  columns.place.fill(-1);
  columns.fields = fields;
  columns.place[id] = 0;
  columns.place[radius] = 2;
  columns.diameters = true;
  for (int axis = 0; axis < 3; ++axis) columns.place[x + axis] = 4 + axis;
  return columns;
}

/// The lines of a section, which an empty line ends: rows(words) for each.
template <class Row>
void for_each_row(TextLines& lines, std::int64_t count, const char* section, Row row) {
  Words words;
  for (std::int64_t k = 0; k < count; ++k) {
    if (!lines.next_filled())
      lines.fail("the section " + std::string(section) + " is cut off after " + std::to_string(k) + " of " +
                 std::to_string(count) + " atoms: write the file anew");
    split_words(without_comment(lines.line()), words);
    row(words);
  }
}

void read_velocities(TextLines& lines, PackingArrays& packing) {
  std::map<std::int64_t, Eigen::Index> place;
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) place[packing.ids[k]] = k;
  packing.velocities.setZero(3, packing.ids.size());
  packing.angular_velocities.setZero(3, packing.ids.size());
  for_each_row(lines, packing.ids.size(), "Velocities", [&](const Words& words) {
    const auto number = words.empty() ? std::nullopt : integer(words[0]);
    const auto found = number ? place.find(*number) : place.end();
    if (words.size() != 7 || found == place.end())
      lines.fail("give the id of an atom and six numbers: velocity and angular velocity");
    for (int k = 0; k < 6; ++k) {
      const auto value = finite_number(words[1 + k]);
      if (!value) lines.fail("a velocity is " + detail::quoted(words[1 + k]) + ": give a finite number");
      (k < 3 ? packing.velocities(k, found->second) : packing.angular_velocities(k - 3, found->second)) = *value;
    }
  });
}

}  // namespace

PackingFile read_data_file(const std::string& path, std::string_view text) {
  TextLines lines(path, text);
  const Header header = read_header(lines);
  if (header.atoms < 0) lines.fail("no line `N atoms` before the section Atoms");
  if (header.atoms == 0) throw InputError(path + ": holds no spheres");
  std::optional<SphereTable> table;
  for_each_row(lines, header.atoms, "Atoms", [&](const Words& words) {
    if (!table) table.emplace(granular_columns(lines, header, words.size()));
    table->add(lines, words);
  });
  PackingFile file;
  file.packing = table->arrays(path, ranks_or_one(nullptr));
  const bool has_room = (header.bounds.upper.array() > header.bounds.lower.array()).all();
  // a tilted box whose periodic sides are not known is no room
  if (has_room && !header.tilted) file.bounds = header.bounds;
  while (lines.next_filled())
    if (starts_with(lines.line(), "Velocities")) read_velocities(lines, file.packing);
  if (text.back() != '\n') lines.fail("the file ends inside this line: its last number may be cut off");
  return file;
}

}  // namespace pfv::detail

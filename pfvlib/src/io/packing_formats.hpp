// SPDX-License-Identifier: GPL-3.0-or-later
// The formats in which people have spheres; `read_packing_file` finds out which one a file is.
#pragma once

#include "io/text_source.hpp"
#include "parallel/ranks.hpp"
#include "pfv/packing_file.hpp"

#include <string>
#include <string_view>

namespace pfv::detail {

inline bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

/// What a unit of length is in m; nothing for one that is not known, as that of a density.
std::optional<double> named_length_unit(std::string_view unit);

// Each throws InputError naming line and field.

// One sphere a line: each rank reads its share of the lines. Collective.
PackingFile read_table(TextSource& source, double length_unit, const Ranks& ranks);
PackingFile read_dump(TextSource& source, const PackingChoice& choice, const Ranks& ranks);

// What belongs to a sphere stands in several places: one rank reads all of the text.
PackingFile read_data_file(const std::string& path, std::string_view text);
PackingFile read_legacy_vtk(const std::string& path, std::string_view text);
PackingFile read_xml_vtk(const std::string& path, std::string_view text);

}  // namespace pfv::detail

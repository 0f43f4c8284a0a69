// SPDX-License-Identifier: GPL-3.0-or-later
// The formats in which people have spheres; `read_packing_file` finds out which one a file is.
#pragma once

#include "pfv/packing_file.hpp"

#include <string>
#include <string_view>

namespace pfv::detail {

/// What a file holds, unpacked if it is packed with gzip. Throws InputError where it cannot be read.
std::string whole_file(const std::string& path);

inline bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

// Each takes the file's text, and throws InputError naming line and field.
/// What a unit of length is in m; nothing for one that is not known, as that of a density.
std::optional<double> named_length_unit(std::string_view unit);

PackingFile read_table(const std::string& path, std::string_view text, double length_unit);
PackingFile read_dump(const std::string& path, std::string_view text, const PackingChoice& choice);
PackingFile read_data_file(const std::string& path, std::string_view text);
PackingFile read_legacy_vtk(const std::string& path, std::string_view text);
PackingFile read_xml_vtk(const std::string& path, std::string_view text);

}  // namespace pfv::detail

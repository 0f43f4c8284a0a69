// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace pfv::detail {

/// Makes the file at `path` hold exactly `content`, or leaves it as it was: writes to a temporary
/// file in the same folder and renames that. Devices and pipes are written straight to.
/// Throws FileError.
void write_file(const std::string& path, std::string_view content);

}  // namespace pfv::detail

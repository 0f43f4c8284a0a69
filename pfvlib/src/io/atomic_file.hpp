// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace pfv::detail {

/// Whether `path` cannot be replaced by another file: a device, a pipe, or the very file that
/// standard output or standard error goes to (/dev/stdout).
bool is_stream(const std::string& path);
bool is_standard_output(const std::string& path);

/// Makes the file at `path` hold exactly `content`, or leaves it as it was: writes to a temporary
/// file in the same folder and renames that. A stream is written straight to. Throws FileError.
void write_file(const std::string& path, std::string_view content);

/// Removes a file, or a link to one, that an earlier run has left at `path`; anything else stays. Throws FileError.
void remove_file(const std::string& path);

}  // namespace pfv::detail

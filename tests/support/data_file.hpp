// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace support {

/// Path of a file of tests/data.
std::string data_file(const std::string& name);

}  // namespace support

// SPDX-License-Identifier: GPL-3.0-or-later
// The only source that depends on where the project lies, so that a compiler cache serves the others.
#include "support/data_file.hpp"

namespace support {

std::string data_file(const std::string& name) { return std::string(PFV_TEST_DATA "/") + name; }

}  // namespace support

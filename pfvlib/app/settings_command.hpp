// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>

namespace pfv::app {

/// Writes the table of settings as the page doc/settings.md.
void write_settings(std::ostream& out);

}  // namespace pfv::app

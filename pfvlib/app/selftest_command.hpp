// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>

namespace pfv::app {

/// Solves known problems on this machine with this build and prints a table of what was found, what it
/// is held against, and whether it passes. Returns true when all pass. Takes a few seconds.
bool selftest(std::ostream& out);

}  // namespace pfv::app

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"

namespace pfv {

/// Whether two boxes differ by no more than the values and places of their boundaries. Where they differ by
/// more, what was derived from one is of no use for the other.
bool same_kinds(const Box& a, const Box& b);

/// Throws InputError unless `dt` (s) can be stepped over.
void require_time_step(double dt, bool commit);

}  // namespace pfv

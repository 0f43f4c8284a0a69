// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

namespace pfv {

/// Whether two containers differ by no more than the values and places of their boundaries. Where they differ by
/// more, what was derived from one is of no use for the other.
bool same_kinds(const Container& a, const Container& b);

/// Whether their faces have the same places and shapes, to the last bit.
bool same_surfaces(const Container& a, const Container& b);
/// The same with their bounds.
bool same_shape(const Container& a, const Container& b);

/// Throws InputError unless `dt` (s) can be stepped over.
void require_time_step(double dt, bool commit);

}  // namespace pfv

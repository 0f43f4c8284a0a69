// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <vector>

namespace pfv {

/// Throws InputError for a face that bounds nothing, since others keep the fluid from it: mostly its normal points the
/// wrong way. A container may have such faces all the same, without area, as a drum has above a free surface: those that
/// `may` says, one entry a face; none if it is empty. Cost: faces squared.
void refuse_idle_faces(const Container& container, const std::vector<char>& may = {});

}  // namespace pfv

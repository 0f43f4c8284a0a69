// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/container.hpp"

#include <string>
#include <vector>

namespace pfv::app {

/// no_slip or symmetry; throws InputError that names `option`.
Wall wall_named(const std::string& option, const std::string& name);

/// Applies every `--face NAME:ITEM[,ITEM]...` to `container`. A face without a wall= of its own gets
/// `wall`. Throws InputError for an unknown, repeated or contradictory item.
void apply_faces(const std::vector<std::string>& arguments, Wall wall, Container& container);

/// Appends every `--patch NAME:A0,A1,B0,B1:ITEM` to the patches of `container`.
void apply_patches(const std::vector<std::string>& arguments, Container& container);

/// Appends every `--region X0,X1,Y0,Y1,Z0,Z1:ITEM`, then every `--point X,Y,Z:ITEM`.
void apply_regions(const std::vector<std::string>& regions, const std::vector<std::string>& points,
                   Container& container);

}  // namespace pfv::app

// SPDX-License-Identifier: GPL-3.0-or-later
// --box and --periodic, also as the packing file states them.
#pragma once

#include "pfv/box.hpp"
#include "solve_arguments.hpp"

#include <array>

namespace pfv::app {

/// Whether the periodic axes and their bounds are those of the dump.
bool periodic_as_dump(const SolveArguments& arguments);
/// Whether the box is the dump's, or the extent of the spheres.
bool box_of_file(const SolveArguments& arguments);

/// The axes that --periodic names, of a box or container. Throws InputError for others.
std::array<bool, 3> periodic_axes(const SolveArguments& arguments);
/// --gradient, Pa/m.
Eigen::Vector3d gradient_of(const SolveArguments& arguments);

/// Reads the packing file beforehand where the box may be in it; without a box, a container and periodic axes, a dump
/// that is periodic all around gives its own. Collective.
void look_for_box(SolveArguments& arguments, const Ranks& ranks);

/// The six planes of --box. Throws InputError.
Box box_of(const SolveArguments& arguments);
/// Throws InputError with the boxes that could be meant.
[[noreturn]] void refuse_without_box(const SolveArguments& arguments);

}  // namespace pfv::app

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace pfv {

inline constexpr double pi = 3.14159265358979323846;

}  // namespace pfv

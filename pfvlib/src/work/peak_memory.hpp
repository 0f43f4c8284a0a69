// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace pfv {

/// Bytes that the program has held at most, not counting those of the program that started it.
std::int64_t peak_memory();

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/grain_stresses.hpp"

namespace pfv {

/// `name`, in the order of Field, and `name_deviator`: sqrt(factor e:e) of each deviator e.
std::vector<Field> tensor_fields(const std::string& name, SphereTensors tensors, double factor);

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/fields.hpp"
#include "results/balance.hpp"

namespace pfv {

/// See Flow::pore_volumes.
Eigen::VectorXd pore_volumes(const BuiltNetwork& built);
/// See Flow::fields.
FieldGrid network_fields(const BuiltNetwork& built, const Solution& solution,
                         const Balance& balance);

}  // namespace pfv

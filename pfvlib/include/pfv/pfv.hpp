// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/box.hpp"
#include "pfv/darcy_grid.hpp"
#include "pfv/dense_packing.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "pfv/flow_model.hpp"
#include "pfv/fluid.hpp"
#include "pfv/io.hpp"
#include "pfv/network.hpp"
#include "pfv/options.hpp"
#include "pfv/packing.hpp"
#include "pfv/report.hpp"
#include "pfv/time_step.hpp"
#include "pfv/union_parts.hpp"
#include "pfv/version.hpp"

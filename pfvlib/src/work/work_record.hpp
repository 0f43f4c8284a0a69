// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/report.hpp"

namespace pfv {

/// What has been done and how long it took, since a flow was made.
struct WorkRecord {
  Counts counts;
  Seconds seconds;
  WallSeconds wall_seconds;
};

/// Adds what was done beside the steps: all but what belongs to the present network alone.
void add_background(WorkRecord& record, const WorkRecord& done);

}  // namespace pfv

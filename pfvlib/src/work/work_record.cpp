// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/work_record.hpp"

namespace pfv {

void add_background(WorkRecord& record, const WorkRecord& done) {
  Counts& counts = record.counts;
  counts.triangulate += done.counts.triangulate;
  counts.order += done.counts.order;
  counts.factor += done.counts.factor;
  counts.force_matrix += done.counts.force_matrix;
  ++counts.background;
  Seconds& seconds = record.seconds;
  seconds.triangulate += done.seconds.triangulate;
  seconds.throats += done.seconds.throats;
  seconds.assemble += done.seconds.assemble;
  seconds.order += done.seconds.order;
  seconds.factor += done.seconds.factor;
  seconds.forces += done.seconds.forces;
  seconds.total += done.seconds.total;
}

}  // namespace pfv

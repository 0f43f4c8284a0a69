// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/flow.hpp"

namespace support {

// Staged and implicit steps, committed or tried.

inline const pfv::Forces& step_staged(pfv::Flow& flow, const pfv::Packing& packing, double dt,
                                      const pfv::GrainDynamics& dynamics) {
  return flow.advance(packing, dt, pfv::Step::with(pfv::Coupling::staged, dynamics));
}

inline const pfv::Forces& try_staged(pfv::Flow& flow, const pfv::Packing& packing, double dt,
                                     const pfv::GrainDynamics& dynamics) {
  return flow.advance(packing, dt, pfv::Step::trial(pfv::Coupling::staged, dynamics));
}

inline const pfv::Forces& step_implicit(pfv::Flow& flow, const pfv::Packing& packing, double dt,
                                        const pfv::GrainDynamics& dynamics) {
  return flow.advance(packing, dt, pfv::Step::with(pfv::Coupling::implicit, dynamics));
}

inline const pfv::Forces& try_implicit(pfv::Flow& flow, const pfv::Packing& packing, double dt,
                                       const pfv::GrainDynamics& dynamics) {
  return flow.advance(packing, dt, pfv::Step::trial(pfv::Coupling::implicit, dynamics));
}

}  // namespace support

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "step/network_builder.hpp"

#include <future>

namespace pfv {

/// A network that another thread derives from the grains as they are now, with all that a step
/// needs of it. It shares nothing with its maker; its destructor waits for the thread.
class BackgroundRebuild {
 public:
  /// `step`, s: as for factor_pressures. `moving`: make what volume rates need, too. Throws SolverError
  /// where no thread can be started.
  BackgroundRebuild(const Packing& packing, const Problem& problem, double step, bool moving);

  /// Waits for the thread and adds what it has done to `work`. Throws what the build has thrown. Once.
  std::unique_ptr<BuiltNetwork> take(WorkRecord& work);

  struct Result {
    std::unique_ptr<BuiltNetwork> network;
    WorkRecord work;
  };

 private:
  std::future<Result> result_;
};

}  // namespace pfv

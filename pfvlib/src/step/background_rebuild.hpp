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
  /// where no thread can be started. Collective.
  BackgroundRebuild(const Packing& packing, const Problem& problem, double step, bool moving);

  void wait() const { result_.wait(); }
  /// Waits for the thread and adds what it has done to `work`. Throws what the build has thrown, on all ranks alike
  /// where it was so there. Once.
  std::unique_ptr<BuiltNetwork> take(WorkRecord& work);

  struct Result {
    std::unique_ptr<BuiltNetwork> network;
    WorkRecord work;
  };

 private:
  std::shared_ptr<const Ranks> ranks_, beside_;  ///< that share the packing, and for the thread; null: one has it
  std::future<Result> result_;
};

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
// The flow from run to run, where it is held: a new fluid, a restart file, what was moved by hand between runs.
#ifndef LMP_PFV_KEPT_FLOW_H
#define LMP_PFV_KEPT_FLOW_H

#include "arguments.h"
#include "left_state.h"

#include "pfv/flow_model.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace LAMMPS_NS {

class PfvKeptFlow {
 public:
  explicit operator bool() const { return model_ != nullptr; }
  pfv::FlowModel& operator*() const { return *model_; }
  pfv::FlowModel* operator->() const { return model_.get(); }
  pfv::FlowModel* get() const { return model_.get(); }

  /// A flow keeps its fluid for life: where gravity or viscosity have changed since the last run, another one takes
  /// over its state, on a network that both build from the same grains. `dt`: s, of a flow step.
  /// `ranks`: those that share it; null: one has it.
  void prepare(const pfv::Container& container, const PfvSettings& settings, const pfv::Packing& grains, double dt,
               const std::shared_ptr<const pfv::Ranks>& ranks);
  /// What the next flow begins with: that of a restart file.
  void begin_with(pfv::FlowState state) { restored_ = std::move(state); }
  /// The state from which this run and one from a restart file go on alike: the network is built anew from the
  /// grains. None before the first run, but where a restart file has been read.
  std::optional<pfv::FlowState> state_on_new_network(const pfv::Container& container, const pfv::Packing& grains,
                                                     double dt);

  /// A run ends with grains and faces in this state ...
  void leave(PfvLeftState state);
  /// ... the next one finds them in another, or not.
  bool is_as_left(const PfvLeftState& found) const { return !model_ || !left_ || *left_ == found; }
  /// The network begins anew. Throws pfv::InputError where the grains of a restart file have been moved before a first
  /// run whose pressures belong to the pores between them.
  void begin_anew(PfvLeftState found);
  bool has_left() const { return left_.has_value(); }
  void begin_run() { left_.reset(); }

  /// Results of the last flow call, for outputs and meshes. A restart file within a run does not change them, as it
  /// does not change the loads that the grains hold until the next call.
  const pfv::Report& report();
  const std::vector<Eigen::Vector3d>& face_forces();
  double mean_pressure();
  void forget_results();

 private:
  std::unique_ptr<pfv::FlowModel> model_;
  std::optional<pfv::FlowState> restored_;
  std::optional<PfvLeftState> left_;  // by the last run, as far as it is known; none within a run
  std::optional<pfv::Report> report_;
  std::optional<std::vector<Eigen::Vector3d>> face_forces_;
  std::optional<double> mean_pressure_;
};

}  // namespace LAMMPS_NS

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#include "flow_host.hpp"

namespace pfv::python {

void LentForces::take_over() {
  // A step writes all of the forces anew, whatever size it finds; moved matrices keep their place in memory.
  taken_ = std::move(const_cast<Forces&>(*forces_));
  forces_ = &taken_;
  model_.reset();
}

FlowHost::FlowHost(const Container& container, const Settings& settings)
    : settings_(settings),
      model_(make_flow(container, settings.fluid, settings.options, settings.grid())) {}

FlowHost::Turn::Turn(bool& busy) : busy_(busy) {
  if (busy) throw InputError("another thread works on this flow: wait for it, or give each thread a Flow of its own");
  busy = true;
}

void FlowHost::advance(const Grains& grains, double dt, const Step& step) {
  const Packing packing = grains.packing();
  const Turn turn(busy_);
  has_result_ = false;
  if (lent_.use_count() > 1) lent_->take_over();
  lent_.reset();
  {
    const py::gil_scoped_release released;
    model_->advance(packing, dt, step);
  }
  has_result_ = true;
}

void FlowHost::require_result() const {
  if (!has_result_)
    throw InputError("the flow holds no result: call advance() or evaluate() first (the last call failed, or there "
                     "was none)");
}

std::shared_ptr<LentForces> FlowHost::forces() {
  require_result();
  const Turn turn(busy_);
  if (!lent_) lent_ = std::make_shared<LentForces>(model_);
  return lent_;
}

Container FlowHost::container() {
  return run([](FlowModel& model) { return model.container(); });
}

}  // namespace pfv::python

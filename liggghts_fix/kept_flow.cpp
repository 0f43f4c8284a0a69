// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_flow.h"

#include "pfv/darcy_grid.hpp"

#include <utility>

namespace LAMMPS_NS {

void PfvKeptFlow::prepare(const pfv::Container& container, const PfvSettings& settings, const pfv::Packing& grains,
                          double dt, const std::shared_ptr<const pfv::Ranks>& ranks) {
  if (model_ && model_->fluid().gravity == settings.fluid.gravity &&
      model_->fluid().viscosity == settings.fluid.viscosity) {
    model_->set_container(container);
    return;
  }
  if (model_) {
    model_->set_container(container);
    model_->rebuild();
    model_->evaluate(grains, dt);
    restored_ = model_->state();
  }
  model_ = pfv::make_flow(container, settings.fluid, settings.options, settings.grid(), ranks);
  if (restored_) model_->set_state(*restored_);
  restored_.reset();
}

std::optional<pfv::FlowState> PfvKeptFlow::state_on_new_network(const pfv::Container& container,
                                                                const pfv::Packing& grains, double dt) {
  if (!model_) return restored_;
  model_->set_container(container);
  model_->rebuild();
  model_->evaluate(grains, dt);
  forget_report();
  return model_->state();
}

void PfvKeptFlow::leave(PfvLeftState state) {
  if (model_) left_ = std::move(state);
}

void PfvKeptFlow::begin_anew(PfvLeftState found) {
  model_->rebuild();
  left_ = std::move(found);
}

const pfv::Report& PfvKeptFlow::report() {
  if (!report_) report_ = model_->report();
  return *report_;
}

}  // namespace LAMMPS_NS

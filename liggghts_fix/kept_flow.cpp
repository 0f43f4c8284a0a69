// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_flow.h"

#include "pfv/darcy_grid.hpp"
#include "pfv/error.hpp"

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
  if (left_) {
    forget_results();
  } else {
    report();
    face_forces();
    mean_pressure();
  }
  model_->set_container(container);
  model_->rebuild();
  model_->evaluate(grains, dt);
  return model_->state();
}

void PfvKeptFlow::leave(PfvLeftState state) {
  if (model_) left_ = std::move(state);
}

void PfvKeptFlow::begin_anew(PfvLeftState found) {
  if (model_) {
    model_->rebuild();
    left_ = std::move(found);
  } else if (restored_) {
    if (!restored_->pore_pressures.empty())
      throw pfv::InputError("grains or periodic sides are not where the restart file has them, and the pressures of its "
                            "compressible fluid belong to the pores there: let a `run 0` follow the fix before they are "
                            "moved, inserted or deleted, or the box is changed");
    restored_->strain = 0.0;
    ++restored_->retriangulations;
  }
}

const pfv::Report& PfvKeptFlow::report() {
  if (!report_) report_ = model_->report();
  return *report_;
}

const std::vector<Eigen::Vector3d>& PfvKeptFlow::face_forces() {
  if (!face_forces_) face_forces_ = model_->face_forces();
  return *face_forces_;
}

double PfvKeptFlow::mean_pressure() {
  if (!mean_pressure_) mean_pressure_ = model_->mean_pressure();
  return *mean_pressure_;
}

void PfvKeptFlow::forget_results() {
  report_.reset();
  face_forces_.reset();
  mean_pressure_.reset();
}

}  // namespace LAMMPS_NS

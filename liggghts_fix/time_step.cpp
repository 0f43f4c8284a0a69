// SPDX-License-Identifier: GPL-3.0-or-later
// `fix pfv`: the limit of the explicit coupling, and which coupling follows from it.
#include "fix_pfv.h"

#include "pfv/error.hpp"

#include "error.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace LAMMPS_NS {

void FixPfv::bind_coupling() {
  const PfvOtherFixes others(lmp, *this);
  groups_ = others.groups();
  obstacle_.clear();
  if (!may_stage()) return;
  obstacle_ = settings_.couple_every > 1
                  ? "staged coupling needs `couple_every 1`; the drag is integrated over each step"
                  : others.obstacle_to_stages();
  if (settings_.coupling == PfvCoupling::staged && !obstacle_.empty())
    error->fix_error(FLERR, this, obstacle_.c_str());
}

bool FixPfv::may_stage() const { return settings_.coupling != PfvCoupling::explicit_forces; }

double FixPfv::flow_step() const { return settings_.couple_every * update->dt; }

/// Asked for each network; rank 0.
void FixPfv::choose_coupling() {
  chosen_for_ = flow_->retriangulations();
  staged_ = settings_.coupling == PfvCoupling::staged;
  if (settings_.coupling != PfvCoupling::automatic) return;
  const double limit = flow_->time_step_limit(grains_.masses());
  staged_ = flow_step() > settings_.safety * limit;
  if (!staged_ || obstacle_.empty()) return;
  char text[120];
  std::snprintf(text, sizeof text, "the flow step of %g s is above the explicit limit of %g s: ",
                flow_step(), limit);
  throw pfv::InputError(text + obstacle_);
}

void FixPfv::step_flow() {
  if (staged_)
    flow_->step_staged(grains_.packing(), elapsed_, grains_.dynamics());
  else
    flow_->step(grains_.packing(), elapsed_);
  if (settings_.coupling == PfvCoupling::automatic && chosen_for_ != flow_->retriangulations())
    choose_coupling();
}

/// The papers' estimate pi rho d^2 / (1200 mu) of the grain that is worst off, s.
double FixPfv::estimated_limit() const {
  const Eigen::VectorXd& masses = grains_.masses();
  const auto radii = grains_.packing().radii;
  double smallest = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < masses.size(); ++k)
    smallest = std::min(smallest, masses[k] / (400.0 * settings_.fluid.viscosity * radii[k]));
  return smallest;
}

/// Says where the time step stands, at the beginning of a run; rank 0.
void FixPfv::check_time_step() {
  if (!settings_.time_step_check && !may_stage()) return;
  const double limit = flow_->time_step_limit(grains_.masses());
  const double ratio = flow_step() / limit;
  char text[320];
  std::snprintf(text, sizeof text,
                "Fix pfv (id %s): limit of the explicit coupling %.4g s (papers' pi rho d^2/(1200 "
                "mu): %.4g s), flow step %.4g s, ratio %.4g, %s coupling, stages %d\n",
                id, limit, estimated_limit(), flow_step(), ratio, staged_ ? "staged" : "explicit",
                flow_->stages());
  print(text);
  if (may_stage() || ratio <= settings_.safety) return;
  std::snprintf(text, sizeof text,
                "Fix pfv (id %s): the flow step of %.4g s is %.4g times the limit of the explicit "
                "coupling; grains will shake. Use a time step below %.3g s, or `coupling staged`",
                id, flow_step(), ratio, settings_.safety * limit / settings_.couple_every);
  error->warning(FLERR, text);
}

}  // namespace LAMMPS_NS

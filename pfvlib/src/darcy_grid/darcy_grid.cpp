// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/darcy_grid.hpp"

#include "darcy_grid/darcy_data.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "problem/box_changes.hpp"
#include "text/number_text.hpp"

#include <cmath>
#include <limits>

namespace pfv {

namespace {

/// The grid has no place for it; a setting that does nothing would mislead.
void refuse_if(bool given, const char* what) {
  if (given)
    throw InputError(std::string("darcy_grid takes no ") + what +
                     ": leave it away, or use the model pfv");
}

void refuse_what_has_no_cells(const Container& box) {
  refuse_if(!box.is_box, "container but a box");
  refuse_if(box.any_periodic(), "periodic axes");
  refuse_if(!box.regions.empty(), "regions");
}

}  // namespace

std::unique_ptr<FlowModel> make_flow(const Container& box, const Fluid& fluid, const Options& options,
                                     const std::optional<DarcyOptions>& grid, std::shared_ptr<const Ranks> ranks) {
  if (!grid) return std::make_unique<Flow>(box, fluid, options, std::move(ranks));
  if (ranks) throw InputError("the model darcy_grid runs on one rank");
  return std::make_unique<DarcyGrid>(box, fluid, *grid, options);
}

DarcyGrid::DarcyGrid(Container box, Fluid fluid, DarcyOptions grid, Options options)
    : data_(std::make_unique<DarcyData>()) {
  check(box);
  check(fluid);
  check(options);
  check(grid, fluid, options);
  refuse_what_has_no_cells(box);
  data_->box = std::move(box);
  data_->fluid = fluid;
  data_->grid_options = grid;
  data_->options = options;
}

DarcyGrid::~DarcyGrid() = default;
DarcyGrid::DarcyGrid(DarcyGrid&&) noexcept = default;
DarcyGrid& DarcyGrid::operator=(DarcyGrid&&) noexcept = default;

const Forces& DarcyGrid::advance(const Packing& packing, double dt, const Step& step) {
  if (step.coupling == Coupling::staged || step.coupling == Coupling::implicit)
    throw InputError(std::string("darcy_grid has no ") + name_of(step.coupling) +
                     " step: take a smaller time step, or the model pfv");
  require_time_step(dt, step.commit);
  return data_->compute(packing, step.commit ? data_->time + dt : data_->time, step.commit);
}

void DarcyGrid::rebuild() { data_->stale = true; }

void DarcyGrid::set_container(const Container& box) {
  check(box);
  refuse_what_has_no_cells(box);
  if (!same_kinds(data_->box, box)) data_->stale = true;
  data_->box = box;
}

const Container& DarcyGrid::container() const { return data_->box; }
const Fluid& DarcyGrid::fluid() const { return data_->fluid; }
const DarcyOptions& DarcyGrid::grid() const { return data_->grid_options; }
double DarcyGrid::time() const { return data_->time; }

FlowState DarcyGrid::state() const { return {data_->time, 0.0, data_->renewals, {}, 0.0, 0.0, 0.0}; }

void DarcyGrid::set_state(FlowState state) {
  data_->time = state.time;
  data_->renewals = state.retriangulations;
}

const Forces& DarcyGrid::forces() const {
  data_->require_result();
  return data_->forces;
}

const std::vector<FaceResult>& DarcyGrid::faces() const {
  data_->require_result();
  return data_->last.faces;
}

std::vector<Eigen::Vector3d> DarcyGrid::face_forces() const {
  std::vector<Eigen::Vector3d> forces;
  for (const FaceResult& face : faces()) forces.push_back(face.force_pressure);
  return forces;
}

double DarcyGrid::pressure_at(const Eigen::Vector3d& place) const {
  data_->require_result();
  const Grid& grid = data_->built->grid;
  const Eigen::Vector3d relative = place - data_->built->lower;
  for (int axis = 0; axis < 3; ++axis)
    if (!(relative[axis] >= 0.0 && relative[axis] <= grid.counts[axis] * grid.lengths[axis]))
      throw InputError("no pressure at (" + detail::number_text(place[0]) + ", " + detail::number_text(place[1]) + ", " +
                       detail::number_text(place[2]) + "): the place is outside the box; give one within");
  const int cell = grid.cell_at(relative);
  return data_->last.pressures[cell] +
         data_->last.fields.gradient.col(cell).dot(relative - grid.centre(cell));
}

double DarcyGrid::plane_pressure(int axis, double position) const {
  data_->require_result();
  const Grid& grid = data_->built->grid;
  const double relative = position - data_->built->lower[axis];
  if (!(relative >= 0.0 && relative <= grid.counts[axis] * grid.lengths[axis]))
    throw InputError("the plane at " + detail::number_text(position) + " m cuts no cell");
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  place[axis] = relative;
  const int layer = grid.place(grid.cell_at(place))[axis];
  double sum = 0.0;
  int count = 0;
  for (int cell = 0; cell < grid.size(); ++cell) {
    if (grid.place(cell)[axis] != layer) continue;
    sum += data_->last.pressures[cell] +
           data_->last.fields.gradient(axis, cell) * (relative - grid.centre(cell)[axis]);
    ++count;
  }
  return sum / count;
}

double DarcyGrid::mean_pressure() const {
  data_->require_result();
  const Eigen::VectorXd fluid = data_->built->porosity.cwiseMax(0.0);
  return fluid.sum() > 0.0 ? fluid.dot(data_->last.pressures) / fluid.sum() : 0.0;
}

double DarcyGrid::time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons,
                                  const std::vector<RigidBody>&) {
  data_->require_result();
  return data_->time_step_limit(masses, pistons);
}

std::int64_t DarcyGrid::retriangulations() const { return data_->renewals; }

std::int64_t DarcyGrid::hidden_or_outside() const {
  data_->require_result();
  return static_cast<std::int64_t>(data_->seen.ids.size()) -
         data_->built->grains.spheres.size();
}

const Eigen::VectorXd& DarcyGrid::cell_pressures() const {
  data_->require_result();
  return data_->last.pressures;
}

const Eigen::VectorXd& DarcyGrid::cell_porosities() const {
  data_->require_result();
  return data_->built->porosity;
}

const Eigen::VectorXd& DarcyGrid::cell_permeabilities() const {
  data_->require_result();
  return data_->built->permeability;
}

Eigen::Matrix3Xd DarcyGrid::cell_velocities() const {
  data_->require_result();
  return data_->last.cells.discharge;
}

Eigen::Vector3d DarcyGrid::cell_lengths() const {
  data_->require_result();
  return data_->built->grid.lengths;
}

Eigen::Vector3d DarcyGrid::lower_corner() const {
  data_->require_result();
  return data_->built->lower;
}

Report DarcyGrid::report() const {
  data_->require_result();
  return make_report(*data_);
}

}  // namespace pfv

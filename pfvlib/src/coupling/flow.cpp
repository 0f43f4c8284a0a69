// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/flow.hpp"

#include "coupling/flow_data.hpp"
#include "network/pore_network.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace pfv {

namespace {

/// What a change of leads to a new network: everything of a boundary but its values.
bool same_kinds(const Box& a, const Box& b) {
  if (a.patches.size() != b.patches.size() || a.regions.size() != b.regions.size() ||
      a.periodic != b.periodic)
    return false;
  for (std::size_t i = 0; i < a.regions.size(); ++i)
    if (a.regions[i].lower != b.regions[i].lower || a.regions[i].upper != b.regions[i].upper ||
        a.regions[i].boundary.kind != b.regions[i].boundary.kind)
      return false;
  for (std::size_t i = 0; i < a.patches.size(); ++i)
    if (a.patches[i].face != b.patches[i].face ||
        a.patches[i].rectangle != b.patches[i].rectangle ||
        a.patches[i].boundary.kind != b.patches[i].boundary.kind)
      return false;
  for (int f = 0; f < 6; ++f)
    if (a.faces[f].wall != b.faces[f].wall ||
        a.faces[f].boundary.kind != b.faces[f].boundary.kind)
      return false;
  return true;
}

void require_positive(double dt) {
  if (!(dt > 0.0) || !std::isfinite(dt))
    throw InputError("the time step is " + std::to_string(dt) + " s; it must be > 0 and finite");
}

}  // namespace

const Forces& FlowModel::step_implicit(const Packing&, double, const GrainDynamics&) {
  throw InputError("this fluid model has no implicit coupling; take the explicit or the staged one");
}

const Forces& FlowModel::evaluate_implicit(const Packing& packing, double dt,
                                           const GrainDynamics& grains) {
  return step_implicit(packing, dt, grains);
}

Flow::Flow(Box box, Fluid fluid, Options options) : data_(std::make_unique<FlowData>()) {
  check(box);
  check(fluid);
  check(options);
  data_->box = std::move(box);
  data_->fluid = fluid;
  data_->options = options;
  data_->team = std::make_shared<Team>(options.threads);
}

Flow::~Flow() = default;
Flow::Flow(Flow&&) noexcept = default;
Flow& Flow::operator=(Flow&&) noexcept = default;

const Forces& Flow::step(const Packing& packing, double dt) {
  require_positive(dt);
  return data_->compute(packing, dt, true);
}

const Forces& Flow::step_staged(const Packing& packing, double dt, const GrainDynamics& grains) {
  require_positive(dt);
  return data_->compute(packing, dt, true, Coupling::staged, &grains);
}

const Forces& Flow::evaluate_staged(const Packing& packing, double dt,
                                    const GrainDynamics& grains) {
  require_positive(dt);
  return data_->compute(packing, dt, false, Coupling::staged, &grains);
}

const Forces& Flow::step_implicit(const Packing& packing, double dt,
                                  const GrainDynamics& grains) {
  require_positive(dt);
  return data_->compute(packing, dt, true, Coupling::implicit, &grains);
}

const Forces& Flow::evaluate_implicit(const Packing& packing, double dt,
                                      const GrainDynamics& grains) {
  require_positive(dt);
  return data_->compute(packing, dt, false, Coupling::implicit, &grains);
}

int Flow::stages() const { return data_->stages; }

const Forces& Flow::evaluate(const Packing& packing, double dt) {
  if (!(dt >= 0.0) || !std::isfinite(dt))
    throw InputError("the time step is " + std::to_string(dt) + " s; it must be >= 0 and finite");
  return data_->compute(packing, dt, false);
}

void Flow::rebuild() { data_->stale = data_->moved_by_host = true; }

void Flow::set_box(const Box& box) {
  check(box);
  if (!same_kinds(data_->box, box)) data_->stale = data_->moved_by_host = true;
  data_->box = box;
}

const Box& Flow::box() const { return data_->box; }
const Fluid& Flow::fluid() const { return data_->fluid; }
const Options& Flow::options() const { return data_->options; }

void Flow::set_retriangulation_strain(double strain) {
  Options changed = data_->options;
  changed.retriangulation_strain = strain;
  check(changed);
  data_->options = changed;
}

double Flow::time() const { return data_->time; }
double Flow::strain() const { return data_->strain; }

FlowState Flow::state() const {
  const auto list = [](const Eigen::VectorXd& values) {
    return std::vector<double>(values.data(), values.data() + values.size());
  };
  return {data_->time, data_->strain, data_->retriangulations,
          list(data_->old_pressures), data_->volume_debt, data_->account.at_start,
          data_->account.came_in};
}

void Flow::set_state(FlowState state) {
  data_->time = state.time;
  data_->strain = state.strain;
  data_->retriangulations = state.retriangulations;
  data_->pending_pressures = std::move(state.pore_pressures);
  data_->volume_debt = state.volume_debt;
  data_->account = {state.fluid_at_start != 0.0, state.fluid_at_start, state.fluid_came_in, 0.0};
}

const Forces& Flow::forces() const {
  data_->require_result();
  return data_->forces;
}

const std::array<FaceResult, 6>& Flow::faces() const {
  return data_->balance().faces;
}

std::array<Eigen::Vector3d, 6> Flow::face_forces() const {
  data_->require_result();
  const std::array<FaceResult, 6> faces = pfv::face_forces(*data_);
  std::array<Eigen::Vector3d, 6> total;
  for (int f = 0; f < 6; ++f) total[f] = faces[f].force_pressure + faces[f].force_viscous;
  return total;
}

const Eigen::VectorXd& Flow::pore_pressures() const {
  data_->require_result();
  return data_->pressures;
}

double Flow::pressure_at(const Eigen::Vector3d& place) const {
  data_->require_result();
  const BuiltNetwork& built = *data_->built;
  const Spheres& spheres = built.vertices;
  const Eigen::Vector3d relative = place - built.network.origin;
  if (built.network.cells() == 0 || !(relative.array() >= 0.0).all() ||
      !(relative.array() <= spheres.edges.array()).all())
    throw InputError("no pressure at a place outside the box (or in a box without grains)");
  const int cell = locate(built.network, spheres, relative, 0);
  return data_->pressures[built.network.cell_pore[cell]];
}

double Flow::plane_pressure(int axis, double position) const {
  data_->require_result();
  const BuiltNetwork& built = *data_->built;
  const double relative = position - built.network.origin[axis];
  std::optional<CellExtents>& extents = data_->built->cell_extents[axis];
  if (!extents) extents = cell_extents(built.network, built.vertices, axis);
  std::vector<char> counted(built.network.pores(), 0);  // a pore may have several cells
  double sum = 0.0;
  int count = 0;
  for (int c = 0; c < built.network.cells(); ++c) {
    if (extents->low[c] > relative || relative > extents->high[c]) continue;
    const int pore = built.network.cell_pore[c];
    if (counted[pore]) continue;
    counted[pore] = 1;
    sum += data_->pressures[pore];
    ++count;
  }
  if (count == 0)
    throw InputError("the plane at " + std::to_string(position) + " m cuts no pore");
  return sum / count;
}

double Flow::mean_pressure() const {
  data_->require_result();
  const Eigen::VectorXd volumes = storage_volumes(data_->built->throats);
  return volumes.size() > 0 ? volumes.dot(data_->pressures) / volumes.sum() : 0.0;
}

double Flow::time_step_limit(const Eigen::VectorXd& masses,
                             const std::array<Piston, 6>& pistons) {
  data_->require_result();
  return data_->time_step_limit(masses, pistons);
}

std::vector<Eigen::Matrix3d> Flow::viscosity_matrices(const std::vector<int>& columns) const {
  data_->require_result();
  return data_->viscosity_matrices(columns);
}

std::int64_t Flow::retriangulations() const { return data_->retriangulations; }

std::vector<int> Flow::hidden() const {
  data_->require_result();
  const BuiltNetwork& built = *data_->built;
  std::vector<int> columns;
  for (const int sphere : built.network.hidden) columns.push_back(built.grains.columns[sphere]);
  return columns;
}

std::int64_t Flow::hidden_or_outside() const {
  data_->require_result();
  const BuiltNetwork& built = *data_->built;
  return static_cast<std::int64_t>(built.network.hidden.size() + data_->packing_ids.size()) -
         built.grains.spheres.size();
}

const PoreNetwork& Flow::network() const {
  data_->require_result();
  return data_->built->network;
}

const std::vector<double>& Flow::throat_conductances() const {
  data_->require_result();
  return data_->built->conductances.value;
}

std::vector<double> Flow::throat_fluxes() const {
  return data_->balance().throat_fluxes;
}

Eigen::VectorXd Flow::pore_volumes() const {
  data_->require_result();
  const std::vector<double>& volumes = data_->built->throats.pore_fluid_volume;
  return Eigen::Map<const Eigen::VectorXd>(volumes.data(),
                                           static_cast<Eigen::Index>(volumes.size()));
}

Report Flow::report() const {
  data_->require_result();
  return make_report(*data_);
}

void Flow::write_fields(const std::string& path) const { write_network(path, *this); }

}  // namespace pfv

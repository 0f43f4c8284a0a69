// SPDX-License-Identifier: GPL-3.0-or-later
// What Flow answers from its last solution.
#include "flow/flow_parts.hpp"
#include "pfv/error.hpp"
#include "results/averages.hpp"
#include "results/network_fields.hpp"
#include "results/network_report.hpp"
#include "results/sphere_fields.hpp"
#include "results/sphere_strains.hpp"
#include "results/viscosity_matrices.hpp"
#include "step/forces.hpp"
#include "step/operators.hpp"
#include "step/stiffest_grain.hpp"

namespace pfv {

BuiltNetwork& Flow::Parts::network() const {
  if (!solved)
    throw InputError("Flow holds no result: call step() or evaluate() first (the last call failed, "
                     "or there was none)");
  return keeper.network();
}

BuiltNetwork& Flow::Parts::whole_network(const char* what) const {
  if (ranks) throw InputError(std::string(what) + " cannot be asked for on several ranks: run on one");
  return network();
}

const Balance& Flow::Parts::balance() {
  if (!kept_balance)
    kept_balance = balance_of(network(), solution, work.counts.correction_solve);
  return *kept_balance;
}

std::int64_t Flow::Parts::outside() const {
  const BuiltNetwork& built = network();
  std::int64_t left_out = keeper.packed();
  for (int k = 0; k < built.grains.spheres.size(); ++k) left_out -= built.share.owns_sphere(k);
  return static_cast<std::int64_t>(built.share.sum(static_cast<double>(left_out)));
}

const Container& Flow::container() const { return parts_->container; }
const Fluid& Flow::fluid() const { return parts_->fluid; }
const Options& Flow::options() const { return parts_->options; }
double Flow::time() const { return parts_->memory.time; }
double Flow::strain() const { return parts_->keeper.strain(); }
std::int64_t Flow::retriangulations() const { return parts_->keeper.rebuilds(); }

const Forces& Flow::forces() const {
  parts_->network();
  return parts_->forces;
}

const std::vector<FaceResult>& Flow::faces() const { return parts_->balance().faces; }

std::vector<Eigen::Vector3d> Flow::face_forces() const {
  const std::vector<FaceResult> faces = pfv::face_forces(parts_->network(), parts_->solution);
  std::vector<Eigen::Vector3d> total;
  for (const FaceResult& face : faces) total.push_back(face.force_pressure + face.force_viscous);
  return total;
}

const Eigen::VectorXd& Flow::pore_pressures() const {
  parts_->network();
  return parts_->solution.pressures;
}

double Flow::pressure_at(const Eigen::Vector3d& place) const {
  return pfv::pressure_at(parts_->network(), parts_->solution, place);
}

double Flow::plane_pressure(int axis, double position) const {
  require_axis(axis);
  return pfv::plane_pressure(parts_->network(), parts_->solution, axis, position);
}

double Flow::mean_pressure() const {
  return pfv::mean_pressure(parts_->network(), parts_->solution);
}

double Flow::time_step_limit(const Eigen::VectorXd& masses, const std::vector<Piston>& pistons,
                             const std::vector<RigidBody>& bodies) {
  return parts_->time_step_limit(masses, pistons, bodies);
}

StiffestGrain Flow::stiffest_grain(const Eigen::VectorXd& masses) {
  BuiltNetwork& built = parts_->network();
  built.share.together([&] {
    if (masses.size() != parts_->keeper.packed())
      throw InputError("the stiffest grain: " + std::to_string(masses.size()) + " masses for " +
                       std::to_string(parts_->keeper.packed()) + " spheres; give one a sphere");
  });
  make_force_matrices(built, parts_->problem(), parts_->work.counts);
  return stiffest_grain_of(built, masses);
}

std::vector<Eigen::Matrix3d> Flow::viscosity_matrices(const std::vector<int>& columns) const {
  return pfv::viscosity_matrices(parts_->whole_network("the viscosity matrices"), parts_->problem(), parts_->keeper.packed(),
                                 columns, parts_->work.counts);
}

std::vector<int> Flow::hidden() const {
  const BuiltNetwork& built = parts_->network();
  std::vector<int> columns;
  for (const int sphere : built.network.hidden)
    if (built.share.owns_sphere(sphere)) columns.push_back(built.grains.columns[sphere]);
  return columns;
}

std::int64_t Flow::hidden_or_outside() const {
  const BuiltNetwork& built = parts_->network();
  return hidden_spheres(built) + parts_->outside();
}

Eigen::Matrix3Xd Flow::pore_velocities() const {
  return pfv::pore_velocities(parts_->network(), parts_->balance());
}

Eigen::Matrix3Xd Flow::sphere_velocities() const {
  return pfv::sphere_velocities(parts_->network(), parts_->balance(), parts_->keeper.packed());
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Flow::sphere_stresses() const {
  return pfv::sphere_stresses(parts_->network(), parts_->solution, parts_->keeper.packed());
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Flow::sphere_strains(const Displaced& moved) const {
  return pfv::sphere_strains(parts_->network(), parts_->container, moved, parts_->keeper.packed());
}

std::vector<Field> Flow::strain_fields(const Displaced& moved) const {
  return pfv::strain_fields(sphere_strains(moved));
}

std::vector<Field> Flow::sphere_fields() const {
  return pfv::sphere_fields({parts_->network(), parts_->solution, parts_->balance(), parts_->keeper.packed()});
}

double Flow::plane_flux(int axis, double position) const {
  require_axis(axis);
  return pfv::plane_flux(parts_->network(), parts_->solution, parts_->balance(), axis, position);
}

SliceMeans Flow::slice_means(int axis, double lower, double upper) const {
  require_axis(axis);
  return pfv::slice_means(parts_->network(), parts_->solution, parts_->balance(), axis, lower,
                          upper);
}

const PoreNetwork& Flow::network() const { return parts_->network().network; }

const std::vector<double>& Flow::throat_conductances() const {
  return parts_->network().conductances.value;
}

std::vector<double> Flow::throat_fluxes() const { return parts_->balance().throat_fluxes; }

Eigen::VectorXd Flow::pore_volumes() const { return pfv::pore_volumes(parts_->network()); }

EmptySpace Flow::empty_space() const { return pfv::empty_space(parts_->network()); }

namespace {

double residual_of(const BuiltNetwork& built, const Solution& solution) {
  const SymmetricMatrix& matrix = built.kept.system.matrix;
  return built.rows ? relative_residual(matrix, solution.unknown_pressures, solution.right_side, *built.rows)
                    : relative_residual(matrix, solution.unknown_pressures, solution.right_side);
}

/// CPU seconds of all ranks, wall time of the slowest.
void add_up_times(Report& report, const Ranks& ranks) {
  Seconds& seconds = report.seconds;
  for (double* phase : {&seconds.triangulate, &seconds.throats, &seconds.assemble, &seconds.order, &seconds.factor,
                        &seconds.solve, &seconds.forces, &seconds.total})
    *phase = ranks.sum(*phase);
  report.wall_seconds.total = ranks.largest(report.wall_seconds.total);
  report.wall_seconds.waited = ranks.largest(report.wall_seconds.waited);
  report.ranks = ranks.count();
}

}  // namespace

Report Flow::report() const {
  BuiltNetwork& built = parts_->network();
  const Solution& solution = parts_->solution;
  const Balance& balance = parts_->balance();
  Report report = network_report(built, parts_->problem(), solution, balance,
                                 parts_->work.counts.query_solve);
  report.spheres = static_cast<std::int64_t>(built.share.sum(static_cast<double>(parts_->keeper.packed())));
  report.outside = parts_->outside();
  add_account(report, parts_->memory, built, parts_->fluid, solution);
  if (parts_->options.forces) {
    Eigen::VectorXd sum = parts_->forces.total.rowwise().sum();
    built.share.add(sum);
    report.force_sum = sum;
  }
  report.residual = solution.implicit
                        ? parts_->schemes.implicit().residual()
                        : residual_of(built, solution);
  report.counts = parts_->work.counts;
  if (const std::string why = parts_->automatic.reason(parts_->options.solver); !why.empty()) report.solver_made_of += " (" + why + ")";
  report.seconds = parts_->work.seconds;
  report.wall_seconds = parts_->work.wall_seconds;
  if (parts_->ranks) add_up_times(report, *parts_->ranks);
  return report;
}

FieldGrid Flow::fields() const {
  return network_fields(parts_->network(), parts_->solution, parts_->balance());
}

}  // namespace pfv

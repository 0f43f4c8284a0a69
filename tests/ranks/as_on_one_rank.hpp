// SPDX-License-Identifier: GPL-3.0-or-later
// Compares what several ranks find with what one finds.
#pragma once

#include "world.hpp"

#include "pfv/flow.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

/// rms and largest difference of the forces on this rank's grains from those of one rank, over the rms of all.
struct Difference {
  double rms = 0.0, worst = 0.0;
};

inline Difference difference_of(const Eigen::Matrix3Xd& part, const Eigen::Matrix3Xd& whole, const std::vector<int>& columns) {
  const pfv::Ranks& ranks = *world();
  Eigen::Matrix3Xd expected = whole(Eigen::all, columns);
  const double scale = std::sqrt(whole.squaredNorm() / static_cast<double>(whole.cols()));
  const Eigen::Matrix3Xd d = part - expected;
  const double sum = ranks.sum(d.squaredNorm());
  const double worst = ranks.largest(d.cols() > 0 ? d.colwise().norm().maxCoeff() : 0.0);
  return {std::sqrt(sum / static_cast<double>(whole.cols())) / scale, worst / scale};
}

inline pfv::Options tight() {
  pfv::Options options;
  options.solver = pfv::SolverKind::amg;
  options.tolerance = 1e-11;
  options.torques = true;
  options.sphere_pressure = true;
  return options;
}

struct Case {
  pfv::PackingArrays packing;
  pfv::Container container;
  pfv::Fluid fluid = {};
  pfv::Options options = tight();
  double dt = 0.0;
  std::vector<Deal> deals = {Deal::by_place};
};

inline void expect_near(double a, double b, double relative, double scale, const char* what) {
  EXPECT_NEAR(a, b, relative * std::max(std::abs(b), scale)) << what;
}

inline void expect_reports_agree(const pfv::Report& found, const pfv::Report& expected) {
  EXPECT_EQ(found.spheres, expected.spheres);
  EXPECT_EQ(found.hidden, expected.hidden);
  EXPECT_EQ(found.outside, expected.outside);
  EXPECT_EQ(found.pores, expected.pores);
  EXPECT_EQ(found.unknowns, expected.unknowns);
  EXPECT_EQ(found.counts.merged_pores, expected.counts.merged_pores);
  EXPECT_EQ(found.counts.pinned_pores, expected.counts.pinned_pores);
  EXPECT_EQ(found.counts.open_water, expected.counts.open_water);
  EXPECT_EQ(found.counts.enclosed_pores, expected.counts.enclosed_pores);
  EXPECT_EQ(found.counts.joined_pores, expected.counts.joined_pores);
  EXPECT_EQ(found.counts.degenerate_throats, expected.counts.degenerate_throats);
  const double flow = std::max({expected.inflow, expected.outflow, 1e-6});  // what cancels leaves round-off
  expect_near(found.porosity, expected.porosity, 1e-12, 0.0, "porosity");
  expect_near(found.solid_area, expected.solid_area, 1e-12, 0.0, "solid area");
  expect_near(found.inflow, expected.inflow, 1e-9, flow, "inflow");
  expect_near(found.outflow, expected.outflow, 1e-9, flow, "outflow");
  expect_near(found.volume_rate_sum, expected.volume_rate_sum, 1e-9, flow, "volume rates");
  expect_near(found.storage_rate, expected.storage_rate, 1e-8, flow, "storage");
  EXPECT_EQ(found.permeability.has_value(), expected.permeability.has_value());
  if (found.permeability && expected.permeability) {
    expect_near(*found.permeability, *expected.permeability, 1e-9, 0.0, "permeability");
    expect_near(*found.permeability_error, *expected.permeability_error, 1e-9, 0.0, "its error");
    EXPECT_EQ(found.outside_range, expected.outside_range);
  }
  EXPECT_EQ(found.permeability_tensor.has_value(), expected.permeability_tensor.has_value());
  if (found.permeability_tensor && expected.permeability_tensor) {
    EXPECT_LT((*found.permeability_tensor - *expected.permeability_tensor).norm(), 1e-9 * expected.permeability_tensor->norm());
    EXPECT_NEAR(*found.permeability_error, *expected.permeability_error, 1e-9);
  }
  expect_near(*found.fluid_volume, *expected.fluid_volume, 1e-12, 0.0, "fluid");
  expect_near(*found.reynolds_largest, *expected.reynolds_largest, 1e-7, 1e-3, "largest Reynolds number");
  expect_near(*found.reynolds_mean, *expected.reynolds_mean, 1e-7, 1e-3, "mean Reynolds number");
  EXPECT_LT(std::abs(found.mass_error), 1e-9) << "on one rank: " << expected.mass_error;
  EXPECT_LT(found.force_balance_error, 1e-12);
  ASSERT_EQ(found.faces.size(), expected.faces.size());
  double force = 1e-30;
  for (const pfv::FaceResult& face : expected.faces) force = std::max(force, face.force_pressure.norm());
  for (std::size_t f = 0; f < found.faces.size(); ++f) {
    expect_near(found.faces[f].flux, expected.faces[f].flux, 1e-9, flow, "flux");
    EXPECT_LT((found.faces[f].force_pressure - expected.faces[f].force_pressure).norm(), 1e-9 * force);
    EXPECT_LT((found.faces[f].force_viscous - expected.faces[f].force_viscous).norm(), 1e-9 * force);
    ASSERT_EQ(found.faces[f].moment.has_value(), expected.faces[f].moment.has_value());
    if (found.faces[f].moment) {
      EXPECT_LT((*found.faces[f].moment - *expected.faces[f].moment).norm(), 1e-8 * force);
    }
  }
  ASSERT_EQ(found.openings.size(), expected.openings.size());
  for (std::size_t i = 0; i < found.openings.size(); ++i) {
    EXPECT_EQ(found.openings[i].pores, expected.openings[i].pores);
    expect_near(found.openings[i].flux, expected.openings[i].flux, 1e-9, flow, "flux of an opening");
  }
}

/// Fields of the spheres: the fluid around each, and what it causes in it.
inline void expect_fields_agree(const pfv::Flow& all, const pfv::Flow& one, const std::vector<int>& columns) {
  const std::vector<pfv::Field> found = all.sphere_fields(), expected = one.sphere_fields();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t f = 0; f < found.size(); ++f) {
    const Eigen::MatrixXd own = expected[f].values(Eigen::all, columns);
    const double largest = expected[f].values.cwiseAbs().maxCoeff();
    EXPECT_LE((found[f].values - own).cwiseAbs().sum(), 1e-7 * largest * static_cast<double>(own.size())) << found[f].name;
  }
  const Eigen::VectorXd volumes = all.pore_volumes();
  EXPECT_NEAR(world()->sum(volumes.sum()) / one.pore_volumes().sum(), 1.0, 1e-12);
  double lines = 0.0;
  for (const std::uint8_t type : all.fields().types) lines += type == pfv::FieldGrid::line;
  EXPECT_EQ(world()->sum(lines), static_cast<double>(one.network().throats()));
}

/// What is asked for at places and over planes and slices.
inline void expect_means_agree(pfv::Flow& all, pfv::Flow& one, double pressure) {
  const pfv::Container& container = one.container();
  const Eigen::Vector3d edges = container.upper - container.lower;
  const pfv::Report report = one.report();
  const double flow = std::max({report.inflow, report.outflow, 1e-6});
  for (const double part : {0.2, 0.5, 0.77}) {
    const double height = container.lower[2] + part * edges[2];
    EXPECT_NEAR(all.plane_pressure(2, height), one.plane_pressure(2, height), 1e-9 * pressure);
    if (!container.periodic[2]) {
      EXPECT_NEAR(all.plane_flux(2, height), one.plane_flux(2, height), 1e-9 * flow);
    }
    const Eigen::Vector3d place = container.lower + edges.cwiseProduct(Eigen::Vector3d(0.41, 0.52, part));
    EXPECT_NEAR(all.pressure_at(place), one.pressure_at(place), 1e-9 * pressure);
  }
  const pfv::SliceMeans found = all.slice_means(2, container.lower[2], container.upper[2] + 1.0);
  const pfv::SliceMeans expected = one.slice_means(2, container.lower[2], container.upper[2] + 1.0);
  EXPECT_EQ(found.pores, expected.pores);
  EXPECT_NEAR(found.pressure, expected.pressure, 1e-9 * pressure);
  EXPECT_NEAR(found.volume, expected.volume, 1e-12 * expected.volume);
}

inline void expect_as_on_one_rank(const Case& what, pfv::Flow& one, const pfv::Forces& expected, Deal deal) {
  const std::vector<int> columns = own_columns(what.packing, deal);
  const pfv::PackingArrays part = part_of(what.packing, columns);
  pfv::Flow all(what.container, what.fluid, what.options, world());
  const pfv::Forces& found = all.evaluate(part.view(), what.dt);
  const Difference forces = difference_of(found.total, expected.total, columns);
  EXPECT_LT(forces.rms, 1e-9);
  EXPECT_LT(forces.worst, 1e-7);
  if (what.options.torques) {
    EXPECT_LT(difference_of(found.torque, expected.torque, columns).rms, 1e-9);
  }
  if (what.options.split_forces) {
    EXPECT_LT(difference_of(found.viscous, expected.viscous, columns).rms, 1e-9);
  }
  const double pressure = expected.sphere_pressure.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < columns.size(); ++i)
    EXPECT_NEAR(found.sphere_pressure[static_cast<Eigen::Index>(i)], expected.sphere_pressure[columns[i]], 1e-9 * pressure);
  EXPECT_NEAR(all.mean_pressure(), one.mean_pressure(), 1e-9 * pressure);
  EXPECT_NEAR(all.empty_space().part, one.empty_space().part, 1e-9);
  EXPECT_NEAR(all.empty_space().largest, one.empty_space().largest, 1e-9 * std::abs(one.empty_space().largest));
  expect_reports_agree(all.report(), one.report());
  expect_means_agree(all, one, pressure);
  expect_fields_agree(all, one, columns);
}

inline void expect_as_on_one_rank(const Case& what) {
  pfv::Flow one(what.container, what.fluid, what.options);
  const pfv::Forces& expected = one.evaluate(what.packing.view(), what.dt);
  for (const Deal deal : what.deals) {
    SCOPED_TRACE("deal " + std::to_string(static_cast<int>(deal)));
    expect_as_on_one_rank(what, one, expected, deal);
  }
}

/// Masses of grains, what else acts on them, pistons.
struct Loads {
  Eigen::VectorXd masses;
  Eigen::Matrix3Xd others;
  std::vector<pfv::Piston> pistons = std::vector<pfv::Piston>(6);

  Loads of(const std::vector<int>& columns) const { return {masses(columns), others(Eigen::all, columns), pistons}; }
  pfv::GrainDynamics view() const { return {{masses.data(), masses.size()}, {others.data(), 3, others.cols()}, pistons}; }
};

/// The same grains on one rank and on all.
struct Both {
  const pfv::PackingArrays& packing;
  const std::vector<int>& columns;
  const pfv::GrainDynamics of_one, of_all;
};

/// Staged steps, side by side.
inline void expect_staged_steps_agree(pfv::Flow& one, pfv::Flow& all, const Both& grains, double dt, int steps) {
  const pfv::PackingArrays part = part_of(grains.packing, grains.columns);
  for (int step = 0; step < steps; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    const pfv::Forces& expected = one.advance(grains.packing.view(), dt, pfv::Step::with(pfv::Coupling::staged, grains.of_one));
    const pfv::Forces& found = all.advance(part.view(), dt, pfv::Step::with(pfv::Coupling::staged, grains.of_all));
    EXPECT_EQ(all.stages(), one.stages());
    EXPECT_GT(one.stages(), 5);
    EXPECT_LT(difference_of(found.total, expected.total, grains.columns).rms, 1e-8);
    EXPECT_LT(difference_of(found.torque, expected.torque, grains.columns).rms, 1e-8);
  }
  EXPECT_LT(std::abs(all.report().mass_error), 1e-9);
  EXPECT_LT(all.report().force_balance_error, 1e-12);
}

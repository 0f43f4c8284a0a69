// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/number_text.hpp"
#include "pfv/box.hpp"
#include "pfv/error.hpp"
#include "pfv/fluid.hpp"
#include "pfv/options.hpp"
#include "problem/solver_traits.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace pfv {
namespace {

using detail::number_text;

constexpr std::array<const char*, 6> face_names{"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

template <class Value>
using Named = std::pair<Value, const char*>;

constexpr std::array<Named<ConductanceLaw>, 3> conductance_laws{
    {{ConductanceLaw::hydraulic_radius, "hydraulic_radius"},
     {ConductanceLaw::effective_radius, "effective_radius"},
     {ConductanceLaw::open_throat, "open_throat"}}};
constexpr std::array<Named<Partition>, 2> partitions{
    {{Partition::signed_angles, "signed"}, {Partition::yade, "yade"}}};
constexpr std::array<Named<SolverKind>, 6> solvers{{{SolverKind::automatic, "auto"},
                                                    {SolverKind::cholmod, "cholmod"},
                                                    {SolverKind::klu2, "klu2"},
                                                    {SolverKind::mumps, "mumps"},
                                                    {SolverKind::cg, "cg"},
                                                    {SolverKind::gauss_seidel, "gauss_seidel"}}};
constexpr std::array<Named<OrderingKind>, 4> orderings{{{OrderingKind::automatic, "auto"},
                                                        {OrderingKind::geometric, "geometric"},
                                                        {OrderingKind::metis, "metis"},
                                                        {OrderingKind::amd, "amd"}}};
constexpr std::array<Named<StrainMeasure>, 2> strain_measures{
    {{StrainMeasure::largest, "largest"}, {StrainMeasure::mean, "mean"}}};
constexpr std::array<Named<VolumeRates>, 2> volume_rate_operators{
    {{VolumeRates::reciprocal, "reciprocal"}, {VolumeRates::geometric, "geometric"}}};
constexpr std::array<Named<Precision>, 2> precisions{
    {{Precision::full, "double"}, {Precision::mixed, "mixed"}}};

template <class Value, std::size_t N>
const char* name_in(const std::array<Named<Value>, N>& table, Value value, const char* what) {
  for (const auto& [candidate, name] : table)
    if (candidate == value) return name;
  throw InputError(std::string("unknown ") + what + " number " +
                   std::to_string(static_cast<int>(value)) + ": use one that options.hpp names");
}

template <class Value, std::size_t N>
Value value_in(const std::array<Named<Value>, N>& table, const std::string& wanted,
               const char* what) {
  std::string known;
  for (const auto& [value, name] : table) {
    if (wanted == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw InputError(std::string("unknown ") + what + " '" + wanted + "': use one of " + known);
}

void require_finite(double value, const std::string& what) {
  if (!std::isfinite(value))
    throw InputError(what + " is " + number_text(value) + ": give a finite number");
}

void require_positive(double value, const std::string& what) {
  if (!std::isfinite(value) || value <= 0)
    throw InputError(what + " is " + number_text(value) + ": give a finite number > 0");
}

std::string interval(double lower, double upper) {
  return "[" + number_text(lower) + ", " + number_text(upper) + "]";
}

void check_edge(const Box& box, int axis) {
  const double lower = box.lower[axis], upper = box.upper[axis];
  const std::string where = std::string("box along ") + axis_names[axis];
  require_finite(lower, where + ": lower bound");
  require_finite(upper, where + ": upper bound");
  require_finite(upper - lower, where + ": length");
  if (upper <= lower)
    throw InputError(where + " is " + interval(lower, upper) +
                     ", flat or inverted: give the lower bound first");
}

void check(const Boundary& boundary, const std::string& where) {
  switch (boundary.kind) {
    case Boundary::Kind::sealed: return;
    case Boundary::Kind::pressure: require_finite(boundary.value, where + ": pressure"); return;
    case Boundary::Kind::flux: require_finite(boundary.value, where + ": flux"); return;
  }
  throw InputError(where + ": unknown kind of boundary: use sealed, pressure or flux");
}

// A rectangle may reach beyond its face, since faces move: the part on the face counts.
void check_extent(const Box& box, const Patch& patch, int axis, int first,
                  const std::string& where) {
  const double from = patch.rectangle[first], to = patch.rectangle[first + 1];
  const std::string along = where + " along " + axis_names[axis];
  require_finite(from, along + ": lower bound");
  require_finite(to, along + ": upper bound");
  if (to <= from)
    throw InputError(along + " is " + interval(from, to) +
                     ", flat or inverted: give the lower bound first");
  if (to <= box.lower[axis] || from >= box.upper[axis])
    throw InputError(along + " is " + interval(from, to) + ", outside its face " +
                     interval(box.lower[axis], box.upper[axis]) + ": move it onto the face");
}

void check_periodic(const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string where = std::string("pressure gradient along ") + axis_names[axis];
    require_finite(box.pressure_gradient[axis], where);
    if (!box.periodic[axis] && box.pressure_gradient[axis] != 0.0)
      throw InputError(where + ": that axis is not periodic; make it periodic, or give its faces "
                               "pressures");
  }
  for (const Face face : all_faces)
    if (box.periodic[axis_of(face)] &&
        (box[face].boundary.kind != Boundary::Kind::sealed || box[face].velocity != 0.0))
      throw InputError(std::string("face ") + name_of(face) +
                       " stands on a periodic axis: it can have neither a boundary nor a velocity");
  for (const Patch& patch : box.patches)
    if (box.periodic[axis_of(patch.face)])
      throw InputError(std::string("a patch on face ") + name_of(patch.face) +
                       " stands on a periodic axis: remove it");
}

void check_patch(const Box& box, std::size_t number) {
  const Patch& patch = box.patches[number];
  const std::string where =
      "patch " + std::to_string(number + 1) + " on face " + name_of(patch.face);
  const int axis = axis_of(patch.face);
  check_extent(box, patch, axis == 0 ? 1 : 0, 0, where);
  check_extent(box, patch, axis == 2 ? 1 : 2, 2, where);
  check(patch.boundary, where);
}

// What may run beside another thread that steps on, and gives the same bytes there.
void check_lag(const Options& options) {
  if (options.rebuild_lag < 0)
    throw InputError("the rebuild lag is " + std::to_string(options.rebuild_lag) +
                     ": give a number of steps, or 0 for rebuilds within a step");
  if (options.rebuild_lag == 0) return;
  const SolverKind solver = resolved(options.solver);
  if (solver == SolverKind::klu2 || solver == SolverKind::mumps)
    throw InputError(std::string("the solver ") + name_of(solver) +
                     " does not factor in the background: use the solver cholmod, or set rebuild_lag "
                     "to 0");
  if (options.ordering == OrderingKind::metis)
    throw InputError("the ordering metis draws on random numbers that it shares with all threads, so "
                     "that runs with rebuilds in the background would not repeat: use the ordering "
                     "geometric, or set rebuild_lag to 0");
}

void check_region(const Box& box, std::size_t number) {
  const Region& region = box.regions[number];
  const std::string where = "region " + std::to_string(number + 1);
  for (int axis = 0; axis < 3; ++axis) {
    const double from = region.lower[axis], to = region.upper[axis];
    const std::string along = where + " along " + axis_names[axis];
    require_finite(from, along + ": lower bound");
    require_finite(to, along + ": upper bound");
    if (to < from)
      throw InputError(along + " is " + interval(from, to) +
                       ", inverted: give the lower bound first");
    if (to < box.lower[axis] || from > box.upper[axis])
      throw InputError(along + " is " + interval(from, to) + ", outside the box " +
                       interval(box.lower[axis], box.upper[axis]) + ": move it into the box");
  }
  if (region.boundary.kind == Boundary::Kind::sealed)
    throw InputError(where + " has no boundary: give it a pressure or a flux");
  check(region.boundary, where);
}

}  // namespace

const char* name_of(Face face) {
  const auto number = static_cast<std::size_t>(face);
  if (number >= face_names.size())
    throw InputError("unknown face number " + std::to_string(number) + ": use xlo ... zhi");
  return face_names[number];
}

Face face_named(const std::string& name) {
  for (const Face face : all_faces)
    if (name == name_of(face)) return face;
  throw InputError("unknown face '" + name + "': use one of xlo, xhi, ylo, yhi, zlo, zhi");
}

const char* name_of(ConductanceLaw law) {
  return name_in(conductance_laws, law, "conductance law");
}
const char* name_of(Partition partition) {
  return name_in(partitions, partition, "partition");
}
const char* name_of(SolverKind solver) { return name_in(solvers, solver, "solver"); }
const char* name_of(OrderingKind ordering) { return name_in(orderings, ordering, "ordering"); }
const char* name_of(Precision precision) { return name_in(precisions, precision, "precision"); }
const char* name_of(StrainMeasure measure) {
  return name_in(strain_measures, measure, "strain measure");
}
const char* name_of(VolumeRates rates) {
  return name_in(volume_rate_operators, rates, "volume rates");
}

ConductanceLaw conductance_law_named(const std::string& name) {
  return value_in(conductance_laws, name, "conductance law");
}
Partition partition_named(const std::string& name) {
  return value_in(partitions, name, "partition");
}
SolverKind solver_named(const std::string& name) { return value_in(solvers, name, "solver"); }
OrderingKind ordering_named(const std::string& name) {
  return value_in(orderings, name, "ordering");
}
Precision precision_named(const std::string& name) {
  return value_in(precisions, name, "precision");
}
VolumeRates volume_rates_named(const std::string& name) {
  return value_in(volume_rate_operators, name, "volume rates");
}

void check(const Box& box) {
  for (int axis = 0; axis < 3; ++axis) check_edge(box, axis);
  for (const Face face : all_faces) {
    const std::string where = std::string("face ") + name_of(face);
    require_finite(box[face].velocity, where + ": velocity");
    require_finite(box[face].spin, where + ": spin");
    if (!box[face].sliding.allFinite() || !box[face].pivot.allFinite() ||
        box[face].sliding[axis_of(face)] != 0.0)
      throw InputError(where + ": its sliding velocity and pivot must be finite, and the sliding velocity "
                       "has no part along the face's axis; that is `velocity`");
    check(box[face].boundary, where);
  }
  for (std::size_t number = 0; number < box.patches.size(); ++number) check_patch(box, number);
  for (std::size_t number = 0; number < box.regions.size(); ++number) check_region(box, number);
  check_periodic(box);
}

void check(const Fluid& fluid) {
  require_positive(fluid.viscosity, "viscosity");
  if (!std::isfinite(fluid.density) || fluid.density < 0)
    throw InputError("density is " + number_text(fluid.density) +
                     ": give a finite number >= 0");
  for (int axis = 0; axis < 3; ++axis)
    require_finite(fluid.gravity[axis], std::string("gravity along ") + axis_names[axis]);
  if (fluid.bulk_modulus) require_positive(*fluid.bulk_modulus, "bulk modulus");
}

void check(const Options& options) {
  name_of(options.conductance);
  name_of(options.partition);
  name_of(options.volume_rates);
  name_of(options.solver);
  name_of(options.ordering);
  if (options.outside != OutsideGrains::refuse && options.outside != OutsideGrains::leave_out)
    throw InputError("unknown rule for grains outside the box: use refuse or leave_out");
  if (!(options.retriangulation_strain > 0))  // infinite: never, as far as strain goes
    throw InputError("retriangulation strain is " + number_text(options.retriangulation_strain) +
                     ": give a number > 0");
  name_of(options.strain_measure);
  check_lag(options);
  check(options.solver, options.ordering);
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0))
    throw InputError("tolerance is " + number_text(options.tolerance) +
                     ": give a number above 0 and below 1");
  if (options.tolerance != default_tolerance && !is_iterative(options.solver))
    throw InputError(std::string("the solver ") + name_of(resolved(options.solver)) +
                     " is direct and takes no tolerance; use the solver cg or gauss_seidel");
  name_of(options.precision);
  if (options.precision == Precision::mixed && resolved(options.solver) != SolverKind::cholmod)
    throw InputError(std::string("the solver ") + name_of(options.solver) +
                     " takes no mixed precision; use the solver cholmod, or the precision double");
  if (options.threads < 1 || options.threads > 64)
    throw InputError("the number of threads is " + std::to_string(options.threads) +
                     ": give 1 to 64");
  if (options.partition == Partition::yade &&
      options.conductance == ConductanceLaw::open_throat)
    throw InputError("the yade partition reproduces YADE's results: use it with the conductance law "
                     "hydraulic_radius (or effective_radius), not with open_throat");
  if (options.partition == Partition::yade && options.volume_rates != VolumeRates::geometric)
    throw InputError("the yade partition reproduces YADE's results: use it with geometric volume rates");
  if (options.torques && options.volume_rates != VolumeRates::reciprocal)
    throw InputError("torques go with reciprocal volume rates: by geometric ones spins move no fluid");
  if (!options.forces &&
      (options.split_forces || options.sphere_pressure || options.shear_viscous))
    throw InputError("split forces, sphere pressures and shear viscous forces need forces: switch those "
                     "on too");
}

}  // namespace pfv

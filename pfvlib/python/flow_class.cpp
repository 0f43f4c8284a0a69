// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Flow: how it is made, steps, forces, state and report.
#include "classes.hpp"
#include "faces.hpp"
#include "flow_host.hpp"
#include "flow_results.hpp"
#include "keywords.hpp"

#include "pfv/io.hpp"

#include <pybind11/stl.h>

namespace pfv::python {
namespace {

using namespace py::literals;

std::unique_ptr<FlowHost> make_host(py::handle box, const Fluid* fluid, const py::kwargs& keywords) {
  Settings settings;
  read_keywords("Flow()", keywords, all_keywords(), settings);
  if (fluid) {
    for (const std::string& name : fluid_keywords())
      if (settings.given.count(name)) throw py::type_error("Flow(): " + name + " is the fluid's: give it to Fluid()");
    settings.fluid = *fluid;
  }
  settle(settings);
  check(settings);
  return std::make_unique<FlowHost>(container_of(box), settings);
}

// ------------------------------------------------------------------------------------------ steps

/// A row for each sphere; the array keeps what it looks at.
template <class Numbers>
py::array lent(FlowHost& host, Numbers Forces::*part) {
  const std::shared_ptr<LentForces> forces = host.forces();
  const py::capsule keeper = keeper_of(new std::shared_ptr<LentForces>(forces));
  return view_of(forces->get().*part, keeper);
}

/// Of a part of the forces that a setting asks for.
template <class Numbers>
py::array asked_for(FlowHost& host, Numbers Forces::*part, const char* name) {
  const Setting& setting = *setting_named(name);
  if (setting.text(host.settings()) == "no")
    throw InputError(std::string("not found in this flow: give Flow ") + name + "=True");
  return lent(host, part);
}

Coupling coupling_of(const FlowHost& host, const std::optional<std::string>& name) {
  return name ? named<Coupling>(*name) : host.settings().steps.coupling;
}

py::array advance(FlowHost& host, const GivenGrains& given, double dt, const std::optional<std::string>& coupling,
                  const GivenDynamics& of_grains, bool commit) {
  const Grains grains(given);
  std::optional<Dynamics> dynamics;
  if (!of_grains.masses.is_none()) dynamics.emplace(of_grains, grains.count(), host.container());
  Step step;
  step.coupling = coupling_of(host, coupling);
  step.dynamics = dynamics ? &dynamics->get() : nullptr;
  step.commit = commit;
  step.safety = host.settings().steps.safety;
  if (step.coupling != Coupling::explicit_step && !step.dynamics)
    throw InputError(std::string("coupling '") + name_of(step.coupling) +
                     "' needs the masses of the grains (N, kg) and what else acts on them: give masses, other_forces");
  host.advance(grains, dt, step);
  return lent(host, &Forces::total);
}

double limit_of(FlowHost& host, py::handle given, py::handle of_faces, const std::vector<RigidBody>& bodies) {
  const auto numbers = reals_of(given, "masses");
  const Eigen::VectorXd masses = vector_of(numbers);
  const Pistons pistons = pistons_of(host.container(), of_faces);
  return host.ask([&](FlowModel& model) { return model.time_step_limit(masses, pistons, bodies); });
}

const char* const advance_text =
    R"(Advances the fluid by a step and returns the forces on the spheres: N x 3, N.

positions: N x 3, m; radii: N, m; velocities: N x 3, m/s (None: at rest)
dt: s, > 0
coupling: "explicit", "staged", "implicit" or "auto" (None: Flow's keyword coupling)
masses: N, kg (inf: a grain whose velocity is prescribed); all but explicit steps need them
other_forces: N x 3, N, beside the fluid's: contacts, gravity (None: none); other_torques: N x 3, N m
inertias: N, kg m2 (None: 2/5 m r2)
pistons: {face: mass} or {face: (mass, other_force)} of faces that move freely, kg, N along +axis, of a Container along
    the plane's inward normal
angular_velocities: N x 3, rad/s, read where Flow was given torques=True
ids: N whole numbers, unique, which errors name (None: the numbers of the rows, from 0)
displaced_volumes: N, m3, that the lift counts (None: whole spheres)
bodies: N whole numbers, the rigid body that holds each sphere, from 0 on, -1 for none (None: there are no bodies):
    pores within one are no fluid; rigid_bodies: a RigidBody for each number, which all but explicit steps need
commit: False takes the same step without advancing anything

An explicit step ends where the grains are at `positions` and is stable below `time_step_limit`; for staged and
implicit ones the velocities are those from which the host applies the forces over dt (leapfrog).
The array that is returned stays as it is after further steps and when the flow is gone.
Cost: one solve on the kept factor; a new network where the grains have moved enough. Raises InputError (with the
ids of the spheres), SolverError; afterwards the flow holds no result until the next successful call.)";

const char* const evaluate_text =
    R"(The forces (N x 3, N) without advancing anything: a steady state, or a look at one. As `advance`.

dt: s; 0, unless the fluid is compressible)";

const char* const limit_text =
    R"(Limit of the explicit coupling of the last packing, s; inf where nothing resists.

masses: N, kg; pistons, rigid_bodies: as for `advance`. Cost: some 15 to 35 solves for a new network.)";

void add_steps(py::class_<FlowHost>& flow) {
  flow.def("advance",
           [](FlowHost& host, py::object positions, py::object radii, py::object velocities, double dt,
              const std::optional<std::string>& coupling, py::object masses, py::object other_forces,
              py::object pistons, py::object angular_velocities, py::object other_torques, py::object inertias,
              py::object ids, py::object displaced_volumes, py::object bodies,
              const std::vector<RigidBody>& rigid_bodies, bool commit) {
             return advance(host, {positions, radii, velocities, angular_velocities, ids, displaced_volumes, bodies},
                            dt, coupling, {masses, other_forces, other_torques, inertias, pistons, rigid_bodies}, commit);
           },
           "positions"_a, "radii"_a, "velocities"_a = py::none(), "dt"_a, "coupling"_a = py::none(), py::kw_only(),
           "masses"_a = py::none(), "other_forces"_a = py::none(), "pistons"_a = py::none(),
           "angular_velocities"_a = py::none(), "other_torques"_a = py::none(), "inertias"_a = py::none(),
           "ids"_a = py::none(), "displaced_volumes"_a = py::none(), "bodies"_a = py::none(),
           "rigid_bodies"_a = py::tuple(), "commit"_a = true,
           advance_text);
}

void add_evaluations(py::class_<FlowHost>& flow) {
  flow.def("evaluate",
           [](FlowHost& host, py::object positions, py::object radii, py::object velocities, double dt,
              py::object angular_velocities, py::object ids, py::object displaced_volumes, py::object bodies) {
             return advance(host, {positions, radii, velocities, angular_velocities, ids, displaced_volumes, bodies},
                            dt, name_of(Coupling::explicit_step), {}, false);
           },
           "positions"_a, "radii"_a, "velocities"_a = py::none(), "dt"_a = 0.0, py::kw_only(),
           "angular_velocities"_a = py::none(), "ids"_a = py::none(), "displaced_volumes"_a = py::none(),
           "bodies"_a = py::none(), evaluate_text);
  flow.def("time_step_limit", &limit_of, "masses"_a, "pistons"_a = py::none(),
           "rigid_bodies"_a = py::tuple(), limit_text);
  flow.def("rebuild", [](FlowHost& host) { host.run([](FlowModel& model) { model.rebuild(); }); },
           "Discards the network; the next step triangulates anew.");
  flow.def("set_box", [](FlowHost& host, py::object given) {
             const Container container = container_of(given);
             host.run([&container](FlowModel& model) { model.set_container(container); });
           }, "box"_a, R"(New places, velocities or boundary values of faces, patches, regions: a Box, bounds or Container.

Values cost nothing; another kind of boundary, another wall or other extents lead to a new network. A face that
moves by its velocity over the steps keeps it until the strain asks for another.)");
}

void add_forces(py::class_<FlowHost>& flow) {
  const auto add = [&flow](const char* name, auto Forces::*part, const char* setting, const char* doc) {
    flow.def_property_readonly(name, [=](FlowHost& host) { return asked_for(host, part, setting); }, doc);
  };
  add("forces", &Forces::total, "forces", "Of the fluid on the spheres in the last step, N x 3, N; not copied.");
  add("torques", &Forces::torque, "torques", "About the centres, N x 3, N m; of a Flow with torques=True.");
  add("pressure_forces", &Forces::pressure, "split_forces",
      "Part of the pressure, with buoyancy, N x 3, N; of a Flow with split_forces=True.");
  add("viscous_forces", &Forces::viscous, "split_forces",
      "Viscous part, N x 3, N; of a Flow with split_forces=True.");
  add("sphere_pressures", &Forces::sphere_pressure, "sphere_pressure",
      "Mean around each sphere, N, Pa; of a Flow with sphere_pressure=True. 0 for hidden spheres.");
}

// --------------------------------------------------------------------------------- state, report

py::dict state_of(FlowHost& host) {
  const FlowState state = host.run([](FlowModel& model) { return model.state(); });
  return py::dict("time"_a = state.time, "strain"_a = state.strain, "retriangulations"_a = state.retriangulations,
                  "pore_pressures"_a = array_of(state.pore_pressures), "volume_debt"_a = state.volume_debt,
                  "fluid_at_start"_a = state.fluid_at_start, "fluid_came_in"_a = state.fluid_came_in,
                  "served_by_last_network"_a = state.served_by_last_network);
}

void restore(FlowHost& host, const py::dict& given) {
  FlowState state;
  const auto pressures = reals_of(given["pore_pressures"], "pore_pressures");
  state.pore_pressures.assign(pressures.data(), pressures.data() + pressures.size());
  state.time = number_of(given["time"], "time");
  state.strain = number_of(given["strain"], "strain");
  state.retriangulations = given["retriangulations"].cast<std::int64_t>();
  state.volume_debt = number_of(given["volume_debt"], "volume_debt");
  state.fluid_at_start = number_of(given["fluid_at_start"], "fluid_at_start");
  state.fluid_came_in = number_of(given["fluid_came_in"], "fluid_came_in");
  if (given.contains("served_by_last_network"))  // states of earlier versions have none
    state.served_by_last_network = number_of(given["served_by_last_network"], "served_by_last_network");
  host.run([&state](FlowModel& model) { model.set_state(state); });
}

/// Through the text that the command writes, so that the two cannot differ.
py::object report_of(FlowHost& host) {
  const std::string text = host.ask([](FlowModel& model) { return json_of(model.report()); });
  return py::module_::import("json").attr("loads")(text);
}

void add_state(py::class_<FlowHost>& flow) {
  flow.def("state", &state_of, R"(What a flow must remember to go on after a restart: a dict of numbers and an array.

A Flow with the same settings takes it up by `restore`. The pressures are those of the present network, so that the
next packing must give the same one: that from which it was built, or call `rebuild` before the last step.)");
  flow.def("restore", &restore, "state"_a, R"(Takes up what `state` returned, of this flow or another; the next step goes on from there.

That step makes its network anew; until then the flow holds no result.)");
  flow.def("report", &report_of, R"(Balances, permeability, counts, times of all done so far: a dict.

It is the JSON report of `pfv solve`. Cost: a pass over the network and, the first time after a triangulation, the
exact union of the spheres.)");
  flow.def("write_report", [](FlowHost& host, py::object given) {
             const std::string path = path_of(given);
             host.ask([&path](FlowModel& model) { write_report(path, model.report()); });
           }, "path"_a, "The report as a JSON file, as `pfv solve --report` writes it. Raises FileError.");
}

std::string class_text() {
  return R"(Flow through the pores of a packing that may move: grains in, forces out.

    flow = pfv.Flow(box, pfv.Fluid(viscosity=1e-3), solver="cholmod")
    forces = flow.advance(positions, radii, velocities, dt)

box: a Box, a Container, or [[xlo, xhi], [ylo, yhi], [zlo, zhi]] (m) with sealed faces
fluid: a Fluid, or its keywords among the others

The first step builds the network of pores and factors its matrix; later ones keep both until the grains have moved
enough. Work is done without the interpreter's lock: flows in several threads go on side by side, while one flow
serves one thread at a time (InputError otherwise). The arrays of a step must not be written to before it has ended.

Keywords, those of the table doc/settings.md; True and False stand for yes and no:
)" + help_of(all_keywords()) +
                          "\n\nRaises TypeError for an unknown keyword, InputError for bad or contradictory values.";
}

}  // namespace

void add_flow_class(py::module_& module) {
  py::class_<FlowHost> flow(module, "Flow", class_text().c_str());
  flow.def(py::init([](py::object box, const Fluid* fluid, const py::kwargs& keywords) {
             return make_host(box, fluid, keywords);
           }), "box"_a, "fluid"_a = py::none());
  add_steps(flow);
  add_evaluations(flow);
  add_forces(flow);
  add_state(flow);
  add_results(flow);
}

}  // namespace pfv::python

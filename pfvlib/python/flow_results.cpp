// SPDX-License-Identifier: GPL-3.0-or-later
// pfv.Flow: what it answers from its last step.
#include "flow_results.hpp"

#include "faces.hpp"
#include "network_class.hpp"

#include "pfv/fields.hpp"
#include "pfv/io.hpp"

#include <pybind11/stl.h>
#include <string>

namespace pfv::python {
namespace {

using namespace py::literals;

py::array sphere_strains_of(FlowHost& host, py::handle now, py::handle before, py::object edges, py::object tilt) {
  const auto places_now = rows_of_three(now, "now"), places_before = rows_of_three(before, "before");
  Displaced moved{columns_of(places_now), columns_of(places_before), {}, {}};
  if (!edges.is_none()) moved.edges_before = vector_of(edges, "edges_before");
  if (!tilt.is_none()) moved.tilt_before = vector_of(tilt, "tilt_before");
  return array_of(host.ask_of<Flow>([&moved](Flow& flow) { return flow.sphere_strains(moved); }));
}

Eigen::VectorXd pressures_of(FlowModel& model) {
  if (auto* grid = dynamic_cast<DarcyGrid*>(&model)) return grid->cell_pressures();
  return dynamic_cast<Flow&>(model).pore_pressures();
}

/// At one place a number, at several an array.
py::object pressure_at(FlowHost& host, py::handle given) {
  if (reals_of(given, "place").ndim() == 1) {
    const Eigen::Vector3d place = vector_of(given, "place");
    return py::float_(host.ask([&place](FlowModel& model) { return model.pressure_at(place); }));
  }
  const auto rows = rows_of_three(given, "place");
  const auto columns = columns_of(rows);
  return array_of(host.ask([&columns](FlowModel& model) {
    Eigen::VectorXd pressures(columns.cols());
    for (Eigen::Index k = 0; k < columns.cols(); ++k) pressures[k] = model.pressure_at(columns.col(k));
    return pressures;
  }));
}

py::dict dict_of(const FaceResult& face) {
  py::object moment = py::none();
  if (face.moment) moment = array_of(*face.moment);
  return py::dict("flux"_a = face.flux, "force_pressure"_a = array_of(face.force_pressure),
                  "force_viscous"_a = array_of(face.force_viscous), "moment"_a = moment);
}

py::dict face_results_of(FlowHost& host) {
  return by_face(host.container(), host.ask([](FlowModel& model) { return model.faces(); }),
                 [](const FaceResult& face) { return dict_of(face); });
}

py::dict face_forces_of(FlowHost& host) {
  return by_face(host.container(), host.ask([](FlowModel& model) { return model.face_forces(); }),
                 [](const Eigen::Vector3d& force) { return array_of(force); });
}

py::object box_or_container(FlowHost& host) {
  const Container container = host.container();
  const std::optional<Box> box = box_of(container);
  return box ? py::cast(*box) : py::cast(container);
}

py::dict slice_means(FlowHost& host, py::handle given, double lower, double upper) {
  const int axis = axis_of(given);
  const SliceMeans means = host.ask_of<Flow>([=](Flow& flow) { return flow.slice_means(axis, lower, upper); });
  return py::dict("pores"_a = means.pores, "volume"_a = means.volume, "pressure"_a = means.pressure,
                  "velocity"_a = array_of(means.velocity));
}

py::dict arrays_of(const std::vector<Field>& fields) {
  py::dict arrays;
  for (const Field& field : fields) {
    py::array array = array_of(field.values);
    arrays[py::str(field.name)] = field.values.rows() == 1 ? array.attr("ravel")() : py::object(array);
  }
  return arrays;
}

py::dict fields_of(FlowHost& host) {
  FieldGrid grid = host.ask([](FlowModel& model) { return model.fields(); });
  return py::dict("points"_a = array_of(std::move(grid.points)),
                  "connectivity"_a = array_of(std::move(grid.connectivity)), "ends"_a = array_of(std::move(grid.ends)),
                  "types"_a = array_of(std::move(grid.types)), "of_points"_a = arrays_of(grid.of_points),
                  "of_cells"_a = arrays_of(grid.of_cells));
}

/// A property that copies what `get` returns of a model.
template <class Model, class Get>
auto copied(Get get) {
  return [get](FlowHost& host) { return array_of(host.ask_of<Model>([get](Model& model) { return get(model); })); };
}

/// A value that the flow knows without a result, too.
template <class Get>
auto value(Get get) {
  return [get](FlowHost& host) { return host.run([get](FlowModel& model) { return get(model); }); };
}

void add_values(py::class_<FlowHost>& flow) {
  flow.def_property_readonly("time", value([](FlowModel& m) { return m.time(); }), "That was advanced, s.");
  flow.def_property_readonly("strain", value([](FlowModel& m) { return m.strain(); }),
                             "Pore strain since the network was built.");
  flow.def_property_readonly("retriangulations", value([](FlowModel& m) { return m.retriangulations(); }),
                             "Networks after the first.");
  flow.def_property_readonly("coupling", value([](FlowModel& m) { return name_of(m.coupling()); }),
                             "Coupling of the last step.");
  flow.def_property_readonly("stages", value([](FlowModel& m) { return m.stages(); }), "Its sub-stages.");
  flow.def_property_readonly("box", &box_or_container, "A copy of the Box or Container; hand it to `set_box` to change it.");
  flow.def_property_readonly("fluid", [](FlowHost& host) { return host.settings().fluid; }, "The fluid.");
  flow.def_property_readonly("hidden", [](FlowHost& host) {
                               return array_of(host.ask([](FlowModel& m) { return m.hidden(); }));
                             }, "Rows of the spheres that lie within others and touch no pore.");
  flow.def_property_readonly("hidden_or_outside",
                             [](FlowHost& host) {
                               return host.ask([](FlowModel& m) { return m.hidden_or_outside(); });
                             },
                             "Number of hidden spheres and of those that were left out.");
}

void add_pressures(py::class_<FlowHost>& flow) {
  flow.def_property_readonly("pressures", [](FlowHost& host) { return array_of(host.ask(pressures_of)); },
                             "Of each pore of `network()`, or of each cell of a grid (x running fastest), Pa; a copy.");
  flow.def("pressure_at", &pressure_at, "place"_a,
           R"(Pressure at a place, Pa: of 3 numbers (m) a number, of n x 3 an array.

That of the tetrahedron around the place. Raises InputError outside the box.)");
  flow.def("plane_pressure", [](FlowHost& host, py::object given, double position) {
             const int axis = axis_of(given);
             return host.ask([=](FlowModel& model) { return model.plane_pressure(axis, position); });
           }, "axis"_a, "position"_a,
           "Mean over the pores that a plane cuts, Pa. axis: 0 to 2 or x, y, z; position: m.");
  flow.def("mean_pressure", [](FlowHost& host) { return host.ask([](FlowModel& m) { return m.mean_pressure(); }); },
           "Mean over the fluid's volume, Pa.");
  flow.def("faces", &face_results_of,
           R"({face: {"flux", "force_pressure", "force_viscous", "moment"}}: m3/s, positive into the box; 3 numbers, N;
N m of both about the origin of the coordinates, None without torques=True.

Cost, once a step: one solve and two passes over the throats.)");
  flow.def("face_forces", &face_forces_of, "{face: force of the fluid on it, 3 numbers, N}; cheap.");
}

void add_velocities(py::class_<FlowHost>& flow) {
  flow.def("pore_velocities", copied<Flow>([](Flow& f) { return f.pore_velocities(); }),
           "Mean velocity of the fluid in each pore relative to the grains, pores x 3, m/s. Cost: as `faces`.");
  flow.def("sphere_velocities", copied<Flow>([](Flow& f) { return f.sphere_velocities(); }),
           "The same around each sphere, N x 3, m/s; 0 for hidden and left-out ones.");
  flow.def("sphere_stresses", copied<Flow>([](Flow& f) { return f.sphere_stresses(); }),
           "Mean stress that the fluid causes in each sphere, N x 6: xx, yy, zz, xy, xz, yz, Pa, tension positive.");
  flow.def("sphere_fields", [](FlowHost& host) {
             return arrays_of(host.ask_of<Flow>([](Flow& f) { return f.sphere_fields(); }));
           }, R"({name: values} of all fields of the spheres, N or N x 3 or N x 6, as the files of grains have them.

Tensors in VTK's order: xx, yy, zz, xy, yz, xz. Cost: as `faces`, and a pass over cells and facets.)");
  flow.def("sphere_strains", &sphere_strains_of, "now"_a, "before"_a, "edges_before"_a = py::none(),
           "tilt_before"_a = py::none(),
           R"(Strain of the packing around each sphere between two instants, N x 6: xx, yy, zz, xy, xz, yz.

now, before: N x 3 places, m, in the order of the packing; in a periodic cell without wrapping, with the lengths
edges_before (where it is tilted tilt_before, too: xy, xz, yz) of the cell. A row of `before` that is not finite: the sphere was not there.
The mean displacement gradient of the tetrahedra around the sphere (Catalano 2012, eqs. 2.20-2.21), over places
before; extension positive; exact for affine motions of any size. 0 where no tetrahedron without a wall is left.
Cost: a pass over the cells. Raises InputError for arrays of another shape.)");
  flow.def("viscosity_matrices", [](FlowHost& host, const std::vector<int>& rows) {
             return array_of(host.ask_of<Flow>([&rows](Flow& f) { return f.viscosity_matrices(rows); }));
           }, "rows"_a, R"(Drag of each of these spheres moving alone: the force on it is -V v. n x 3 x 3, N s/m.

Cost: three solves a sphere.)");
  flow.def("plane_flux", [](FlowHost& host, py::object given, double position) {
             const int axis = axis_of(given);
             return host.ask_of<Flow>([=](Flow& f) { return f.plane_flux(axis, position); });
           }, "axis"_a, "position"_a, "Flow rate through a plane of the box, m3/s, positive along the axis.");
  flow.def("slice_means", &slice_means, "axis"_a, "lower"_a, "upper"_a,
           "Means over the pores with their centre in a slice: pores, volume (m3), pressure (Pa), velocity (m/s).");
}

void add_network(py::class_<FlowHost>& flow) {
  flow.def("network", [](FlowHost& host) {
             return std::make_unique<NetworkArrays>(
                 host.ask_of<Flow>([](Flow& f) { return f.network(); }), face_names(host.container()));
           }, "The network in use, a copy: it stays as it is when the flow builds another.");
  flow.def("throat_conductances", copied<Flow>([](Flow& f) { return f.throat_conductances(); }),
           "g/L of each throat, m3/(Pa s).");
  flow.def("throat_fluxes", copied<Flow>([](Flow& f) { return f.throat_fluxes(); }),
           "Flow rate of each throat from its first pore to its second, m3/s. Cost: as `faces`.");
  flow.def("pore_volumes", copied<Flow>([](Flow& f) { return f.pore_volumes(); }), "Volume of each pore's fluid, m3.");
  flow.def("cell_porosities", copied<DarcyGrid>([](DarcyGrid& g) { return g.cell_porosities(); }),
           "Porosity of each cell of a grid, x running fastest.");
  flow.def("cell_permeabilities", copied<DarcyGrid>([](DarcyGrid& g) { return g.cell_permeabilities(); }),
           "Permeability of each cell of a grid, m2.");
  flow.def("cell_velocities", copied<DarcyGrid>([](DarcyGrid& g) { return g.cell_velocities(); }),
           "Velocity of the fluid over the total area in each cell of a grid, cells x 3, m/s.");
}

void add_fields(py::class_<FlowHost>& flow) {
  flow.def("fields", &fields_of, R"(The fields of the last step as a VTK unstructured grid: a dict of arrays.

points (n x 3, m), connectivity, ends, types (VTK's numbers of cells), of_points and of_cells: {name: values}.)");
  flow.def("write_fields", [](FlowHost& host, py::object given) {
             const std::string path = path_of(given);
             host.ask([&path](FlowModel& model) {
               write_fields(path, model.fields());
               write_walls_beside(path, model.container(), model.report().faces);
             });
           }, "path"_a, R"(The same as a .vtu file for ParaView, as `pfv solve --vtk` writes it.

The walls with their loads go to FILE_walls.vtu beside FILE.vtu. Raises FileError.)");
}

}  // namespace

void add_results(py::class_<FlowHost>& flow) {
  add_values(flow);
  add_pressures(flow);
  add_velocities(flow);
  add_network(flow);
  add_fields(flow);
}

}  // namespace pfv::python

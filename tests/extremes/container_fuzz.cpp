// SPDX-License-Identifier: GPL-3.0-or-later
// container_fuzz --count N --seed S [--first K] (support/fuzzing.hpp): N convex containers, polyhedra and cylinders of
// any axis, with packings from few spheres to dense ones, under boundaries, walls, patches and motions of their own.
#include "network/grains.hpp"
#include "network/pore_boundaries.hpp"
#include "network/pore_network.hpp"
#include "pfv/pfv.hpp"
#include "physics/cell_volumes.hpp"
#include "physics/throats.hpp"
#include "problem/container_geometry.hpp"
#include "problem/wall_polygons.hpp"
#include "support/adversarial.hpp"
#include "support/containers.hpp"
#include "support/fuzzing.hpp"
#include "support/long_steps.hpp"
#include "text/number_text.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace support;
using fuzzing::Outcome;
using Eigen::Vector3d;
using Faces = std::vector<pfv::ContainerFace>;

struct Case {
  std::size_t kind = 0;
  const char* filling = "";
  pfv::PackingArrays packing;
  pfv::Container container;
  pfv::Fluid fluid;
  pfv::Options options;
  double dt = 0.0;
  pfv::Coupling coupling = pfv::Coupling::explicit_step;
  bool moving = false;
};

// ------------------------------------------------------------------------------------- containers

/// Those that bound something; none if they are open or long.
Faces bounding(Faces faces) {
  for (pfv::ContainerFace& face : faces) face.may_bound_nothing = true;
  try {
    const pfv::Container container = pfv::container_of(faces);
    if ((container.upper - container.lower).maxCoeff() > 20.0) return {};
    const std::vector<double> areas = pfv::face_areas(container);
    Faces kept;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (areas[f] > 0.0) kept.push_back(faces[f]);
    return kept;
  } catch (const pfv::InputError&) {
    return {};
  }
}

/// A simplex and 3 to 12 planes more, about the origin.
Faces polyhedron(Random& random) {
  for (;;) {
    Faces faces;
    for (int i = whole(random, 7, 16); i > 0; --i) {
      const Vector3d out = direction(random);
      faces.push_back(plane_face("f" + std::to_string(faces.size()), out, random(0.6, 1.5) * out));
    }
    faces = bounding(faces);
    if (faces.size() > 3) return faces;
  }
}

/// Pressed flat or drawn out.
Faces sliver(Random& random) {
  Faces faces = polyhedron(random);
  const Vector3d stretch(1.0, logarithmic(random, 0.02, 1.0), logarithmic(random, 0.2, 5.0));
  const Eigen::Matrix3d turn = Eigen::Quaterniond(random(), random(), random(), random(0.1, 1.0)).normalized().toRotationMatrix();
  const Eigen::Matrix3d map = stretch.asDiagonal() * turn;
  for (pfv::ContainerFace& face : faces)
    face.surface = pfv::Surface::plane(map.transpose().inverse() * face.surface.normal,
                                       map * (face.surface.offset * face.surface.normal));
  return faces;
}

/// A second plane through the middle of a face, parallel to it but for an angle.
Faces with_twin(Random& random, double least, double most) {
  Faces faces = polyhedron(random);
  const auto polygons = pfv::wall_polygons(pfv::container_of(faces));
  const auto& polygon = polygons[static_cast<std::size_t>(whole(random, 0, static_cast<int>(polygons.size()) - 1))];
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& corner : polygon.corners) middle += corner / static_cast<double>(polygon.corners.size());
  const Vector3d normal = faces[static_cast<std::size_t>(polygon.face)].surface.normal;
  const double off = logarithmic(random, least, most);
  faces.push_back(plane_face("near", normal + off * direction(random), middle - random(0.0, 0.1) * off * normal));
  return faces;
}

/// Corners cut off by as much as one sees, or by next to nothing.
Faces with_cuts(Random& random, double least, double most) {
  Faces faces = polyhedron(random);
  for (int cuts = whole(random, 1, 4); cuts > 0; --cuts) {
    const auto polygons = pfv::wall_polygons(pfv::container_of(faces));
    const auto& corners = polygons[static_cast<std::size_t>(whole(random, 0, static_cast<int>(polygons.size()) - 1))].corners;
    const Vector3d corner = corners[static_cast<std::size_t>(whole(random, 0, static_cast<int>(corners.size()) - 1))];
    Faces more = faces;
    const Vector3d out = (corner + 0.3 * corner.norm() * random.in_cube()).normalized();
    more.push_back(plane_face("cut" + std::to_string(cuts), out, corner - logarithmic(random, least, most) * out));
    if (Faces kept = bounding(more); kept.size() > 3) faces = kept;
  }
  return faces;
}

/// 3 to 62 flats around, upright or leaning, with ends that need not be square to them.
Faces flats(Random& random) {
  for (;;) {
    Faces faces;
    const int count = whole(random, 3, 62);
    const double slope = random() < 0.5 ? 0.0 : random(-0.5, 0.5), height = logarithmic(random, 0.2, 5.0);
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * pi * (i + 0.3) / count;
      const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
      faces.push_back(plane_face("side" + std::to_string(i), out - slope * Vector3d::UnitZ(), out));
    }
    const double lean = random() < 0.5 ? 0.0 : 0.3;
    faces.push_back(plane_face("bottom", -Vector3d::UnitZ() + lean * random.in_cube(), {0.0, 0.0, -0.5 * height}));
    faces.push_back(plane_face("top", Vector3d::UnitZ() + lean * random.in_cube(), {0.0, 0.0, 0.5 * height}));
    faces = bounding(faces);
    if (faces.size() > 3) return faces;
  }
}

Faces cylinder(Random& random) {
  const Vector3d axis = direction(random);
  const double radius = logarithmic(random, 0.3, 3.0), half = logarithmic(random, 0.3, 3.0);
  return {plane_face("bottom", -axis, -half * axis), plane_face("top", axis, half * axis),
          cylinder_face("shell", axis, random(-1.0, 1.0) * axis, radius)};
}

Faces near_parallel(Random& random) { return with_twin(random, 1e-5, 0.1); }
Faces nearly_one_plane(Random& random) { return with_twin(random, 1e-8, 1e-5); }
Faces tiny_facets(Random& random) { return with_cuts(random, 1e-5, 0.05); }
Faces specks(Random& random) { return with_cuts(random, 1e-10, 1e-5); }

/// Largest errors of volumes and forces.
struct Bounds {
  double volume, balance;
};
/// The triangulation's walls are spheres of 2^25 box lengths, which places them to a few 1e-9 of the box: what is
/// smaller may be in the volumes, and in the areas that forces act on.
constexpr Bounds round_off{1e-10, 1e-11}, by_triangulation{1e-6, 1e-7};

struct Kind {
  const char* name;
  Faces (*faces)(Random&);
  Bounds bounds;
};
constexpr std::array<Kind, 8> kinds{{{"polyhedra", polyhedron, round_off},
                                     {"slivers", sliver, round_off},
                                     {"near-parallel", near_parallel, round_off},
                                     {"nearly one plane", nearly_one_plane, by_triangulation},
                                     {"tiny facets", tiny_facets, round_off},
                                     {"specks", specks, by_triangulation},
                                     {"flats around", flats, round_off},
                                     {"cylinders", cylinder, round_off}}};

/// Turned, grown and put somewhere.
pfv::Container placed(Faces faces, Random& random) {
  const Eigen::Matrix3d turn = Eigen::Quaterniond(random(-1.0, 1.0), random(), random(), random(0.1, 1.0)).normalized().toRotationMatrix();
  const double size = random() < 0.3 ? logarithmic(random, 1e-6, 1e3) : 1.0;
  const Vector3d shift = random() < 0.3 ? Vector3d(size * logarithmic(random, 1.0, 1e3) * random.in_cube()) : Vector3d::Zero();
  const auto moved = [&](const Vector3d& place) -> Vector3d { return size * (turn * place) + shift; };
  for (pfv::ContainerFace& face : faces) {
    const pfv::Surface from = face.surface;
    face.surface = from.is_plane() ? pfv::Surface::plane(turn * from.normal, moved(from.offset * from.normal))
                                   : pfv::Surface::cylinder(turn * from.axis, moved(from.point), size * from.radius);
  }
  return pfv::container_of(faces);
}

// ------------------------------------------------------------------------------------- packings

double to_walls(const pfv::Container& container, const Vector3d& place) {
  double least = 1e300;
  for (const pfv::ContainerFace& face : container.faces) least = std::min(least, face.surface.distance(place));
  return least;
}

Vector3d inside(const pfv::Container& container, Random& random) {
  Vector3d place = 0.5 * (container.lower + container.upper);
  for (int tries = 0; tries < 5000; ++tries) {
    const Vector3d trial = container.lower + (container.upper - container.lower).cwiseProduct(random.in_cube(0.0, 1.0));
    if (to_walls(container, trial) > 0.0) return trial;
  }
  return place;
}

using Spheres = std::vector<Sphere>;

Spheres few(const pfv::Container& container, double size, Random& random) {
  Spheres spheres;
  for (int n = whole(random, 1, 6); n > 0; --n)
    spheres.push_back(sphere_at(inside(container, random), size * logarithmic(random, 1e-3, 0.3)));
  return spheres;
}

/// At random, from far apart to all over each other; sizes up to a ratio of 10.
Spheres scattered(const pfv::Container& container, double size, Random& random) {
  Spheres spheres;
  const int count = whole(random, 10, 150);
  const double largest = size * std::cbrt(logarithmic(random, 0.01, 2.0) / (4.0 * count)), ratio = logarithmic(random, 1.0, 10.0);
  for (int n = count; n > 0; --n)
    spheres.push_back(sphere_at(inside(container, random), largest / logarithmic(random, 1.0, ratio)));
  return spheres;
}

/// On a shaken lattice of close packing that its box is cut out of, so that walls cut grains, too.
Spheres dense(const pfv::Container& container, double size, Random& random) {
  Spheres spheres;
  const double apart = size / std::cbrt(random(60.0, 300.0)) * 1.12, shake = random() < 0.2 ? 0.0 : random(0.01, 0.2);
  const double ratio = random() < 0.5 ? 1.0 : logarithmic(random, 1.0, 10.0);
  const Vector3d first = container.lower + apart * random.in_cube(0.0, 1.0);
  const Vector3d edges = (container.upper - container.lower) / apart;
  if (edges.prod() > 1e5) return few(container, size, random);
  for (int i = -1; i < edges[0]; ++i)
    for (int j = -1; j < edges[1]; ++j)
      for (int k = -1; k < edges[2]; ++k)
        for (const Vector3d& base : {Vector3d(0, 0, 0), Vector3d(0, .5, .5), Vector3d(.5, 0, .5), Vector3d(.5, .5, 0)}) {
          const Vector3d place = first + apart * (Vector3d(i, j, k) + base + shake * random.in_cube());
          if (to_walls(container, place) > 0.0)
            spheres.push_back(sphere_at(place, apart * random(0.33, 0.36) / logarithmic(random, 1.0, ratio)));
        }
  if (spheres.empty()) return few(container, size, random);
  return spheres;
}

/// Each touches a wall, or overlaps with it by a hair.
Spheres at_walls(const pfv::Container& container, double size, Random& random) {
  Spheres spheres = scattered(container, size, random);
  for (Sphere& sphere : spheres) {
    Vector3d place = centre_of(sphere);
    const auto& face = container.faces[static_cast<std::size_t>(whole(random, 0, container.face_count() - 1))];
    const Vector3d out = face.surface.outward_at(place);
    place += (face.surface.distance(place) - sphere.radius * (1.0 - hair(random))) * out;
    sphere = sphere_at(place, sphere.radius);
  }
  return spheres;
}

struct Filling {
  const char* name;
  Spheres (*spheres)(const pfv::Container&, double, Random&);
};
constexpr std::array<Filling, 5> fillings{{{"few", few}, {"scattered", scattered}, {"dense", dense}, {"dense", dense},
                                           {"at walls", at_walls}}};

// ------------------------------------------------------------------------------------- the cases

pfv::Boundary some_boundary(Random& random) {
  const double choice = random();
  if (choice < 0.5) return pfv::Boundary::sealed();
  if (choice < 0.6) return pfv::Boundary::flux(logarithmic(random, 1e-9, 1.0));
  return pfv::Boundary::pressure(random() < 0.5 ? 0.0 : random(-5.0, 5.0));
}

/// Around the place of a face that is nearest to a place inside.
void add_patch(pfv::Container& container, double size, Random& random) {
  pfv::ContainerPatch patch;
  patch.face = whole(random, 0, container.face_count() - 1);
  const pfv::Surface& surface = container.faces[static_cast<std::size_t>(patch.face)].surface;
  Vector3d place = inside(container, random);
  place += surface.distance(place) * surface.outward_at(place);
  const Vector3d half = size * logarithmic(random, 0.01, 1.0) * random.in_cube(0.1, 1.0);
  patch.lower = place - half;
  patch.upper = place + half;
  patch.boundary = some_boundary(random);
  container.patches.push_back(patch);
  try {
    pfv::check(container);
  } catch (const pfv::InputError&) {
    container.patches.pop_back();  // that place is beyond an edge
  }
}

void set_conditions(pfv::Container& container, double size, Random& random) {
  const int faces = container.face_count(), first = whole(random, 0, faces - 1);
  const bool plain = random() < 0.5;
  for (pfv::ContainerFace& face : container.faces) {
    face.wall = random() < 0.6 ? pfv::Wall::no_slip : pfv::Wall::symmetry;
    if (!plain && random() < 0.4) face.boundary = some_boundary(random);
  }
  if (plain) {
    container.faces[static_cast<std::size_t>(first)].boundary = pfv::Boundary::pressure(1.0);
    container.faces[static_cast<std::size_t>((first + 1 + whole(random, 0, faces - 2)) % faces)].boundary = pfv::Boundary::pressure(0.0);
  }
  if (random() < 0.3) add_patch(container, size, random);
  if (random() < 0.1) {
    const Vector3d place = inside(container, random);
    container.regions.push_back({place, place, pfv::Boundary::pressure(2.0)});
  }
}

void set_motion(pfv::Container& container, double size, Random& random) {
  const std::optional<int> round = pfv::cylinder_of(container);
  for (pfv::ContainerFace& face : container.faces) {
    if (random() < 0.5) continue;
    if (!round) {
      face.velocity = size * random.in_cube();
      face.angular_velocity = random.in_cube();
      face.pivot = inside(container, random);
    } else if (face.surface.is_plane()) {
      face.velocity = size * random(-1.0, 1.0) * face.surface.normal;
    } else {
      face.angular_velocity = random(-3.0, 3.0) * face.surface.axis;
      face.pivot = face.surface.point;
    }
  }
}

Case case_number(std::uint64_t seed, std::uint64_t number) {
  Random random(seed * 1000003ULL + number);
  Case c;
  c.kind = static_cast<std::size_t>(number % kinds.size());
  c.container = placed(kinds[c.kind].faces(random), random);
  const double size = std::cbrt(pfv::volume_of(c.container));
  set_conditions(c.container, size, random);
  const Filling& filling = fillings[static_cast<std::size_t>(whole(random, 0, static_cast<int>(fillings.size()) - 1))];
  c.filling = filling.name;
  c.packing = packing_of(filling.spheres(c.container, size, random));
  c.fluid.viscosity = logarithmic(random, 1e-3, 1e3);
  if (random() < 0.3) c.fluid.gravity = {0.0, 0.0, -9.81};
  if (random() < 0.2) c.fluid.bulk_modulus = logarithmic(random, 1e3, 1e9);
  c.options.conductance = static_cast<pfv::ConductanceLaw>(whole(random, 0, 2));
  c.options.outside = pfv::OutsideGrains::leave_out;
  c.options.sphere_pressure = random() < 0.3;
  c.options.torques = !pfv::cylinder_of(c.container) && random() < 0.3;
  c.dt = logarithmic(random, 1e-6, 0.03);
  c.moving = random() < 0.6;
  if (c.moving) {
    if (random() < 0.5) set_motion(c.container, size, random);
    c.packing.velocities.resize(3, c.packing.radii.size());
    for (Eigen::Index k = 0; k < c.packing.radii.size(); ++k) c.packing.velocities.col(k) = size * random.in_cube();
    const double choice = random();
    c.coupling = choice < 0.2 ? pfv::Coupling::staged : choice < 0.4 ? pfv::Coupling::implicit : pfv::Coupling::explicit_step;
  }
  return c;
}

std::string description(const Case& c) {
  std::ostringstream text;
  text << kinds[c.kind].name << " of " << c.container.face_count() << " faces, size "
       << (c.container.upper - c.container.lower).transpose() << ", " << c.filling << ": " << c.packing.radii.size()
       << " spheres, " << pfv::name_of(c.options.conductance) << ", dt " << c.dt << ", "
       << (c.moving ? pfv::name_of(c.coupling) : "still");
  for (const pfv::ContainerFace& face : c.container.faces) {
    text << ", " << face.name << (face.wall == pfv::Wall::symmetry ? "*" : "");
    if (face.boundary.is_open()) text << (face.boundary.imposes_pressure() ? " pressure=" : " flux=") << face.boundary.value;
  }
  text << ", " << c.container.patches.size() << " patches, " << c.container.regions.size() << " regions";
  return text.str();
}

// ------------------------------------------------------------------------------------- the checks

/// Of a network built from the same grains: what its cells and its pores lack of the container, over it.
struct VolumeErrors {
  double cells = 0.0, pores = 0.0;
  double merging = 0.0;  ///< what merged pores may lack
};

/// Cells become one pore where their centres are 1e-6 of the spheres' spacing apart; the one centre that it has may be so
/// far from the walls of the others.
double lost_by_merging(const pfv::PoreNetwork& network, const Case& c, double volume, std::size_t spheres) {
  double area = 0.0;
  for (const double one : pfv::face_areas(c.container)) area += one;
  const double spacing = std::cbrt(volume / static_cast<double>(spheres));
  return 1e-6 * spacing * area / (3.0 * volume) * (network.cells() - network.pores()) / network.cells();
}

VolumeErrors volume_errors(const Case& c) {
  const pfv::Spheres spheres = pfv::select_grains(c.packing.view(), c.container, pfv::OutsideGrains::leave_out).spheres;
  const pfv::PoreNetwork network = pfv::build_network(spheres, c.container.lower).network;
  VolumeErrors errors;
  if (network.cells() == 0) return errors;
  const pfv::Throats throats = pfv::measure_throats(network, pfv::find_pore_boundaries(network, c.container), spheres);
  const double whole = pfv::volume_of(c.container);
  double pores = 0.0, cells = 0.0;
  for (const double volume : throats.pore_volume) pores += volume;
  for (const auto& cell : network.cell_vertices) cells += pfv::cell_volume(cell, spheres).volume;
  errors.cells = std::abs(cells / whole - 1.0);
  errors.pores = std::abs(pores / whole - 1.0);
  errors.merging = lost_by_merging(network, c, whole, spheres.radii.size());
  return errors;
}

void check_drawing(const pfv::Container& container, const pfv::Flow& flow, Outcome& outcome) {
  const pfv::FieldGrid grid = pfv::grid_of_walls(container, flow.faces());
  if (!grid.points.allFinite()) outcome.fail("a wall's corner that is not finite");
  for (const pfv::Field& field : grid.of_cells)
    if (!field.values.allFinite()) outcome.fail("a wall's " + field.name + " that is not finite");
}

void check_result(const Case& c, const pfv::Flow& flow, Outcome& outcome) {
  const pfv::Forces& forces = flow.forces();
  if (!forces.total.allFinite() || !forces.torque.allFinite() || !forces.sphere_pressure.allFinite())
    outcome.fail("a force that is not finite");
  if (!flow.pore_pressures().allFinite()) outcome.fail("a pressure that is not finite");
  const pfv::Report report = flow.report();
  if (!fuzzing::all_finite(report)) outcome.fail("a number in the report that is not finite");
  const double volume = flow.time() == 0.0 ? pfv::volume_of(c.container) : report.pore_volume;  // moves with the network
  if (!(report.pore_volume >= -1e-10 * volume && report.pore_volume <= (1.0 + 1e-10) * volume))
    outcome.fail("a fluid's volume of " + std::to_string(report.pore_volume / volume) + " of the container");
  outcome.mass = std::max(outcome.mass, std::abs(report.mass_error));
  outcome.balance = std::max(outcome.balance, report.force_balance_error);
}

/// Without motion, fluxes or storage no pressure leaves the range of those imposed.
void check_range(const Case& c, const pfv::Flow& flow, Outcome& outcome) {
  double low = 1e300, high = -1e300;
  bool driven = c.fluid.bulk_modulus.has_value();
  const auto extend = [&](const pfv::Boundary& b) {
    driven = driven || b.imposes_flux();
    if (!b.imposes_pressure()) return;
    low = std::min(low, b.value);
    high = std::max(high, b.value);
  };
  for (const pfv::ContainerFace& face : c.container.faces) {
    extend(face.boundary);
    driven = driven || !face.velocity.isZero(0.0) || !face.angular_velocity.isZero(0.0);
  }
  for (const pfv::ContainerPatch& patch : c.container.patches) extend(patch.boundary);
  for (const pfv::Region& region : c.container.regions) extend(region.boundary);
  if (driven || low > high || flow.pore_pressures().size() == 0) return;
  const double hair = 1e-9 * std::max({std::abs(low), std::abs(high), high - low});
  if (flow.pore_pressures().minCoeff() < low - hair || flow.pore_pressures().maxCoeff() > high + hair)
    outcome.fail("pressures from " + pfv::detail::number_text(flow.pore_pressures().minCoeff()) + " to " + pfv::detail::number_text(flow.pore_pressures().maxCoeff()) +
                 ", beyond the range of those imposed, " + pfv::detail::number_text(low) + " to " + pfv::detail::number_text(high));
}

void check_volumes(const Case& c, Outcome& outcome) {
  const VolumeErrors errors = volume_errors(c);
  outcome.volume = std::max(errors.cells, errors.pores);
  if (errors.cells > kinds[c.kind].bounds.volume) outcome.fail("volumes of cells that are off by " + pfv::detail::number_text(errors.cells));
  if (errors.pores > kinds[c.kind].bounds.volume + errors.merging)
    outcome.fail("volumes of pores that are off by " + pfv::detail::number_text(errors.pores));
}

void move_on(Case& c, pfv::Flow& flow) {
  c.packing.positions += c.dt * c.packing.velocities;
  c.container = pfv::container_after(c.container, c.dt);
  flow.set_container(c.container);
}

void run_flow(Case& c, Outcome& outcome) {
  pfv::Flow flow(c.container, c.fluid, c.options);
  pfv::PackingArrays still = c.packing;
  still.velocities.resize(3, 0);
  flow.evaluate(still.view(), c.dt);
  check_result(c, flow, outcome);
  check_range(c, flow, outcome);
  check_drawing(c.container, flow, outcome);
  check_volumes(c, outcome);
  const Eigen::VectorXd masses = c.packing.radii.array().cube() * 4e3;
  const double limit = flow.time_step_limit(masses);
  if (!(limit > 0.0)) outcome.fail("a time step limit of " + std::to_string(limit));
  if (!c.moving) return;
  if (c.coupling != pfv::Coupling::explicit_step) c.dt = std::min(c.dt, 1e3 * limit);
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, masses.size());
  const pfv::GrainDynamics grains{{masses.data(), masses.size()}, {none.data(), 3, none.cols()}};
  for (int step = 0; step < 3; ++step) {
    move_on(c, flow);
    if (c.coupling == pfv::Coupling::staged) step_staged(flow, c.packing.view(), c.dt, grains);
    else if (c.coupling == pfv::Coupling::implicit) step_implicit(flow, c.packing.view(), c.dt, grains);
    else flow.step(c.packing.view(), c.dt);
    check_result(c, flow, outcome);
  }
}

Outcome examine(Case c) {
  Outcome outcome = fuzzing::examine([&](Outcome& of) { run_flow(c, of); });
  if (outcome.mass > 1e-6) outcome.fail("mass error " + pfv::detail::number_text(outcome.mass));
  if (outcome.balance > kinds[c.kind].bounds.balance) outcome.fail("unbalanced forces, " + pfv::detail::number_text(outcome.balance));
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  return fuzzing::run(argc, argv, names, case_number, examine, description);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// A network is numbered by its spheres' ids and places: the rows of a packing may stand in any order, and a
// part of it may be triangulated alone, and no byte changes.
#include "network/canonical_order.hpp"

#include "network/facets.hpp"
#include "physics/force_matrix.hpp"
#include "physics/volume_rates.hpp"
#include "pfv/flow.hpp"
#include "support/adversarial.hpp"
#include "support/boxes.hpp"
#include "support/packings.hpp"
#include "support/stages.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace canonical_order_test {
namespace {

using namespace support;

/// What a network or a flow is, by ids: numbers and the bytes of doubles, under the names of the arrays.
class Record {
 public:
  void add(const std::string& name, std::int64_t number) { arrays_[name].push_back(number); }
  void add(const std::string& name, double value) {
    std::int64_t bytes;
    std::memcpy(&bytes, &value, sizeof bytes);
    arrays_[name].push_back(bytes);
  }
  void add(const std::string& name, int number) { add(name, std::int64_t{number}); }
  template <class Derived>
  void add(const std::string& name, const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index j = 0; j < values.cols(); ++j)
      for (Eigen::Index i = 0; i < values.rows(); ++i) add(name, values(i, j));
  }
  template <class Number>
  void add(const std::string& name, const std::vector<Number>& values) {
    for (const Number& value : values) add(name, value);
  }
  template <std::size_t n>
  void add(const std::string& name, const std::array<int, n>& values) {
    for (const int value : values) add(name, value);
  }
  template <std::size_t n>
  void add(const std::string& name, const std::array<double, n>& values) {
    for (const double value : values) add(name, value);
  }
  void expect_equal(const Record& other, const std::string& what) const {
    EXPECT_EQ(arrays_.size(), other.arrays_.size()) << what;
    for (const auto& [name, values] : arrays_) {
      const auto found = other.arrays_.find(name);
      EXPECT_TRUE(found != other.arrays_.end() && values == found->second) << what << ": " << name;
    }
  }

 private:
  std::map<std::string, std::vector<std::int64_t>> arrays_;
};

/// A sphere's id and the place of the image, or the wall.
void add_vertex(Record& record, const std::string& name, pfv::Vertex v, const pfv::Spheres& spheres) {
  record.add(name, v < 0 ? v : std::int64_t{0});
  if (v < 0) return;
  record.add(name, spheres.ids[v]);
  record.add(name, spheres.centres.col(v));
}

std::vector<int> columns_by_id(const pfv::Packing::Ids& ids) {
  std::vector<int> columns(static_cast<std::size_t>(ids.size()));
  std::iota(columns.begin(), columns.end(), 0);
  std::sort(columns.begin(), columns.end(), [&](int a, int b) { return ids[a] < ids[b]; });
  return columns;
}

void add_network(Record& record, const pfv::PoreNetwork& network, const pfv::Spheres& vertices,
                 const pfv::Spheres& spheres) {
  for (int c = 0; c < network.cells(); ++c) {
    for (const pfv::Vertex v : network.cell_vertices[c])
      add_vertex(record, "cell_vertices", v, vertices);
    record.add("cell_neighbours", network.cell_neighbours[c]);
  }
  record.add("cell_centres", network.cell_centres);
  record.add("cell_pore", network.cell_pore);
  record.add("pore_centres", network.pore_centres);
  for (const auto faces : network.pore_faces) record.add("pore_faces", static_cast<int>(faces));
  for (int f = 0; f < network.facets(); ++f) {
    for (const pfv::Vertex v : network.facet_vertices[f])
      add_vertex(record, "facet_vertices", v, vertices);
    record.add("facet_cells", network.facet_cells[f]);
  }
  for (const auto& pores : network.throat_pores) record.add("throat_pores", pores);
  record.add("throat_offsets", network.throat_offsets);
  record.add("throat_facets", network.throat_facets);
  record.add("hidden", 0);  // so that the array is there
  for (const int k : network.hidden) record.add("hidden", spheres.ids[k]);
}

void add_throats(Record& record, const pfv::Throats& throats) {
  for (const auto& discs : throats.facet_disc) record.add("facet_disc", discs);
  for (const auto& gamma : throats.facet_gamma) record.add("facet_gamma", gamma);
  record.add("normal", throats.normal);
  record.add("area", throats.area);
  record.add("fluid_area", throats.fluid_area);
  record.add("length", throats.length);
  record.add("volume", throats.volume);
  record.add("gamma", throats.gamma);
  record.add("pore_volume", throats.pore_volume);
  record.add("pore_fluid_volume", throats.pore_fluid_volume);
  record.add("pore_gamma", throats.pore_gamma);
}

void add_matrices(Record& record, const pfv::PoreNetwork& network, const pfv::Throats& throats,
                  const pfv::Spheres& vertices, const pfv::Spheres& spheres) {
  const auto law = pfv::ConductanceLaw::open_throat;
  record.add("conductances", pfv::conductances(law, 1.0, network, throats, vertices).value);
  const pfv::ForceMatrix s =
      pfv::force_matrix(network, vertices, throats,
                        pfv::viscous_shares(law, network, throats, vertices), spheres.size(), {});
  for (const int k : columns_by_id(spheres.ids))
    for (int e = s.row_begin[k]; e < s.row_begin[k + 1]; ++e) {
      record.add("S", s.pore[e]);
      record.add("S", s.value.col(e));
    }
  const pfv::VolumeRateMatrix rates = pfv::volume_rate_matrix(network, vertices);
  record.add("E", rates.row_begin);
  for (std::size_t e = 0; e < rates.mover.size(); ++e) {
    const pfv::Vertex mover = rates.mover[e];
    record.add("E", mover < 0 ? std::int64_t{mover} : spheres.ids[mover]);
    record.add("E", rates.area.col(static_cast<Eigen::Index>(e)));
  }
}

/// The network and what follows from it; one number where it is refused (the message may name any of
/// several spheres).
Record stages_record(const pfv::PackingArrays& packing, const pfv::Box& box) {
  Record record;
  try {
    const pfv::Spheres spheres =
        pfv::select_grains(packing.view(), box, pfv::OutsideGrains::leave_out).spheres;
    const pfv::PoreSpace space = pfv::build_network(spheres, box.lower);
    add_network(record, space.network, space.spheres, spheres);
    const auto boundaries = pfv::find_pore_boundaries(space.network, box);
    const auto throats = pfv::measure_throats(space.network, boundaries, space.spheres);
    add_throats(record, throats);
    add_matrices(record, space.network, throats, space.spheres, spheres);
  } catch (const pfv::InputError&) {
    record = {};
    record.add("refused", 0);
  }
  return record;
}

void add_forces(Record& record, const std::string& when, const pfv::Flow& flow,
                const pfv::Packing& packing) {
  const pfv::Forces& forces = flow.forces();
  const auto velocities = flow.sphere_velocities();
  const auto stresses = flow.sphere_stresses();
  for (const int k : columns_by_id(packing.ids)) {
    record.add(when + "total", forces.total.col(k));
    record.add(when + "pressure", forces.pressure.col(k));
    record.add(when + "viscous", forces.viscous.col(k));
    record.add(when + "sphere_pressure", forces.sphere_pressure[k]);
    record.add(when + "sphere_velocities", velocities.col(k));
    record.add(when + "sphere_stresses", stresses.col(k));
  }
}

void add_flow(Record& record, const std::string& when, const pfv::Flow& flow) {
  record.add(when + "pressures", flow.pore_pressures());
  record.add(when + "conductances", flow.throat_conductances());
  record.add(when + "volumes", flow.pore_volumes());
  record.add(when + "fluxes", flow.throat_fluxes());
  for (const auto& face : flow.faces()) {
    record.add(when + "face_fluxes", face.flux);
    record.add(when + "face_forces", face.force_pressure);
    record.add(when + "face_forces", face.force_viscous);
  }
}

pfv::PackingArrays shuffled(const pfv::PackingArrays& packing, Random& random) {
  const auto n = packing.ids.size();
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(n));
  std::iota(rows.begin(), rows.end(), Eigen::Index{0});
  for (int i = static_cast<int>(n) - 1; i > 0; --i)
    std::swap(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(whole(random, 0, i))]);
  pfv::PackingArrays result = packing;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index from = rows[static_cast<std::size_t>(k)];
    result.ids[k] = packing.ids[from];
    result.positions.col(k) = packing.positions.col(from);
    result.radii[k] = packing.radii[from];
    if (packing.velocities.cols() > 0) result.velocities.col(k) = packing.velocities.col(from);
  }
  return result;
}

struct Sample {
  std::string name;
  pfv::PackingArrays packing;
  pfv::Box box;
};

pfv::Box periodic_box() {
  pfv::Box box;
  box.periodic = {true, true, true};
  box.pressure_gradient = {1.0, 0.3, -0.2};
  return box;
}

pfv::PackingArrays moving(pfv::PackingArrays packing) {
  Random random(11);
  packing.velocities.resize(3, packing.ids.size());
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
    packing.velocities.col(k) = 1e-3 * random.in_cube();
  return packing;
}

/// Spheres with overlaps; one is inside another, and of one the power cell has shrunk to a polygon.
pfv::PackingArrays with_hidden_spheres() {
  std::vector<Sphere> spheres{{0.25, 0.5, 0.5, 0.15625},   {0.375, 0.5, 0.5, 0.09375},
                              {0.7, 0.5, 0.5, 0.2},        {0.72, 0.5, 0.5, 0.1},
                              {0.7, 0.45, 0.52, 0.08},     {0.3, 0.2, 0.8, 0.15},
                              {0.38, 0.25, 0.8, 0.15},     {0.5, 0.8, 0.2, 0.1}};
  Random random(4);
  for (int i = 0; i < 60; ++i) {
    const double r = random(0.03, 0.09);
    const Eigen::Vector3d x = random.in_cube(0.05, 0.95);
    spheres.push_back({x[0], x[1], x[2], r});
  }
  return packing_of(spheres);
}

std::vector<Sample> samples() {
  const pfv::Box upwards = upward_box(pfv::Wall::no_slip);
  pfv::Box partly = periodic_box();
  partly.periodic = {true, true, false};
  partly.pressure_gradient = {1.0, 0.0, 0.0};
  partly[pfv::Face::zlo].boundary = pfv::Boundary::pressure(1.0);
  return {{"random", random_packing(300, 0.03, 0.06, 1), upwards},
          {"size ratio 5", random_packing(300, 0.02, 0.1, 2), upwards},
          {"dense", data_packing("packing_500.csv"), upwards},
          {"simple cubic", lattice(Lattice::sc, 5), upwards},
          {"body centred", lattice(Lattice::bcc, 4), upwards},
          {"face centred", lattice(Lattice::fcc, 4), upwards},
          {"face centred, overlapping", lattice(Lattice::fcc, 3, 1.1), upwards},
          {"hidden spheres", with_hidden_spheres(), upwards},
          {"periodic", data_packing("bed_periodic_64.csv"), periodic_box()},
          {"periodic, body centred", lattice(Lattice::bcc, 3), periodic_box()},
          {"periodic, face centred", lattice(Lattice::fcc, 2), periodic_box()},
          {"periodic along two axes", random_packing(200, 0.03, 0.08, 3), partly}};
}

TEST(CanonicalOrder, NetworksThroatsAndMatricesDoNotDependOnTheOrderOfRows) {
  Random random(1);
  for (const Sample& sample : samples()) {
    const Record record = stages_record(sample.packing, sample.box);
    for (int turn = 0; turn < 3; ++turn)
      record.expect_equal(stages_record(shuffled(sample.packing, random), sample.box), sample.name);
  }
}

TEST(CanonicalOrder, NorDoThoseOfPackingsThatLookForTrouble) {
  Random random(2);
  for (std::size_t kind = 0; kind < adversarial::kinds.size(); ++kind)
    for (int turn = 0; turn < 20; ++turn) {
      const auto packing = packing_of(adversarial::spheres_of(kind, random));
      stages_record(packing, {}).expect_equal(stages_record(shuffled(packing, random), {}),
                                              adversarial::kinds[kind].name);
    }
}

Record flow_record(const Sample& sample, const pfv::Fluid& fluid, double dt) {
  pfv::Options options;
  options.split_forces = options.sphere_pressure = true;
  pfv::PackingArrays packing = sample.packing;
  pfv::Flow flow(sample.box, fluid, options);
  Record record;
  for (const char* when : {"first ", "kept ", "rebuilt "}) {
    if (when[0] == 'r') flow.rebuild();
    flow.step(packing.view(), dt);
    add_flow(record, when, flow);
    add_forces(record, when, flow, packing.view());
    packing.positions += dt * packing.velocities;
    packing.velocities *= 1.1;
  }
  return record;
}

TEST(CanonicalOrder, FlowsHaveTheSameBytesForEachId) {
  Random random(3);
  pfv::Fluid incompressible = viscosity_one(), compressible = viscosity_one();
  incompressible.density = 1.0;
  incompressible.gravity = {0.1, 0.0, -9.81};
  compressible.bulk_modulus = 100.0;
  for (Sample& sample : samples()) {
    if (sample.name == "hidden spheres") incompressible.bulk_modulus = 1e6;  // it has closed pores
    sample.packing = moving(sample.packing);
    const Sample other{sample.name, shuffled(sample.packing, random), sample.box};
    for (const auto& fluid : {incompressible, compressible})
      flow_record(sample, fluid, 1e-3).expect_equal(flow_record(other, fluid, 1e-3), sample.name);
  }
}

// ------------------------------------------------------------------------------- parts of a packing

using Name = std::array<std::int64_t, 4>;

/// Cells by the ids of their vertices in their order; walls are negative.
std::vector<Name> names_of_cells(const Stages& s) {
  std::vector<Name> names;
  for (const auto& cell : s.network.cell_vertices) {
    names.emplace_back();
    for (int i = 0; i < 4; ++i)
      names.back()[i] = pfv::is_wall(cell[i]) ? cell[i] : s.spheres.ids[cell[i]];
  }
  return names;
}

bool all_below(const Stages& s, int cell, double limit) {
  for (const pfv::Vertex v : s.network.cell_vertices[cell])
    if (v == pfv::wall_vertex(1) || (v >= 0 && s.spheres.centres(0, v) > limit)) return false;
  return s.network.cell_centres(0, cell) < limit;
}

pfv::PackingArrays part_below(const pfv::PackingArrays& packing, double limit) {
  pfv::PackingArrays part = packing;
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    if (packing.positions(0, k) > limit) continue;
    part.ids[count] = packing.ids[k];
    part.positions.col(count) = packing.positions.col(k);
    part.radii[count++] = packing.radii[k];
  }
  part.ids.conservativeResize(count);
  part.positions.conservativeResize(3, count);
  part.radii.conservativeResize(count);
  return part;
}

/// Throats between pores whose cells are all among the first `kept` ones: named by the first cell of each
/// pore; values in their order.
Record inner_throats(const Stages& s, double limit) {
  const auto names = names_of_cells(s);
  std::vector<int> first(s.network.pores(), -1);
  std::vector<char> inner(s.network.pores(), 1);
  for (int c = 0; c < s.network.cells(); ++c) {
    const int pore = s.network.cell_pore[c];
    if (first[pore] < 0) first[pore] = c;
    if (!all_below(s, c, limit)) inner[pore] = 0;
  }
  Record record;
  for (int t = 0; t < s.network.throats(); ++t) {
    const auto [i, j] = s.network.throat_pores[t];
    if (!inner[i] || !inner[j]) continue;
    for (const int pore : {i, j})
      for (const auto id : names[first[pore]]) record.add("throat_pores", id);
    record.add("throats", s.throats.normal.col(t));
    for (const auto* values : {&s.throats.area, &s.throats.fluid_area, &s.throats.length,
                               &s.throats.volume, &s.throats.gamma})
      record.add("throats", (*values)[t]);
    for (int f = s.network.throat_facets[t]; f < s.network.throat_facets[t + 1]; ++f) {
      for (const pfv::Vertex v : s.network.facet_vertices[f])
        record.add("facets", v < 0 ? std::int64_t{v} : s.spheres.ids[v]);
      record.add("facets", s.throats.facet_disc[f]);
      record.add("facets", s.throats.facet_gamma[f]);
    }
  }
  return record;
}

Record inner_cells(const Stages& s, double limit) {
  const auto names = names_of_cells(s);
  Record record;
  for (int c = 0; c < s.network.cells(); ++c)
    if (all_below(s, c, limit)) {
      for (const auto id : names[c]) record.add("cells", id);
      record.add("centres", s.network.cell_centres.col(c));
    }
  return record;
}

TEST(CanonicalOrder, APartOfAPackingGivesItsPartOfTheNetwork) {
  const pfv::Box box = upward_box(pfv::Wall::no_slip);
  const std::vector<Sample> wholes{{"random", random_packing(400, 0.03, 0.06, 1), box},
                                   {"dense", data_packing("packing_500.csv"), box},
                                   {"simple cubic", lattice(Lattice::sc, 8), box},
                                   {"body centred", lattice(Lattice::bcc, 7), box},
                                   {"face centred", lattice(Lattice::fcc, 6), box}};
  for (const Sample& whole : wholes) {
    const Stages all = stages_of(whole.packing, box);
    const Stages part = stages_of(part_below(whole.packing, 0.85), box);
    ASSERT_LT(part.spheres.size(), all.spheres.size());
    inner_cells(all, 0.5).expect_equal(inner_cells(part, 0.5), whole.name);
    inner_throats(all, 0.5).expect_equal(inner_throats(part, 0.5), whole.name);
  }
}

// --------------------------------------------------------------------------------------- the order

TEST(Numbering, CellsAndFacetsBeginWithTheirLowestIdAndAreTurnedAlike) {
  for (const Sample& sample : samples()) {
    if (sample.box.any_periodic()) continue;
    const Stages s = stages_of(sample.packing, sample.box);
    for (const auto& cell : s.network.cell_vertices) {
      const bool three_spheres = pfv::is_wall(cell[3]) && !pfv::is_wall(cell[2]);
      for (int i = 1; i < 4; ++i) EXPECT_TRUE(pfv::precedes(cell[0], cell[i], s.spheres));
      EXPECT_TRUE(three_spheres || pfv::precedes(cell[1], cell[2], s.spheres)) << sample.name;
    }
    for (const auto& facet : s.network.facet_vertices)
      if (!pfv::is_wall(facet[2])) {
        EXPECT_TRUE(pfv::precedes(facet[0], facet[1], s.spheres));
        EXPECT_TRUE(pfv::precedes(facet[0], facet[2], s.spheres));
      }
  }
}

TEST(HilbertNumber, NeighboursAlongTheCurveAreNeighboursInSpace) {
  constexpr std::uint32_t edge = 16;  // the curve's first 16^3 places fill the lowest corner
  std::map<std::uint64_t, std::array<std::uint32_t, 3>> places;
  for (std::uint32_t x = 0; x < edge; ++x)
    for (std::uint32_t y = 0; y < edge; ++y)
      for (std::uint32_t z = 0; z < edge; ++z) places[pfv::hilbert_number({x, y, z})] = {x, y, z};
  ASSERT_EQ(places.size(), edge * edge * edge);
  EXPECT_EQ(places.begin()->first, 0u);
  EXPECT_EQ(places.rbegin()->first, edge * edge * edge - 1);
  for (auto here = places.begin(), next = std::next(here); next != places.end(); ++here, ++next) {
    int steps = 0;
    for (int axis = 0; axis < 3; ++axis)
      steps += std::abs(static_cast<int>(here->second[axis]) - static_cast<int>(next->second[axis]));
    EXPECT_EQ(steps, 1);
  }
  EXPECT_EQ(pfv::hilbert_number({65535, 0, 0}) >> 48, 0u);
}

}  // namespace
}  // namespace canonical_order_test

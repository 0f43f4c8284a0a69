// SPDX-License-Identifier: GPL-3.0-or-later
// Grains that have left the bed: the drag that a network of few pores leaves out.
#include "pfv/dense_packing.hpp"
#include "pfv/pfv.hpp"
#include "physics/bead_mobility.hpp"
#include "physics/open_water.hpp"
#include "support/boxes.hpp"
#include "support/containers.hpp"
#include "support/long_steps.hpp"
#include "support/packings.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace support;
using pfv::Coupling;
using pfv::Face;
using pfv::Wall;

constexpr double radius = 1e-3;  // m

pfv::Box tank(const Eigen::Vector3d& edges, const std::vector<Face>& open, Wall wall) {
  pfv::Box box;
  box.upper = edges;
  for (const Face face : pfv::all_faces) box[face].wall = wall;
  for (const Face face : open) box[face].boundary = pfv::Boundary::pressure(0.0);
  return box;
}

/// Drag on sphere k, over Stokes', when it alone moves in a box or container; column: along each axis.
template <class Room>
Eigen::Matrix3d drag_of(const Room& room, pfv::PackingArrays packing, int k, const pfv::Options& by = {}) {
  pfv::Flow flow(room, viscosity_one(), by);
  Eigen::Matrix3d drag;
  for (int axis = 0; axis < 3; ++axis) {
    packing.velocities.setZero(3, packing.radii.size());
    packing.velocities(axis, k) = 1.0;
    drag.col(axis) = -flow.evaluate(packing.view(), 1e-6).total.col(k) / (6.0 * pi * packing.radii[k]);
  }
  return drag;
}

Eigen::Matrix3d drag_alone(const pfv::Box& box, const Eigen::Vector3d& place) {
  return drag_of(box, packing_of({{place[0], place[1], place[2], radius}}), 0);
}

Eigen::Vector2d extremes(const Eigen::Matrix3d& drag) {
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(drag).eigenvalues();
  return {values[0], values[2]};
}

const std::vector<std::vector<Face>> tops{{Face::zhi}, {Face::zlo, Face::zhi}, {Face::xlo, Face::xhi},
                                          {Face::xlo, Face::xhi, Face::zhi}};

TEST(OpenWater, AGrainAloneHasStokesDragWhateverIsFarAway) {
  Random random(1);
  for (const auto& open : tops)
    for (const Wall wall : {Wall::symmetry, Wall::no_slip})
      for (int place = 0; place < 12; ++place) {
        const Eigen::Vector3d edges = radius * (Eigen::Vector3d::Constant(350.0) + 150.0 * random.in_cube());
        const Eigen::Vector3d at = random.in_cube(0.2, 0.8).cwiseProduct(edges);
        const Eigen::Vector2d drag = extremes(drag_alone(tank(edges, open, wall), at));
        EXPECT_GT(drag[0], 0.9) << open.size() << ' ' << at.transpose();
        EXPECT_LT(drag[1], 1.1) << open.size() << ' ' << at.transpose();
      }
}

// Drag over Stokes', exact: towards a plane Brenner (1961), Chemical Engineering Science 16, 242-251; along it Goldman,
// Cox & Brenner (1967), the same 22, 637-651.
TEST(OpenWater, NearAFloorItHasTheWallsCorrection) {
  struct Exact {
    double height, towards, along;
  };
  for (const auto& [height, towards, along] :
       {Exact{10.0677, 1.1252, 1.0591}, {3.7622, 1.4129, 1.1738}, {2.3524, 1.8375, 1.3079}, {1.5431, 3.0361, 1.5675}})
    for (const auto& open : {std::vector<Face>{Face::zhi}, std::vector<Face>{Face::xlo, Face::zhi}}) {
      const Eigen::Vector3d edges = radius * Eigen::Vector3d(600.0, 500.0, 400.0);
      const Eigen::Vector3d at(0.5 * edges[0], 0.5 * edges[1], height * radius);
      const Eigen::Matrix3d drag = drag_alone(tank(edges, open, Wall::no_slip), at);
      EXPECT_NEAR(drag(2, 2) / towards, 1.0, 0.05) << height;
      EXPECT_NEAR(drag(0, 0) / along, 1.0, 0.05) << height;
      EXPECT_NEAR(drag(1, 1) / along, 1.0, 0.05) << height;
    }
}

TEST(OpenWater, TheCorrectionsOfPlanesFadeAndAreBounded) {
  for (const auto kind : {pfv::PlaneKind::no_slip, pfv::PlaneKind::slip, pfv::PlaneKind::open}) {
    const auto far = pfv::mobility_beside_plane(kind, 1.0, 1e4), contact = pfv::mobility_beside_plane(kind, 1.0, 1.0),
               bound = pfv::mobility_beside_plane(kind, 1.0, 1.5);
    EXPECT_NEAR(far.along, 1.0, 1e-4);
    EXPECT_NEAR(far.towards, 1.0, 2e-4);
    EXPECT_EQ(contact.along, bound.along);
    EXPECT_EQ(contact.towards, bound.towards);
    EXPECT_GT(contact.towards, 0.2);
  }
}

pfv::Container open_prism(int sides) {
  pfv::Container container = prism(sides, 1.0, 20.0);
  container.faces[*container.face_named("top")].boundary = pfv::Boundary::pressure(0.0);
  return container;
}

// On the axis of a tube: Haberman & Sayre (1958), David Taylor Model Basin report 1143.
TEST(OpenWater, ManySidesAroundAGrainBrakeItAsARoundWallDoes) {
  for (const int sides : {8, 16, 32, 60})
    for (const double ratio : {0.02, 0.05, 0.1, 0.2}) {
      const double drag = drag_of(open_prism(sides), packing_of({{0.0, 0.0, 10.0, ratio}}), 0)(2, 2);
      const double cubed = std::pow(ratio, 3), fifth = std::pow(ratio, 5);
      const double exact = (1.0 - 0.75857 * fifth) /
                           (1.0 - 2.105 * ratio + 2.0865 * cubed - 1.7068 * fifth + 0.72603 * fifth * ratio);
      EXPECT_NEAR(drag / exact, 1.0, 0.02 + 0.5 * ratio) << sides << " sides, r/R " << ratio;
    }
}

// Off the axis of a tube, towards the wall, around and along, to first order in r/R (doc/open_water.py; along it as Brenner &
// Happel 1958, J. Fluid Mech. 4). What sides brake too much across is that opposite walls add up, as they do in a box.
TEST(OpenWater, ManySidesBrakeAGrainOffTheAxisAsARoundWallDoes) {
  constexpr double r = 0.02;
  struct Exact {
    double off;
    Eigen::Vector3d slope;
  };
  const std::vector<Exact> tube{{0.0, {1.8044, 1.8044, 2.1044}}, {0.4, {2.2707, 1.9722, 2.0440}},
                                {0.6, {3.1486, 2.3301, 2.1697}}, {0.8, {5.9284, 3.6067, 3.2317}}};
  for (const int sides : {16, 32, 60})
    for (const auto& [off, slope] : tube) {
      const double side = pi / sides;
      const Eigen::Vector3d towards(std::cos(side), std::sin(side), 0.0), up(0.0, 0.0, 1.0), along = up.cross(towards);
      const Eigen::Vector3d at = off * towards + 10.0 * up;
      const Eigen::Matrix3d drag = drag_of(open_prism(sides), packing_of({{at[0], at[1], at[2], r}}), 0);
      const Eigen::Vector3d over(towards.dot(drag * towards), along.dot(drag * along), up.dot(drag * up));
      const Eigen::Array3d found = (1.0 - over.array().inverse()) / (r * slope.array());
      EXPECT_GT(found.minCoeff(), 0.92) << sides << " sides, " << off << ": " << found.transpose();
      EXPECT_LT(found[2], 1.16) << sides << " sides, " << off << ": " << found.transpose();
      EXPECT_LT(found.maxCoeff(), 1.8) << sides << " sides, " << off << ": " << found.transpose();
    }
}

// Also where pores lie beyond the corner of two sides, of two grains, and for grains much smaller than the vessel. The plane
// in front alone brakes less: more walls only add to the dissipation (Hill & Power 1956).
TEST(OpenWater, ManySidesBrakeAGrainNoLessThanThePlaneInFront) {
  struct Grain {
    int sides;
    double radius, off;
  };
  std::vector<Grain> grains;
  for (const int sides : {6, 8, 32})
    for (const double off : {0.5, 0.75, 0.8, 0.85, 0.9}) grains.push_back({sides, 0.05, off});
  for (const int sides : {16, 32, 62})
    for (const double radii : {1.5, 2.0, 5.0}) grains.push_back({sides, 0.005, 1.0 - 0.005 * radii});
  for (const auto& [sides, r, off] : grains)
    for (const double turn : {0.0, 0.2, 0.5})  // from a corner to the middle of a side
      for (const bool two : {false, true}) {
        const double angle = 2.0 * pi * turn / sides, side = pi / sides;
        const Eigen::Vector3d at(off * std::cos(angle), off * std::sin(angle), 10.0), up(0.0, 0.0, 1.0),
            towards(std::cos(side), std::sin(side), 0.0), along = up.cross(towards);
        std::vector<Sphere> spheres{{at[0], at[1], at[2], r}};
        if (two) spheres.push_back({-0.5 * at[0], 0.2, 12.0, r});  // at rest
        const Eigen::Matrix3d drag = drag_of(open_prism(sides), packing_of(spheres), 0);
        const auto plane = pfv::mobility_beside_plane(pfv::PlaneKind::no_slip, r, 1.0 - at.dot(towards));
        const Eigen::Vector3d over(up.dot(drag * up) * plane.along, along.dot(drag * along) * plane.along,
                                   towards.dot(drag * towards) * plane.towards);
        // the open top, 10 R away, eases the way towards it by 3/4 r/10, with the sides' part of it 0.121 r
        EXPECT_GT(over.minCoeff(), 1.0 - 0.125 * r) << sides << " sides, " << at.transpose() << ": " << over.transpose();
        EXPECT_LT(over.maxCoeff(), 1.5) << sides << " sides, " << at.transpose() << ": " << over.transpose();
      }
}

// Two spheres that touch: Stimson & Jeffery (1926), 2 x 0.645 of one sphere's drag along their axis; Goldman, Cox &
// Brenner (1966), 2 x 0.725 across it.
TEST(OpenWater, BeadsOfABodyShareTheDragThatTheyHaveTogether) {
  pfv::Spheres pair;
  pair.centres.resize(3, 2);
  pair.centres << 0.0, 2.0, 0.0, 0.0, 0.0, 0.0;
  pair.radii = Eigen::Vector2d::Ones();
  const auto drags = pfv::drags_of_beads(pair, {0, 1});
  const Eigen::Matrix3d sum = drags[0] + drags[1];
  EXPECT_NEAR(sum(0, 0) / 1.290, 1.0, 0.06);
  EXPECT_NEAR(sum(1, 1) / 1.450, 1.0, 0.06);
  EXPECT_NEAR(sum(2, 2), sum(1, 1), 1e-12);
  pair.centres(0, 1) = 1e-9;  // one sphere written twice
  EXPECT_NEAR((pfv::drags_of_beads(pair, {0, 1})[0] + pfv::drags_of_beads(pair, {0, 1})[1]).trace(), 3.0, 1e-6);
  for (const double r : {0.3, 0.7, 1.5, 1.7})  // no jump where one enters the other
    EXPECT_NEAR((pfv::bead_mobility(1.0, 0.7, {r - 1e-9, 0, 0}) - pfv::bead_mobility(1.0, 0.7, {r + 1e-9, 0, 0})).norm(),
                0.0, 1e-7) << r;
}

TEST(OpenWater, ABodyOfTwoHasTheDragOfADumbbellInATank) {
  for (const auto& open : tops)
    for (const Wall wall : {Wall::symmetry, Wall::no_slip}) {
      pfv::PackingArrays pair = packing_of({{0.199, 0.19, 0.21, radius}, {0.201, 0.19, 0.21, radius}});
      pair.bodies = Eigen::VectorXi::Zero(2);
      pfv::Flow flow(tank(Eigen::Vector3d::Constant(0.4), open, wall), viscosity_one());
      for (int axis = 0; axis < 3; ++axis) {
        pair.velocities.setZero(3, 2);
        pair.velocities.row(axis).setOnes();
        const double force = -flow.evaluate(pair.view(), 1e-6).total.row(axis).sum();
        EXPECT_NEAR(force / (6.0 * pi * radius) / (axis == 0 ? 1.290 : 1.450), 1.0, 0.08) << axis;
      }
    }
}

pfv::PackingArrays cloud(int count, double fraction, std::uint64_t seed) {
  const double r = std::cbrt(fraction / (4.0 / 3.0 * pi * count));
  return random_packing(count, 0.8 * r, 1.1 * r, seed);
}

TEST(OpenWater, InACloudEveryGrainIsBrakedAtLeastAsAlone) {
  for (const double fraction : {1e-4, 0.01, 0.05})
    for (const Wall wall : {Wall::symmetry, Wall::no_slip}) {
      const pfv::PackingArrays packing = cloud(60, fraction, 3);
      for (int k = 0; k < 60; k += 7)
        EXPECT_GT(extremes(drag_of(tank({1, 1, 1}, {Face::zhi}, wall), packing, k))[0], 0.6) << fraction << ' ' << k;
    }
}

TEST(OpenWater, ADenseBedHasNone) {
  const pfv::PackingArrays bed = pfv::dense_packing(500, 0.6, 0.05);
  pfv::Options without;
  without.open_water = false;
  pfv::PackingArrays moving = bed;
  Random random(2);
  moving.velocities.resize(3, bed.radii.size());
  for (int k = 0; k < bed.radii.size(); ++k) moving.velocities.col(k) = random.in_cube();
  for (const Wall wall : {Wall::symmetry, Wall::no_slip}) {
    pfv::Flow with(upward_box(wall), viscosity_one()), off(upward_box(wall), viscosity_one(), without);
    const Eigen::Matrix3Xd forces = with.evaluate(moving.view(), 1e-3).total;
    EXPECT_EQ(forces, off.evaluate(moving.view(), 1e-3).total);
    EXPECT_EQ(with.report().counts.open_water, 0);
  }
}

/// Spheres of one size at random in a periodic cube, a solid fraction c of it.
pfv::PackingArrays periodic_cloud(int count, double fraction, std::uint64_t seed) {
  const double r = std::cbrt(fraction / (4.0 / 3.0 * pi * count));
  Random random(seed);
  std::vector<Sphere> placed;
  while (static_cast<int>(placed.size()) < count) {
    const Eigen::Vector3d x = random.in_cube(0.0, 1.0);
    const bool free = std::all_of(placed.begin(), placed.end(), [&](const Sphere& s) {
      Eigen::Vector3d apart = x - Eigen::Vector3d(s.x, s.y, s.z);
      apart -= apart.array().round().matrix();
      return apart.norm() > 2.0 * r;
    });
    if (free) placed.push_back({x[0], x[1], x[2], r});
  }
  return packing_of(placed);
}

/// Mean over the spheres of how fast one moves under a force on it alone, the others free, over Stokes'.
double own_mobility(const pfv::PackingArrays& of, bool shear) {
  pfv::PackingArrays packing = of;
  const Eigen::Index size = 3 * of.radii.size();
  pfv::Box box;
  box.periodic = {true, true, true};
  pfv::Options by;
  by.shear_viscous = shear;
  pfv::Flow flow(box, viscosity_one(), by);
  Eigen::MatrixXd drag(size, size);
  for (Eigen::Index c = 0; c < size; ++c) {
    packing.velocities.setZero(3, of.radii.size());
    packing.velocities(c % 3, c / 3) = 1.0;
    drag.col(c) = -flow.evaluate(packing.view(), 1e-6).total.reshaped() / (6.0 * pi * of.radii[0]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(0.5 * (drag + drag.transpose()));
  double sum = 0.0;  // but for what all do together
  for (const double value : parts.eigenvalues())
    if (value > 1e-8) sum += 1.0 / value;
  return sum / static_cast<double>(size);
}

// Short-time self-diffusion over that of a sphere alone: Ladd (1990), Journal of Chemical Physics 93, 3484-3494, and
// 1 - 1.83 c (Batchelor 1976) where dilute. Without shear forces grains that move past each other meet next to no
// resistance: the mobility is 10 to 40 times that.
TEST(OpenWater, WithShearForcesTheMobilityOfGrainsInACloudIsThatOfASuspension) {
  struct Reference {
    double fraction, mobility;
  };
  for (const auto& [fraction, mobility] : {Reference{0.01, 0.98}, {0.1, 0.82}, {0.2, 0.65}, {0.3, 0.48}}) {
    EXPECT_NEAR(own_mobility(periodic_cloud(40, fraction, 1), true) / mobility, 1.0, 0.2) << fraction;
    if (fraction > 0.15) {
      EXPECT_GT(own_mobility(periodic_cloud(40, fraction, 1), false), 4.0 * mobility) << fraction;
    }
  }
}

// What others lean on is braked by their reactions, and not by these on top of its own.
TEST(OpenWater, ReactionsOfOthersAreNotAddedToADragThatIsWhole) {
  for (const double fine : {1.0, 0.3, 0.1, 0.01})
    for (const double apart : {2.0, 20.0}) {
      const pfv::Box box = tank(Eigen::Vector3d::Constant(100.0 * radius), {Face::zhi}, Wall::symmetry);
      const pfv::PackingArrays pair = packing_of({{0.05, 0.045, 0.055, radius},
                                                  {0.05 + apart * radius, 0.046, 0.0555, fine * radius}});
      for (const int k : {0, 1}) {
        EXPECT_GT(extremes(drag_of(box, pair, k))[0], 0.8) << fine << ' ' << apart << ' ' << k;
        EXPECT_LT(extremes(drag_of(box, pair, k))[1], 1.7) << fine << ' ' << apart << ' ' << k;
      }
    }
  pfv::Box cell = tank(Eigen::Vector3d::Constant(100.0 * radius), {}, Wall::symmetry);
  cell.periodic = {true, true, true};
  const pfv::PackingArrays pair = packing_of({{0.02, 0.03, 0.05, radius}, {0.05, 0.045, 0.06, radius}});
  EXPECT_LT(extremes(drag_of(cell, pair, 0))[1], 1.3);
}

TEST(OpenWater, SaysHowManyGrainsItBrakes) {
  pfv::Flow flow(tank({1, 1, 1}, {Face::zhi}, Wall::symmetry), viscosity_one());
  pfv::PackingArrays packing = cloud(20, 1e-3, 1);
  packing.velocities = Eigen::Matrix3Xd::Constant(3, 20, 1.0);
  flow.evaluate(packing.view(), 1e-3);
  EXPECT_EQ(flow.report().counts.open_water, 20);
}

/// A cloud of 40 in open water, its faces moving with the container's.
struct Cloud {
  pfv::PackingArrays packing = cloud(40, 0.01, 5);
  pfv::Box box = tank({1, 1, 1}, {Face::zhi}, Wall::no_slip);
  pfv::Flow flow{box, viscosity_one()};

  Eigen::Matrix3Xd forces(const Eigen::Matrix3Xd& velocities) {
    packing.velocities = velocities;
    return flow.evaluate(packing.view(), 1e-3).total;
  }
  Eigen::Matrix3Xd motion(std::uint64_t seed) const {
    Random random(seed);
    Eigen::Matrix3Xd v(3, packing.radii.size());
    for (int k = 0; k < v.cols(); ++k) v.col(k) = random.in_cube();
    return v;
  }
};

// A plug: grains that go with the water that is driven through meet no resistance.
TEST(OpenWater, WaterThatIsDrivenThroughTakesTheGrainsAlong) {
  pfv::Box box = tank({1, 1, 1}, {Face::zhi}, Wall::symmetry);
  EXPECT_TRUE(pfv::is_still(box));
  box[Face::zlo].boundary = pfv::Boundary::flux(0.0);
  EXPECT_TRUE(pfv::is_still(box));
  box[Face::zlo].boundary = pfv::Boundary::flux(0.01);
  EXPECT_FALSE(pfv::is_still(box));
  box[Face::zlo].boundary = pfv::Boundary::pressure(0.0);
  EXPECT_TRUE(pfv::is_still(box));
  box[Face::zlo].boundary = pfv::Boundary::pressure(1.0);
  EXPECT_FALSE(pfv::is_still(box));
  box[Face::zlo].boundary = pfv::Boundary::flux(0.01);
  pfv::PackingArrays packing = cloud(40, 0.01, 5);
  packing.velocities = Eigen::Vector3d(0.0, 0.0, 0.01).replicate(1, 40);
  pfv::Flow flow(box, viscosity_one());
  EXPECT_LT(flow.evaluate(packing.view(), 1e-3).total.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(OpenWater, ActionsAndReactionsBalance) {
  Cloud run;
  Eigen::Vector3d sum = run.forces(run.motion(1)).rowwise().sum();
  const double scale = run.flow.forces().total.colwise().norm().sum();
  for (const auto& face : run.flow.face_forces()) sum += face;
  EXPECT_LT(sum.norm(), 1e-12 * scale);
}

TEST(OpenWater, ResistsReciprocallyAndFeedsNoMotion) {
  Cloud run;
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Eigen::Matrix3Xd one = run.motion(seed), other = run.motion(seed + 100);
    const Eigen::Matrix3Xd by_one = run.forces(one), by_other = run.forces(other);
    const double power = -by_one.cwiseProduct(one).sum();
    EXPECT_GT(power, 0.0);
    EXPECT_NEAR(by_one.cwiseProduct(other).sum(), by_other.cwiseProduct(one).sum(), 1e-10 * power);
  }
}

TEST(OpenWater, ATranslationOfEverythingMeetsNoResistance) {
  Cloud run;
  for (const Face face : pfv::all_faces) {
    const int axis = static_cast<int>(face) / 2;
    (axis == 2 ? run.box[face].velocity : run.box[face].sliding[2]) = 0.3;
  }
  run.flow.set_box(run.box);
  const double alone = 6.0 * pi * run.packing.radii.maxCoeff();
  const Eigen::Matrix3Xd up = Eigen::Vector3d(0.0, 0.0, 0.3).replicate(1, 40);
  EXPECT_LT(run.forces(up).colwise().norm().maxCoeff(), 1e-9 * alone);
}

/// A grain that falls from rest in a tank, under its weight less its lift.
struct Falling {
  pfv::PackingArrays packing = packing_of({{0.05, 0.04, 0.06, radius}});
  pfv::Flow flow;
  Eigen::VectorXd mass = Eigen::VectorXd::Constant(1, 2600.0 * 4.0 / 3.0 * pi * radius * radius * radius);
  Eigen::Matrix3Xd weight = Eigen::Vector3d(1e-5, 0.0, -2e-5);
  std::vector<pfv::Piston> pistons = std::vector<pfv::Piston>(6);

  explicit Falling(const std::vector<Face>& open = {Face::zhi})
      : flow(tank({0.1, 0.1, 0.1}, open, Wall::symmetry), viscosity_one()) {
    packing.velocities.setZero(3, 1);
  }
  double time() const { return mass[0] / (6.0 * pi * radius); }  ///< of Stokes' drag
  Eigen::Vector3d ends() const { return weight / (6.0 * pi * radius); }
  Eigen::Vector3d after(Coupling coupling, double dt, int steps) {
    const pfv::GrainDynamics dynamics{{mass.data(), 1}, {weight.data(), 3, 1}, pistons};
    for (int step = 0; step < steps; ++step) {
      const pfv::Forces& forces = coupling == Coupling::explicit_step
                                      ? flow.step(packing.view(), dt)
                                      : flow.advance(packing.view(), dt, pfv::Step::with(coupling, dynamics));
      packing.velocities += dt * (forces.total + weight) / mass[0];
    }
    return packing.velocities;
  }
};

TEST(OpenWater, FallsAsFastInLongStepsAsInShortOnes) {
  for (const auto& open : tops)
    for (const auto& [coupling, part, steps] :
         {std::tuple{Coupling::explicit_step, 0.1, 100}, {Coupling::staged, 20.0, 6}, {Coupling::implicit, 20.0, 20}}) {
    Falling run(open);
    const Eigen::Vector3d v = run.after(coupling, part * run.time(), steps);
    EXPECT_NEAR(v[0] / run.ends()[0], 1.0, 0.06) << static_cast<int>(coupling);
    EXPECT_NEAR(v[2] / run.ends()[2], 1.0, 0.06) << static_cast<int>(coupling);
  }
}

// What is kept from step to step forgets the faces where water begins to be driven through, on the same network.
TEST(OpenWater, LimitsAndFactorsFollowWaterThatBeginsToFlow) {
  const std::vector<Face> ends{Face::zlo, Face::zhi};
  pfv::Box driven = tank({0.1, 0.1, 0.1}, ends, Wall::symmetry);
  driven[Face::zlo].boundary = pfv::Boundary::pressure(1e-3);
  Falling run(ends);
  run.after(Coupling::implicit, run.time(), 1);
  EXPECT_LT(run.flow.time_step_limit(run.mass, run.pistons), 3.0 * run.time());
  run.flow.set_box(driven);
  run.after(Coupling::implicit, run.time(), 1);
  EXPECT_EQ(run.flow.report().counts.triangulate, 1);
  EXPECT_EQ(run.flow.time_step_limit(run.mass, run.pistons), std::numeric_limits<double>::infinity());
  run.packing.velocities.setZero();
  Falling fresh(ends);
  fresh.flow.set_box(driven);
  const Eigen::Vector3d found = run.after(Coupling::implicit, run.time(), 1);
  const Eigen::Vector3d wanted = fresh.after(Coupling::implicit, run.time(), 1);
  EXPECT_LT((found - wanted).norm(), 1e-9 * wanted.norm());
}

TEST(OpenWater, ItsLimitIsThatOfStokesDrag) {
  for (const auto& open : tops) {
    Falling run(open);
    run.flow.evaluate(run.packing.view(), 1.0);
    EXPECT_NEAR(run.flow.time_step_limit(run.mass, run.pistons) / (2.0 * run.time()), 1.0, 0.06);
  }
}

}  // namespace

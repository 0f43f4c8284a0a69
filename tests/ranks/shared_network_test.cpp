// SPDX-License-Identifier: GPL-3.0-or-later
// The network that several ranks make together is that of one rank, value for value.
#include "same_network.hpp"

#include "support/adversarial.hpp"
#include "support/containers.hpp"
#include "support/random_beds.hpp"

#include <gtest/gtest.h>
#include <string>

TEST(SharedNetwork, IsThatOfOneRankForADenseBed) {
  const pfv::PackingArrays bed = numbered(dense_bed(in_long(700, 250)));
  expect_same(bed, pfv::Box{}, every_deal);
}

TEST(SharedNetwork, IsThatOfOneRankForUnlikeSpheresAndVoids) {
  expect_same(numbered(support::random_packing(in_long(500, 200), 0.015, 0.075, 2)), pfv::Box{}, {Deal::by_place});
  expect_same(numbered(support::without_the_middle(dense_bed(in_long(1500, 400)), 0.35)), pfv::Box{}, {Deal::by_place});
}

TEST(SharedNetwork, IsThatOfOneRankForALatticeWhosePoresMerge) {
  for (const auto kind : {support::Lattice::sc, support::Lattice::fcc})
    expect_same(support::lattice(kind, in_long(5, 4)), pfv::Box{}, {Deal::by_place});
}

/// The hole that a grain leaves in such a lattice is one pore of twelve grains, whose own neighbours are far.
TEST(SharedNetwork, IsThatOfOneRankForPoresOfManyGrains) {
  const pfv::PackingArrays lattice = support::lattice(support::Lattice::fcc, 4, 0.93);
  for (const int gone : {37, 101, 150}) {
    std::vector<int> kept;
    for (int k = 0; k < static_cast<int>(lattice.ids.size()); ++k)
      if (k != gone) kept.push_back(k);
    expect_same(numbered(part_of(lattice, kept)), pfv::Box{}, {Deal::by_place, Deal::at_random});
  }
}

TEST(SharedNetwork, IsThatOfOneRankForAFewGrainsInMuchWater) {
  expect_same(numbered(support::random_packing(30, 0.02, 0.04, 3)), pfv::Box{}, {Deal::by_place});
  expect_same(numbered(support::random_packing(5, 0.02, 0.04, 3)), pfv::Box{}, {Deal::at_random});
  expect_same(numbered(support::random_packing(1, 0.02, 0.04, 3)), pfv::Box{}, {Deal::by_place});
}

TEST(SharedNetwork, IsThatOfOneRankInContainers) {
  support::Random random(5);
  const pfv::Container wedge = support::wedge(), prism = support::prism(7, 0.4, 1.0);
  const pfv::Container cylinder = support::cylinder({0.0, 0.0, 1.0}, {0.5, 0.5, 0.0}, 0.4, 1.0);
  for (const pfv::Container& container : {wedge, prism, cylinder})
    expect_same(numbered(support::spheres_in(container, in_long(300, 120), 0.06, random)), container, {Deal::by_place});
}

/// PFV_RANK_PACKINGS: how many.
TEST(SharedNetwork, IsThatOfOneRankForWhatIsHardToTriangulate) {
  const char* wanted = std::getenv("PFV_RANK_PACKINGS");
  const int count = wanted ? std::atoi(wanted) : in_long(200, 50);
  support::Random random(11);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("packing " + std::to_string(i));
    const auto kind = static_cast<std::size_t>(i) % (support::adversarial::kinds.size() + 1);
    const bool plain = kind == support::adversarial::kinds.size();
    const pfv::PackingArrays packing =
        numbered(plain ? support::random_packing(support::whole(random, 20, 150), 0.02, random(0.03, 0.09),
                                                 static_cast<std::uint64_t>(i))
                       : support::packing_of(support::adversarial::spheres_of(kind, random)));
    expect_same(packing, pfv::Box{}, {i % 2 ? Deal::at_random : Deal::by_place});
    if (HasFailure()) return;
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pfv/packing.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// Random beds in the unit cube whose spheres neither overlap nor cross a wall: small numbers of
/// spheres, every pair looked at. Same arguments, same bed.
namespace support {

class RandomBed {
 public:
  /// Radii in any unit; they are scaled to the solid fraction.
  RandomBed(std::vector<double> radii, double solid_fraction, bool periodic, std::uint64_t seed)
      : radii_(std::move(radii)), periodic_(periodic), generator_(seed) {
    const double scale = std::cbrt(solid_fraction / fraction());
    for (double& r : radii_) r *= scale;
    for (std::size_t k = 0; k < radii_.size(); ++k)
      centres_.emplace_back(uniform(), uniform(), uniform());
  }

  /// Moves overlapping spheres apart until no gap is below -`overlap` times the sum of radii, at most
  /// `sweeps` times.
  void push_apart(double overlap, int sweeps) {
    for (int sweep = 0; sweep < sweeps && smallest_distance() < 1.0 - overlap; ++sweep)
      for (int k = 0; k < count(); ++k) {
        for (int l = 0; l < count(); ++l) {
          if (l == k) continue;
          const Eigen::Vector3d apart = between(k, l);
          const double distance = apart.norm(), excess = radii_[k] + radii_[l] - distance;
          if (excess <= 0.0 || distance == 0.0) continue;
          centres_[k] += 0.5 * excess / distance * apart;
          centres_[l] -= 0.5 * excess / distance * apart;
        }
        if (periodic_)
          for (Eigen::Vector3d& centre : centres_) wrap(centre);
        else
          centres_[k] = centres_[k].cwiseMax(radii_[k]).cwiseMin(1.0 - radii_[k]);
      }
  }

  /// Radii such that the closest pair, or the sphere closest to a wall, keeps this gap (over the sum of
  /// radii).
  void set_smallest_gap(double gap) {
    const double scale = smallest_distance() / (1.0 + gap);
    for (double& r : radii_) r *= scale;
  }

  /// Hard-sphere Monte Carlo: as many trial moves a sphere as there are sweeps.
  void stir(int sweeps) {
    double step = 0.1 * radii_.front();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      int moved = 0;
      for (int trial = 0; trial < count(); ++trial) moved += try_move(step);
      step = std::clamp(step * (moved > 0.4 * count() ? 1.05 : 0.95), 1e-6, 0.2);
    }
  }

  /// Grows the radii by half a per cent at a time and pushes apart what then overlaps by more than a
  /// per mille; near jamming more of it may stay.
  void compress(double solid_fraction) {
    while (fraction() < solid_fraction) {
      const double scale = std::min(1.005, std::cbrt(solid_fraction / fraction()) * (1.0 + 1e-12));
      for (double& r : radii_) r *= scale;
      push_apart(1e-3, 2000);
    }
  }

  pfv::PackingArrays packing() const {
    pfv::PackingArrays packing;
    packing.ids = pfv::Packing::Ids::LinSpaced(count(), 1, count());
    packing.positions.resize(3, count());
    packing.radii.resize(count());
    for (int k = 0; k < count(); ++k) {
      packing.positions.col(k) = centres_[k];
      packing.radii[k] = radii_[k];
    }
    return packing;
  }

 private:
  int count() const { return static_cast<int>(radii_.size()); }
  double fraction() const {
    double cubes = 0.0;
    for (const double r : radii_) cubes += r * r * r;
    return 4.0 / 3.0 * 3.14159265358979323846 * cubes;
  }
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  static void wrap(Eigen::Vector3d& place) {
    for (int axis = 0; axis < 3; ++axis)
      place[axis] += (place[axis] < 0.0) - (place[axis] >= 1.0);
  }

  Eigen::Vector3d between(int k, int l) const {
    Eigen::Vector3d apart = centres_[k] - centres_[l];
    if (periodic_)  // centres stay in the cell
      for (int axis = 0; axis < 3; ++axis)
        apart[axis] -= (apart[axis] > 0.5) - (apart[axis] < -0.5);
    return apart;
  }

  double smallest_distance() const {
    double smallest = 2.0;
    for (int k = 0; k < count(); ++k) {
      for (int l = 0; l < k; ++l)
        smallest = std::min(smallest, between(k, l).norm() / (radii_[k] + radii_[l]));
      if (!periodic_)
        smallest = std::min(smallest, std::min(centres_[k].minCoeff(),
                                               1.0 - centres_[k].maxCoeff()) / radii_[k]);
    }
    return smallest;
  }

  bool try_move(double step) {
    const int k = static_cast<int>(generator_() % radii_.size());
    const Eigen::Vector3d before = centres_[k];
    for (int axis = 0; axis < 3; ++axis) centres_[k][axis] += step * (2.0 * uniform() - 1.0);
    if (periodic_) wrap(centres_[k]);
    for (int l = 0; l < count(); ++l)
      if (l != k && between(k, l).squaredNorm() < std::pow(radii_[k] + radii_[l], 2)) {
        centres_[k] = before;
        return false;
      }
    return true;
  }

  std::vector<double> radii_;
  bool periodic_;
  std::mt19937_64 generator_;
  std::vector<Eigen::Vector3d> centres_;
};

struct NamedBed {
  std::string name;
  pfv::PackingArrays packing;
  bool periodic;
};

/// Radii that fall evenly from 1 to 1 / ratio.
inline std::vector<double> graded_radii(int spheres, double ratio) {
  std::vector<double> radii;
  for (int k = 0; k < spheres; ++k)
    radii.push_back(1.0 - (1.0 - 1.0 / ratio) * k / (spheres - 1));
  return radii;
}

inline pfv::PackingArrays bed_between_walls(std::vector<double> radii, double solid_fraction) {
  RandomBed bed(std::move(radii), solid_fraction, false, 1);
  bed.push_apart(0.002, 20000);
  bed.set_smallest_gap(0.02);
  return bed.packing();
}

inline pfv::PackingArrays without_the_middle(const pfv::PackingArrays& packing, double radius) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < packing.radii.size(); ++k)
    if ((packing.positions.col(k).array() - 0.5).matrix().norm() > radius) kept.push_back(k);
  pfv::PackingArrays rest;
  const auto n = static_cast<Eigen::Index>(kept.size());
  rest.ids = pfv::Packing::Ids::LinSpaced(n, 1, n);
  rest.positions = packing.positions(Eigen::all, kept);
  rest.radii = packing.radii(kept);
  return rest;
}

/// Equal hard spheres in a periodic cell, stirred at a solid fraction of 0.5 or less; denser ones are
/// compressed from there too fast to crystallise, and stirred again.
inline pfv::PackingArrays periodic_bed(double solid_fraction, std::uint64_t seed) {
  RandomBed bed(std::vector<double>(300, 1.0), std::min(solid_fraction, 0.5), true, seed);
  bed.push_apart(1e-3, 5000);
  if (solid_fraction > 0.5) {
    bed.set_smallest_gap(0.0);
    bed.stir(3000);
    bed.compress(solid_fraction);
  }
  if (solid_fraction <= 0.6) {  // beyond, what touches cannot move
    bed.set_smallest_gap(0.0);
    bed.stir(3000);
  }
  return bed.packing();
}

/// The beds of doc/accuracy.md that come from no discrete-element run. Those between walls keep gaps of
/// 2 % of the sum of radii, so that finite elements can mesh them.
inline std::vector<NamedBed> random_beds() {
  std::vector<NamedBed> beds;
  std::vector<double> two_sizes(76, 0.25);
  std::fill_n(two_sizes.begin(), 6, 1.0);
  const pfv::PackingArrays fifty_four = bed_between_walls(graded_radii(54, 2.0), 0.5);
  beds.push_back({"bed_25", bed_between_walls(graded_radii(25, 2.0), 0.46), false});
  beds.push_back({"bed_54", fifty_four, false});
  beds.push_back({"bed_200", bed_between_walls(graded_radii(200, 2.0), 0.54), false});
  beds.push_back({"bed_two_sizes", bed_between_walls(two_sizes, 0.5), false});
  beds.push_back({"bed_cavity", without_the_middle(fifty_four, 0.27), false});
  for (const int percent : {30, 40, 50, 55, 60, 63, 64})
    beds.push_back(
        {"bed_periodic_" + std::to_string(percent), periodic_bed(0.01 * percent, 1), true});
  return beds;
}

}  // namespace support

// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/sphere_records.hpp"

#include "network/grains.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace pfv {

namespace {

constexpr int record = 13;  // id, position, radius, velocity, spin, displaced volume, body

}  // namespace

SphereArrays arrays_of_all(const Packing& packing, const Ranks& ranks) {
  Eigen::Vector4d has(packing.velocities.cols() > 0, packing.angular_velocities.cols() > 0,
                      packing.displaced_volumes.size() > 0, has_bodies(packing));
  ranks.take_largest(has.data(), 4);
  return {has[0] > 0.0, has[1] > 0.0, has[2] > 0.0, has[3] > 0.0};
}

void append_sphere(Ranks::Bytes& bytes, const Packing& packing, Eigen::Index k) {
  std::array<double, record> values{};
  std::memcpy(values.data(), packing.ids.data() + k, sizeof(double));
  const auto put = [&](std::size_t place, const auto& columns) {
    for (int i = 0; i < 3 && columns.cols() > 0; ++i) values[place + static_cast<std::size_t>(i)] = columns(i, k);
  };
  put(1, packing.positions);
  values[4] = packing.radii[k];
  put(5, packing.velocities);
  put(8, packing.angular_velocities);
  values[11] = displaced_volume(packing, k);
  values[12] = body_of(packing, k);
  append(bytes, values.data(), record);
}

Eigen::Index spheres_in(const Ranks::Bytes& bytes) {
  return static_cast<Eigen::Index>(bytes.size() / (record * sizeof(double)));
}

void resize(PackingArrays& packing, const SphereArrays& arrays, Eigen::Index count) {
  packing.ids.conservativeResize(count);
  packing.positions.conservativeResize(3, count);
  packing.radii.conservativeResize(count);
  packing.velocities.conservativeResize(3, arrays.velocities ? count : 0);
  packing.angular_velocities.conservativeResize(3, arrays.spins ? count : 0);
  packing.displaced_volumes.conservativeResize(arrays.displaced ? count : 0);
  packing.bodies.conservativeResize(arrays.bodies ? count : 0);
}

void take_spheres(PackingArrays& packing, const Ranks::Bytes& bytes, Eigen::Index first) {
  const std::vector<double> values = values_in<double>(bytes);
  const Eigen::Map<const Eigen::MatrixXd> rows(values.data(), record, spheres_in(bytes));
  const Eigen::Index count = rows.cols();
  for (Eigen::Index k = 0; k < count; ++k) std::memcpy(packing.ids.data() + first + k, values.data() + record * k, sizeof(double));
  packing.positions.middleCols(first, count) = rows.middleRows<3>(1);
  packing.radii.segment(first, count) = rows.row(4);
  if (packing.velocities.cols() > 0) packing.velocities.middleCols(first, count) = rows.middleRows<3>(5);
  if (packing.angular_velocities.cols() > 0) packing.angular_velocities.middleCols(first, count) = rows.middleRows<3>(8);
  if (packing.displaced_volumes.size() > 0) packing.displaced_volumes.segment(first, count) = rows.row(11);
  if (packing.bodies.size() > 0) packing.bodies.segment(first, count) = rows.row(12).cast<int>();
}

PackingArrays handed_over(const Packing& packing, const std::vector<std::vector<int>>& sent, std::vector<int>& received,
                          const Ranks& ranks) {
  const std::size_t piece = std::max<std::size_t>(256, 16384 / sent.size());
  std::vector<Ranks::Bytes> to(sent.size());
  std::size_t most = 0;
  for (std::size_t r = 0; r < sent.size(); ++r) {
    const int size = static_cast<int>(sent[r].size());
    append(to[r], &size, 1);
    most = std::max(most, sent[r].size());
  }
  most = static_cast<std::size_t>(ranks.largest(static_cast<double>(most)));
  received.clear();
  std::vector<Eigen::Index> next{0};
  for (const Ranks::Bytes& bytes : ranks.hand_over(to)) {
    received.push_back(values_in<int>(bytes)[0]);
    next.push_back(next.back() + received.back());
  }
  PackingArrays all;
  resize(all, arrays_of_all(packing, ranks), next.back());
  for (std::size_t begin = 0; begin < most; begin += piece) {
    for (std::size_t r = 0; r < sent.size(); ++r) {
      to[r].clear();
      for (std::size_t k = begin; k < std::min(begin + piece, sent[r].size()); ++k) append_sphere(to[r], packing, sent[r][k]);
    }
    const std::vector<Ranks::Bytes> from = ranks.hand_over(to);
    for (std::size_t r = 0; r < from.size(); ++r) {
      if (!from[r].empty()) take_spheres(all, from[r], next[r]);
      next[r] += spheres_in(from[r]);
    }
  }
  return all;
}

PackingArrays columns_of(const PackingArrays& packing, const std::vector<int>& columns) {
  const auto three = [&](const Eigen::Matrix3Xd& values) {
    return values.cols() > 0 ? Eigen::Matrix3Xd(values(Eigen::all, columns)) : Eigen::Matrix3Xd(3, 0);
  };
  const auto one = [&](const auto& values) {
    using Values = std::decay_t<decltype(values)>;
    return values.size() > 0 ? Values(values(columns)) : Values();
  };
  return {one(packing.ids),        three(packing.positions),          one(packing.radii),
          three(packing.velocities), three(packing.angular_velocities), one(packing.displaced_volumes),
          one(packing.bodies)};
}

}  // namespace pfv

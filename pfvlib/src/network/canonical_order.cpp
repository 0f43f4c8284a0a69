// SPDX-License-Identifier: GPL-3.0-or-later
#include "network/canonical_order.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace pfv {

namespace {

constexpr int curve_bits = 16;

/// Bits b, a, ... of a number of 16 bits -> b00a00 ...
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000ff0000ffu;
  x = (x | x << 8) & 0x00f00f00f00fu;
  x = (x | x << 4) & 0x0c30c30c30c3u;
  return (x | x << 2) & 0x249249249249u;
}

std::array<std::uint32_t, 3> grid_place(const Spheres& spheres, int k, double per_metre) {
  std::array<std::uint32_t, 3> place;
  for (int axis = 0; axis < 3; ++axis) {
    const double inside =
        std::min(std::max(spheres.centres(axis, k), 0.0), spheres.edges[axis]) * per_metre;
    place[axis] = std::min(static_cast<std::uint32_t>(inside), (1u << curve_bits) - 1);
  }
  return place;
}

/// A cell by the places of its spheres along the curve.
struct Name {
  std::array<int, 3> rest;  ///< after the first, ascending
  int cell;
  bool operator<(const Name& other) const { return rest < other.rest; }
};

/// Ascending; walls as numbers beyond all spheres.
std::array<int, 4> sorted(const std::array<Vertex, 4>& cell, int spheres) {
  std::array<int, 4> v;
  for (int i = 0; i < 4; ++i) v[i] = is_wall(cell[i]) ? spheres + wall_number(cell[i]) : cell[i];
  const auto order = [&](int i, int j) {
    const int low = std::min(v[i], v[j]), high = std::max(v[i], v[j]);
    v[i] = low;
    v[j] = high;
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  return v;
}

}  // namespace

std::uint64_t hilbert_number(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t top = 1u << (curve_bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (int i = 0; i < 3; ++i) {
      // bit set: turn the lower bits of x[0] round; else exchange those of x[0] and x[i]
      const std::uint32_t set = x[i] & q ? below : 0u;
      const std::uint32_t exchanged = (x[0] ^ x[i]) & (below ^ set);
      x[0] ^= set | exchanged;
      x[i] ^= exchanged;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t gray = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1) gray ^= x[2] & q ? q - 1 : 0u;
  return spread(x[0] ^ gray) << 2 | spread(x[1] ^ gray) << 1 | spread(x[2] ^ gray);
}

std::vector<std::uint64_t> curve_numbers(const Spheres& spheres) {
  const double per_metre = (1u << curve_bits) / spheres.edges.maxCoeff();
  std::vector<std::uint64_t> numbers(spheres.size());
  for (int k = 0; k < spheres.size(); ++k) numbers[k] = hilbert_number(grid_place(spheres, k, per_metre));
  return numbers;
}

std::vector<Vertex> along_curve(const Spheres& spheres) {
  const std::vector<std::uint64_t> numbers = curve_numbers(spheres);
  std::vector<std::pair<std::uint64_t, Vertex>> numbered(spheres.size());
  for (int k = 0; k < spheres.size(); ++k) numbered[k] = {numbers[k], k};
  std::sort(numbered.begin(), numbered.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : precedes(a.second, b.second, spheres);
  });
  std::vector<Vertex> order(spheres.size());
  for (int k = 0; k < spheres.size(); ++k) order[k] = numbered[k].second;
  return order;
}

void arrange(std::array<Vertex, 4>& vertices, std::array<int, 4>& opposite,
             const Spheres& spheres) {
  bool odd = false;
  const auto exchange = [&](int i, int j) {
    std::swap(vertices[i], vertices[j]);
    std::swap(opposite[i], opposite[j]);
    odd = !odd;
  };
  const auto order = [&](int i, int j) {
    if (precedes(vertices[j], vertices[i], spheres)) exchange(i, j);
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  if (!odd) return;
  const bool three_spheres = is_wall(vertices[3]) && !is_wall(vertices[2]);
  three_spheres ? exchange(1, 2) : exchange(2, 3);
}

std::vector<int> order_of_cells(const std::vector<std::array<Vertex, 4>>& cells, int spheres) {
  std::vector<std::array<int, 4>> all(cells.size());
  std::vector<int> begin(spheres + 1, 0);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    all[c] = sorted(cells[c], spheres);
    ++begin[all[c][0] + 1];
  }
  for (int k = 0; k < spheres; ++k) begin[k + 1] += begin[k];
  std::vector<Name> names(cells.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t c = 0; c < cells.size(); ++c)
    names[next[all[c][0]]++] = {{all[c][1], all[c][2], all[c][3]}, static_cast<int>(c)};
  for (int k = 0; k < spheres; ++k)
    std::sort(names.begin() + begin[k], names.begin() + begin[k + 1]);
  std::vector<int> order(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) order[c] = names[c].cell;
  return order;
}

CellName cell_name(const std::array<Vertex, 4>& cell, const Spheres& spheres) {
  CellName name;
  for (int i = 0; i < 4; ++i)
    name[i] = is_wall(cell[i]) ? std::numeric_limits<std::int64_t>::min() + wall_number(cell[i]) : spheres.ids[cell[i]];
  std::sort(name.begin(), name.end());
  return name;
}

void sort_by_ids(std::vector<int>& columns, const Spheres& spheres) {
  std::sort(columns.begin(), columns.end(),
            [&](int a, int b) { return spheres.ids[a] < spheres.ids[b]; });
}

}  // namespace pfv

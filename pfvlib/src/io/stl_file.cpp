// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/error.hpp"
#include "pfv/obstacle.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

namespace pfv {

namespace {

constexpr std::size_t stl_header = 84, stl_record = 50;  // bytes: text and number of triangles; one of them

bool is_binary_stl(const std::string& bytes) {
  if (bytes.size() < stl_header) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, &bytes[80], sizeof count);
  return bytes.size() == stl_header + stl_record * static_cast<std::size_t>(count);
}

std::vector<Triangle> binary_triangles(const std::string& bytes) {
  std::vector<Triangle> triangles((bytes.size() - stl_header) / stl_record);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    float corners[9];
    std::memcpy(corners, &bytes[stl_header + stl_record * t + 12], sizeof corners);
    triangles[t] = Eigen::Map<const Eigen::Matrix3f>(corners).cast<double>();
  }
  return triangles;
}

std::vector<Triangle> text_triangles(const std::string& bytes, const std::string& path) {
  std::vector<Triangle> triangles;
  std::istringstream lines(bytes);
  std::string line;
  int corner = 0, number = 0;
  Triangle triangle;
  const auto fail = [&](const std::string& what) {
    throw InputError(path + ", line " + std::to_string(number) + ": " + what);
  };
  while (std::getline(lines, line)) {
    ++number;
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "vertex") {
      if (corner == 3) fail("a facet has more than three corners; write triangles");
      for (int axis = 0; axis < 3; ++axis)
        if (!(words >> triangle(axis, corner))) fail("`vertex` must be followed by three numbers");
      ++corner;
    } else if (word == "endfacet") {
      if (corner != 3) fail("a facet ends with " + std::to_string(corner) + " corners instead of three");
      triangles.push_back(triangle);
      corner = 0;
    }
  }
  if (corner != 0) fail("the file ends within a facet");
  return triangles;
}

}  // namespace

std::vector<Triangle> read_stl(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened");
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::vector<Triangle> triangles = is_binary_stl(bytes) ? binary_triangles(bytes) : text_triangles(bytes, path);
  if (triangles.empty()) throw InputError(path + ": it has no triangles; give an STL file, text or binary");
  return triangles;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pfv::detail {

template <class Number>
struct VtkType;
template <>
struct VtkType<double> {
  static constexpr const char* name = "Float64";
};
template <>
struct VtkType<std::int64_t> {
  static constexpr const char* name = "Int64";
};
template <>
struct VtkType<std::uint8_t> {
  static constexpr const char* name = "UInt8";
};

/// A VTK XML unstructured grid with one piece and its arrays appended as raw binary: the head is
/// text, the arrays follow in the order in which they were added, each after its length in bytes.
class VtuFile {
 public:
  VtuFile(std::int64_t points, std::int64_t cells) {
    constexpr std::uint16_t one = 1;
    const bool little = *reinterpret_cast<const unsigned char*>(&one) == 1;
    head_ = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\""
            " byte_order=\"" + std::string(little ? "LittleEndian" : "BigEndian") +
            "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
            std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n";
  }

  /// Points, Cells, PointData or CellData.
  void begin(const char* section) { head_ += std::string("<") + section + ">\n"; }
  void end(const char* section) { head_ += std::string("</") + section + ">\n"; }

  /// `numbers` times `components` values.
  template <class Number>
  void add(const char* name, const Number* values, std::int64_t numbers, int components = 1) {
    append(VtkType<Number>::name, name, components, values,
           static_cast<std::uint64_t>(numbers) * components * sizeof(Number));
  }

  /// Texts, each ended by a zero.
  void add(const char* name, const std::vector<std::string>& texts) {
    std::string all;
    for (const std::string& text : texts) all.append(text.c_str(), text.size() + 1);
    append("String", name, 1, all.data(), all.size());
  }

  std::string text() const {
    return head_ + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" + arrays_ +
           "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  void append(const char* type, const char* name, int components, const void* values, std::uint64_t bytes) {
    head_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(arrays_.size()) + "\"/>\n";
    arrays_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    if (bytes > 0) arrays_.append(static_cast<const char*>(values), bytes);
  }

  std::string head_, arrays_;
};

}  // namespace pfv::detail

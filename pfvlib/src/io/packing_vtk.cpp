// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres as points of VTK files: legacy ones as LIGGGHTS writes them, .vtu and .vtp as ParaView, YADE and we do.
#include "io/packing_formats.hpp"
#include "io/sphere_table.hpp"
#include "parallel/one_rank.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

namespace pfv::detail {
namespace {

/// Values of all points one after the other.
struct Field {
  std::string name;
  std::vector<double> values;
};

struct Points {
  std::size_t count = 0;
  std::vector<double> places;
  std::vector<Field> fields;
};

const Field* field_named(const Points& points, std::initializer_list<const char*> names) {
  for (const std::string name : names)
    for (const Field& field : points.fields)
      if (plain_name(field.name) == name) return &field;
  return nullptr;
}

Eigen::Matrix3Xd vectors(const Points& points, std::initializer_list<const char*> names) {
  const Field* field = field_named(points, names);
  if (!field || field->values.size() != 3 * points.count) return Eigen::Matrix3Xd(3, 0);
  return Eigen::Map<const Eigen::Matrix3Xd>(field->values.data(), 3, static_cast<Eigen::Index>(points.count));
}

void require_finite(const std::string& path, const PackingArrays& packing) {
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
    if (!packing.positions.col(k).allFinite() || !(packing.radii[k] > 0.0) || !std::isfinite(packing.radii[k]))
      throw InputError(path + ": point " + std::to_string(k + 1) +
                       " has a place that is not finite or a radius that is not a positive number");
}

PackingFile spheres_of(const std::string& path, const Points& points) {
  if (points.count == 0) throw InputError(path + ": holds no points");
  const Field* radii = field_named(points, {"radius", "radii", "r", "rad"});
  const Field* diameters = radii ? nullptr : field_named(points, {"diameter", "diam", "d"});
  const Field* sizes = radii ? radii : diameters;
  if (!sizes || sizes->values.size() != points.count) {
    std::string names;
    for (const Field& field : points.fields) names += (names.empty() ? "" : ", ") + field.name;
    throw InputError(path + (sizes ? ": its field " + sizes->name + " has " + std::to_string(sizes->values.size()) +
                                         " values for " + std::to_string(points.count) + " points"
                                   : ": its points have no radius or diameter; there are " +
                                         (names.empty() ? std::string("no fields") : names)) +
                     ": give spheres, not a mesh or another result");
  }
  const auto n = static_cast<Eigen::Index>(points.count);
  PackingFile file;
  PackingArrays& packing = file.packing;
  packing.positions = Eigen::Map<const Eigen::Matrix3Xd>(points.places.data(), 3, n);
  packing.radii = Eigen::Map<const Eigen::VectorXd>(sizes->values.data(), n) * (radii ? 1.0 : 0.5);
  packing.velocities = vectors(points, {"v", "velocity", "vel", "linvelvec", "linvel"});
  packing.angular_velocities = vectors(points, {"omega", "angular_velocity", "angvelvec", "angvel"});
  packing.ids.resize(n);
  const Field* ids = field_named(points, {"id", "ids", "tag"});
  if (ids && ids->values.size() != points.count) ids = nullptr;
  constexpr double largest_id = 9e15;  // that a double holds as a whole number
  for (Eigen::Index k = 0; ids && k < n; ++k)
    if (!(std::abs(ids->values[k]) < largest_id) || ids->values[k] != std::floor(ids->values[k]))
      throw InputError(path + ": the id of point " + std::to_string(k + 1) + " is no whole number");
  for (Eigen::Index k = 0; k < n; ++k) packing.ids[k] = ids ? std::llround(ids->values[k]) : k + 1;
  if (!ids) file.remarks.push_back("there are no ids: the spheres are numbered from 1 in their order");
  require_finite(path, packing);
  refuse_equal_ids(path, {packing.ids.data(), packing.ids.data() + n}, {}, ranks_or_one(nullptr));
  return file;
}

// ------------------------------------------------------------------------------------------ legacy

/// Words of a legacy file one after the other.
class WordReader {
 public:
  WordReader(std::string path, std::string_view text) : path_(std::move(path)), rest_(text) {}

  bool next() {
    const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return false;
    rest_.remove_prefix(begin);
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    word_ = rest_.substr(0, end);
    rest_.remove_prefix(end);
    taken_ = false;
    return true;
  }
  std::string_view word() const { return word_; }
  /// Whether the file ends, without a blank, in a number that was taken or in what may be part of a keyword; a number
  /// of what is left out, as of METADATA or CELL_DATA, may end as it likes.
  bool may_be_cut_off() const {
    return rest_.empty() && !word_.empty() && (taken_ || !finite_number(word_));
  }
  std::string_view take(const char* what) {
    if (!next()) throw InputError(path_ + ": is cut off before " + what);
    return word_;
  }
  std::size_t take_count(const char* what) {
    const auto number = integer(take(what));
    if (!number || *number < 0) throw InputError(path_ + ": " + what + " is " + detail::quoted(word_) + ": give a whole number");
    return static_cast<std::size_t>(*number);
  }
  std::vector<double> take_numbers(std::size_t count, const std::string& what) {
    std::vector<double> numbers;
    numbers.reserve(std::min(count, rest_.size()));
    for (std::size_t k = 0; k < count; ++k) {
      const auto number = finite_number(take("all of its numbers"));
      if (!number) throw InputError(path_ + ": " + what + " holds " + detail::quoted(word_) + ", which is no finite number");
      numbers.push_back(*number);
    }
    taken_ = true;
    return numbers;
  }

 private:
  std::string path_;
  std::string_view rest_, word_;
  bool taken_ = false;  ///< the word, as the last of the numbers asked for
};

/// `SCALARS name type [components]`, `VECTORS name type`, `FIELD name count` with its arrays.
void read_point_data(WordReader& words, Points& points) {
  while (words.next()) {
    if (words.word() == "CELL_DATA") return;
    if (words.word() == "SCALARS") {
      const std::string name(words.take("a name"));
      words.take("a type");
      std::size_t components = 1;
      if (words.take("LOOKUP_TABLE") != "LOOKUP_TABLE") {
        components = static_cast<std::size_t>(integer(words.word()).value_or(1));
        words.take("LOOKUP_TABLE");
      }
      words.take("a table's name");
      points.fields.push_back({name, words.take_numbers(components * points.count, name)});
    } else if (words.word() == "VECTORS" || words.word() == "NORMALS") {
      const std::string name(words.take("a name"));
      words.take("a type");
      points.fields.push_back({name, words.take_numbers(3 * points.count, name)});
    } else if (words.word() == "FIELD") {
      words.take("a name");
      for (std::size_t k = words.take_count("the number of fields"); k > 0; --k) {
        const std::string name(words.take("a field's name"));
        const std::size_t components = words.take_count("components"), tuples = words.take_count("tuples");
        words.take("a type");
        points.fields.push_back({name, words.take_numbers(components * tuples, name)});
      }
    }
  }
}

// --------------------------------------------------------------------------------------------- XML

using Tree = boost::property_tree::ptree;

std::string decoded_base64(const std::string& path, std::string_view text) {
  std::string bytes;
  unsigned buffer = 0;
  int bits = 0;
  for (const char c : text) {
    int value = -1;
    if (c >= 'A' && c <= 'Z') value = c - 'A';
    if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
    if (c >= '0' && c <= '9') value = c - '0' + 52;
    if (c == '+') value = 62;
    if (c == '/') value = 63;
    if (c == '=' || c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    if (value < 0) throw InputError(path + ": its base64 data hold " + detail::quoted(std::string(1, c)));
    buffer = (buffer << 6 | static_cast<unsigned>(value)) & 0xFFFFFFu;
    if ((bits += 6) >= 8) bytes += static_cast<char>(buffer >> (bits -= 8) & 0xFFu);
  }
  return bytes;
}

/// A .vtu or .vtp file: how its arrays are stored.
class XmlArrays {
 public:
  XmlArrays(const std::string& path, const Tree& file, std::string_view appended, bool appended_is_raw)
      : path_(path), appended_(appended), appended_is_raw_(appended_is_raw) {
    if (file.get<std::string>("<xmlattr>.byte_order", "LittleEndian") != "LittleEndian")
      throw InputError(path + ": its byte order is not LittleEndian; write it anew");
    wide_header_ = file.get<std::string>("<xmlattr>.header_type", "UInt32") == "UInt64";
    const std::string compressor = file.get<std::string>("<xmlattr>.compressor", "");
    compressed_ = !compressor.empty();
    if (compressed_ && compressor != "vtkZLibDataCompressor")
      throw InputError(path + ": it is packed by " + compressor + "; write it with zlib or as ASCII");
  }

  std::vector<double> values(const Tree& array) const {
    const std::string format = array.get<std::string>("<xmlattr>.format", "ascii");
    const std::string type = array.get<std::string>("<xmlattr>.type", "");
    if (format == "ascii") return numbers(array.data());
    const bool raw = format == "appended" && appended_is_raw_;
    std::string_view stored = array.data();
    if (format == "appended") {
      const auto offset = array.get<std::size_t>("<xmlattr>.offset", 0);
      if (offset > appended_.size()) fail();
      stored = appended_.substr(offset);
    } else {
      stored = trimmed(stored.substr(std::min(stored.find_first_not_of(" \t\r\n"), stored.size())));
    }
    return converted(type, compressed_ ? unpacked(stored, raw) : plain(stored, raw));
  }

 private:
  [[noreturn]] void fail() const { throw InputError(path_ + ": its data are cut off or garbled; write it anew"); }
  std::size_t word() const { return wide_header_ ? 8 : 4; }

  std::size_t header(const std::string& bytes, std::size_t index) const {
    if (bytes.size() < (index + 1) * word()) fail();
    std::uint64_t wide = 0;
    std::memcpy(&wide, bytes.data() + index * word(), word());
    return static_cast<std::size_t>(wide);
  }

  std::string bytes_of(std::string_view stored, std::size_t from, std::size_t count, bool raw) const {
    if (from > stored.size() || count > stored.size() - from) fail();
    if (raw) {
      if (from + count > stored.size()) fail();
      return std::string(stored.substr(from, count));
    }
    std::string bytes = decoded_base64(path_, stored.substr(0, (from + count + 2) / 3 * 4));
    if (bytes.size() < from + count) fail();
    return bytes.substr(from, count);
  }

  /// A length in bytes and the bytes.
  std::string plain(std::string_view stored, bool raw) const {
    const std::size_t length = header(bytes_of(stored, 0, word(), raw), 0);
    if (length > stored.size()) fail();
    return bytes_of(stored, word(), length, raw);
  }

  /// Number of blocks, their size, the last one's, and each one's packed size; then the blocks.
  std::string unpacked(std::string_view stored, bool raw) const {
    const std::string first = bytes_of(stored, 0, 3 * word(), raw);
    const std::size_t blocks = header(first, 0), size = header(first, 1), last = header(first, 2);
    if (blocks > stored.size()) fail();
    const std::size_t head = (3 + blocks) * word();
    const std::string sizes = bytes_of(stored, 0, head, raw);
    // base64 pads the header on its own
    const std::string_view rest = stored.substr(std::min(stored.size(), raw ? head : (head + 2) / 3 * 4));
    std::size_t all = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t one = header(sizes, 3 + b);
      if (one > stored.size() - all) fail();
      all += one;
    }
    const std::string packed = bytes_of(rest, 0, all, raw);
    std::string result;
    std::size_t from = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      uLongf length = b + 1 == blocks && last > 0 ? last : size;
      if (length / 1100 > stored.size()) fail();  // zlib packs no tighter
      std::string block(length, '\0');
      if (uncompress(reinterpret_cast<Bytef*>(block.data()), &length,
                     reinterpret_cast<const Bytef*>(packed.data() + from), header(sizes, 3 + b)) != Z_OK)
        fail();
      result.append(block, 0, length);
      from += header(sizes, 3 + b);
    }
    return result;
  }

  std::vector<double> numbers(const std::string& text) const {
    Words words;
    std::string flat = text;
    std::replace_if(flat.begin(), flat.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    split_words(flat, words);
    std::vector<double> values;
    for (const std::string_view one : words) {
      const auto number = finite_number(one);
      if (!number) throw InputError(path_ + ": it holds " + detail::quoted(one) + ", which is no finite number");
      values.push_back(*number);
    }
    return values;
  }

  template <class Number>
  static std::vector<double> as_doubles(const std::string& bytes) {
    std::vector<Number> values(bytes.size() / sizeof(Number));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Number));
    return {values.begin(), values.end()};
  }

  std::vector<double> converted(const std::string& type, const std::string& bytes) const {
    if (type == "Float64") return as_doubles<double>(bytes);
    if (type == "Float32") return as_doubles<float>(bytes);
    if (type == "Int64") return as_doubles<std::int64_t>(bytes);
    if (type == "UInt64") return as_doubles<std::uint64_t>(bytes);
    if (type == "Int32") return as_doubles<std::int32_t>(bytes);
    if (type == "UInt32") return as_doubles<std::uint32_t>(bytes);
    if (type == "Int16") return as_doubles<std::int16_t>(bytes);
    if (type == "UInt16") return as_doubles<std::uint16_t>(bytes);
    if (type == "Int8") return as_doubles<std::int8_t>(bytes);
    if (type == "UInt8") return as_doubles<std::uint8_t>(bytes);
    throw InputError(path_ + ": type " + detail::quoted(type) + " of an array is not known");
  }

  std::string path_;
  std::string_view appended_;
  bool appended_is_raw_ = false, wide_header_ = false, compressed_ = false;
};

/// What follows the underscore of an <AppendedData> element, which need not be XML.
struct Appended {
  std::string_view data;
  bool raw = false;
  std::size_t begin = std::string_view::npos;  ///< of the element
};

Appended appended_of(std::string_view text) {
  Appended appended;
  appended.begin = text.find("<AppendedData");
  if (appended.begin == std::string_view::npos) return appended;
  const std::size_t close = text.find('>', appended.begin);
  appended.raw = text.substr(appended.begin, close - appended.begin).find("raw") != std::string_view::npos;
  const std::size_t mark = text.find('_', close);
  if (mark != std::string_view::npos) appended.data = text.substr(mark + 1);
  return appended;
}

/// The reader of XML calls itself once a level.
void refuse_deep_nesting(const std::string& path, std::string_view xml) {
  constexpr int deepest = 64;
  int depth = 0;
  for (std::size_t k = 0; k + 1 < xml.size(); ++k) {
    if (xml[k] == '<' && xml[k + 1] != '?' && xml[k + 1] != '!') depth += xml[k + 1] == '/' ? -1 : 1;
    if (xml[k] == '/' && xml[k + 1] == '>') --depth;
    if (depth > deepest) throw InputError(path + ": is no file of points: its elements are nested too deeply");
  }
}

Tree tree_of(const std::string& path, std::string_view text, const Appended& appended) {
  std::string xml(text.substr(0, appended.begin));
  if (appended.begin != std::string_view::npos) xml += "</VTKFile>";
  refuse_deep_nesting(path, xml);
  std::istringstream stream(xml);
  Tree tree;
  try {
    boost::property_tree::read_xml(stream, tree);
  } catch (const boost::property_tree::xml_parser_error& error) {
    throw InputError(path + ":" + std::to_string(error.line()) + ": is no whole XML file (" + error.message() + ")");
  }
  return tree;
}

}  // namespace

PackingFile read_legacy_vtk(const std::string& path, std::string_view text) {
  TextLines lines(path, text);
  lines.next();
  lines.next();  // a title
  if (!lines.next() || lines.line() != "ASCII")
    lines.fail("is a binary legacy VTK file: write it as ASCII, or as .vtu");
  const std::size_t start = text.find("ASCII") + 5;
  WordReader words(path, text.substr(start));
  Points points;
  while (words.next()) {
    if (words.word() == "DATASET") {
      const std::string type(words.take("a type"));
      if (type != "POLYDATA" && type != "UNSTRUCTURED_GRID")
        throw InputError(path + ": is a " + type + ", a grid without spheres (as the bounding box that LIGGGHTS writes "
                         "beside each dump): give the file of the grains");
    } else if (words.word() == "POINTS") {
      points.count = words.take_count("the number of points");
      words.take("a type");
      points.places = words.take_numbers(3 * points.count, "POINTS");
    } else if (words.word() == "POINT_DATA") {
      if (words.take_count("the number of points") != points.count)
        throw InputError(path + ": POINT_DATA is of another number of points than POINTS");
      read_point_data(words, points);
    }
  }
  if (points.count > 0 && words.may_be_cut_off())
    throw InputError(path + ": ends without a line end: its last " + (finite_number(words.word()) ? "number" : "word") +
                     " may be cut off; write it anew");
  return spheres_of(path, points);
}

namespace {

PackingFile read_pieces(const std::string& path, std::string_view text) {
  const Appended appended = appended_of(text);
  const Tree tree = tree_of(path, text, appended);
  const Tree& file = tree.get_child("VTKFile");
  const std::string type = file.get<std::string>("<xmlattr>.type", "");
  if (type != "UnstructuredGrid" && type != "PolyData")
    throw InputError(path + ": is a VTK file of type " + detail::quoted(type) + ": give points, .vtu or .vtp");
  const XmlArrays arrays(path, file, appended.data, appended.raw);
  Points points;
  for (const auto& [name, piece] : file.get_child(type)) {
    if (name != "Piece") continue;
    const auto count = piece.get<std::size_t>("<xmlattr>.NumberOfPoints", 0);
    if (count == 0) continue;
    if (points.count > 0) throw InputError(path + ": has several pieces: join them to one");
    points.count = count;
    points.places = arrays.values(piece.get_child("Points.DataArray"));
    if (points.places.size() != 3 * points.count)
      throw InputError(path + ": names " + std::to_string(points.count) + " points and holds " +
                       std::to_string(points.places.size()) + " coordinates");
    if (!piece.get_child_optional("PointData")) continue;
    for (const auto& [kind, array] : piece.get_child("PointData"))
      if (kind == "DataArray")
        points.fields.push_back({array.get<std::string>("<xmlattr>.Name", ""), arrays.values(array)});
  }
  return spheres_of(path, points);
}

}  // namespace

PackingFile read_xml_vtk(const std::string& path, std::string_view text) {
  try {
    return read_pieces(path, text);
  } catch (const boost::property_tree::ptree_error& error) {
    throw InputError(path + ": is no whole file of points (" + error.what() + ")");
  }
}

}  // namespace pfv::detail

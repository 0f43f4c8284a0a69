// SPDX-License-Identifier: GPL-3.0-or-later
#include "pfv/packing_file.hpp"

#include "distributed/even_rows.hpp"
#include "io/packing_formats.hpp"
#include "parallel/one_rank.hpp"
#include "pfv/error.hpp"
#include "pfv/io.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <algorithm>
#include <utility>

namespace pfv {
namespace detail {

std::optional<double> named_length_unit(std::string_view unit) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr Unit units[]{{"m", 1.0},  {"km", 1e3},    {"cm", 1e-2},      {"mm", 1e-3},
                         {"um", 1e-6}, {"nm", 1e-9},   {"in", 0.0254},    {"inch", 0.0254},
                         {"ft", 0.3048}, {"\xC2\xB5m", 1e-6}, {"\xCE\xBCm", 1e-6}};  // both signs of micro
  for (const Unit& one : units)
    if (unit == one.name) return one.metres;
  return {};
}

namespace {

/// What a file is that holds no spheres in a form that is read, with what to do; empty: it may be one.
std::string other_kind(std::string_view text) {
  struct Kind {
    std::string_view start;
    const char* what;
  };
  constexpr Kind kinds[]{
      {"BZh", "is packed with bzip2: unpack it first (bunzip2)"},
      {"\xFD" "7zXZ", "is packed with xz: unpack it first (unxz)"},
      {"PK\x03\x04", "is a zip archive or a spreadsheet: unpack it, or save the sheet as CSV"},
      {"\x28\xB5\x2F\xFD", "is packed with zstd: unpack it first (unzstd)"},
      {"7z\xBC\xAF\x27\x1C", "is a 7z archive: unpack it first"},
      {"Rar!", "is a rar archive: unpack it first"},
      {"%PDF", "is a PDF: give the numbers as text"},
      {"{\\rtf", "is rich text: save it as plain text"},
      {"\xFF\xFE", "is UTF-16 text: save it as UTF-8"},
      {"\xFE\xFF", "is UTF-16 text: save it as UTF-8"},
      {"\x93NUMPY", "is a NumPy array: write it with numpy.savetxt, or use the Python module"},
      {"\x89HDF", "is an HDF5 file: write its spheres as CSV"},
      {"LIGGGHTS (", "is a log of LIGGGHTS: give a dump"},
      {"LAMMPS (", "is a log of LAMMPS: give a dump"},
      {"{", "is JSON: give a table with columns id, x, y, z, radius"},
      {"[", "is JSON: give a table with columns id, x, y, z, radius"},
      {"<html", "is a web page"},
      {"<!DOCTYPE", "is a web page"},
      {"<?xml", "is XML, but no VTK file: give a table, a dump or points of a VTK file"}};
  if (starts_with(text, "solid") && text.substr(0, 4096).find("facet") != std::string_view::npos)
    return "is an STL mesh, which holds no spheres: give the grains' file";
  if (text.substr(std::min<std::size_t>(257, text.size()), 5) == "ustar") return "is a tar archive: unpack it first";
  for (const Kind& kind : kinds)
    if (starts_with(text, kind.start)) return kind.what;
  if (text.substr(0, 4096).find("\natom_style") != std::string_view::npos)
    return "is a script of LIGGGHTS: give a dump or a data file";
  if (text.substr(0, 4096).find('\0') != std::string_view::npos)
    return "is binary: give text (a dump written with dump_modify binary no, or a table)";
  return {};
}

bool is_xml_vtk(std::string_view text) { return text.substr(0, 2048).find("<VTKFile") != std::string_view::npos; }

/// `N atoms` within the first lines, after one that may say anything.
bool is_data_file(std::string_view text) {
  TextLines lines("", text.substr(0, 4096));
  std::vector<std::string_view> words;
  for (int k = 0; k < 12 && lines.next(); ++k) {
    split_words(lines.line(), words);
    if (k > 0 && words.size() >= 2 && words[1] == "atoms" && integer(words[0])) return true;
  }
  return false;
}

enum class Kind { table, dump, data, legacy_vtk, xml_vtk };

/// Of a text that begins so. Throws InputError for one without spheres.
Kind kind_of(const std::string& path, std::string_view text, const PackingChoice& choice) {
  const std::string_view begin = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (starts_with(begin, "ITEM:")) return Kind::dump;
  if (choice.snapshot != "last")
    throw InputError(path + ": is no dump, so it has no snapshot " + detail::quoted(choice.snapshot) + ": leave --snapshot away");
  if (is_xml_vtk(begin)) return Kind::xml_vtk;
  if (starts_with(begin, "# vtk DataFile")) return Kind::legacy_vtk;
  if (const std::string kind = other_kind(begin); !kind.empty()) throw InputError(path + ":1: " + kind);
  return is_data_file(text) ? Kind::data : Kind::table;
}

/// As much of a text as its kind follows from, behind blanks.
std::string begin_of(TextSource& source) {
  constexpr std::size_t enough = 4096;
  for (std::size_t count = 2 * enough;; count *= 2) {
    std::string text = source.part(0, count);
    if (text.size() < count || text.find_first_not_of(" \t\r\n") < count - enough) return text;
  }
}

/// Tells all ranks what rank 0 has found beside the spheres. Collective.
void share_rest(PackingFile& file, const Ranks& ranks) {
  Ranks::Bytes bytes;
  if (file.bounds) append(bytes, &*file.bounds, 1);
  for (const PackingBounds& bounds : values_in<PackingBounds>(told_by_first(ranks, bytes))) file.bounds = bounds;
  std::string text;
  for (const std::string& remark : file.remarks) text += remark + '\n';
  const Ranks::Bytes told = told_by_first(ranks, {text.begin(), text.end()});
  TextLines lines("", {told.data(), told.size()});
  for (file.remarks.clear(); lines.next();) file.remarks.emplace_back(lines.line());
}

/// One rank reads, and hands all but its share on. Collective.
PackingFile read_by_first(TextSource& source, Kind kind, const Ranks& ranks) {
  PackingFile file;
  ranks.together([&] {
    if (ranks.own() > 0) return;
    const std::string text = source.take();
    file = (kind == Kind::data ? read_data_file : kind == Kind::xml_vtk ? read_xml_vtk : read_legacy_vtk)(source.path(), text);
  });
  if (ranks.count() > 1) share_rest(file, ranks);
  return file;
}

PackingFile read_any(TextSource& source, const PackingChoice& choice, const Ranks& ranks) {
  Kind kind = Kind::table;
  ranks.together([&] { kind = kind_of(source.path(), begin_of(source), choice); });
  if (kind == Kind::dump) return read_dump(source, choice, ranks);
  if (kind == Kind::table) return read_table(source, choice.length_unit, ranks);
  return read_by_first(source, kind, ranks);
}

void apply_unit(PackingFile& file, double unit) {
  if (unit == 1.0) return;
  file.packing.positions *= unit;
  file.packing.radii *= unit;
  file.packing.velocities *= unit;
  if (!file.bounds) return;
  file.bounds->lower *= unit;
  file.bounds->upper *= unit;
  file.bounds->tilt *= unit;
}

}  // namespace
}  // namespace detail

double length_unit(const std::string& text) {
  const auto named = detail::named_length_unit(text);
  const auto metres = named ? named : detail::finite_number(detail::trimmed(text));
  if (!metres || !(*metres > 0.0))
    throw InputError("the unit of length is " + detail::quoted(text) +
                     ": give m, cm, mm, um, nm, km, in, ft, or what one is in m, a number > 0");
  return *metres;
}

PackingFile read_packing_file(const std::string& path, const PackingChoice& choice, const Ranks* given) {
  const Ranks& ranks = ranks_or_one(given);
  PackingFile file = detail::read_any(*detail::open_text(path, ranks), choice, ranks);
  detail::apply_unit(file, choice.length_unit);
  file.packing = evenly_divided(std::move(file.packing), ranks);
  return file;
}

PackingBounds extent_of(const PackingArrays& packing) {
  if (packing.ids.size() == 0) throw InputError("the extent of no sphere at all is asked for: give bounds");
  const Eigen::Matrix3Xd reach = packing.radii.transpose().replicate(3, 1);
  return {(packing.positions - reach).rowwise().minCoeff(), (packing.positions + reach).rowwise().maxCoeff(), {}};
}

PackingArrays read_packing(const std::string& path) { return read_packing_file(path).packing; }

}  // namespace pfv

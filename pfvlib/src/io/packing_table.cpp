// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/packing_formats.hpp"
#include "io/sphere_table.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <algorithm>

namespace pfv::detail {
namespace {

/// Tabs among blanks are blanks.
char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  Words fields;
  split(line, '\t', fields);
  const bool tabs = fields.size() > 1 && std::none_of(fields.begin(), fields.end(), [](std::string_view field) {
    return plain_name(field).find(' ') != std::string::npos;
  });
  if (tabs) return '\t';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

void split_fields(std::string_view line, char separator, Words& fields) {
  if (separator == ' ') {
    split_words(line, fields);
  } else {
    split(line, separator, fields);
  }
  for (std::string_view& field : fields)
    if (field.size() > 1 && (field.front() == '"' || field.front() == '\'') && field.back() == field.front())
      field = trimmed(field.substr(1, field.size() - 2));
}

bool all_numbers(const Words& fields) {
  return !fields.empty() && std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
    return finite_number(field).has_value();
  });
}

/// Names of YADE's `#format x_y_z_r`.
Words format_names(std::string_view comment) {
  Words names;
  const std::string_view word = "#format";
  if (!starts_with(comment, word)) return names;
  split(trimmed(comment.substr(word.size())), '_', names);
  return names;
}

/// A header that stands in a comment: `# id x y z radius`.
Words names_in_comment(std::string_view comment) {
  Words names = format_names(comment);
  if (!names.empty()) return names;
  comment.remove_prefix(std::min(comment.find_first_not_of("# \t"), comment.size()));
  split_fields(comment, separator_of(comment), names);
  const auto has = [&](const char* name) {
    return std::any_of(names.begin(), names.end(), [&](std::string_view one) { return plain_name(one) == name; });
  };
  const bool header = has("x") && has("y") && has("z") && (has("r") || has("radius") || has("diameter") || has("d"));
  return header ? names : Words();
}

/// Units of lengths and velocities in names, which `--length-unit` has to agree with.
void refuse_units(const TextLines& lines, const Words& names, bool lengths_have_a_unit) {
  for (const std::string_view name : names) {
    const std::string_view unit = unit_in(name), length = unit.substr(0, unit.find('/'));
    if (lengths_have_a_unit && (unit == "m" || unit == "m/s"))
      lines.fail("column " + detail::quoted(name) + " is in m, and --length-unit names another unit for all of them");
    if (lengths_have_a_unit) continue;
    for (const std::string_view other : {"mm", "cm", "um", "nm", "km", "in", "ft", "inch"})
      if (length == other)
        lines.fail("column " + detail::quoted(name) + " is not in m: give the file's unit with --length-unit");
  }
}

[[noreturn]] void fail_without_header(const TextLines& lines, std::size_t fields) {
  lines.fail("has " + std::to_string(fields) + " numbers where the names of the columns are expected: put a "
             "line like id,x,y,z,radius above");
}

}  // namespace

PackingFile read_table(const std::string& path, std::string_view text, bool lengths_have_a_unit) {
  TextLines lines(path, text);
  std::string_view comment;
  PackingFile file;
  do {
    if (!lines.next_filled())
      throw InputError(path + ": is empty: give a header id,x,y,z,radius and one line a sphere");
    if (lines.line().front() == '#') comment = lines.line();
  } while (lines.line().front() == '#');
  const char separator = separator_of(lines.line());
  Words fields, names;
  split_fields(lines.line(), separator, fields);
  const bool numbers = all_numbers(fields);
  if (numbers) names = names_in_comment(comment);
  if (numbers && names.empty() && fields.size() == 4) {
    names = {"x", "y", "z", "r"};
    file.remarks.push_back("there are no names of columns: the four were taken as x, y, z and radius");
  }
  if (numbers && names.empty()) fail_without_header(lines, fields.size());
  refuse_units(lines, numbers ? names : fields, lengths_have_a_unit);
  SphereTable table(find_columns(lines, numbers ? names : fields));
  table.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
  if (numbers) table.add(lines, fields);
  while (lines.next_filled()) {
    if (lines.line().front() == '#') continue;
    split_fields(lines.line(), separator, fields);
    table.add(lines, fields);
  }
  file.packing = table.arrays(path);
  if (!table.has_ids()) file.remarks.push_back("there are no ids: the spheres are numbered from 1 in their order");
  return file;
}

}  // namespace pfv::detail

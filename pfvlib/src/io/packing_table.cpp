// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/packing_formats.hpp"
#include "io/sphere_table.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace pfv::detail {
namespace {

/// Tabs among blanks are blanks, tabs beside commas or semicolons as well.
char separator_of(std::string_view line) {
  Words fields;
  for (const char separator : {';', ','}) {
    split(line, separator, fields);
    const bool tabs = std::any_of(fields.begin(), fields.end(), [](std::string_view field) {
      return field.find('\t') != std::string_view::npos;
    });
    if (fields.size() > 1 && (separator == ';' || !tabs)) return separator;
  }
  split(line, '\t', fields);
  const bool tabs = fields.size() > 1 && std::none_of(fields.begin(), fields.end(), [](std::string_view field) {
    return plain_name(field).find(' ') != std::string::npos;
  });
  if (tabs) return '\t';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

const char* name_of_separator(char separator) {
  return separator == ';' ? "semicolons" : separator == ',' ? "commas" : separator == '\t' ? "tabs" : "blanks";
}

/// Of `#`, of Matlab, and the first line that Excel reads its separator from.
bool is_comment(std::string_view line) {
  return line.front() == '#' || line.front() == '%' || (starts_with(line, "sep=") && line.size() == 5);
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
  comment.remove_prefix(std::min(comment.find_first_not_of("#% \t"), comment.size()));
  split_fields(comment, separator_of(comment), names);
  const auto has = [&](const char* name) {
    return std::any_of(names.begin(), names.end(), [&](std::string_view one) { return plain_name(one) == name; });
  };
  const bool header = has("x") && has("y") && has("z") && (has("r") || has("radius") || has("diameter") || has("d"));
  return header ? names : Words();
}

/// Units of lengths and velocities in names, which `--length-unit` has to agree with.
void refuse_units(const TextLines& lines, const Words& names, double length_unit) {
  for (const std::string_view name : names) {
    const std::string_view unit = unit_in(name);
    const std::string_view length = unit.substr(0, unit.find('/'));
    const auto metres = named_length_unit(length);
    if (!metres || std::abs(*metres - length_unit) <= 1e-9 * length_unit) continue;
    if (length_unit == 1.0)
      lines.fail("column " + detail::quoted(name) + " is not in m: give the file's unit with --length-unit");
    lines.fail("column " + detail::quoted(name) + " is in " + std::string(length) +
               ", and --length-unit names another unit for all of them");
  }
}

[[noreturn]] void fail_without_header(const TextLines& lines, std::size_t fields) {
  if (fields == 1)
    lines.fail("is a number alone, as an xyz file begins with: it names no columns; write a table with a header "
               "id,x,y,z,radius or a dump");
  lines.fail("has " + std::to_string(fields) + " numbers where the names of the columns are expected: put a "
             "line like id,x,y,z,radius above");
}

/// Where a line has not as many fields as there are names: what is likely to be the cause.
void explain_fields(const TextLines& lines, char separator, std::size_t fields, std::size_t names) {
  const std::string counts = "has " + std::to_string(fields) + " fields instead of " + std::to_string(names);
  const char other = separator_of(lines.line());
  Words others;
  split_fields(lines.line(), other, others);
  const bool otherwise = others.size() > 1 && (lines.ended() || others.size() == names);  // and not cut off
  if (other != separator && fields == 1 && otherwise)
    lines.fail(std::string("is separated by ") + name_of_separator(other) + ", and the names of the columns by " +
               name_of_separator(separator) + ": separate all lines alike");
  if (separator == ',' && (fields == 2 * names || fields + 1 == 2 * names))  // all numbers, or all but the id
    lines.fail(counts + ", as of numbers with a comma: write a decimal point");
}

/// Header and lines of a table.
class TableReader {
 public:
  TableReader(const std::string& path, std::string_view text, double length_unit)
      : path_(path), text_(text), lines_(path, text), length_unit_(length_unit) {}

  PackingFile read() {
    find_names();
    SphereTable table(find_columns(lines_, names_));
    table.reserve(static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n')));
    for (bool more = first_is_data_ || next(); more; more = next()) {
      if (fields_.size() != names_.size()) explain_fields(lines_, separator_, fields_.size(), names_.size());
      table.add(lines_, fields_);
    }
    file_.packing = table.arrays(path_);
    if (!table.has_ids()) file_.remarks.push_back("there are no ids: the spheres are numbered from 1 in their order");
    if (ends_in_a_number())
      file_.remarks.push_back("the last line has no end; its last number may be cut off");
    return std::move(file_);
  }

 private:
  /// The next line that is no comment; false at the end.
  bool next() {
    do
      if (!lines_.next_filled()) return false;
    while (is_comment(lines_.line()));
    split_fields(lines_.line(), separator_, fields_);
    fit_to_names();
    return true;
  }

  /// For a separator behind the last field of lines, or of the names, alone.
  void fit_to_names() {
    if (fields_.size() == names_.size() + 1 && fields_.back().empty()) fields_.pop_back();
    if (fields_.size() + 1 == names_.size() && names_.back().empty()) fields_.emplace_back();
  }

  /// Whether the file's last character is a number's: nothing tells that this is whole.
  bool ends_in_a_number() const {
    const char last = text_.back();
    return ((last >= '0' && last <= '9') || last == '.') && !is_comment(lines_.line());
  }

  /// From the first line that is no comment, or, where that holds numbers, from the comments above.
  void find_names() {
    do {
      if (!lines_.next_filled())
        throw InputError(path_ + ": is empty: give a header id,x,y,z,radius and one line a sphere");
      if (!is_comment(lines_.line())) break;
      if (Words names = names_in_comment(lines_.line()); !names.empty()) names_ = std::move(names);
    } while (true);
    separator_ = separator_of(lines_.line());
    split_fields(lines_.line(), separator_, fields_);
    Words filled = fields_;
    if (filled.back().empty()) filled.pop_back();
    first_is_data_ = all_numbers(filled);
    if (!first_is_data_) names_ = fields_;
    else if (names_.empty()) fields_ = filled;
    else fit_to_names();
    if (names_.empty() && fields_.size() == 4) {
      names_ = {"x", "y", "z", "r"};
      file_.remarks.push_back("there are no names of columns: the four were taken as x, y, z and radius");
    }
    if (names_.empty()) fail_without_header(lines_, fields_.size());
    refuse_units(lines_, names_, length_unit_);
  }

  std::string path_;
  std::string_view text_;
  TextLines lines_;
  double length_unit_;
  char separator_ = ' ';
  Words names_, fields_;
  bool first_is_data_ = false;  // of the line that find_names() stops at
  PackingFile file_;
};

}  // namespace

PackingFile read_table(const std::string& path, std::string_view text, double length_unit) {
  return TableReader(path, text, length_unit).read();
}

}  // namespace pfv::detail

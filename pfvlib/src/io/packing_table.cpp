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

/// What the lines of a table are made of.
struct TableHead {
  Columns columns;
  char separator = ' ';
  std::size_t names = 0;
  bool last_name_empty = false;  ///< for a separator behind all names
  TextPart rows;
  std::vector<std::string> remarks;
};

/// For a separator behind the last field of lines, or of the names, alone.
void fit_to_names(Words& fields, const TableHead& head) {
  if (fields.size() == head.names + 1 && fields.back().empty()) fields.pop_back();
  if (fields.size() + 1 == head.names && head.last_name_empty) fields.emplace_back();
}

/// Header of a table.
class HeadReader {
 public:
  HeadReader(TextSource& source, double length_unit)
      : path_(source.path()), lines_(lines_of(source, {0, source.size(), 0})), length_unit_(length_unit) {
    head_.rows.end = source.size();
  }

  TableHead read() {
    find_names();
    head_.names = names_.size();
    head_.last_name_empty = names_.back().empty();
    head_.columns = find_columns(lines_, names_);
    head_.rows.begin = first_is_data_ ? lines_.begin() : lines_.taken();
    head_.rows.lines_before = lines_.number() - (first_is_data_ ? 1 : 0);
    return std::move(head_);
  }

 private:
  /// From the first line that is no comment, or, where that holds numbers, from the comments above.
  void find_names() {
    do {
      if (!lines_.next_filled())
        throw InputError(path_ + ": is empty: give a header id,x,y,z,radius and one line a sphere");
      if (!is_comment(lines_.line())) break;
      if (names_in_comment(lines_.line()).empty()) continue;
      comment_ = lines_.line();
      names_ = names_in_comment(comment_);
    } while (true);
    head_.separator = separator_of(lines_.line());
    Words fields;
    split_fields(lines_.line(), head_.separator, fields);
    Words filled = fields;
    if (filled.back().empty()) filled.pop_back();
    first_is_data_ = all_numbers(filled);
    if (!first_is_data_) names_ = fields;
    if (names_.empty() && filled.size() == 4) {
      names_ = {"x", "y", "z", "r"};
      head_.remarks.push_back("there are no names of columns: the four were taken as x, y, z and radius");
    }
    if (names_.empty()) fail_without_header(lines_, filled.size());
    refuse_units(lines_, names_, length_unit_);
  }

  std::string path_, comment_;
  TextLines lines_;
  double length_unit_;
  Words names_;
  bool first_is_data_ = false;  // of the line that find_names() stops at
  TableHead head_;
};

/// The next line that is no comment; false at the end.
bool next_row(TextLines& lines, const TableHead& head, Words& fields) {
  do
    if (!lines.next_filled()) return false;
  while (is_comment(lines.line()));
  split_fields(lines.line(), head.separator, fields);
  fit_to_names(fields, head);
  return true;
}

/// Whether the text's last character is a number's: nothing tells that this is whole.
bool ends_in_a_number(TextSource& source, const TextLines& lines) {
  if (lines.ended() || lines.line().empty() || is_comment(lines.line())) return false;
  const std::string last = source.part(source.size() - 1, 1);
  return !last.empty() && ((last[0] >= '0' && last[0] <= '9') || last[0] == '.');
}

}  // namespace

PackingFile read_table(TextSource& source, double length_unit, const Ranks& ranks) {
  TableHead head;
  ranks.together([&] { head = HeadReader(source, length_unit).read(); });
  const LineShare share = share_of_lines(source, head.rows, ranks);
  SphereTable table(head.columns);
  bool may_be_cut_off = false;
  ranks.together([&] {
    table.reserve(share.lines);
    TextLines lines = lines_of(source, share.own);
    Words fields;
    while (next_row(lines, head, fields)) {
      if (fields.size() != head.names) explain_fields(lines, head.separator, fields.size(), head.names);
      table.add(lines, fields);
    }
    may_be_cut_off = ends_in_a_number(source, lines);
  });
  PackingFile file;
  file.remarks = head.remarks;
  file.packing = table.arrays(source.path(), ranks);
  if (!table.has_ids()) file.remarks.push_back("there are no ids: the spheres are numbered from 1 in their order");
  if (ranks.any(may_be_cut_off))
    file.remarks.push_back("the last line has no end; its last number may be cut off");
  return file;
}

}  // namespace pfv::detail

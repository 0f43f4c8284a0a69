// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/packing_formats.hpp"
#include "io/sphere_table.hpp"
#include "parallel/one_rank.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pfv::detail {
namespace {

constexpr std::string_view item = "ITEM:";
constexpr std::string_view step_item = "ITEM: TIMESTEP";

/// A snapshot in the text of a dump.
struct Snapshot {
  TextPart part;  ///< from its ITEM: TIMESTEP
  std::optional<std::int64_t> step;
  std::optional<double> time;
};

std::string_view line_after(std::string_view text, std::size_t begin) {
  const std::size_t start = text.find('\n', begin);
  if (start == std::string_view::npos) return {};
  return trimmed(text.substr(start + 1, text.find('\n', start + 1) - start - 1));
}

/// Newer LAMMPS writes units and time before the step, in items of a line each.
std::size_t begin_of_head(std::string_view text, std::size_t begin, std::optional<double>& time) {
  const auto line_before = [&](std::size_t place) {
    const std::size_t end = text.rfind('\n', place - 2);
    return place < 2 ? std::size_t{0} : end == std::string_view::npos ? 0 : end + 1;
  };
  for (;;) {
    const std::size_t above = line_before(line_before(begin));
    const std::string_view heading = trimmed(text.substr(above, text.find('\n', above) - above));
    if (above == begin || (heading != "ITEM: TIME" && heading != "ITEM: UNITS")) return begin;
    if (heading == "ITEM: TIME") time = finite_number(line_after(text, above));
    begin = above;
  }
}

/// The text from block to block, with enough of it before and behind each place for the head of a snapshot.
std::vector<Snapshot> snapshots_of(TextSource& source) {
  constexpr std::size_t block = std::size_t{1} << 20, head = 4096;
  std::vector<Snapshot> snapshots;
  std::string text;
  std::size_t before = 0;  // of the source, in front of `text`
  std::size_t lines = 0, looked = 0;
  for (bool whole = false; !whole;) {
    const std::string more = source.part(before + text.size(), block);
    whole = more.size() < block;
    text += more;
    const std::size_t end = whole ? text.size() : text.size() - head;
    const auto count_to = [&](std::size_t place) {
      lines += static_cast<std::size_t>(std::count(text.begin() + looked, text.begin() + place, '\n'));
      looked = place;
    };
    for (std::size_t begin = text.find(step_item, looked); begin < end; begin = text.find(step_item, begin + 1)) {
      count_to(begin);
      Snapshot snapshot{{before + begin, source.size(), lines}, integer(line_after(text, begin)), {}};
      const std::size_t top = begin_of_head(text, begin, snapshot.time);
      if (!snapshots.empty()) snapshots.back().part.end = before + top;
      snapshots.push_back(snapshot);
    }
    count_to(end);
    const std::size_t passed = looked > head ? looked - head : 0;
    text.erase(0, passed);
    before += passed;
    looked -= passed;
  }
  return snapshots;
}

/// On all ranks, of which one looks for them. Collective.
std::vector<Snapshot> snapshots_of(TextSource& source, const Ranks& ranks) {
  Ranks::Bytes bytes;
  ranks.together([&] {
    if (ranks.own() > 0) return;
    const std::vector<Snapshot> snapshots = snapshots_of(source);
    if (snapshots.empty()) throw InputError(source.path() + ": has no ITEM: TIMESTEP: write the dump anew");
    append(bytes, snapshots.data(), snapshots.size());
  });
  return values_in<Snapshot>(told_by_first(ranks, bytes));
}

std::string names_of(const std::vector<Snapshot>& snapshots) {
  std::string text = std::to_string(snapshots.size()) + " snapshots, of steps";
  const std::size_t shown = 8;
  for (std::size_t k = 0; k < snapshots.size(); ++k)
    if (snapshots[k].step && (k < shown || k + 1 == snapshots.size()))
      text += (k >= shown ? " ... " : " ") + std::to_string(*snapshots[k].step);
  return text;
}

bool is_of(const Snapshot& snapshot, const std::optional<std::int64_t>& step, const std::optional<double>& time) {
  if (step && snapshot.step == step) return true;
  return time && snapshot.time && std::abs(*snapshot.time - *time) <= 1e-9 * std::abs(*time);
}

/// The last of this name, as a run that goes on from a restart file appends a step again. Throws InputError where there
/// is none.
const Snapshot& chosen(const std::string& path, const std::vector<Snapshot>& snapshots, const std::string& name) {
  if (name == "last") return snapshots.back();
  const std::string time_word = "time=";
  std::optional<double> time;
  std::optional<std::int64_t> step;
  if (starts_with(name, time_word)) time = finite_number(name.substr(time_word.size()));
  else step = integer(name);
  for (auto snapshot = snapshots.rbegin(); snapshot != snapshots.rend(); ++snapshot)
    if (is_of(*snapshot, step, time)) return *snapshot;
  if (step && *step >= 1 && *step <= static_cast<std::int64_t>(snapshots.size()))
    return snapshots[static_cast<std::size_t>(*step) - 1];
  throw InputError(path + ": there is no snapshot " + detail::quoted(name) + ": it has " + names_of(snapshots) +
                   "; give one of these steps, a number counted from 1, time=T where the dump has times, or last");
}

[[noreturn]] void fail_cut_off(const TextLines& lines, const std::string& what) {
  lines.fail("the snapshot is cut off " + what + ": remove it, write the dump to its end, or choose another with "
             "--snapshot");
}

std::int64_t read_number_of_atoms(TextLines& lines) {
  if (!lines.next()) fail_cut_off(lines, "before its number of atoms");
  const auto number = integer(lines.line());
  if (!number || *number < 0)
    lines.fail("number of atoms is " + detail::quoted(lines.line()) + ": give a whole number >= 0");
  return *number;
}

/// Of a tilted room the file has the bounds of the box around it.
void take_off_tilt(PackingBounds& bounds) {
  const double xy = bounds.tilt[0], xz = bounds.tilt[1], yz = bounds.tilt[2];
  bounds.lower[0] -= std::min({0.0, xy, xz, xy + xz});
  bounds.upper[0] -= std::max({0.0, xy, xz, xy + xz});
  bounds.lower[1] -= std::min(0.0, yz);
  bounds.upper[1] -= std::max(0.0, yz);
}

/// `ITEM: BOX BOUNDS [xy xz yz] pp pp ff` and three lines of lower and upper bounds. A tilted room without periodic
/// sides has none.
std::optional<PackingBounds> read_bounds(TextLines& lines) {
  Words words, fields;
  split_words(lines.line(), words);
  PackingBounds bounds;
  if (words.size() > 3 && words[3] == "abc")
    lines.fail("the bounds are those of a general triclinic cell: write the dump with triclinic/general no");
  if (words.size() >= 6)
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view sides = words[words.size() - 3 + axis];
      bounds.periodic[axis] = sides == "pp";
      bounds.follows_grains[axis] = sides.find('s') != std::string_view::npos;
    }
  for (int axis = 0; axis < 3; ++axis) {
    if (!lines.next()) fail_cut_off(lines, "in its bounds");
    split_words(lines.line(), fields);
    const auto lower = fields.size() > 1 ? finite_number(fields[0]) : std::nullopt;
    const auto upper = fields.size() > 1 ? finite_number(fields[1]) : std::nullopt;
    if (!lower || !upper) lines.fail("bounds are " + detail::quoted(lines.line()) + ": give two numbers");
    bounds.lower[axis] = *lower;
    bounds.upper[axis] = *upper;
    const auto tilt = fields.size() > 2 ? finite_number(fields[2]) : 0.0;
    if (!tilt) lines.fail("the tilt is " + detail::quoted(fields[2]) + ": give a number");
    bounds.tilt[axis] = *tilt;
  }
  if (bounds.tilt.isZero(0.0)) return bounds;
  if (!bounds.any_periodic()) return {};
  take_off_tilt(bounds);
  return bounds;
}

/// What stands in a snapshot before its atoms.
struct SnapshotHead {
  std::int64_t atoms = -1;
  std::optional<PackingBounds> bounds;
  Columns columns;
  bool names_a_variable = false;
  TextPart rows;
};

/// This rank's lines of atoms.
SphereTable read_atoms(TextSource& source, const SnapshotHead& head, const LineShare& share) {
  SphereTable table(head.columns);
  table.reserve(share.lines);
  TextLines lines = lines_of(source, share.own);
  Words fields;
  const std::string of_all = " of " + std::to_string(head.atoms) + " atoms";
  const std::int64_t first = static_cast<std::int64_t>(share.first), all = static_cast<std::int64_t>(share.all);
  for (std::int64_t atom = first; atom < head.atoms && lines.next(); ++atom) {
    if (lines.line().empty()) fail_cut_off(lines, "after " + std::to_string(atom) + of_all);
    split_words(lines.line(), fields);
    table.add(lines, fields);
  }
  if (share.last && all < head.atoms) fail_cut_off(lines, "after " + std::to_string(all) + of_all);
  if (lines.next_filled()) {
    if (starts_with(item, lines.line()) || starts_with(lines.line(), item)) fail_cut_off(lines, "in its first line");
    lines.fail("more lines than the " + std::to_string(head.atoms) + " atoms that the snapshot names: write the dump anew");
  }
  if (!lines.ended())
    lines.fail("the dump ends inside this line: its last number may be cut off; write the dump to its end");
  return table;
}

/// Multiplies scaled coordinates out and takes unwrapped ones back into a periodic room.
void make_plain(PackingArrays& packing, Places places, const std::optional<PackingBounds>& bounds,
                const std::string& path) {
  if (places == Places::plain) return;
  const bool scaled = places != Places::unwrapped;
  if (bounds && !bounds->tilt.isZero(0.0)) {  // places on its lattice may stay as they are
    if (scaled) throw InputError(path + ": its coordinates are scaled and its room is tilted: write x, y, z");
    return;
  }
  if (scaled && !bounds)
    throw InputError(path + ": its coordinates are scaled and its room is not known or tilted: write x, y, z");
  for (int axis = 0; bounds && axis < 3; ++axis) {
    const double lower = bounds->lower[axis], edge = bounds->upper[axis] - lower;
    auto row = packing.positions.row(axis).array();
    if (scaled) row = lower + edge * row;
    if (bounds->periodic[axis] && places != Places::scaled && edge > 0.0)
      row -= edge * ((row - lower) / edge).floor();
  }
}

bool names_a_variable(const Words& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string_view name) {
    return name == "v_x" || name == "v_y" || name == "v_z";
  });
}

SnapshotHead read_head(TextSource& source, const Snapshot& snapshot) {
  TextLines lines = lines_of(source, snapshot.part);
  SnapshotHead head;
  while (lines.next()) {
    if (starts_with(lines.line(), "ITEM: NUMBER OF ATOMS")) head.atoms = read_number_of_atoms(lines);
    if (starts_with(lines.line(), "ITEM: BOX BOUNDS")) head.bounds = read_bounds(lines);
    if (starts_with(lines.line(), "ITEM: ENTRIES"))
      lines.fail("ITEM: ENTRIES instead of ITEM: ATOMS: a dump of contacts or other pairs; give that of the grains");
    constexpr std::string_view heading = "ITEM: ATOMS";
    if (!starts_with(lines.line(), heading)) continue;
    if (head.atoms < 0) lines.fail("no ITEM: NUMBER OF ATOMS before this line: write the dump anew");
    if (head.atoms == 0)
      throw InputError(source.path() + ": the snapshot of step " + std::to_string(snapshot.step.value_or(0)) +
                       " has no atoms (yet): give a dump of a later step, or choose another of its snapshots with --snapshot");
    Words names;
    split_words(lines.line().substr(heading.size()), names);
    head.columns = find_columns(lines, names, Naming::dump);
    head.names_a_variable = names_a_variable(names);
    head.rows = {snapshot.part.begin + lines.taken(), snapshot.part.end, lines.number()};
    return head;
  }
  fail_cut_off(lines, "before its ITEM: ATOMS");
}

/// All of a snapshot. Collective.
PackingFile read_snapshot(TextSource& source, const Snapshot& snapshot, const Ranks& ranks) {
  SnapshotHead head;
  ranks.together([&] { head = read_head(source, snapshot); });
  const LineShare share = share_of_lines(source, head.rows, ranks);
  SphereTable table(head.columns);
  ranks.together([&] { table = read_atoms(source, head, share); });
  PackingFile file;
  file.step = snapshot.step;
  file.bounds = head.bounds;
  file.packing = table.arrays(source.path(), ranks);
  ranks.together([&] { make_plain(file.packing, head.columns.places, file.bounds, source.path()); });
  if (!head.columns.velocities() && head.names_a_variable)
    file.remarks.push_back("v_x, v_y, v_z are variables of the script, not velocities, which would be vx, vy, vz: there "
                           "are none");
  if (!table.has_ids()) file.remarks.push_back("there are no ids: the spheres are numbered from 1 in their order");
  return file;
}

/// The unit style that a newer LAMMPS writes first.
void refuse_other_units(const std::string& path, std::string_view text, double length_unit) {
  constexpr std::string_view heading = "ITEM: UNITS";
  if (!starts_with(text, heading) || length_unit != 1.0) return;
  const std::string_view units = line_after(text, 0);
  if (units != "si")
    throw InputError(path + ":2: its units are " + detail::quoted(units) + ", not si: give the unit of its lengths in m with "
                     "--length-unit");
}

}  // namespace

PackingFile read_dump(TextSource& source, const PackingChoice& choice, const Ranks& ranks) {
  ranks.together([&] { refuse_other_units(source.path(), source.part(0, 4096), choice.length_unit); });
  const std::vector<Snapshot> snapshots = snapshots_of(source, ranks);
  if (choice.snapshot == "last") return read_snapshot(source, snapshots.back(), ranks);
  const Snapshot* found = nullptr;
  ranks.together([&] { found = &chosen(source.path(), snapshots, choice.snapshot); });
  PackingFile file = read_snapshot(source, *found, ranks);
  file.remarks.push_back("the snapshot is that of step " + std::to_string(found->step.value_or(0)) + ", number " +
                         std::to_string(found - snapshots.data() + 1) + " of " + std::to_string(snapshots.size()));
  const auto same = std::count_if(snapshots.begin(), snapshots.end(), [&](const Snapshot& other) {
    return found->step && other.step == found->step;
  });
  if (same > 1)
    file.remarks.push_back("the dump has that step " + std::to_string(same) +
                           " times; a number counted from 1 chooses another of them");
  return file;
}

}  // namespace pfv::detail

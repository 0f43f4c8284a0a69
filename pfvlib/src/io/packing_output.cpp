// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres in the formats that others read.
#include "io/atomic_file.hpp"
#include "network/grains.hpp"
#include "pfv/error.hpp"
#include "pfv/fields.hpp"
#include "pfv/io.hpp"
#include "pfv/packing_file.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace pfv {
namespace {

using Remarks = std::vector<std::string>;

constexpr double usual_density = 2500.0;  // kg/m³

void append_words(std::string& text, char separator, std::initializer_list<double> values) {
  for (const double value : values) {
    text += separator;
    detail::append_number(text, value);
  }
}

void append_vector(std::string& text, char separator, const Eigen::Vector3d& vector) {
  append_words(text, separator, {vector[0], vector[1], vector[2]});
}

bool moves(const PackingArrays& packing) { return packing.velocities.cols() > 0; }
bool spins(const PackingArrays& packing) { return packing.angular_velocities.cols() > 0; }

bool numbered_in_order(const PackingArrays& packing) {
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k)
    if (packing.ids[k] != k + 1) return false;
  return true;
}

void say_lost_bounds(const PackingFile& file, Remarks& remarks) {
  if (file.bounds)
    remarks.push_back(std::string("lost: the bounds of the simulation box") +
                      (file.bounds->any_periodic() ? " and which sides are periodic" : ""));
}

/// Those of the file, or the extent of the spheres.
PackingBounds bounds_of(const PackingFile& file, Remarks& remarks) {
  if (file.bounds) return *file.bounds;
  remarks.push_back("assumed: a simulation box of the extent of the spheres, without periodic sides");
  return extent_of(file.packing);
}

/// A header and a line a sphere, as tables and dumps have them.
std::string rows_of(const PackingArrays& packing, char separator, std::string names, const char* middle) {
  const auto add_names = [&](std::initializer_list<const char*> more) {
    for (const char* name : more) names += separator + std::string(name);
  };
  add_names({"x", "y", "z", "radius"});
  if (moves(packing)) add_names({"vx", "vy", "vz"});
  if (spins(packing)) add_names({"omegax", "omegay", "omegaz"});
  std::string text = names + '\n';
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    text += std::to_string(packing.ids[k]) + middle;
    append_vector(text, separator, packing.positions.col(k));
    append_words(text, separator, {packing.radii[k]});
    if (moves(packing)) append_vector(text, separator, packing.velocities.col(k));
    if (spins(packing)) append_vector(text, separator, packing.angular_velocities.col(k));
    text += '\n';
  }
  return text;
}

std::string table_of(const PackingFile& file, Remarks& remarks) {
  say_lost_bounds(file, remarks);
  return rows_of(file.packing, ',', "id", "");
}

/// The three lines of a dump's bounds; of a tilted cell those of the box around it.
std::string dump_bounds(const PackingBounds& bounds) {
  const bool tilted = !bounds.tilt.isZero(0.0);
  const double xy = bounds.tilt[0], xz = bounds.tilt[1], yz = bounds.tilt[2];
  Eigen::Vector3d lower = bounds.lower, upper = bounds.upper;
  lower[0] += std::min({0.0, xy, xz, xy + xz});
  upper[0] += std::max({0.0, xy, xz, xy + xz});
  lower[1] += std::min(0.0, yz);
  upper[1] += std::max(0.0, yz);
  std::string text = tilted ? "ITEM: BOX BOUNDS xy xz yz" : "ITEM: BOX BOUNDS";
  for (const bool periodic : bounds.periodic) text += periodic ? " pp" : " ff";
  text += '\n';
  for (int axis = 0; axis < 3; ++axis) {
    detail::append_number(text, lower[axis]);
    append_words(text, ' ', {upper[axis]});
    if (tilted) append_words(text, ' ', {bounds.tilt[axis]});
    text += '\n';
  }
  return text;
}

std::string dump_of(const PackingFile& file, Remarks& remarks) {
  return "ITEM: TIMESTEP\n" + std::to_string(file.step.value_or(0)) + "\nITEM: NUMBER OF ATOMS\n" +
         std::to_string(file.packing.ids.size()) + '\n' + dump_bounds(bounds_of(file, remarks)) +
         rows_of(file.packing, ' ', "ITEM: ATOMS id type", " 1");
}

std::string data_header(const PackingFile& file, Remarks& remarks) {
  const PackingBounds bounds = bounds_of(file, remarks);
  if (bounds.any_periodic()) remarks.push_back("lost: which sides of the simulation box are periodic; `boundary` of the script says so");
  std::string text = "spheres, written by pfv\n\n" + std::to_string(file.packing.ids.size()) +
                     " atoms\n1 atom types\n\n";
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    detail::append_number(text, bounds.lower[axis]);
    append_words(text, ' ', {bounds.upper[axis]});
    text += ' ' + name + "lo " + name + "hi\n";
  }
  if (bounds.tilt.isZero(0.0)) return text;
  detail::append_number(text, bounds.tilt[0]);
  append_words(text, ' ', {bounds.tilt[1], bounds.tilt[2]});
  return text + " xy xz yz\n";
}

std::string data_of(const PackingFile& file, const std::optional<double>& density, Remarks& remarks) {
  const PackingArrays& packing = file.packing;
  std::string text = data_header(file, remarks) + "\nAtoms\n\n";
  if (!density) remarks.push_back("assumed: a density of 2500 kg/m3, which the option density changes");
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    text += std::to_string(packing.ids[k]) + " 1";
    append_words(text, ' ', {2.0 * packing.radii[k], density.value_or(usual_density)});
    append_vector(text, ' ', packing.positions.col(k));
    text += '\n';
  }
  if (!moves(packing) && !spins(packing)) return text;
  text += "\nVelocities\n\n";
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    text += std::to_string(packing.ids[k]);
    append_vector(text, ' ', moves(packing) ? Eigen::Vector3d(packing.velocities.col(k)) : Eigen::Vector3d::Zero());
    append_vector(text, ' ',
                  spins(packing) ? Eigen::Vector3d(packing.angular_velocities.col(k)) : Eigen::Vector3d::Zero());
    text += '\n';
  }
  return text;
}

std::string yade_text_of(const PackingFile& file, Remarks& remarks) {
  const PackingArrays& packing = file.packing;
  say_lost_bounds(file, remarks);
  if (moves(packing) || spins(packing)) remarks.push_back("lost: velocities");
  if (!numbered_in_order(packing)) remarks.push_back("lost: ids; the spheres count from 1 (in YADE from 0) in their order");
  std::string text = "#format x_y_z_r\n";
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) {
    detail::append_number(text, packing.positions(0, k));
    append_words(text, '\t', {packing.positions(1, k), packing.positions(2, k), packing.radii[k]});
    text += '\n';
  }
  return text;
}

void write_points(const std::string& path, const PackingFile& file, Remarks& remarks) {
  const PackingArrays& packing = file.packing;
  say_lost_bounds(file, remarks);
  FieldGrid grid;
  grid.points = packing.positions;
  for (Eigen::Index k = 0; k < packing.ids.size(); ++k) grid.add_cell(FieldGrid::vertex, {k});
  grid.point_ids.assign(packing.ids.data(), packing.ids.data() + packing.ids.size());
  grid.of_points.push_back({"radius", packing.radii.transpose()});
  if (moves(packing)) grid.of_points.push_back({"velocity", packing.velocities});
  if (spins(packing)) grid.of_points.push_back({"angular_velocity", packing.angular_velocities});
  write_fields(path, grid);
}

}  // namespace

PackingFormat packing_format_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  std::string ending = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  struct Ending {
    const char* name;
    PackingFormat format;
  };
  std::string known;
  for (const Ending one : {Ending{"csv", PackingFormat::table}, {"txt", PackingFormat::yade}, {"xyzr", PackingFormat::yade},
                           {"dump", PackingFormat::dump}, {"liggghts", PackingFormat::dump},
                           {"lammpstrj", PackingFormat::dump}, {"data", PackingFormat::data}, {"vtu", PackingFormat::vtu}}) {
    if (ending == one.name) return one.format;
    known += (known.empty() ? "." : ", .") + std::string(one.name);
  }
  throw InputError("output " + detail::quoted(path) + ": its ending names no format of spheres: there are " + known +
                   "; or say which with --format, in Python format=");
}

Remarks write_packing_file(const std::string& path, const PackingFile& file, const PackingOutput& output) {
  const PackingFormat format = output.format ? *output.format : packing_format_of(path);
  require_folder_of(path);
  check_spheres(file.packing.view());
  if (output.density && !(*output.density > 0.0 && std::isfinite(*output.density)))
    throw InputError("the density is " + detail::number_text(*output.density) + ": give a positive number, kg/m3");
  Remarks remarks;
  if (output.density && format != PackingFormat::data)
    throw InputError(std::string("only the format data holds a density, and this is ") + name_of(format) +
                     ": leave the option density away");
  if (file.step.value_or(0) != 0 && format != PackingFormat::dump)
    remarks.push_back("lost: the time step " + std::to_string(*file.step));
  switch (format) {
    case PackingFormat::table: detail::write_file(path, table_of(file, remarks)); break;
    case PackingFormat::yade: detail::write_file(path, yade_text_of(file, remarks)); break;
    case PackingFormat::dump: detail::write_file(path, dump_of(file, remarks)); break;
    case PackingFormat::data: detail::write_file(path, data_of(file, output.density, remarks)); break;
    case PackingFormat::vtu: write_points(path, file, remarks); break;
  }
  return remarks;
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_arguments.hpp"

#include "numbers.hpp"
#include "pfv/error.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <cmath>
#include <limits>
#include <sstream>

namespace pfv::app {
namespace {

bool box_is_auto(const SolveArguments& arguments) { return arguments.box == std::vector<std::string>{"auto"}; }
bool box_is_dump(const SolveArguments& arguments) { return arguments.box == std::vector<std::string>{"dump"}; }

/// Along the periodic axes of the dump its own bounds, which --box must not contradict.
void apply_dump(const SolveArguments& arguments, Box& box) {
  const std::optional<PackingBounds>& dumped = arguments.file->bounds;
  if (!dumped || !dumped->any_periodic())
    throw InputError("--periodic dump: " + detail::quoted(arguments.packing) +
                     " is no dump of a simulation box with periodic sides (BOX BOUNDS pp ...): name the axes");
  box.tilt = dumped->tilt;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (!dumped->periodic[axis]) {
      if (arguments.box.empty())
        throw InputError("--periodic dump: the simulation box is not periodic along " + name +
                         ": give the flow's bounds there with --box");
      continue;
    }
    const double length = dumped->upper[axis] - dumped->lower[axis];
    const auto differ = [&](double a, double b) { return !(std::abs(a - b) <= 1e-9 * length); };
    if (!arguments.box.empty() && !box_is_auto(arguments) &&
        (differ(box.lower[axis], dumped->lower[axis]) || differ(box.upper[axis], dumped->upper[axis])))
      throw InputError("--box: along " + name + ", which is periodic in the dump, its bounds are " +
                       detail::number_text(dumped->lower[axis]) + " " + detail::number_text(dumped->upper[axis]) +
                       ": give these, or name the periodic axes yourself");
    box.lower[axis] = dumped->lower[axis];
    box.upper[axis] = dumped->upper[axis];
    box.periodic[axis] = true;
  }
}

/// "x", "x,y", "z,x,y": the axes along which the packing repeats.
void apply_periodic(const SolveArguments& arguments, Box& box) {
  const bool of_dump = periodic_as_dump(arguments);
  if (of_dump) apply_dump(arguments, box);
  if (of_dump && !arguments.tilt.empty())
    throw InputError("--tilt: the cell is that of the dump, with its tilt: leave it away");
  for (std::size_t k = 0; k < arguments.tilt.size(); ++k)
    box.tilt[static_cast<Eigen::Index>(k)] = number("--tilt", arguments.tilt[k]);
  if (!of_dump && !arguments.periodic.empty()) {
    box.periodic = periodic_axes(arguments);
    if (box_is_auto(arguments))
      throw InputError("--periodic: the extent of the spheres is no period: give the cell with --box");
  }
  box.pressure_gradient = gradient_of(arguments);
}

/// The simulation box that the file states.
void apply_bounds_of_file(const SolveArguments& arguments, Box& box) {
  const std::optional<PackingBounds>& stated = arguments.file->bounds;
  if (!stated)
    throw InputError("--box dump: " + detail::quoted(arguments.packing) +
                     " states no simulation box: give six numbers, or --box auto, the extent of the spheres");
  if (!stated->tilt.isZero(0.0) && !periodic_as_dump(arguments))
    throw InputError("--box dump: the simulation box is tilted: give --periodic dump, which takes its cell");
  for (int axis = 0; axis < 3; ++axis)
    if (stated->follows_grains[axis])
      throw InputError(std::string("--box dump: along ") + "xyz"[axis] + " the simulation box follows the grains "
                       "(boundary s), no wall stands there: give six numbers, or --box auto, their extent");
  box.lower = stated->lower;
  box.upper = stated->upper;
}

std::string text_of(const PackingBounds& bounds) {
  std::ostringstream text;
  text.precision(6);
  for (int axis = 0; axis < 3; ++axis)
    text << (axis > 0 ? " " : "") << bounds.lower[axis] << ' ' << bounds.upper[axis];
  return text.str();
}

}  // namespace

std::array<bool, 3> periodic_axes(const SolveArguments& arguments) {
  std::array<bool, 3> axes{};
  for (const std::string& axis : arguments.periodic) {
    if (axis != "x" && axis != "y" && axis != "z")
      throw InputError("--periodic: unknown axis " + detail::quoted(axis) +
                       ": give some of x, y, z, with commas between them, or dump alone");
    bool& periodic = axes[static_cast<std::size_t>(axis[0] - 'x')];
    if (periodic) throw InputError("--periodic: axis " + axis + " occurs twice");
    periodic = true;
  }
  return axes;
}

Eigen::Vector3d gradient_of(const SolveArguments& arguments) {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < arguments.gradient.size(); ++axis)
    gradient[static_cast<Eigen::Index>(axis)] = number("--gradient", arguments.gradient[axis]);
  return gradient;
}

bool periodic_as_dump(const SolveArguments& arguments) {
  return arguments.periodic == std::vector<std::string>{"dump"};
}

bool box_of_file(const SolveArguments& arguments) {
  return arguments.box.empty() || box_is_auto(arguments) || box_is_dump(arguments);
}

namespace {

/// Of the spheres of all ranks.
PackingBounds extent_on(const Ranks& ranks, const PackingArrays& own) {
  Eigen::Matrix<double, 6, 1> reach = Eigen::Matrix<double, 6, 1>::Constant(-std::numeric_limits<double>::infinity());
  if (own.ids.size() > 0) {
    const PackingBounds extent = extent_of(own);
    reach << extent.upper, -extent.lower;
  }
  ranks.take_largest(reach.data(), 6);
  return {-reach.tail<3>(), reach.head<3>(), {}};
}

}  // namespace

void look_for_box(SolveArguments& arguments, const Ranks& ranks) {
  const bool none = arguments.box.empty() && !arguments.container && arguments.periodic.empty();
  if (!none && !box_is_auto(arguments) && !box_is_dump(arguments) && !periodic_as_dump(arguments)) return;
  PackingChoice choice{arguments.snapshot, 1.0};
  ranks.together([&] { choice.length_unit = length_unit_of(arguments.length_unit); });
  arguments.file = std::make_shared<PackingFile>(read_packing_file(arguments.packing, choice, &ranks));
  arguments.extent = extent_on(ranks, arguments.file->packing);
  const std::optional<PackingBounds>& bounds = arguments.file->bounds;
  if (none && bounds && bounds->periodic[0] && bounds->periodic[1] && bounds->periodic[2])
    arguments.periodic = {"dump"};
}

void refuse_without_box(const SolveArguments& arguments) {
  std::string ways = "six numbers in m";
  if (arguments.file) {
    const std::optional<PackingBounds>& stated = arguments.file->bounds;
    if (stated) ways += ", --box dump (the simulation box of the file, " + text_of(*stated) + ")";
    ways += ", --box auto (the extent of the spheres, " + text_of(arguments.extent) + ")";
  }
  throw InputError("--box or --container is required, where the walls stand: give --box with " + ways +
                   "; see pfv solve --help");
}

Box box_of(const SolveArguments& arguments) {
  Box box;
  if (box_is_auto(arguments)) {
    box.lower = arguments.extent.lower;
    box.upper = arguments.extent.upper;
  } else if (box_is_dump(arguments)) {
    apply_bounds_of_file(arguments, box);
  } else if (!arguments.box.empty()) {
    if (arguments.box.size() != 6) throw InputError("--box: give six numbers, dump or auto: see pfv solve --help");
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = number("--box", arguments.box[2 * axis]);
      box.upper[axis] = number("--box", arguments.box[2 * axis + 1]);
    }
  }
  apply_periodic(arguments, box);
  check(box);
  return box;
}


}  // namespace pfv::app

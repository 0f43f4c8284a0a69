// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert_command.hpp"

#include "io/atomic_file.hpp"
#include "numbers.hpp"
#include "pfv/error.hpp"
#include "pfv/packing_file.hpp"
#include "solve_arguments.hpp"

#include <ostream>

namespace pfv::app {

void add_convert_options(CLI::App& command, ConvertArguments& arguments) {
  const std::string files = "Files";
  command.add_option("INPUT", arguments.input, "spheres in any format that `pfv solve` reads")
      ->required()->option_text("(required)")->group(files);
  command.add_option("OUTPUT", arguments.output,
                     "its ending says what is written: .csv (table), .dump, .data (LIGGGHTS),\n"
                     ".txt (YADE: x y z r), .vtu (ParaView)")
      ->required()->option_text("(required)")->group(files);
  command.add_option("--format", arguments.format, "another format than that of the ending (default: by the ending)")
      ->option_text(names_of<PackingFormat>("|"))->group(files);
  command.add_option("--snapshot", arguments.snapshot, "of a dump, as for `pfv solve` (default last)")
      ->option_text("N|time=T|last")->group(files);
  command.add_option("--length-unit", arguments.length_unit,
                     "unit of the input's lengths; the output is in m (default m)")
      ->option_text("m|cm|mm|um|METRES")->group(files);
  command.add_flag("--at-rest", arguments.at_rest, "leave the velocities out (default: kept)")->group(files);
  command.add_option("--density", arguments.density,
                     "of the grains, kg/m3, which a data file holds (default 2500, which is\n"
                     "said)")
      ->option_text("RHO")->group(files);
}

void convert(const ConvertArguments& arguments, std::ostream& out, std::ostream& remarks) {
  const auto say = [&](const std::string& file, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) remarks << "pfv: " << file << ": " << sentence << '\n';
  };
  if (same_file(arguments.input, arguments.output))
    throw InputError("output " + arguments.output + " would replace the input: give it a name of its own");
  PackingOutput output;
  if (!arguments.format.empty()) output.format = named<PackingFormat>(arguments.format);
  if (!arguments.density.empty()) output.density = positive("--density", arguments.density);
  PackingFile file = read_packing_file(arguments.input, {arguments.snapshot, length_unit_of(arguments.length_unit)});
  if (arguments.at_rest) file.packing.velocities.resize(3, 0);
  if (arguments.at_rest) file.packing.angular_velocities.resize(3, 0);
  const std::vector<std::string> changed = write_packing_file(arguments.output, file, output);
  say(arguments.input, file.remarks);
  say(arguments.output, changed);
  if (!detail::is_standard_output(arguments.output))
    out << file.packing.ids.size() << " spheres in " << arguments.output << '\n';
}

}  // namespace pfv::app

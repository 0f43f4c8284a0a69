// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings_command.hpp"

#include "problem/solver_abilities.hpp"
#include "solve_arguments.hpp"

#include <ostream>

namespace pfv::app {
namespace {

/// A bar would end the cell.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string in_fix(const Setting& setting) {
  const Hosts& hosts = setting.hosts;
  if (hosts.of_grid) return "behind *model darcy_grid*";
  if (hosts.fix) return std::string("*") + setting.name + "*" + (hosts.modify ? ", fix_modify" : "");
  return hosts.modify ? "fix_modify alone" : "";
}

std::string readers_of(const Setting& setting) {
  std::string readers;
  if (setting.models.size() == 1) readers = std::string("model ") + name_of(setting.models.front());
  if (setting.solvers) readers += "solver " + solvers_with(setting.solvers);
  return readers;
}

/// "yes or no"
std::string spoken(std::string values) {
  for (std::size_t at; (at = values.find('|')) != std::string::npos;) values.replace(at, 1, " or ");
  return values;
}

/// "MU (Pa s) = what it is (default 0.001)"
std::string explanation(const Setting& setting) {
  const std::string unit = setting.unit;
  return (unit.empty() ? "" : setting.values + " (" + unit + ") = ") + setting.help + " (default " +
         setting.text(Settings{}) + ")";
}

/// What follows the name of a grid.
void write_grid_syntax(std::ostream& out) {
  for (const Setting& setting : all_settings())
    if (setting.hosts.of_grid) out << " [" << setting.name << ' ' << setting.values << ']';
  out << '\n';
  for (const Setting& setting : all_settings())
    if (setting.hosts.of_grid)
      out << "  " << setting.name << ' ' << spoken(setting.values) << " = " << explanation(setting) << '\n';
}

void write_row(const Setting& setting, std::ostream& out) {
  const std::string unit = setting.unit;
  const std::string option = setting.hosts.command ? "`" + option_of(setting) + "`" : "";
  out << "| " << setting.name << " | " << cell(setting.values) << " | " << unit << " | "
      << setting.text(Settings{}) << " | " << in_fix(setting) << " | " << option << " | "
      << (setting.hosts.python ? setting.name : "") << " | " << readers_of(setting)
      << " | " << cell(setting.help) << " |\n";
}

}  // namespace

void write_settings(std::ostream& out) {
  out << "# Settings\n\n"
         "What a flow can be told besides its box and its files, as [fix pfv](fix_pfv.md), the\n"
         "[command](user_guide.md) and the [Python module](python.md) write it. `pfv settings` prints this page. A setting that the model or the solver\n"
         "does not read is refused, also at its default value.\n";
  std::string group;
  for (const Setting& setting : all_settings()) {
    if (group != setting.group) {
      group = setting.group;
      out << "\n## " << group << "\n\n"
          << "| setting | value | unit | default | fix pfv | pfv solve | Python | read by | what |\n"
          << "|---|---|---|---|---|---|---|---|---|\n";
    }
    write_row(setting, out);
  }
}

void write_fix_syntax(std::ostream& out) {
  for (const Setting& setting : all_settings()) {
    if (!setting.hosts.fix) continue;
    const bool is_model = setting.name == std::string("model");
    out << setting.name << " values = " << spoken(setting.values);
    if (is_model) out << ' ' << setting_named("cells")->values;
    is_model ? write_grid_syntax(out) : void(out << '\n');
    out << "  " << explanation(setting) << '\n';
  }
}

}  // namespace pfv::app

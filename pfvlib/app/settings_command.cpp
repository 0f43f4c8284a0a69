// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings_command.hpp"

#include "pfv/box.hpp"
#include "problem/solver_abilities.hpp"
#include "solve_arguments.hpp"
#include "text/number_text.hpp"

#include <cctype>
#include <ostream>
#include <sstream>

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

constexpr const char* none = "–";

const char* code(const char* name) { return name ? name : none; }

/// "geometric (`auto`), metis, amd"
std::string orderings_of(const SolverAbilities& solver) {
  const bool has_own = solver.own_ordering != OrderingKind::automatic;
  if (!solver.takes_orderings) return has_own ? name_of(solver.own_ordering) + std::string(" (its own)") : none;
  std::string text = name_of(solver.own_ordering) + std::string(" (`auto`)");
  for (const auto& one : Names<OrderingKind>::all)
    if (one.value != OrderingKind::automatic && one.value != solver.own_ordering) text += std::string(", ") + one.name;
  return text;
}

/// The type of a keyword in Python, by how its value is written.
std::string python_type(const Setting& setting) {
  const std::string number = setting.whole ? "int" : "float";
  if (setting.words == 0) return "bool";
  if (setting.words > 1) return setting.whole ? "Sequence[int]" : "ArrayLike";
  if (setting.values.find(' ') != std::string::npos) return number + " | str";
  const bool takes_number = setting.values.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string::npos;
  std::string type = takes_number ? number : "", words;
  std::istringstream values(setting.values);
  for (std::string value; std::getline(values, value, '|');)
    if (std::islower(static_cast<unsigned char>(value[0]))) words += (words.empty() ? "\"" : ", \"") + value + '"';
  if (!words.empty()) type = "Literal[" + words + "]" + (takes_number ? " | " + number : "");
  return type + (setting.text(Settings{}) == "none" ? " | None" : "");
}

std::string python_type(const BoundaryKind& kind) {
  if (!kind.symbol) return "bool";
  return kind.kind == Boundary::Kind::pressure ? "_Pressure" : "float";
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

void write_solver_table(std::ostream& out) {
  out << "| `--solver` | symbolic factorisation | factorisation, or preconditioner | solves | `--ordering` | `--tolerance` | "
         "threads share it | rebuilds in the background | several ranks share it | mixed precision | implicit steps |\n"
         "|--|--|--|--|--|--|--|--|--|--|--|\n";
  const auto yes_or_no = [](bool ability) { return ability ? "yes" : "no"; };
  for (const SolverAbilities& solver : Names<SolverKind>::all) {
    if (solver.value == SolverKind::automatic) continue;
    out << "| `" << solver.name << '`' << (resolved(SolverKind::automatic) == solver.value ? " (`auto`)" : "") << " | "
        << code(solver.analysed) << " | " << code(solver.factored) << " | " << solver.solved << " | " << orderings_of(solver)
        << " | " << (solver.is_iterative ? detail::number_text(solver.tolerance) : none);
    for (const bool ability : {solver.shares_work, solver.factors_beside_steps, solver.shared_by_ranks, solver.mixed_precision,
                               solver.implicit_steps})
      out << " | " << yes_or_no(ability);
    out << " |\n";
  }
}

void write_python_keywords(std::ostream& out) {
  const char* const between = " = ...,\n                 ";
  out << "# SPDX-License-Identifier: GPL-3.0-or-later\n"
         "# made by: pfv settings --python\n"
         "set(PFV_BOUNDARIES [==["
      << list_boundary_kinds([](const BoundaryKind& one) { return one.name + (": " + python_type(one)); }, between)
      << " = ...]==])\nset(PFV_SETTINGS [==[";
  const char* before = "";
  for (const Setting& setting : all_settings()) {
    if (!setting.hosts.python) continue;
    out << before << setting.name << ": " << python_type(setting);
    before = between;
  }
  out << " = ...]==])\n";
}

}  // namespace pfv::app

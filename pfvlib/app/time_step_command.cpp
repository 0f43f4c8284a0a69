// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_step_command.hpp"

#include "face_arguments.hpp"
#include "numbers.hpp"
#include "geometry/pi.hpp"
#include "io/atomic_file.hpp"
#include "pfv/error.hpp"
#include "pfv/flow.hpp"
#include "pfv/io.hpp"
#include "pfv/time_step.hpp"
#include "text/number_text.hpp"
#include "text/text_lines.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <ostream>

namespace pfv::app {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The sphere that is worst off.
struct Worst {
  double step = infinite;  ///< s
  std::int64_t id = -1;

  void take(double other, std::int64_t other_id) {
    if (other < step) *this = {other, other_id};
  }
};

struct Limits {
  double coupling = infinite;
  Worst viscous, formula, contact;
  std::optional<double> contacts;
  std::size_t spheres = 0, looked_at = 0;
};

Eigen::VectorXd masses_of(const Packing& packing, const std::string& density) {
  return 4.0 / 3.0 * pi * positive("--grain-density", density) * packing.radii.array().cube();
}

std::vector<Piston> pistons_of(const std::vector<std::string>& arguments, const Container& container) {
  std::vector<Piston> pistons(container.faces.size());
  for (const std::string& argument : arguments) {
    const std::size_t colon = argument.find(':');
    if (colon == std::string::npos)
      throw InputError("--piston: " + detail::quoted(argument) + " is no NAME:MASS, e.g. zhi:0.5");
    const std::optional<int> face = container.face_named(argument.substr(0, colon));
    if (!face) throw InputError("--piston: there is no face " + detail::quoted(argument.substr(0, colon)));
    Piston& piston = pistons[*face];
    if (std::isfinite(piston.mass))
      throw InputError("--piston: face " + argument.substr(0, colon) + " occurs twice");
    piston.mass = positive("--piston", argument.substr(colon + 1));
  }
  return pistons;
}

/// Columns of the spheres that are looked at one by one.
std::vector<int> chosen(const TimeStepArguments& arguments, const Packing& packing) {
  const auto count = static_cast<int>(packing.size());
  std::vector<int> columns;
  if (!arguments.ids.empty()) {
    std::map<std::int64_t, int> column_of;
    for (int k = 0; k < count; ++k) column_of[packing.ids[k]] = k;
    for (const std::string& text : arguments.ids) {
      const auto id = detail::integer(text);
      if (!id || column_of.count(*id) == 0)
        throw InputError("--ids: no sphere " + detail::quoted(text) + " in the packing");
      columns.push_back(column_of[*id]);
    }
    return columns;
  }
  int wanted = count;
  if (arguments.spheres != "all")
    wanted = std::min(count, whole_number("--spheres", arguments.spheres));
  for (int i = 0; i < wanted; ++i)
    columns.push_back(static_cast<int>(static_cast<std::int64_t>(i) * count / wanted));
  return columns;
}

void write_matrices(const std::string& path, const Packing& packing, const std::vector<int>& columns,
                    const std::vector<Eigen::Matrix3d>& matrices, double viscosity) {
  std::string text = "id,radius,vxx,vxy,vxz,vyx,vyy,vyz,vzx,vzy,vzz\n";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    text += std::to_string(packing.ids[columns[i]]) + ',';
    detail::append_number(text, packing.radii[columns[i]]);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        text += ',';
        detail::append_number(text, matrices[i](row, column) / viscosity);
      }
    text += '\n';
  }
  detail::write_file(path, text);
}

/// The flow problem with everything at rest.
SolveRequest problem_of(const TimeStepArguments& arguments) {
  if (!arguments.ids.empty() && arguments.spheres != "all")
    throw InputError("--ids and --spheres exclude each other: give one of them");
  if (arguments.tangential && !arguments.stiffness)
    throw InputError("--tangential-stiffness belongs to --contact-stiffness: give it too");
  SolveArguments problem = arguments.problem;
  problem.report = arguments.report;  // so that outputs that replace each other are refused
  problem.culprits = arguments.matrices;
  SolveRequest request = request_of(problem);
  for (ContainerFace& face : request.container.faces) {
    face.velocity.setZero();
    face.angular_velocity.setZero();
  }
  return request;
}

void add_contacts(const TimeStepArguments& arguments, const Packing& packing, const Container& container,
                  const Eigen::VectorXd& masses, Limits& limits) {
  if (!arguments.stiffness) return;
  const double tangential =
      arguments.tangential ? number("--tangential-stiffness", *arguments.tangential) : 0.0;
  const ContactSprings springs(packing, container,
                               {number("--contact-stiffness", *arguments.stiffness), tangential});
  const std::vector<Eigen::Matrix3d> stiffness = springs.of_spheres();
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    limits.contact.take(contact_time_step(masses[k], stiffness[static_cast<std::size_t>(k)]),
                        packing.ids[k]);
  limits.contacts = springs.time_step_limit(masses);
}

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const Worst& worst) {
  return {{"time_step", number_or_null(worst.step)},
          {"sphere", worst.id >= 0 ? Json(worst.id) : Json(nullptr)}};
}

void write_report_of(const std::string& path, const Limits& limits) {
  const Json json = {
      {"coupling_limit", number_or_null(limits.coupling)},
      {"viscous", json_of(limits.viscous)},
      {"formula", json_of(limits.formula)},
      {"contact", json_of(limits.contact)},
      {"contact_limit", limits.contacts ? number_or_null(*limits.contacts) : Json(nullptr)},
      {"spheres", limits.spheres},
      {"looked_at", limits.looked_at}};
  detail::write_file(path, json.dump(2) + "\n");
}

void print(const Limits& limits, std::ostream& out) {
  const auto line = [&](const char* name, double step, const Worst* worst) {
    out << std::left << std::setw(52) << name << std::setprecision(4);
    std::isfinite(step) ? out << step << " s" : out << "no limit";
    if (worst && worst->id >= 0) out << ", sphere " << worst->id;
    out << '\n';
  };
  line("explicit coupling, 2/lambda_max(M^-1 S G^-1 E)", limits.coupling, nullptr);
  line("papers: 2 min M/V (eq. 4.15)", limits.viscous.step, &limits.viscous);
  line("papers: min pi rho d^2/(1200 mu) (eq. 4.20)", limits.formula.step, &limits.formula);
  if (limits.contacts) {
    line("contacts: min sqrt(M/K) (eq. 2.14)", limits.contact.step, &limits.contact);
    line("contacts without dashpots, 2/omega_max", *limits.contacts, nullptr);
  }
  if (limits.looked_at < limits.spheres)
    out << "V of " << limits.looked_at << " of " << limits.spheres << " spheres\n";
}

}  // namespace

void add_time_step_options(CLI::App& command, TimeStepArguments& arguments) {
  add_flow_options(command, arguments.problem);
  add_settings(command, arguments.problem, {"viscosity", "conductance"});
  std::string group = "Grains";
  command.add_option("--grain-density", arguments.grain_density, "density of the grains, kg/m3")
      ->required()->option_text("RHO (required)")->group(group);
  command.add_option("--piston", arguments.pistons,
                     "a face that moves freely along its axis and its mass, kg, may be given\n"
                     "several times (default: faces do not yield)")
      ->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->option_text("NAME:MASS")->group(group);
  command.add_option("--contact-stiffness", arguments.stiffness,
                     "linear stiffness of each contact, spheres and faces, N/m\n"
                     "(default: no contacts)")->option_text("KN")->group(group);
  command.add_option("--tangential-stiffness", arguments.tangential,
                     "the same along the contact, N/m (default 0)")->option_text("KT")->group(group);
  group = "Spheres that are looked at one by one: three solves each";
  command.add_option("--spheres", arguments.spheres, "how many, evenly chosen (default all)")
      ->option_text("all|N")->group(group);
  command.add_option("--ids", arguments.ids, "or which (default: --spheres)")
      ->delimiter(',')->allow_extra_args(false)->option_text("ID,ID,...")->group(group);
  group = "Output beside the table";
  command.add_option("--report", arguments.report, "all of it (default: not written)")
      ->option_text("FILE.json")->group(group);
  command.add_option("--matrices", arguments.matrices,
                     "V* = V/mu of each sphere looked at, m (default: not written)")
      ->option_text("FILE.csv")->group(group);
  for (CLI::Option* option : command.get_options())
    if (!option->get_option_text().empty()) option->type_name("VALUE");  // in parser's messages
}

void time_step(const TimeStepArguments& arguments, std::ostream& out, std::ostream& warnings) {
  const SolveRequest request = problem_of(arguments);
  const std::vector<Piston> pistons = pistons_of(arguments.pistons, request.container);
  const PackingArrays arrays = packing_of(request, warnings);
  Packing packing = arrays.view();
  new (&packing.velocities) Eigen::Map<const Eigen::Matrix3Xd>(nullptr, 3, 0);
  const Eigen::VectorXd masses = masses_of(packing, arguments.grain_density);
  const std::vector<int> columns = chosen(arguments, packing);

  Flow flow(request.container, request.settings.fluid, request.settings.options);
  flow.evaluate(packing);
  const std::vector<Eigen::Matrix3d> matrices = flow.viscosity_matrices(columns);
  Limits limits;
  limits.coupling = flow.time_step_limit(masses, pistons);
  limits.spheres = static_cast<std::size_t>(packing.size());
  limits.looked_at = columns.size();
  for (std::size_t i = 0; i < columns.size(); ++i)
    limits.viscous.take(viscous_time_step(masses[columns[i]], matrices[i]), packing.ids[columns[i]]);
  for (Eigen::Index k = 0; k < packing.size(); ++k)
    limits.formula.take(estimated_time_step(masses[k], packing.radii[k], request.settings.fluid.viscosity),
                        packing.ids[k]);
  add_contacts(arguments, packing, request.container, masses, limits);
  if (arguments.matrices)
    write_matrices(*arguments.matrices, packing, columns, matrices, request.settings.fluid.viscosity);
  if (arguments.report) write_report_of(*arguments.report, limits);
  // An output on the same stream must stay what its format says.
  for (const auto& output : {arguments.report, arguments.matrices})
    if (output && detail::is_standard_output(*output)) return;
  print(limits, out);
}

}  // namespace pfv::app

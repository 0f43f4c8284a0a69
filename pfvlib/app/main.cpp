// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_command.hpp"
#include "convert_command.hpp"
#include "launch.hpp"
#include "pfv/error.hpp"
#include "pfv/version.hpp"
#include "pfv/words.hpp"
#include "selftest_command.hpp"
#include "settings_command.hpp"
#include "solve_arguments.hpp"
#include "solve_command.hpp"
#include "time_step_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iostream>
#include <new>
#include <string>
#include <thread>

namespace {

constexpr int succeeded = 0, failed = 1, bad_input = 2;

/// One line on standard error, whatever the message holds.
int complain(int status, std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  std::cerr << "pfv: " << message << '\n';
  return status;
}

const std::string version_line = std::string("pfv ") + pfv::version;

/// What one call of the program may be, with the arguments of each.
struct Commands {
  CLI::App app{"Flow through the pores of a sphere packing by pore-scale finite volumes (PFV)", "pfv"};
  CLI::App *solve, *convert, *selftest, *bench, *time_step, *settings;
  pfv::app::SolveArguments solve_arguments;
  pfv::app::ConvertArguments convert_arguments;
  pfv::app::BenchArguments bench_arguments;
  pfv::app::TimeStepArguments time_step_arguments;
  bool of_fix = false, of_solvers = false, of_python = false;

  Commands() {
    app.set_version_flag("--version", version_line);
    app.require_subcommand(1);
    solve = add("solve", "pressures, fluxes and forces of one packing");
    convert = add("convert", "files of spheres from one format into another");
    selftest = add("selftest", "known problems on this machine: a table of pass and fail");
    bench = add("bench", "times of each phase on packings made here, and what a run would cost");
    time_step =
        add("time-step", "which time step an explicit coupling bears, and the papers' estimates of it");
    settings = add("settings", "the table of all settings, as a page of the documentation");
    pfv::app::add_solve_options(*solve, solve_arguments);
    pfv::app::add_convert_options(*convert, convert_arguments);
    pfv::app::add_bench_options(*bench, bench_arguments);
    pfv::app::add_time_step_options(*time_step, time_step_arguments);
    CLI::Option* fix = settings->add_flag("--fix", of_fix, "the keywords of fix pfv instead, as its page has them");
    CLI::Option* solvers = settings->add_flag("--solvers", of_solvers, "what each solver is made of and can do instead");
    CLI::Option* python = settings->add_flag("--python", of_python, "the keywords of the Python module's stub instead");
    solvers->excludes(fix);
    python->excludes(fix)->excludes(solvers);
    add_examples();
  }

 private:
  CLI::App* add(const char* name, const char* description) {
    CLI::App* command = app.add_subcommand(name, description);
    command->set_version_flag("--version", version_line);
    return command;
  }

  void add_examples() {
    solve->footer(
        "Example: permeability along z\n"
        "  pfv solve --packing grains.csv --box 0 1 0 1 0 1 --face zlo:pressure=0\n"
        "            --face zhi:pressure=1 --wall symmetry --report report.json\n"
        "Exit status: 0; 2 bad input; 1 any other failure (solver, disk).");
    convert->footer(
        "Example: the grains of a LIGGGHTS run for YADE\n"
        "  pfv convert post/grains.dump grains.txt\n"
        "What the format does not hold (ids, velocities, bounds, periodic sides) is said.");
    bench->footer(
        "Example: what a run of 20000 grains and a million steps costs here\n"
        "  pfv bench --spheres 1000,5000 --predict 20000 --steps 1e6 --steps-per-network 5000");
    time_step->footer(
        "Example: grains of quartz under a lid of 0.2 kg\n"
        "  pfv time-step --packing grains.csv --box 0 1 0 1 0 1 --face zlo:pressure=0\n"
        "                --grain-density 2600 --piston zhi:0.2 --contact-stiffness 1e4");
  }
};

/// One rank talks for all.
void solve_on_ranks(pfv::app::SolveArguments arguments, const std::string& words) {
  const std::shared_ptr<const pfv::Ranks> ranks = pfv::app::launched_ranks();
  if (ranks) pfv::app::refuse_unlike_arguments(*ranks, words);
  if (std::vector<std::string>& solver = arguments.settings["solver"]; ranks && solver.empty()) solver = {"amg"};
  const pfv::app::SolveRequest request = pfv::app::request_of(arguments, ranks.get());
  std::ostream silent(nullptr);
  const bool speaks = pfv::app::speaks(ranks.get());
  solve(request, ranks, speaks ? std::cout : silent, speaks ? std::cerr : silent);
}

/// Of the command that was parsed.
int carry_out(const Commands& commands, const std::string& words) {
  using namespace pfv::app;
  if (commands.selftest->parsed()) return selftest(std::cout) ? succeeded : failed;
  if (commands.convert->parsed())
    convert(commands.convert_arguments, std::cout, std::cerr);
  else if (commands.bench->parsed())
    bench(commands.bench_arguments, std::cout);
  else if (commands.time_step->parsed())
    time_step(commands.time_step_arguments, std::cout, std::cerr);
  else if (commands.settings->parsed())
    (commands.of_fix       ? write_fix_syntax
     : commands.of_solvers ? write_solver_table
     : commands.of_python  ? write_python_keywords
                           : write_settings)(std::cout);
  else
    solve_on_ranks(commands.solve_arguments, words);
  return succeeded;
}

/// The first word, where it is no option and no command.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  if (!word.empty() && (word[0] == '-' || std::find(names.begin(), names.end(), word) != names.end())) return;
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  const std::string meant = pfv::meant_by(word, names);
  throw pfv::InputError((word.empty() ? "a command is missing" : "there is no command '" + word + "'") +
                        (meant.empty() ? ": give" : meant + " Give") + " one of " + known + "; see pfv --help");
}

/// Names the first option that the command does not have, where CLI11 says what is left of all words.
std::string refusal_of(const CLI::App& command, const CLI::ParseError& error, int argc, char** argv) {
  const std::string help = "see pfv " + (command.get_parent() ? command.get_name() + " " : "") + "--help";
  std::vector<std::string> names;
  for (const CLI::Option* one : command.get_options())
    for (const std::string& name : one->get_lnames()) names.push_back("--" + name);
  for (int i = 1; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    const std::string meant = pfv::meant_by(word, names);
    if (word.rfind("--", 0) == 0 && std::find(names.begin(), names.end(), word) == names.end())
      return "there is no option '" + word + "'" + (meant.empty() ? "; " : meant + " ") + help;
  }
  return error.what() + (": " + help);
}

int run(int argc, char** argv) {
  Commands commands;
  CLI::App& app = commands.app;
  refuse_unknown_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // help or version
    return app.exit(request, std::cout, std::cerr);
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    return complain(bad_input, refusal_of(command, error, argc, argv));
  }
  std::string words;
  for (int i = 1; i < argc; ++i) words += argv[i] + std::string(1, '\0');
  return carry_out(commands, words);
}

}  // namespace

namespace {

/// What all ranks know is said once; where one has failed alone, it ends the others.
int complain_on_ranks(int status, const std::string& message) {
  const std::shared_ptr<const pfv::Ranks> ranks = pfv::app::launched_ranks();
  const bool alone = ranks && !ranks->failed_together();
  // where all fail in the same way, the first speaks and ends the others before they do
  if (alone && ranks->own() > 0) std::this_thread::sleep_for(std::chrono::seconds(1));
  if (alone || pfv::app::speaks(ranks.get())) complain(status, message);
  pfv::app::end_others(ranks.get(), status);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int status = run(argc, argv);
    if (!std::cout.flush()) return complain(failed, "cannot write to standard output");
    return status;
  } catch (const pfv::InputError& error) {
    return complain_on_ranks(bad_input, error.what());
  } catch (const std::bad_alloc&) {
    return complain_on_ranks(failed, "not enough memory: use fewer spheres or another machine");
  } catch (const std::exception& error) {
    return complain_on_ranks(failed, error.what());
  }
}

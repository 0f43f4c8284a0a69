// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_command.hpp"
#include "pfv/error.hpp"
#include "pfv/version.hpp"
#include "selftest_command.hpp"
#include "settings_command.hpp"
#include "solve_arguments.hpp"
#include "solve_command.hpp"
#include "time_step_command.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <new>
#include <string>

namespace {

constexpr int succeeded = 0, failed = 1, bad_input = 2;

/// One line on standard error, whatever the message holds.
int complain(int status, std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  std::cerr << "pfv: " << message << '\n';
  return status;
}

int run(int argc, char** argv) {
  const std::string version_line = std::string("pfv ") + pfv::version;
  CLI::App app("Flow through the pores of a sphere packing by pore-scale finite volumes (PFV)",
               "pfv");
  app.set_version_flag("--version", version_line);
  app.require_subcommand(1);

  pfv::app::SolveArguments arguments;
  CLI::App* solve = app.add_subcommand("solve", "pressures, fluxes and forces of one packing");
  solve->set_version_flag("--version", version_line);
  pfv::app::add_solve_options(*solve, arguments);
  solve->footer(
      "Example: permeability along z\n"
      "  pfv solve --packing grains.csv --box 0 1 0 1 0 1 --face zlo:pressure=0\n"
      "            --face zhi:pressure=1 --wall symmetry --report report.json\n"
      "Exit status: 0; 2 bad input; 1 any other failure (solver, disk).");
  CLI::App* selftest =
      app.add_subcommand("selftest", "known problems on this machine: a table of pass and fail");
  selftest->set_version_flag("--version", version_line);
  pfv::app::BenchArguments bench_arguments;
  CLI::App* bench = app.add_subcommand(
      "bench", "times of each phase on packings made here, and what a run would cost");
  bench->set_version_flag("--version", version_line);
  pfv::app::add_bench_options(*bench, bench_arguments);
  bench->footer(
      "Example: what a run of 20000 grains and a million steps costs here\n"
      "  pfv bench --spheres 1000,5000 --predict 20000 --steps 1e6 --steps-per-network 5000");
  pfv::app::TimeStepArguments time_step_arguments;
  CLI::App* time_step = app.add_subcommand(
      "time-step", "which time step an explicit coupling bears, and the papers' estimates of it");
  time_step->set_version_flag("--version", version_line);
  pfv::app::add_time_step_options(*time_step, time_step_arguments);
  time_step->footer(
      "Example: grains of quartz under a lid of 0.2 kg\n"
      "  pfv time-step --packing grains.csv --box 0 1 0 1 0 1 --face zlo:pressure=0\n"
      "                --grain-density 2600 --piston zhi:0.2 --contact-stiffness 1e4");
  CLI::App* settings = app.add_subcommand("settings", "the table of all settings, as a page of the documentation");
  settings->set_version_flag("--version", version_line);
  const CLI::Option* of_fix = settings->add_flag("--fix", "the keywords of fix pfv instead, as its page has them");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // help or version
    return app.exit(request, std::cout, std::cerr);
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const std::string command = chosen.empty() ? "pfv" : "pfv " + chosen.front()->get_name();
    return complain(bad_input, error.what() + (": see " + command + " --help"));
  }
  if (selftest->parsed()) return pfv::app::selftest(std::cout) ? succeeded : failed;
  if (bench->parsed()) {
    pfv::app::bench(bench_arguments, std::cout);
    return succeeded;
  }
  if (settings->parsed()) {
    of_fix->count() > 0 ? pfv::app::write_fix_syntax(std::cout) : pfv::app::write_settings(std::cout);
    return succeeded;
  }
  if (time_step->parsed()) {
    pfv::app::time_step(time_step_arguments, std::cout);
    return succeeded;
  }
  pfv::app::solve(pfv::app::request_of(arguments), std::cout, std::cerr);
  return succeeded;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int status = run(argc, argv);
    if (!std::cout.flush()) return complain(failed, "cannot write to standard output");
    return status;
  } catch (const pfv::InputError& error) {
    return complain(bad_input, error.what());
  } catch (const std::bad_alloc&) {
    return complain(failed, "not enough memory: use fewer spheres or another machine");
  } catch (const std::exception& error) {
    return complain(failed, error.what());
  }
}

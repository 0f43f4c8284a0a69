// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace pfv::app {

struct BenchArguments {
  std::vector<std::string> sizes{"1000", "5000", "20000"};
  std::vector<std::string> solvers{"auto"};
  std::string ordering = "auto", conductance, precision, threads = "1", repeat = "5";
  std::optional<std::string> predict, steps, steps_per_network, report;
};

void add_bench_options(CLI::App& command, BenchArguments& arguments);

/// Times each phase on dense packings that it makes itself, fits t = a N^b to each phase (the terms of
/// Catalano 2012 eq. 5.19 on this machine) and, where asked for, says what a run would cost. A table
/// goes to `out`, everything measured into the JSON file. Throws InputError, FileError, SolverError.
void bench(const BenchArguments& arguments, std::ostream& out);

}  // namespace pfv::app

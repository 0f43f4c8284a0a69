// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_command.hpp"

#include "problem/solver_abilities.hpp"
#include "work/peak_memory.hpp"
#include "work/phase_clock.hpp"
#include "io/atomic_file.hpp"
#include "numbers.hpp"
#include "pfv/pfv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <thread>

namespace pfv::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int largest_size = 1'000'000;

/// Phases in the order of a call, in CPU seconds, then what the whole of them needs.
const std::vector<std::string> measured_names{"triangulate", "throats", "assemble",
                                              "order",       "factor",  "solve",
                                              "forces",      "rebuild", "first", "step"};

using Times = std::map<std::string, double>;
struct Sample {
  Times cpu, wall;
};

/// The column sinks on its undrained base, so that volume rates are at work too.
PackingArrays sinking_packing(int spheres) {
  PackingArrays packing = dense_packing(spheres);
  packing.velocities = Eigen::Matrix3Xd::Zero(3, spheres);
  packing.velocities.row(2) = -packing.positions.row(2);
  return packing;
}

Box drained_box() {
  Box box;
  for (FaceCondition& face : box.faces) face.wall = Wall::symmetry;
  box[Face::zlo].boundary = Boundary::pressure(0.0);
  box[Face::zhi].boundary = Boundary::pressure(1.0);
  return box;
}

Times operator-(Times after, const Times& before) {
  for (auto& [name, seconds] : after) seconds -= before.at(name);
  return after;
}

Times phases_of(const Seconds& s) {
  return {{"triangulate", s.triangulate}, {"throats", s.throats}, {"assemble", s.assemble},
          {"order", s.order},             {"factor", s.factor},   {"solve", s.solve},
          {"forces", s.forces},           {"rebuild", s.total}};
}

/// A network from nothing ("first"), another one in its place, as a run makes them, then steps on it.
/// Grains speed up by 0.1 % a step: a solver that begins with the last step's pressures must find new
/// ones, as in a run.
Sample measure_once(PackingArrays packing, const Options& options, Report& report) {
  constexpr int steps = 20;
  Flow flow(drained_box(), Fluid{}, options);
  flow.evaluate(packing.view());
  const Report first = flow.report();
  flow.rebuild();
  flow.evaluate(packing.view());
  report = flow.report();
  Sample sample;
  sample.cpu = phases_of(report.seconds) - phases_of(first.seconds);
  sample.cpu["first"] = first.seconds.total;
  sample.wall = {{"first", first.wall_seconds.total},
                 {"rebuild", report.wall_seconds.total - first.wall_seconds.total}};
  std::vector<double> cpu, wall;
  for (int step = 0; step < steps; ++step) {
    packing.velocities *= 1.001;
    const double cpu_start = cpu_seconds(), wall_start = wall_seconds();
    flow.evaluate(packing.view());
    cpu.push_back(cpu_seconds() - cpu_start);
    wall.push_back(wall_seconds() - wall_start);
  }
  sample.cpu["step"] = median(cpu);
  sample.wall["step"] = median(wall);
  return sample;
}

struct Row {
  int spheres = 0;
  std::int64_t memory = 0;  ///< of the process so far, above that of the bare program, bytes; what a
                            ///< report takes besides is not in it
  std::string solver, ordering;
  Report report;
  std::map<std::string, std::vector<double>> seconds;       ///< CPU, all repeats of each phase
  std::map<std::string, std::vector<double>> wall_seconds;  ///< of "rebuild" and "step"
};

Row measure(const PackingArrays& packing, const Options& options, int repeat,
            std::int64_t bare_memory) {
  Row row;
  row.spheres = static_cast<int>(packing.ids.size());
  {
    Flow flow(drained_box(), Fluid{}, options);
    for (int network = 0; network < 2; ++network, flow.rebuild()) flow.evaluate(packing.view());
  }
  row.memory = peak_memory() - bare_memory;
  for (int k = 0; k < repeat; ++k) {
    const Sample sample = measure_once(packing, options, row.report);
    for (const auto& [name, seconds] : sample.cpu) row.seconds[name].push_back(seconds);
    for (const auto& [name, seconds] : sample.wall) row.wall_seconds[name].push_back(seconds);
  }
  row.solver = row.report.solver;
  row.ordering = row.report.ordering;
  return row;
}

/// t = factor N^exponent, by least squares in the logarithms.
struct PowerLaw {
  double factor = 0.0, exponent = 1.0;
  double at(double size) const { return factor * std::pow(size, exponent); }
};

PowerLaw fit(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& [size, value] : points) {
    const double a = std::log(size), b = std::log(std::max(value, 1e-9));
    x += a, y += b, xx += a * a, xy += a * b;
  }
  const double spread = n * xx - x * x;
  PowerLaw law;
  if (spread > 1e-9) law.exponent = (n * xy - x * y) / spread;
  law.factor = std::exp((y - law.exponent * x) / n);
  return law;
}

std::vector<std::string> solvers_of(const std::vector<Row>& rows) {
  std::vector<std::string> solvers;
  for (const Row& row : rows)
    if (std::find(solvers.begin(), solvers.end(), row.solver) == solvers.end())
      solvers.push_back(row.solver);
  return solvers;
}

/// The laws of one solver: each phase, and the memory. What is measured is the most that the process
/// has held so far, so memory has a meaning only where one solver ran, over ascending sizes.
std::map<std::string, PowerLaw> laws_of(const std::vector<Row>& rows, const std::string& solver) {
  std::map<std::string, std::vector<std::pair<double, double>>> points;
  for (const Row& row : rows) {
    if (row.solver != solver) continue;
    for (const auto& [name, values] : row.seconds)
      points[name].emplace_back(row.spheres, median(values));
    points["memory_bytes"].emplace_back(row.spheres, static_cast<double>(row.memory));
  }
  if (solvers_of(rows).size() > 1) points.erase("memory_bytes");
  std::map<std::string, PowerLaw> laws;
  for (const auto& [name, values] : points) laws[name] = fit(values);
  return laws;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

double load() {
  double average = 0.0;
  return getloadavg(&average, 1) == 1 ? average : 0.0;
}

Json machine(double load_before) {
  return {{"processor", processor()},
          {"cores", std::thread::hardware_concurrency()},
          {"load_before", load_before},
          {"load_after", load()},
          {"pfv", pfv::version},
          {"compiler", __VERSION__}};
}

Json spread_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {{"median", median(values)}, {"least", *least}, {"most", *most}, {"repeats", values}};
}

Json to_json(const std::vector<Row>& rows, const Options& options, double load_before) {
  Json json{{"machine", machine(load_before)},
            {"conductance", name_of(options.conductance)},
            {"precision", name_of(options.precision)},
            {"threads", options.threads}};
  for (const Row& row : rows) {
    Json entry{{"spheres", row.spheres},
               {"pores", row.report.pores},
               {"unknowns", row.report.unknowns},
               {"solver", row.solver},
               {"ordering", row.ordering},
               {"residual", row.report.residual},
               {"mass_error", row.report.mass_error},
               {"memory_bytes", row.memory}};
    for (const std::string& name : measured_names)
      entry["cpu_seconds"][name] = spread_of(row.seconds.at(name));
    for (const auto& [name, values] : row.wall_seconds)
      entry["wall_seconds"][name] = spread_of(values);
    json["rows"].push_back(entry);
  }
  for (const std::string& solver : solvers_of(rows))
    for (const auto& [name, law] : laws_of(rows, solver))
      json["fits"][solver][name] = {{"factor", law.factor}, {"exponent", law.exponent}};
  return json;
}

void print_table(const std::vector<Row>& rows, const std::string& solver, std::ostream& out) {
  out << "\nCPU milliseconds, medians; solver " << solver << "\n" << std::left << std::setw(14)
      << "spheres";
  std::vector<const Row*> chosen;
  for (const Row& row : rows)
    if (row.solver == solver) chosen.push_back(&row);
  for (const Row* row : chosen) out << std::right << std::setw(11) << row->spheres;
  out << std::setw(12) << "~ N^" << '\n';
  const auto laws = laws_of(rows, solver);
  for (const std::string& name : measured_names) {
    out << std::left << std::setw(14) << name << std::right << std::setprecision(4);
    for (const Row* row : chosen) out << std::setw(11) << 1e3 * median(row->seconds.at(name));
    if (chosen.size() > 1) out << std::setw(12) << std::setprecision(3) << laws.at(name).exponent;
    out << '\n';
  }
  if (laws.count("memory_bytes") == 0) return;
  out << std::left << std::setw(14) << "memory, MB" << std::right << std::setprecision(4);
  for (const Row* row : chosen)
    out << std::setw(11) << static_cast<double>(row->memory) / 1e6;
  out << '\n';
}

/// Catalano 2012 eq. 5.19 with the factors of this machine, without the grains' own share.
void print_prediction(const BenchArguments& arguments, const std::vector<Row>& rows,
                      std::ostream& out) {
  const int size = whole_number("--predict", *arguments.predict, 1, 100 * largest_size);
  const double steps = arguments.steps ? number("--steps", *arguments.steps) : 1.0;
  const double per_network =
      arguments.steps_per_network ? number("--steps-per-network", *arguments.steps_per_network)
                                  : steps;
  if (!(steps >= 1.0)) throw InputError("--steps: " + *arguments.steps + " is < 1");
  if (!(per_network >= 1.0))
    throw InputError("--steps-per-network: " + *arguments.steps_per_network + " is < 1");
  const double networks = std::ceil(steps / per_network);
  out << "\n"
      << std::setprecision(12) << size << " grains, " << steps << " steps, " << networks
      << " networks:\n";
  std::string best;
  double best_time = 0.0;
  for (const std::string& solver : solvers_of(rows)) {
    const auto laws = laws_of(rows, solver);
    const double network = laws.at("rebuild").at(size), step = laws.at("step").at(size);
    const double time = networks * network + std::max(0.0, steps - networks) * step;
    out << "  " << solver << std::setprecision(3) << ": a network " << network << " s, a step "
        << 1e3 * step << " ms, together " << time << " CPU s";
    if (laws.count("memory_bytes") > 0)
      out << "; memory " << laws.at("memory_bytes").at(size) / 1e9 << " GB";
    out << '\n';
    if (best.empty() || time < best_time) best = solver, best_time = time;
  }
  const double largest = rows.back().spheres;
  out << "  take --solver " << best;
  if (size > 2 * largest) out << " (beyond twice the largest size measured: a guess)";
  out << "\n";
}

}  // namespace

void add_bench_options(CLI::App& command, BenchArguments& arguments) {
  command.add_option("--spheres", arguments.sizes, "sizes of the packings, ascending")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--solver", arguments.solvers, "solvers to compare: " + names_of<SolverKind>())
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--ordering", arguments.ordering, "ordering of the direct solver: " + names_of<OrderingKind>())
      ->capture_default_str();
  const Options defaults;
  arguments.conductance = name_of(defaults.conductance);
  arguments.precision = name_of(defaults.precision);
  command.add_option("--conductance", arguments.conductance, "conductance law: " + names_of<ConductanceLaw>())
      ->capture_default_str();
  command.add_option("--precision", arguments.precision,
                     "how supernodal keeps its factor: " + names_of<Precision>())
      ->capture_default_str();
  command.add_option("--threads", arguments.threads, "threads that share a rebuild or step")
      ->capture_default_str();
  command.add_option("--repeat", arguments.repeat, "repeats of each size")->capture_default_str();
  command.add_option("--predict", arguments.predict, "number of grains to predict a run for");
  command.add_option("--steps", arguments.steps, "steps of that run (default 1)");
  command.add_option("--steps-per-network", arguments.steps_per_network,
                     "steps between two of its retriangulations (default: all)");
  command.add_option("--report", arguments.report, "JSON file for everything measured");
}

void bench(const BenchArguments& arguments, std::ostream& out) {
  if (arguments.report) require_folder_of(*arguments.report);
  if (!arguments.predict && (arguments.steps || arguments.steps_per_network))
    throw InputError("--steps and --steps-per-network belong to --predict: give it too");
  const int repeat = whole_number("--repeat", arguments.repeat, 1, 1000);
  std::vector<int> sizes;
  for (const std::string& text : arguments.sizes) {
    sizes.push_back(whole_number("--spheres", text, 10, largest_size));
    if (sizes.size() > 1 && sizes.back() <= sizes[sizes.size() - 2])
      throw InputError("--spheres: " + text + " is not above the size before it");
  }
  if (arguments.predict && sizes.size() < 2)
    throw InputError("--predict needs at least two sizes to fit: give more with --spheres");
  Options options;
  options.conductance = named<ConductanceLaw>(arguments.conductance);
  options.precision = named<Precision>(arguments.precision);
  options.threads = whole_number("--threads", arguments.threads, 1, 64);
  const double load_before = load();
  const std::int64_t bare_memory = peak_memory();
  std::vector<Row> rows;
  for (const int size : sizes) {
    const PackingArrays packing = sinking_packing(size);
    for (const std::string& solver : arguments.solvers) {
      options.solver = named<SolverKind>(solver);
      // auto changes over between networks, a row is of the one that a run begins with
      if (options.solver == SolverKind::automatic && size < options.amg_from) options.solver = resolved(options.solver);
      options.ordering = named<OrderingKind>(arguments.ordering);
      check(options);
      rows.push_back(measure(packing, options, repeat, bare_memory));
    }
  }
  for (const std::string& solver : solvers_of(rows)) print_table(rows, solver, out);
  if (arguments.predict) print_prediction(arguments, rows, out);
  if (arguments.report)
    detail::write_file(*arguments.report, to_json(rows, options, load_before).dump(2) + "\n");
}

}  // namespace pfv::app

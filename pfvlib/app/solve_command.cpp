// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve_command.hpp"

#include "solve_obstacles.hpp"

#include "distributed/even_rows.hpp"
#include "launch.hpp"
#include "network/grains.hpp"
#include "network/pore_boundaries.hpp"
#include "parallel/one_rank.hpp"
#include "work/phase_clock.hpp"
#include "io/atomic_file.hpp"
#include "numbers.hpp"
#include "pfv/darcy_grid.hpp"
#include "pfv/flow.hpp"
#include "pfv/io.hpp"
#include "text/number_text.hpp"

#include <filesystem>
#include <algorithm>
#include <iomanip>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

namespace pfv::app {
namespace {

struct StepTimes {
  std::optional<double> cpu, wall;
};

StepTimes repeat_steps(FlowModel& flow, const Packing& packing, const SolveRequest& request) {
  if (request.repeat == 0) return {};
  std::vector<double> cpu, wall;
  for (int step = 0; step < request.repeat; ++step) {
    const double cpu_start = cpu_seconds(), wall_start = wall_seconds();
    flow.evaluate(packing, request.time_step);
    cpu.push_back(cpu_seconds() - cpu_start);
    wall.push_back(wall_seconds() - wall_start);
  }
  return {median(cpu), median(wall)};
}

/// What is said about a packing, on all ranks.
struct Facts {
  bool at_rest = false;
  double fastest = 0.0;        ///< m/s
  double mean_diameter = 0.0;  ///< m
  std::vector<std::int64_t> hidden;  ///< ids

  Facts(const SolveRequest& request, const FlowModel& flow, const Packing& packing, const Ranks* ranks) {
    double sums[3] = {packing.radii.sum(), static_cast<double>(packing.size()), 0.0};
    double largest[2] = {pfv::at_rest(packing, request.container) ? 0.0 : 1.0,
                         packing.velocities.cols() > 0 ? packing.velocities.colwise().norm().maxCoeff() : 0.0};
    Ranks::Bytes ids;
    for (const int column : flow.hidden()) append(ids, packing.ids.data() + column, 1);
    std::vector<Ranks::Bytes> all{ids};
    if (ranks) {
      ranks->add(sums, 2);
      ranks->take_largest(largest, 2);
      all = ranks->gather(ids);
    }
    for (const Ranks::Bytes& part : all)
      for (const std::int64_t id : values_in<std::int64_t>(part)) hidden.push_back(id);
    at_rest = largest[0] == 0.0;
    fastest = largest[1];
    mean_diameter = sums[1] > 0.0 ? 2.0 * sums[0] / sums[1] : 0.0;
  }
};

/// Where nothing drives a flow, what is missing.
std::optional<std::string> why_nothing_flows(const SolveRequest& request, const Facts& facts) {
  const Container& container = request.container;
  if (request.settings.fluid.bulk_modulus || !facts.at_rest || !container.pressure_gradient.isZero(0.0)) return {};
  std::optional<double> level;
  for (int number = 0; number < boundary_count(container); ++number) {
    const Boundary& boundary = boundary_of(container, number);
    if (boundary.drives_flux() || boundary.profile) return {};
    if (!boundary.imposes_pressure()) continue;
    if (level && *level != boundary.value) return {};
    level = boundary.value;
  }
  if (!level) return "no pressure anywhere, no flux and grains at rest: p is 0";
  return "nothing drives a flow: p is " + detail::number_text(*level) +
         " Pa everywhere; give the opposite face, or another, a pressure that differs, or a flux";
}

void warn_of_hidden(const Facts& facts, std::ostream& warnings) {
  constexpr std::size_t shown = 5;
  const std::vector<std::int64_t>& hidden = facts.hidden;
  if (hidden.empty()) return;
  warnings << "pfv: warning: " << hidden.size()
           << " hidden spheres lie inside bigger ones and touch no pore, ids";
  for (std::size_t k = 0; k < std::min(shown, hidden.size()); ++k) warnings << ' ' << hidden[k];
  warnings << (hidden.size() > shown ? " ...\n" : "\n");
}

/// A flow between pressures through grains that are not quite at rest.
void warn_of_motion(const SolveRequest& request, const Facts& facts, const Report& report, std::ostream& warnings) {
  if (report.permeability || facts.fastest == 0.0) return;
  const auto& faces = request.container.faces;
  const auto pressures = std::count_if(faces.begin(), faces.end(), [](const ContainerFace& face) {
    return face.boundary.imposes_pressure();
  });
  if (pressures != 2 || facts.at_rest) return;
  warnings << "pfv: warning: the grains move, up to " << facts.fastest
           << " m/s: no permeability is given; --at-rest leaves their velocities out\n";
}

/// Spheres or walls in another unit than m.
void warn_of_size(const Facts& facts, const Report& report, std::ostream& warnings) {
  constexpr double hardly_any = 1e-6;  // a box that is a hundred times too large along each axis
  constexpr std::int64_t packing = 10;
  if (facts.mean_diameter > largest_usual_diameter)
    warnings << "pfv: warning: the mean diameter is " << facts.mean_diameter
             << " m; lengths are in m: is --length-unit mm missing?\n";
  if (report.spheres >= packing && 1.0 - report.porosity < hardly_any)
    warnings << "pfv: warning: the spheres fill " << detail::percent_text(1.0 - report.porosity)
             << " of the room: the walls are in m, whatever unit the packing is in; are they meant in another?\n";
}

void warn_of_pinned(const SolveRequest& request, const Facts& facts, const Report& report, std::ostream& warnings) {
  const Counts& counts = report.counts;
  // in a cell that is periodic all around no pressure has a level
  if (report.permeability_tensor && counts.pinned_pores == 0) return;
  if (const auto why = why_nothing_flows(request, facts))
    warnings << "pfv: warning: " << *why << '\n';
  else if (counts.pinned_pores > 0)
    warnings << "pfv: warning: " << counts.pinned_pores
             << " pores at rest have no way to the fluid: they take the mean pressure around them\n";
}

void warn_of_empty_space(const FlowModel& flow, std::ostream& warnings) {
  const auto* pores = dynamic_cast<const Flow*>(&flow);
  const auto warning = pores ? warning_of(pores->empty_space()) : std::nullopt;
  if (warning) warnings << "pfv: warning: " << *warning << '\n';
}

/// Of a fluid whose density is known.
void warn_of_inertia(const SolveRequest& request, const Report& report, std::ostream& warnings) {
  if (request.settings.given.count("density") == 0 || !report.reynolds_largest || !(*report.reynolds_largest > 1.0)) return;
  warnings << "pfv: warning: the Reynolds number of the throats reaches " << *report.reynolds_largest << " (mean "
           << *report.reynolds_mean << "): above 1 the fluid's inertia, which this model leaves out, counts\n";
}

void warn(const SolveRequest& request, const FlowModel& flow, const Facts& facts, const Report& report,
          std::ostream& warnings) {
  const Counts& counts = report.counts;
  warn_of_hidden(facts, warnings);
  warn_of_motion(request, facts, report, warnings);
  warn_of_size(facts, report, warnings);
  warn_of_empty_space(flow, warnings);
  warn_of_pinned(request, facts, report, warnings);
  warn_of_inertia(request, report, warnings);
  if (counts.degenerate_throats > 0)
    warnings << "pfv: warning: " << counts.degenerate_throats
             << " throats without positive volume, surface or area: a rule sets their"
                " conductance\n";
  for (const std::string& reason : report.outside_range)
    warnings << "pfv: warning: the permeability's estimated error may not hold: " << reason << '\n';
}

void write_outputs(const SolveRequest& request, const FlowModel& flow, const DealtPacking& packing,
                   const Report& report, Eigen::Index grains, const Forces& forces, const Ranks* ranks) {
  if (request.forces)
    write_forces(*request.forces, first_spheres(packing.rows(), grains), first_forces(forces, grains), ranks);
  const auto by_one = [&](const auto& write) {
    const auto alone = [&] {
      if (speaks(ranks)) write();
    };
    if (ranks) ranks->together(alone);
    else alone();
  };
  if (request.report) by_one([&] { write_report(*request.report, report); });
  if (!request.vtk) return;
  if (ranks) write_fields(*request.vtk, flow.fields(), *ranks);
  else write_fields(*request.vtk, flow.fields());
  by_one([&] { write_walls_beside(*request.vtk, flow.container(), report.faces); });
}

const Eigen::IOFormat one_blank(Eigen::StreamPrecision, Eigen::DontAlignCols);

/// The tensor stands in the report; without a gradient its error is worth a line all the same.
void write_permeability(const Report& report, std::ostream& out) {
  if (report.permeability) out << "permeability " << *report.permeability << " m2, ";
  else if (report.permeability_tensor)
    out << "permeability along x, y, z " << report.permeability_tensor->diagonal().transpose().format(one_blank) << " m2, ";
  if (report.permeability_error)
    out << "estimated error of the permeability " << detail::percent_text(*report.permeability_error)
        << ", degenerate throats' share of the dissipation " << detail::percent_text(*report.degenerate_share) << '\n';
}

void write_summary(const SolveRequest& request, const Report& report, std::ostream& out) {
  // An output on the same stream must stay what its format says.
  for (const auto& output : {request.forces, request.report, request.vtk})
    if (output && detail::is_standard_output(*output)) return;
  out << std::setprecision(6) << report.spheres << " spheres, " << report.pores
      << (request.settings.grid() ? " cells, " : " pores, ")
      << report.unknowns << " unknowns, " << report.seconds.total << " s\n";
  write_permeability(report, out);
  out << "inflow " << report.inflow << " m3/s, outflow " << report.outflow << " m3/s\n";
  if (!request.forces && !request.report && !request.vtk)
    for (const FaceResult& face : report.faces) out << "flux " << face.name << ' ' << face.flux << " m3/s\n";
  for (const ObstacleResult& one : report.obstacles)
    out << "obstacle " << one.name << ": " << one.spheres << " spheres, volume " << one.volume << " m3, force "
        << one.force.transpose().format(one_blank) << " N, moment " << one.moment.transpose().format(one_blank) << " N m\n";
}

bool names_pieces(const std::string& path) { return std::filesystem::path(path).extension() == ".pvtu"; }

void refuse_on_ranks(const SolveRequest& request) {
  if (request.settings.grid()) throw InputError("the model darcy_grid runs on one rank");
  if (request.culprits) throw InputError("--culprits is written by one rank; run without mpirun for it");
  if (request.vtk && !names_pieces(*request.vtk))
    throw InputError("--vtk " + *request.vtk + ": each rank writes a piece; give a file .pvtu, which names them");
}

/// CPU time of all ranks, wall time of the slowest.
void add_times(Report& report, double read_seconds, const StepTimes& step, const Ranks* ranks) {
  report.seconds.read = ranks ? ranks->sum(read_seconds) : read_seconds;
  report.seconds.step = step.cpu;
  report.wall_seconds.step = step.wall;
  if (!ranks || !step.cpu) return;
  report.seconds.step = ranks->sum(*step.cpu);
  report.wall_seconds.step = ranks->largest(*step.wall);
}

/// The grains of a file and, behind them, the spheres of obstacles.
struct WithObstacles {
  PackingArrays spheres;    ///< this rank's share of all of them
  Eigen::Index first = 0;   ///< of these, among all
  Eigen::Index grains = 0;  ///< of all ranks
  std::vector<StandingObstacle> obstacles;
};

WithObstacles read_spheres(const SolveRequest& request, const Ranks* ranks, std::ostream& warnings) {
  if (!ranks && request.vtk && names_pieces(*request.vtk))
    throw InputError("--vtk " + *request.vtk + ": names the pieces of several ranks; one writes a .vtu");
  if (ranks) ranks->together([&] { refuse_on_ranks(request); });
  const Ranks& all = ranks_or_one(ranks);
  WithObstacles read;
  read.spheres = packing_of(request, warnings, ranks);
  read.grains = rows_of_all(read.spheres.ids.size(), all);
  read.obstacles = add_obstacles(request, read.spheres, warnings, all);
  read.first = rows_before(read.spheres.ids.size(), all);
  return read;
}

}  // namespace

void solve(const SolveRequest& request, const std::shared_ptr<const Ranks>& ranks, std::ostream& out,
           std::ostream& warnings) {
  const double start = cpu_seconds();
  WithObstacles read = read_spheres(request, ranks.get(), warnings);
  const DealtPacking dealt(std::move(read.spheres), request.container, ranks.get());
  const Packing packing = dealt.own();
  const double read_seconds = cpu_seconds() - start;

  Options options = request.settings.options;
  if (request.repeat == 0) options.amg_from = amg_from_for_one_solution;
  const std::unique_ptr<FlowModel> model =
      make_flow(request.container, request.settings.fluid, options, request.settings.grid(), ranks);
  FlowModel& flow = *model;
  try {
    flow.evaluate(packing, request.time_step);
  } catch (const Error& error) {
    if (request.culprits) write_culprits(*request.culprits, packing, error.culprits());
    throw;
  }
  const StepTimes step = repeat_steps(flow, packing, request);

  Report report = flow.report();
  add_times(report, read_seconds, step, ranks.get());
  const bool wants_forces = request.forces || !read.obstacles.empty();
  const Forces forces = wants_forces ? dealt.forces_of_rows(flow.forces()) : Forces{};
  report.obstacles = results_of(read.obstacles, request, forces, dealt.rows(), read.first, ranks.get());
  const Eigen::Index own_grains = std::clamp<Eigen::Index>(read.grains - read.first, 0, dealt.rows().size());
  write_outputs(request, flow, dealt, report, own_grains, forces, ranks.get());
  warn(request, flow, Facts(request, flow, packing, ranks.get()), report, warnings);
  write_summary(request, report, out);
}

}  // namespace pfv::app

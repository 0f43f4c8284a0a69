// SPDX-License-Identifier: GPL-3.0-or-later
// The report as people read it at the end of a run.
#include "pfv/io.hpp"

#include "text/number_text.hpp"

#include <cstdio>

namespace pfv {

namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string phases(const Report& done) {
  const Seconds& s = done.seconds;
  const Counts& n = done.counts;
  const struct {
    const char* name;
    double seconds;
    std::int64_t count;
  } rows[] = {{done.model == "darcy_grid" ? "porosity" : "triangulate", s.triangulate, n.triangulate},
              {"throats", s.throats, n.triangulate},
              {"assemble", s.assemble, n.triangulate},
              {"order", s.order, n.order},
              {"factor", s.factor, n.factor},
              {"solve", s.solve, n.solve},
              {"forces", s.forces, n.force_matrix},
              {"total", s.total, n.solve}};
  std::string text = "phase         CPU seconds       count\n";
  for (const auto& row : rows)
    text += line("%-12s %12.4f %11lld\n", row.name, row.seconds, static_cast<long long>(row.count));
  return text;
}

/// Only while all grains are at rest.
std::string permeability(const Report& done) {
  if (!done.permeability || (!done.degenerate_share && done.outside_range.empty())) return {};
  std::string text = line("permeability %.6g m2", *done.permeability);
  if (done.permeability_error) text += "  estimated error " + detail::percent_text(*done.permeability_error);
  if (done.degenerate_share) text += "  in degenerate throats " + detail::percent_text(*done.degenerate_share);
  text += '\n';
  for (const std::string& reason : done.outside_range)
    text += "WARNING: the permeability's estimated error may not hold: " + reason + "\n";
  return text;
}

std::string reynolds(const Report& done) {
  if (!done.reynolds_largest || !(*done.reynolds_largest > 0.0)) return {};
  std::string text = line("Reynolds number of the throats: largest %.3g  mean %.3g", *done.reynolds_largest, *done.reynolds_mean);
  if (*done.reynolds_mean > 1.0) text += " (above 1 the fluid's inertia, which is left out, counts)";
  else if (*done.reynolds_largest > 1.0) text += " (above 1 somewhere: there the fluid's inertia, which is left out, counts)";
  return text + "\n";
}

}  // namespace

std::string summary_of(const Report& done) {
  const auto whole = [](std::int64_t number) { return static_cast<long long>(number); };
  std::string text = phases(done);
  text += line("spheres %lld  hidden %lld  outside %lld  pores %lld  unknowns %lld\n",
               whole(done.spheres), whole(done.hidden), whole(done.outside), whole(done.pores),
               whole(done.unknowns));
  text += line("residual %.3g  mass error %.3g  force balance error %.3g\n", done.residual,
               done.mass_error, done.force_balance_error);
  text += reynolds(done);
  text += "solver " + done.solver + ": " + done.solver_made_of + "\n";
  if (done.counts.background > 0)
    text += line("built in the background %lld  waited for them %.4g wall seconds\n",
                 whole(done.counts.background), done.wall_seconds.waited);
  return text + permeability(done);
}

const char* citation() {
  return "Please cite, for the flow and for its coupling with the grains:\n"
         "  Chareyre, Cortis, Catalano, Barthelemy (2012) Pore-scale modeling of viscous flow and\n"
         "  induced forces in dense sphere packings. Transport in Porous Media 92:473-493\n"
         "  Catalano, Chareyre, Barthelemy (2014) Pore-scale modeling of fluid-particles\n"
         "  interaction and emerging poromechanical effects. Int. J. Numer. Anal. Methods\n"
         "  Geomech. 38:51-71\n";
}

}  // namespace pfv

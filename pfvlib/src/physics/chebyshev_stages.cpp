// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/chebyshev_stages.hpp"

#include "text/number_text.hpp"
#include "pfv/error.hpp"

#include <string>

namespace pfv {

namespace {

/// Chebyshev polynomials T_0 ... T_s and the first derivative of T_s at x.
struct Chebyshev {
  std::vector<double> value;
  double derivative;
};

Chebyshev chebyshev(int degree, double x) {
  Chebyshev result;
  std::vector<double> slope{0.0, 1.0};
  result.value = {1.0, x};
  for (int j = 2; j <= degree; ++j) {
    result.value.push_back(2.0 * x * result.value[j - 1] - result.value[j - 2]);
    slope.push_back(2.0 * result.value[j - 1] + 2.0 * x * slope[j - 1] - slope[j - 2]);
  }
  result.derivative = slope[degree];
  return result;
}

/// Half of the damping goes into width: without it contacts with dashpots become unstable.
constexpr double damping = 2.0;

/// More stages than these cost more than the steps they save; a step of this size is a mistake.
constexpr int most_stages = 2000;

}  // namespace

std::vector<ChebyshevStage> chebyshev_stages(double z) {
  constexpr double explicit_bound = 1.9, margin = 1.05;
  if (z < explicit_bound) return {{1.0, 0.0, 1.0}};
  for (int s = 2; s <= most_stages; ++s) {
    const double w0 = 1.0 + damping / (static_cast<double>(s) * s);
    const Chebyshev t = chebyshev(s, w0);
    const double w1 = t.value[s] / t.derivative;
    if ((1.0 + w0) / w1 < margin * z) continue;
    std::vector<ChebyshevStage> stages{{1.0, 0.0, w1 / w0}};
    for (int j = 2; j <= s; ++j) {
      const double b = 1.0 / t.value[j], b1 = 1.0 / t.value[j - 1], b2 = 1.0 / t.value[j - 2];
      stages.push_back({2.0 * w0 * b / b1, -b / b2, 2.0 * w1 * b / b1});
    }
    return stages;
  }
  throw InputError("the time step is " + detail::number_text(0.5 * z) + " times the limit of the explicit "
                   "coupling: more than " + std::to_string(most_stages) +
                   " stages would be needed; take a smaller step, or look for grains that are too "
                   "light for their fluid");
}

}  // namespace pfv

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace pfv {

/// Coefficients of one sub-stage: y_j = (1 - m - n) y_0 + m y_{j-1} + n y_{j-2} + f F(y_{j-1}).
struct ChebyshevStage {
  double m, n, f;
};

/// First-order Runge-Kutta-Chebyshev scheme (Verwer 1996, Appl. Numer. Math. 20), strongly damped
/// (epsilon = 2), for y' = F(y) whose eigenvalues reach from 0 to -lambda: the least number of stages
/// that is stable for z = dt lambda, one (explicit Euler) for z below 1.9. F is dt times the rate of
/// change. Grows like sqrt(z).
std::vector<ChebyshevStage> chebyshev_stages(double z);

}  // namespace pfv

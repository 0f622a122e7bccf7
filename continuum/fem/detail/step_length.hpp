#pragma once
// How much of a Newton step to take. Private to fem/.
#include <algorithm>
#include <cmath>

namespace drumlin::continuum::fem {

struct StepLength {
  double share = 1;
  bool asked_last = true;  ///< whether the slope was asked for last there
};

/// Share alpha of a step du, at most 1, where the slope R(u + alpha du).du has fallen well below `start`,
/// that at alpha = 0. The residual norm would ask for needlessly short steps, since stiff, nearly rigid parts
/// dominate it. `slope_at(alpha)` may return what is not finite where there is no such state.
template <class SlopeAt>
StepLength step_length(double start, SlopeAt slope_at) {
  double low = 0, at_low = start, alpha = 1, best = 1, best_slope = INFINITY;
  double high = 0, at_high = 0, last = 1;
  for (int trial = 0; trial < 8; ++trial) {
    const double here = slope_at(alpha);
    last = alpha;
    if (std::isfinite(here) && std::abs(here) < best_slope) best_slope = std::abs(here), best = alpha;
    if (std::isfinite(here) && std::abs(here) <= 0.5 * std::abs(start)) break;
    if (!std::isfinite(here) || here * start < 0)
      high = alpha, at_high = here;
    else
      low = alpha, at_low = here;
    if (high == 0) break;  // the slope has not changed sign by alpha = 1: take the whole step
    const double secant =
        std::isfinite(at_high) ? low + (high - low) * at_low / (at_low - at_high) : 0.5 * high;
    alpha = std::clamp(secant, low + 0.1 * (high - low), low + 0.7 * (high - low));
  }
  return {best, last == best};
}

}  // namespace drumlin::continuum::fem

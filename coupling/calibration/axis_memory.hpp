#pragma once
// What a material carries along its path: the memory of its stress's axes, and means of what it passed
// through. Law N1 of docs/theory/rheology.md with the particles' motion given.
#include <optional>

#include "coupling/calibration/stress_paths.hpp"

namespace drumlin::coupling {

/// Coefficients of the law: v.grad A + 2 i W A = 2 c |D| (e^(i chi(I)) n - A), s/p = mu(I) (n + m A)/rho,
/// v.grad rho = 2 c_rho |D| (|n + m A| - rho); rho = |n + m A| at once without c_rho.
struct AxisMemory {
  double c = 0;
  double m = 0;
  double chi = 0;  ///< rad, below I_low; atan(1/c) above I_high
  std::optional<double> c_rho = {};
  double I_low = 1e-3, I_high = 1e-2;
};

/// chi at an inertial number, smooth in ln I.
double lead_angle(const AxisMemory& law, double ln_I);

/// A at the end of a path. Exact over each step, on which D, W and I are constant; before its first step the
/// path was in steady state without spin.
Deviator carried_memory(const StressPath& path, const AxisMemory& law);

/// (n + m A)/rho at the end of a path: s/p over the amount mu(I). As carried_memory().
Deviator carried_axes(const StressPath& path, const AxisMemory& law);

/// What lags behind its axes at the end of a path: axes_lag() of the law.
double carried_lag(const StressPath& path, const AxisMemory& law);

/// Mean of `value` over the steps of a path, the later the more: weight exp(-2 c strain); `first` before
/// them.
template <class Value>
double carried_mean(const StressPath& path, double c, double first, const Value& value) {
  double mean = first;
  for (const PathStep& step : path.steps) {
    const double remaining = std::exp(-2 * c * step.strain);
    mean = remaining * mean + (1 - remaining) * value(step);
  }
  return mean;
}

/// ln I that is remembered with c, from `low` to `high`.
double carried_ln_I(const StressPath& path, double c, double low, double high);

/// The dilatancy that a path passed through itself; within a half, for where the material hardly shears it is
/// noise.
double carried_dilatancy(const StressPath& path, double c);

}  // namespace drumlin::coupling

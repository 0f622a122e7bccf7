#include "coupling/calibration/axis_memory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/core/law/memory_law.hpp"

namespace drumlin::coupling {
namespace {

/// What the material commits to memory on a step.
Deviator committed(const PathStep& step, const AxisMemory& law) {
  return step.axis * std::polar(1.0, lead_angle(law, step.ln_I));
}

/// A after a step.
Deviator renewed(Deviator A, const PathStep& step, const AxisMemory& law) {
  const double gain = 2 * law.c * step.strain;
  const Deviator rate(gain, 2 * step.turn), left = std::exp(-rate);
  return left * A +
         (std::abs(rate) > 1e-12 ? gain / rate * (1.0 - left) : Deviator(gain)) * committed(step, law);
}

}  // namespace

double lead_angle(const AxisMemory& law, double ln_I) {
  return memory_turn(law.chi, law.c, law.I_low, law.I_high, ln_I);
}

Deviator carried_memory(const StressPath& path, const AxisMemory& law) {
  Deviator A = committed(path.steps.front(), law);
  for (const PathStep& step : path.steps) A = renewed(A, step, law);
  return A;
}

Deviator carried_axes(const StressPath& path, const AxisMemory& law) {
  Deviator A = committed(path.steps.front(), law);
  double rho = std::abs(path.steps.front().axis + law.m * A);
  for (const PathStep& step : path.steps) {
    A = renewed(A, step, law);
    if (!law.c_rho) continue;
    const double remaining = std::exp(-2 * *law.c_rho * step.strain);
    rho = remaining * rho + (1 - remaining) * std::abs(step.axis + law.m * A);
  }
  const Deviator sum = path.axis + law.m * A;
  if (!law.c_rho) rho = std::abs(sum);
  return sum / std::max(rho, 1e-3);
}

double carried_lag(const StressPath& path, const AxisMemory& law) {
  const MemoryLaw axes{law.c, law.m, law.chi * 180 / std::numbers::pi, {}, law.I_low, law.I_high, {}};
  return axes_lag(axes, 1, path.axis, carried_memory(path, law), std::exp(path.ln_I));
}

double carried_ln_I(const StressPath& path, double c, double low, double high) {
  const auto remembered = [&](const PathStep& step) { return std::clamp(step.ln_I, low, high); };
  return carried_mean(path, c, remembered(path.steps.front()), remembered);
}

double carried_dilatancy(const StressPath& path, double c) {
  constexpr double most = 0.5;
  return carried_mean(path, c, 0,
                      [=](const PathStep& step) { return std::clamp(step.dilatancy, -most, most); });
}

}  // namespace drumlin::coupling

#include "coupling/core/law/stress_ratio.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace drumlin {
StressRatioLaw::StressRatioLaw(const std::vector<double>& I, std::vector<double> k)
    : k_(logarithms(I), k, MonotoneCubic::Outside::level),
      // Between its points the curve is monotone.
      smallest_(*std::min_element(k.begin(), k.end())),
      largest_(*std::max_element(k.begin(), k.end())) {}

StressRatioLaw stress_ratio_law(const NormalStressRatio& points) { return {points.I, points.k}; }

ShearState shear_state(const StressRatioLaw& law, double rate, double pressure) {
  assert(rate > 0 && pressure > 0);
  const double ln_I_p = std::log(2 * rate / std::sqrt(pressure));  // what I is for k = 1
  double low = ln_I_p + 0.5 * std::log(0.5 * (1 + law.smallest()));
  double high = ln_I_p + 0.5 * std::log(0.5 * (1 + law.largest()));
  double ln_I = 0.5 * (low + high);
  CurvePoint k = law.at_ln(ln_I);
  for (int i = 0; i < 60; ++i) {
    const double excess = ln_I - ln_I_p - 0.5 * std::log(0.5 * (1 + k.value));
    (excess > 0 ? high : low) = ln_I;
    const double newton = ln_I - excess / (1 - 0.5 * k.slope / (1 + k.value));
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    const bool done = std::abs(next - ln_I) <= 1e-14 * std::max(1.0, std::abs(ln_I));
    ln_I = next;
    k = law.at_ln(ln_I);
    if (done) break;
  }
  return {std::exp(ln_I), k.value, k.slope};
}

}  // namespace drumlin

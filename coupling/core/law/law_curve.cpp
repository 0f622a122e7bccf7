#include "coupling/core/law/law_curve.hpp"

#include <cmath>

namespace drumlin {

LawCurve law_curve(const FrictionLaw& law, double I_min, double I_max) {
  constexpr int intervals = 40;
  LawCurve curve;
  for (int k = 0; k <= intervals; ++k) {
    curve.I.push_back(I_min * std::pow(I_max / I_min, static_cast<double>(k) / intervals));
    curve.mu.push_back(friction_at(law, curve.I.back()).mu);
  }
  return curve;
}

}  // namespace drumlin

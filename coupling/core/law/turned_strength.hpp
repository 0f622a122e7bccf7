#pragma once
// Shear strengths of a law with k: A along the strain rate D and B across it, with their derivatives.
//
//   A = p M,  M = 2 mu/(1 + k),  B = p beta,  beta = turn (k - 1)/(k + 1)
//
// The convention of signs is that of docs/conventions.md ("Axes of stress and strain rate").
#include <cmath>

#include "coupling/core/law/friction_law.hpp"
#include "coupling/core/law/stress_ratio.hpp"

namespace drumlin {

/// beta and dbeta/dln I.
using StressTurn = CurvePoint;

/// k from the local inertial number.
struct LocalRatio {
  const StressRatioLaw* law = nullptr;
  double turn = 1;  ///< s sgn(W - Omega_D), about -1 to 1

  ShearState state(double rate, double pressure) const { return shear_state(*law, rate, pressure); }
  StressTurn turning(const ShearState& at) const {
    const double share = 2 / (1 + at.k);
    return {turn * (1 - share), turn * 0.5 * share * share * at.k_slope};
  }
};

/// Strengths along D and across it.
struct TurnedStrength {
  Strength along;   ///< A and its slopes
  Strength across;  ///< B and its slopes
  ShearState at;
};

/// A and B at |D| > 0 and p > 0, the caller's regularised values.
template <class Law>
TurnedStrength turned_strength(const Law& law, const LocalRatio& ratio, double rate, double pressure) {
  const ShearState at = ratio.state(rate, pressure);
  const FrictionValue f = law.friction(at.I);
  const double share = 2 / (1 + at.k);  // sigma_zz/p
  const double M = share * f.mu, M_slope = share * f.slope - 0.5 * share * share * at.k_slope * f.mu;
  const StressTurn beta = ratio.turning(at);
  // ln I = ln |D| - (ln p)/2 + ln(1/share)/2, where the last term depends on I.
  const double gain = 1 / (1 - 0.25 * share * at.k_slope);
  const auto strength_of = [&](double value, double slope) {
    return Strength{pressure * value, pressure * slope * gain / rate, value - 0.5 * slope * gain};
  };
  return {strength_of(M, M_slope), strength_of(beta.value, beta.slope), at};
}

}  // namespace drumlin

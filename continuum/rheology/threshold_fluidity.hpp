#pragma once
// Friction with a fluidity of its own, and a threshold.
//
// The fluidity g = 2|D|/mu is a field that obeys
//
//   A^2 lap g/g = mu_loc(I) - mu,   mu = 2|D|/g,   I = 2|D|/sqrt(p),   mu_loc(I -> 0) = mu_s
//
// (Kamrin & Koval, Phys. Rev. Lett. 108 (2012), in the primitive form of Kamrin & Henann, Soft Matter 11
// (2015), d = 1). Without neighbours it is mu_loc(I); below mu_s g decays over A/sqrt(mu_s - mu). y = ln g is
// the unknown of the finite elements, so that the stress p mu D/|D| = 2 p exp(-y) D is linear in D.
#include <optional>

#include "continuum/rheology/memory_stress.hpp"

namespace drumlin::continuum {

/// The shear strength at a given ln g.
struct FluidityLaw {
  double ln_fluidity = 0;
};
inline Strength strength(const FluidityLaw& law, double rate, double pressure) {
  const double per_rate = 2 * pressure * std::exp(-law.ln_fluidity);
  return {per_rate * rate, per_rate, per_rate * rate / pressure};
}

/// mu_loc - mu, what the curvature of the fluidity has to make up for, and its slopes.
struct FluidityBalance {
  double mu_loc = 0;
  double mu = 0;  ///< 2|D|/g; the slope of mu_loc - mu by ln g is mu
  double by_rate = 0;
  double by_pressure = 0;  ///< by the law's own p
};

/// At the regularised rate and pressure of a law. With `threshold` mu_loc is mu_s + kept_positive(mu(I) -
/// mu_s): it stays above mu_s however slow the shear, without a kink; absent, the law's own mu(I).
template <class Law>
FluidityBalance fluidity_balance(const Law& law, const std::optional<double>& threshold, double ln_fluidity,
                                 double rate, double pressure) {
  const Strength F = strength(law, rate, pressure);
  double mu = F.value / pressure, by_ln_rate = rate * F.d_rate / pressure;
  if (threshold) {
    const FrictionValue above = kept_positive(mu - *threshold, by_ln_rate);
    mu = *threshold + above.mu;
    by_ln_rate = above.slope;
  }
  const double per_rate = 2 * std::exp(-ln_fluidity);
  return {.mu_loc = mu,
          .mu = per_rate * rate,
          .by_rate = by_ln_rate / rate - per_rate,
          .by_pressure = -0.5 * by_ln_rate / pressure};  // I = 2|D|/sqrt(p)
}

/// Response of a law at a given ln g, with what its unknown asks for.
template <class Base>
struct FluidityResponse : Base {
  FluidityBalance balance = {};  ///< by_pressure by the true p
  PlaneTensor by_fluidity = {};  ///< d tau/d ln g
};

}  // namespace drumlin::continuum

#pragma once
// The law with k: its stress is turned against the strain rate.
//
//   tau = A D/|D| + B turned(D)/|D|,  A = p M,  M = 2 mu/(1 + k),  B = p beta,  beta = turn (k - 1)/(k + 1).
//
// In simple shear with turn = 1 this is sigma_xx/sigma_zz = k and sigma_xz/sigma_zz = mu exactly; the axes of
// stress and strain rate enclose delta, tan(2 delta) = beta/M, and B does no work. `turn` says by how much
// and to which side the material turns through its own axes of strain rate (continuum/rheology/spin.hpp); it
// is given here, while the dependence of A and B on D and p through I, that of beta too, is differentiated
// exactly.
#include <cmath>

#include "continuum/rheology/stress_ratio.hpp"
#include "continuum/rheology/tensor_law.hpp"

namespace drumlin {

/// D turned by a quarter turn in the space of traceless symmetric tensors: by 45 degrees in the plane, such
/// that for dv_x/dz > 0 a positive multiple adds to sigma_xx and takes from sigma_zz.
inline PlaneTensor turned(const PlaneTensor& D) { return {-D.xz, D.xz, 0.5 * (D.xx - D.zz)}; }

/// beta and dbeta/dln I.
using Turning = CurvePoint;

/// k from the local inertial number.
struct LocalRatio {
  const StressRatioLaw* law = nullptr;
  double turn = 1;  ///< s sgn(W - Omega_D), about -1 to 1

  ShearState state(double rate, double pressure) const { return shear_state(*law, rate, pressure); }
  Turning turning(const ShearState& at) const {
    const double share = 2 / (1 + at.k);
    return {turn * (1 - share), turn * 0.5 * share * share * at.k_slope};
  }
};

/// k as the material carries it (its fabric): beta is given and held. With e = beta turn, in simple shear
/// (turn = 1 or -1) k = (1 + e)/(1 - e) is the ratio of the normal stresses and mu(I) that of the shear
/// stress to the one across the layers, as with LocalRatio; no equation for I is left.
struct CarriedRatio {
  double beta = 0;  ///< -1 to 1
  double turn = 1;  ///< as in LocalRatio

  ShearState state(double rate, double pressure) const {
    const double e = beta * turn;
    return {2 * rate / std::sqrt(pressure * (1 - e)), (1 + e) / (1 - e), 0};
  }
  Turning turning(const ShearState&) const { return {beta, 0}; }
};

/// Strengths along D and across it.
struct TurnedStrength {
  Strength along;   ///< A and its slopes
  Strength across;  ///< B and its slopes
  ShearState at;
};

/// A and B at |D| > 0 and p > 0, the caller's regularised values.
template <class FrictionLaw, class Ratio>
TurnedStrength turned_strength(const FrictionLaw& law, const Ratio& ratio, double rate, double pressure) {
  const ShearState at = ratio.state(rate, pressure);
  const Friction f = law.friction(at.I);
  const double share = 2 / (1 + at.k);  // sigma_zz/p
  const double M = share * f.mu, M_slope = share * f.slope - 0.5 * share * share * at.k_slope * f.mu;
  const Turning beta = ratio.turning(at);
  // ln I = ln |D| - (ln p)/2 + ln(1/share)/2, where the last term depends on I.
  const double gain = 1 / (1 - 0.25 * share * at.k_slope);
  const auto strength_of = [&](double value, double slope) {
    return Strength{pressure * value, pressure * slope * gain / rate, value - 0.5 * slope * gain};
  };
  return {strength_of(M, M_slope), strength_of(beta.value, beta.slope), at};
}

/// StressResponse of the turned law; d tau has the terms of B besides:
///   across_modulus turned(dD) + 1/2 across_slope turned(left) (right:dD).
/// The base's strength is A, its modulus and slope belong to A, and its stress and by_pressure are the whole.
struct TurnedResponse : StressResponse {
  double across_modulus = 0;  ///< B/|D|
  double across_slope = 0;    ///< dB/d|D| - B/|D|
  Strength across;            ///< B and its slopes, by p before regularisation
  ShearState at;
};

/// As stress_response() of tensor_law.hpp, with k.
template <class FrictionLaw, class Ratio>
TurnedResponse turned_response(const FrictionLaw& law, const Ratio& ratio, const Regularisation& r,
                               const PlaneTensor& D, double p, const PlaneTensor& dual) {
  TurnedResponse response;
  const RegularisedPressure pressure = regularised_pressure(p, r);
  response.law_pressure = pressure.value;
  response.rate = regularised_rate(D, r);
  TurnedStrength F = turned_strength(law, ratio, response.rate, pressure.value);
  F.along.d_pressure *= pressure.slope;
  F.across.d_pressure *= pressure.slope;
  response.strength = F.along;
  response.across = F.across;
  response.at = F.at;
  response.modulus = F.along.value / response.rate;
  response.slope = F.along.d_rate - response.modulus;
  response.across_modulus = F.across.value / response.rate;
  response.across_slope = F.across.d_rate - response.across_modulus;
  response.stress = response.modulus * D + response.across_modulus * turned(D);
  response.right = (1 / response.rate) * D;
  response.left = dual;
  response.by_pressure = F.along.d_pressure * response.right + F.across.d_pressure * turned(response.right);
  return response;
}

inline PlaneTensor tangent(const TurnedResponse& s, const PlaneTensor& dD) {
  return tangent(static_cast<const StressResponse&>(s), dD) + s.across_modulus * turned(dD) +
         (0.5 * s.across_slope * contraction(s.right, dD)) * turned(s.left);
}

}  // namespace drumlin

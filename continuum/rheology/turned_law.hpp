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
#include "continuum/rheology/tensor_law.hpp"
#include "coupling/core/law/turned_strength.hpp"

namespace drumlin::continuum {

/// D turned by a quarter turn in the space of traceless symmetric tensors: by 45 degrees in the plane, such
/// that for dv_x/dz > 0 a positive multiple adds to sigma_xx and takes from sigma_zz.
inline PlaneTensor turned(const PlaneTensor& D) { return {-D.xz, D.xz, 0.5 * (D.xx - D.zz)}; }

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
template <class FrictionLaw>
TurnedResponse turned_response(const FrictionLaw& law, const LocalRatio& ratio, const Regularisation& r,
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

}  // namespace drumlin::continuum

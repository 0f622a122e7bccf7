#pragma once
// tau(D, p) with its regularisation and the two linearisations that Newton's method uses.
#include <algorithm>

#include "continuum/rheology/plane_tensor.hpp"
#include "continuum/rheology/stress_law.hpp"

namespace drumlin::continuum {

/// |D| -> sqrt(|D|^2 + shear_rate^2/4), and inside the law p -> (p + sqrt(p^2 + 4 pressure^2))/2.
struct Regularisation {
  double shear_rate = 1e-5;  ///< eps, 1/sqrt(d/g)
  double pressure = 0.4;     ///< p_min, rho0 g d
};

/// The law's p and its derivative by the true one.
struct RegularisedPressure {
  double value = 0;
  double slope = 0;
};
inline RegularisedPressure regularised_pressure(double p, const Regularisation& r) {
  const double root = std::sqrt(p * p + 4 * r.pressure * r.pressure);
  const double value = p > 0 ? 0.5 * (p + root) : 2 * r.pressure * r.pressure / (root - p);
  return {value, value / root};
}

/// Stress at a point and its derivative
///   d tau = modulus dD + 1/2 slope (left (right:dD) + right (left:dD))/2 + by_pressure dp.
/// With left = right = D/|D| this is the exact tangent; the primal-dual tangent has the dual variable for
/// `left`.
struct StressResponse {
  PlaneTensor stress;
  double modulus = 0;  ///< F/|D|, twice the viscosity
  double slope = 0;    ///< dF/d|D| - F/|D|
  PlaneTensor left;
  PlaneTensor right;        ///< D/|D|, |right| <= 1
  PlaneTensor by_pressure;  ///< d tau/dp
  Strength strength;        ///< F and its slopes by |D| and by p before regularisation
  double rate = 0;          ///< regularised |D|
  double law_pressure = 0;  ///< regularised p
};

inline double regularised_rate(const PlaneTensor& D, const Regularisation& r) {
  return std::sqrt(0.5 * contraction(D, D) + 0.25 * r.shear_rate * r.shear_rate);
}

/// Response to D at the pressure `p` of the law. `dual` (|dual| <= 1) stands for D/|D| in the tangent: the
/// primal-dual linearisation of |D| Lambda = D (Chan, Golub & Mulet, SIAM J. Sci. Comput. 20 (1999), there
/// for total variation), made symmetric. Pass D/|D| itself for the exact tangent.
template <class Law>
StressResponse stress_response(const Law& law, const Regularisation& r, const PlaneTensor& D, double p,
                               const PlaneTensor& dual) {
  StressResponse response;
  const RegularisedPressure pressure = regularised_pressure(p, r);
  response.law_pressure = pressure.value;
  response.rate = regularised_rate(D, r);
  Strength& F = response.strength;
  F = strength(law, response.rate, response.law_pressure);
  F.d_pressure *= pressure.slope;
  response.modulus = F.value / response.rate;
  response.slope = F.d_rate - response.modulus;
  response.stress = response.modulus * D;
  response.right = (1 / response.rate) * D;
  response.left = dual;
  response.by_pressure = F.d_pressure * response.right;
  return response;
}

/// d tau for a change dD at fixed pressure.
inline PlaneTensor tangent(const StressResponse& s, const PlaneTensor& dD) {
  return s.modulus * dD +
         0.25 * s.slope * (contraction(s.right, dD) * s.left + contraction(s.left, dD) * s.right);
}

/// The dual variable after a Newton step dD from D: (D + dD)/|D| - dual (D:dD)/(2 |D|^2), drawn back into
/// |dual| <= 1.
inline PlaneTensor advanced_dual(const PlaneTensor& D, const PlaneTensor& dD, const PlaneTensor& dual,
                                 double rate) {
  const PlaneTensor next = (1 / rate) * (D + dD) - (contraction(D, dD) / (2 * rate * rate)) * dual;
  return (1 / std::max(1.0, magnitude(next))) * next;
}

}  // namespace drumlin::continuum

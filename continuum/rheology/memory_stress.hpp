#pragma once
// The law with memory of the axes: its stress stands between the strain rate and what the material remembers.
//
//   tau = p mu(I) (n + m h A)/rho,  n = D/|D|,  h = |n|^2,
//
// with the regularised |D|, so that h is one wherever the material shears faster than eps. h makes the
// dissipation p mu |D| (|n|^2 + m h n.A)/rho >= 0 for |A| <= 1 and m <= 1, also where |D| < eps. A and rho
// are given here (continuum/fem/detail/carried_field.hpp says how they are carried); what depends on D and p
// is differentiated exactly.
#include <complex>

#include "continuum/rheology/tensor_law.hpp"
#include "coupling/core/law/memory_law.hpp"

namespace drumlin::continuum {

/// What the material carries.
struct Remembered {
  double xx = 0, xz = 0;  ///< A, traceless, |A| <= 1
  double rho = 1;
  double added = 0;  ///< to mu(I) + slope ln I, see FollowedLaw
};

/// Traceless part as a complex number: a turn of the axes by an angle multiplies it by exp(2 i angle).
inline std::complex<double> as_complex(const PlaneTensor& a) { return {0.5 * (a.xx - a.zz), a.xz}; }
inline PlaneTensor as_tensor(std::complex<double> a) { return {a.real(), -a.real(), a.imag()}; }

/// mu(I) + slope ln I + added + creep, kept positive: what the past adds to the friction, part of it as it
/// would follow from I = 2|D|/sqrt(p + own_weight), the rest held, and creep at the spin given here. Where
/// nothing changes any more `added` has slope ln I taken out.
template <class Law>
struct FollowedLaw {
  const Law& law;
  double slope = 0, added = 0;
  Creep creep = {};  ///< of no slope: none
  double spin = 0;   ///< W
  double own_weight = 0;
};
template <class Law>
Strength strength(const FollowedLaw<Law>& followed, double rate, double pressure) {
  // The law without the weight at the rate that has the same I there.
  const double weighed = pressure + followed.own_weight, same_I = std::sqrt(pressure / weighed);
  const Strength F = strength(followed.law, same_I * rate, pressure);
  const double mu = F.value / pressure, ln_I = std::log(2 * rate / std::sqrt(weighed));
  const double by_rate = same_I * F.d_rate;
  const double mu_by_pressure =
      (F.d_pressure - mu + 0.5 * rate * by_rate * (1 - pressure / weighed) / pressure) / pressure;
  const double creep = followed.creep.slope > 0 ? creep_friction(followed.creep, rate, followed.spin) : 0;
  const double by_ln_rate = followed.slope + (creep < 0 ? followed.creep.slope : 0);
  const FrictionValue all = kept_positive(mu + followed.slope * ln_I + followed.added + creep, 1);
  const double by_pressure = mu_by_pressure - 0.5 * followed.slope / weighed;
  return {pressure * all.mu, all.slope * (by_rate + pressure * by_ln_rate / rate),
          all.mu + pressure * all.slope * by_pressure};
}

/// StressResponse of the law; d tau has a term besides, 1/2 memory_slope A (right:dD). The base's strength is
/// the amount p mu(I), its modulus and slope belong to n, its stress and by_pressure are the whole.
struct MemoryResponse : StressResponse {
  PlaneTensor memory;       ///< A
  double weight = 0;        ///< m h
  double weight_slope = 0;  ///< |D| d(m h)/d|D|
  double rho = 1;
  double memory_slope = 0;
};

/// As stress_response() of tensor_law.hpp; `m` is the weight of the memory.
template <class Law>
MemoryResponse memory_response(const Law& law, double m, const Remembered& held, const Regularisation& r,
                               const PlaneTensor& D, double p, const PlaneTensor& dual) {
  MemoryResponse response;
  static_cast<StressResponse&>(response) = stress_response(law, r, D, p, dual);
  const double h = 0.5 * contraction(response.right, response.right);
  const Strength& F = response.strength;
  response.memory = {held.xx, -held.xx, held.xz};
  response.rho = held.rho;
  response.weight = m * h;
  response.weight_slope = 2 * m * (1 - h);
  response.memory_slope =
      (F.d_rate * response.weight + F.value / response.rate * response.weight_slope) / held.rho;
  response.modulus /= held.rho;
  response.slope /= held.rho;
  const PlaneTensor direction = (1 / held.rho) * (response.right + response.weight * response.memory);
  response.stress = F.value * direction;
  response.by_pressure = F.d_pressure * direction;
  return response;
}

inline PlaneTensor tangent(const MemoryResponse& s, const PlaneTensor& dD) {
  return tangent(static_cast<const StressResponse&>(s), dD) +
         (0.5 * s.memory_slope * contraction(s.right, dD)) * s.memory;
}

/// Well-posedness margin with A and rho held, as short waves see them (docs/theory/rheology.md).
double well_posedness_margin(const MemoryResponse& s);

/// What rho tends to: |n + m h A|, with one in place of |n|: the same wherever the material shears, and one
/// where it remembers nothing. Not below least_rho.
double rho_target(double m, std::complex<double> n, std::complex<double> A);
constexpr double least_rho = 0.1;

}  // namespace drumlin::continuum

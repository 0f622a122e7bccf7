#pragma once
// Shear strength F(|D|, p) = mu(I) p of a friction law, with its derivatives by strain rate and pressure.
#include "coupling/law/friction_law.hpp"

namespace drumlin {

/// Value of F and its slopes. F is the shear stress in simple shear, in rho0 g d.
struct Strength {
  double value = 0;
  double d_rate = 0;      ///< dF/d|D|
  double d_pressure = 0;  ///< dF/dp
};

/// F = mu(I) p with I = 2|D|/sqrt(p); p > 0 and |D| > 0 are the caller's regularised values (p = sigma_zz
/// since k = 1).
template <class Law>
Strength strength(const Law& law, double rate, double pressure);

extern template Strength strength(const LogLaw&, double, double);
extern template Strength strength(const LogLinearLaw&, double, double);
extern template Strength strength(const SaturatingLaw&, double, double);
extern template Strength strength(const ConstantLaw&, double, double);
extern template Strength strength(const TabulatedLaw&, double, double);

}  // namespace drumlin

#pragma once
// Scalar laws F(|D|, p) of the deviatoric stress tau = F D/|D|: the short closed list from which a problem
// picks one.
#include <variant>

#include "continuum/rheology/friction_law.hpp"
#include "coupling/exchange/rheology_fit.hpp"

namespace drumlin {

/// Value of F and its slopes. F is the shear stress in simple shear, in rho0 g d.
struct Strength {
  double value = 0;
  double d_rate = 0;      ///< dF/d|D|
  double d_pressure = 0;  ///< dF/dp
};

/// Newtonian fluid, tau = 2 viscosity D: for verification, and the first guess of every flow.
struct NewtonianLaw {
  double viscosity = 0;  ///< rho0 g d sqrt(d/g)
};

using StressLaw = std::variant<LogLaw, LogLinearLaw, SaturatingLaw, ConstantLaw, TabulatedLaw, NewtonianLaw>;

/// F = mu(I) p with I = 2|D|/sqrt(p); p > 0 and |D| > 0 are the caller's regularised values (p = sigma_zz
/// since k = 1).
template <class FrictionLaw>
Strength strength(const FrictionLaw& law, double rate, double pressure);
Strength strength(const NewtonianLaw& law, double rate, double pressure);
Strength strength(const StressLaw& law, double rate, double pressure);

extern template Strength strength(const LogLaw&, double, double);
extern template Strength strength(const LogLinearLaw&, double, double);
extern template Strength strength(const SaturatingLaw&, double, double);
extern template Strength strength(const ConstantLaw&, double, double);
extern template Strength strength(const TabulatedLaw&, double, double);

/// The friction law of a rheology file. What the file says of k is another part of the law
/// (continuum/rheology/stress_ratio.hpp).
StressLaw stress_law(const RheologyFit& fit);

}  // namespace drumlin

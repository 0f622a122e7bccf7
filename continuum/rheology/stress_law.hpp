#pragma once
// Scalar laws F(|D|, p) of the deviatoric stress tau = F D/|D|: the short closed list from which a problem
// picks one.
#include <string>
#include <variant>

#include "coupling/exchange/rheology_fit.hpp"

namespace drumlin {

/// Value of F and its slopes. F is the shear stress in simple shear, in rho0 g d.
struct Strength {
  double value = 0;
  double d_rate = 0;      ///< dF/d|D|
  double d_pressure = 0;  ///< dF/dp
};

/// Friction coefficient at an inertial number I, and I dmu/dI.
struct Friction {
  double mu = 0;
  double slope = 0;
};

/// mu = a + b ln I, kept positive by mu -> (mu + sqrt(mu^2 + 4 m^2))/2 with m = 1e-3, so that the law
/// dissipates at any I; moves mu = 0.2 by 5e-6.
struct LogLaw {
  double a = 0;
  double b = 0;
  Friction friction(double I) const;
};

/// Jop, Forterre & Pouliquen, Nature 441 (2006): mu = mu_s + (mu_2 - mu_s)/(I_0/I + 1).
struct SaturatingLaw {
  double mu_s = 0;
  double mu_2 = 0;
  double I_0 = 0;
  Friction friction(double I) const;
};

/// Newtonian fluid, tau = 2 viscosity D: for verification, and the first guess of every flow.
struct NewtonianLaw {
  double viscosity = 0;  ///< rho0 g d sqrt(d/g)
};

using StressLaw = std::variant<LogLaw, SaturatingLaw, NewtonianLaw>;

/// F = mu(I) p with I = 2|D|/sqrt(p); p > 0 and |D| > 0 are the caller's regularised values (p = sigma_zz
/// since k = 1).
template <class FrictionLaw>
Strength strength(const FrictionLaw& law, double rate, double pressure);
Strength strength(const NewtonianLaw& law, double rate, double pressure);
Strength strength(const StressLaw& law, double rate, double pressure);

extern template Strength strength(const LogLaw&, double, double);
extern template Strength strength(const SaturatingLaw&, double, double);

/// The law of a rheology file, named in messages. Throws InputError if it holds k(I): this solver takes the
/// law with k absent only.
StressLaw stress_law(const RheologyFit& fit, const std::string& file);

}  // namespace drumlin

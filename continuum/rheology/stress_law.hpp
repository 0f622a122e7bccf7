#pragma once
// Scalar laws F(|D|, p) of the deviatoric stress tau = F D/|D|: a closed list, from which a problem picks
// one.
#include <variant>

#include "coupling/law/friction_law.hpp"
#include "coupling/law/rheology_fit.hpp"
#include "coupling/law/strength.hpp"

namespace drumlin::continuum {

/// Newtonian fluid, tau = 2 viscosity D: for verification, and the first guess of every flow.
struct NewtonianLaw {
  double viscosity = 0;  ///< rho0 g d sqrt(d/g)
};

using StressLaw = std::variant<LogLaw, LogLinearLaw, SaturatingLaw, ConstantLaw, TabulatedLaw, NewtonianLaw>;

Strength strength(const NewtonianLaw& law, double rate, double pressure);
Strength strength(const StressLaw& law, double rate, double pressure);

/// The friction law of a rheology file. What the file says of k is another part of the law
/// (coupling/law/stress_ratio.hpp).
StressLaw stress_law(const RheologyFit& fit);

}  // namespace drumlin::continuum

#pragma once
// Scalar laws F(|D|, p) of the deviatoric stress tau = F D/|D|: those of a rheology file, and a fluid.
#include <variant>

#include "coupling/core/law/friction_law.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::continuum {

/// Newtonian fluid, tau = 2 viscosity D: for verification, and the first guess of every flow.
struct NewtonianLaw {
  double viscosity = 0;  ///< rho0 g d sqrt(d/g)
  Strength strength(double rate, double /*pressure*/) const {
    return {2 * viscosity * rate, 2 * viscosity, 0};
  }
};

namespace detail {
template <class>
struct WithFluid;
template <class... Laws>
struct WithFluid<std::variant<Laws...>> {
  using Type = std::variant<Laws..., NewtonianLaw>;
};
}  // namespace detail

using StressLaw = detail::WithFluid<FrictionLaw>::Type;

using drumlin::strength;  // of one law
Strength strength(const StressLaw& law, double rate, double pressure);

/// The friction law of a rheology file. What the file says of k is another part of the law
/// (coupling/core/law/stress_ratio.hpp).
StressLaw stress_law(const RheologyFit& fit);

}  // namespace drumlin::continuum

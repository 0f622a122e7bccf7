#pragma once
// Friction law with nonlocal fluidity.
//
// The fluidity g = 2|D|/mu obeys g - length^2 lap g = g_loc, where g_loc(mu, p) is what the local law gives
// at the stress of the place (Kamrin & Koval, Phys. Rev. Lett. 108 (2012); Bocquet, Colin & Ajdari, ibid. 103
// (2009)). The local law then sees the rate that it would have caused itself, |D| g_loc/g: the whole effect
// is a factor on I, and is written so here, for a law of the form mu = a + b ln I makes 2|D|/g, with g held,
// far too stiff an equation for the stress.
#include "continuum/rheology/stress_law.hpp"

namespace drumlin::continuum {

/// mu at factor I; the slope is that by ln I still.
template <class Law>
struct NonlocalLaw {
  const Law& law;
  double factor = 1;  ///< g_loc/g
  FrictionValue friction(double I) const { return law.friction(factor * I); }
};

template <class Law>
Strength strength(const NonlocalLaw<Law>& nonlocal, double rate, double pressure) {
  Strength F = strength(nonlocal.law, nonlocal.factor * rate, pressure);
  F.d_rate *= nonlocal.factor;
  return F;
}

/// Whether mu determines the fluidity: not with a law that has a threshold, below which g_loc = 0 and the
/// factor is undefined, nor where the pressure decides over mu, too.
inline bool tells_fluidity(const StressLaw& law) {
  return std::visit(
      []<class Law>(const Law&) {
        constexpr bool stands = requires(const Law& of) { of.threshold(); };
        return OfInertialNumber<Law> && !stands;
      },
      law);
}

}  // namespace drumlin::continuum

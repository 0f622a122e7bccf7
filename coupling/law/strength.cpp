#include "coupling/law/strength.hpp"

#include <cassert>
#include <cmath>

namespace drumlin {

template <class Law>
Strength strength(const Law& law, double rate, double pressure) {
  assert(rate > 0 && pressure > 0);
  const FrictionValue f = law.friction(2 * rate / std::sqrt(pressure));
  return {f.mu * pressure, f.slope * pressure / rate, f.mu - 0.5 * f.slope};
}
template Strength strength(const LogLaw&, double, double);
template Strength strength(const LogLinearLaw&, double, double);
template Strength strength(const SaturatingLaw&, double, double);
template Strength strength(const ConstantLaw&, double, double);
template Strength strength(const TabulatedLaw&, double, double);

}  // namespace drumlin

#include "particles/measurement/layers/sensitivity.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {

ScalarSensitivity sensitivity_of(const Scalar& scalar, const std::vector<ScalarVariant>& variants) {
  ScalarSensitivity found{{}, scalar.value, scalar.value, {}};
  constexpr double rounding = 1e-9;
  double largest = 0;
  for (const ScalarVariant& variant : variants) {
    const Scalar* other = variant.scalars.find(scalar.name);
    if (!other || !std::isfinite(scalar.value)) continue;
    const double moved = std::abs(other->value - scalar.value);
    if (!(moved > rounding * (1 + std::abs(scalar.value)))) continue;
    found.changes.push_back({variant.change, other->value});
    found.lowest = std::min(found.lowest, other->value);
    found.highest = std::max(found.highest, other->value);
    if (moved > largest) found.strongest = variant.change;
    largest = std::max(largest, moved);
  }
  return found;
}

}  // namespace drumlin::particles

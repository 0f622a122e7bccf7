#pragma once
// The number of a quantity that has no value.
#include <limits>

namespace drumlin {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace drumlin

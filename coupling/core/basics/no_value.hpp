#pragma once
// The number of a quantity that has no value, and the largest that one may have.
#include <limits>

namespace drumlin {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
/// Of results that are read, from 0: squares and quotients stay finite.
inline constexpr double largest_value = 1e100;

}  // namespace drumlin

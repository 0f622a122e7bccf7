#pragma once
// Positions and lengths in the keys of a scene, and their ranges.
#include <array>

#include "coupling/core/documents/key_spec.hpp"

namespace drumlin::particles {

using Point_mm = std::array<double, 2>;  ///< x to the right, z upwards, laboratory frame

/// A kilometre either way: what lies beyond is a slip of the pen and would cost memory.
inline Allowed coordinate_mm() { return at_least(-1e6, 1e6); }
inline Allowed length_mm() { return above(0, 1e6); }

}  // namespace drumlin::particles

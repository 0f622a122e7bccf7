#pragma once
// Random velocities of a gas at the start: Maxwell's distribution at one temperature.
#include <cstdint>

#include "particles/bodies/bodies.hpp"

namespace drumlin::particles {

/// Adds to each grain a velocity whose parts are normal with a variance inverse to its mass, so that grains
/// of all sizes have the same mean energy. Together the velocities have no momentum (but for rounding), and
/// the energy of all mass at `speed`, sum m v^2 = speed^2 sum m. One grain alone gets none. Depends on the
/// seed and on the order of the grains alone.
void add_thermal_motion(double speed, std::uint64_t seed, Bodies&);

}  // namespace drumlin::particles

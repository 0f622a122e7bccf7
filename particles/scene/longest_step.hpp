#pragma once
// How far things may move within a step, whatever made them: grains, walls, cells. Beyond, contacts are
// looked for where they no longer are.
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

/// Smallest diameters that gravity moves a grain from rest, and random velocities one of a gas: no further
/// than its neighbour.
inline constexpr double longest_fall = 1;
/// Smallest diameters that a wall moves across itself: half of a grain, whose side of the wall stays sure.
inline constexpr double longest_push = 0.5;
/// Strain of a cell: up to 0.2 a sheared gas keeps its energy, at 0.25 a quarter of the steps misses the
/// solver's tolerance, at 0.5 the energy grows without bound.
inline constexpr double longest_strain = 0.2;
/// Mean diameters that a single grain flies: its way is swept, and is right however long; this one is an
/// error.
inline constexpr double longest_flight = 1000;

/// The smallest diameter that a scene can make, listed grains aside; infinite where it makes none.
double smallest_made_mm(const Scene& scene);

/// Steps in which something moves too far, grains of the smallest diameter being there.
std::vector<SceneFault> steps_too_long(const Scene& scene, double smallest_mm);

}  // namespace drumlin::particles

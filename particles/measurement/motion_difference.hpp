#pragma once
// Difference between two simulations that started from one state.
#include "particles/bodies/bodies.hpp"

namespace drumlin::particles {

/// Differences as root mean squares over the grains, weighted with their masses, over that of the reference's
/// own motion less its rigid part: what all grains share by translation and rotation is no flow, and counts
/// neither in a frame that turns nor in one at rest.
struct MotionDifference {
  double velocity = 0;  ///< of each grain, at the end: whether an impact came just before or after decides
  double displacement = 0;  ///< of each grain since the start: its velocity over the whole stretch
  double field = 0;         ///< the same, averaged over the grains that began in one square of 4 d: the flow
  double energy = 0;        ///< relative difference of the kinetic energy
};

/// The three have the same grains in the same order. NaN where the reference moves as a rigid body.
MotionDifference motion_difference(const Bodies& start, const Bodies& reference, const Bodies& other);

}  // namespace drumlin::particles

#pragma once
// A scene that is told in a frame which turns. Each step is done in the laboratory: the state is turned
// there, and back after the step. Centrifugal and Coriolis forces so act exactly, without a time-step error
// of their own (as body forces explicit in time they would raise the speed of a free disc by a factor of
// sqrt(1 + (2 h Omega)^2) in each step). Costs two passes over the bodies per step, whatever the contacts.
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/stepping/moreau_jean.hpp"

namespace drumlin {

/// Turns about `center`; coincides with the laboratory at time 0.
struct TurningFrame {
  double spin = 0;  ///< positive clockwise
  Point center;
};

/// Positions, velocities and spins of the frame to those of the laboratory, at `time` of the whole run.
void to_laboratory(const TurningFrame& frame, double time, Bodies& bodies);
/// And back.
void from_laboratory(const TurningFrame& frame, double time, Bodies& bodies);
/// Walls of a step that begins at `time`, as the laboratory sees them.
WallStep in_laboratory(const TurningFrame& frame, double time, double time_step, const WallStep& walls);
/// A direction of the laboratory as seen in the frame.
Point direction_in_frame(const TurningFrame& frame, double time, Point direction);

}  // namespace drumlin

#pragma once
// Rotating frame: a scene that is told in a frame which turns. Each step is done in the laboratory: the state
// is turned there, and back after the step. Centrifugal and Coriolis forces so act exactly, without a
// time-step error of their own (as body forces explicit in time they would raise the speed of a free disc by
// a factor of sqrt(1 + (2 h Omega)^2) in each step). Costs two passes over the bodies per step.
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/effects/key_ranges.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/wall_step.hpp"

namespace drumlin::particles {

/// The keys. Walls, motions, positions and velocities of the scene are those of the frame; gravity keeps its
/// direction in the laboratory, with which the frame coincides at time 0.
struct RotatingFrame {
  static constexpr const char* name = "rotating_frame";
  static constexpr const char* sentence =
      "Scene told in a turning frame; gravity keeps its laboratory direction.";
  static constexpr const char* modest_text = "1 rpm";
  static RotatingFrame modest() { return {1, {0, 0}}; }
  void check(const auto& scene, auto refuse) const {
    if (scene.periodic_x)
      refuse("turns a domain that is periodic in x", "in a scene without periodic_x", "periodic_x");
  }

  double speed_rpm = 0;  ///< positive clockwise as drawn
  Point_mm center_mm{0, 0};
};

template <class Visitor>
void describe(Visitor& v, RotatingFrame& f) {
  v.value("speed_rpm", f.speed_rpm, required("turns/min", at_least(-1e6, 1e6), "Positive clockwise."));
  v.value("center_mm", f.center_mm, defaulted("mm", coordinate_mm(), "Centre [x, z]."));
}

/// The law. Turns about `center`; coincides with the laboratory at time 0.
struct TurningFrame {
  double spin = 0;  ///< positive clockwise
  Point center;
};
TurningFrame law_of(const RotatingFrame&, const LawInput&);

// Terms: before and after a step.

/// Positions, velocities and spins of the frame to those of the laboratory, at `time` of the whole run.
void to_laboratory(const TurningFrame& frame, double time, Bodies& bodies);
/// And back.
void from_laboratory(const TurningFrame& frame, double time, Bodies& bodies);
/// Walls of a step that begins at `time`, as the laboratory sees them.
WallStep in_laboratory(const TurningFrame& frame, double time, double time_step, const WallStep& walls);
/// A direction of the laboratory as seen in the frame.
Point direction_in_frame(const TurningFrame& frame, double time, Point direction);

}  // namespace drumlin::particles

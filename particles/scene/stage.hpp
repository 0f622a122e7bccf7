#pragma once
// Stages of a scene: stretches of time, what moves in them, what changes, and when they end.
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "particles/effects/driven_walls.hpp"
#include "particles/effects/effects.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/effects/servo_walls.hpp"
#include "particles/effects/stage_gravity.hpp"

namespace drumlin::particles {

/// The grains are at rest: their kinetic energy stays below a bound.
struct UntilRest {
  double energy = 1e-6;  ///< per grain, in weights of a disc of the mean diameter times that diameter
  double for_s = 0;      ///< in all steps of so long a time
};
/// The middle of a wall's first shape is so far from where it stood when the stage began.
struct UntilMoved {
  std::string wall;
  double distance_mm = 0;
};
/// An outlet has taken so many grains since the stage began.
struct UntilOut {
  std::string outlet;
  int count = 0;
};
/// What ends a stage before its time: the first of these that is met.
struct Until {
  std::optional<UntilRest> at_rest = {};
  std::optional<UntilMoved> moved = {};
  std::optional<UntilOut> out = {};
};

/// Turns a wall about a point; positive in the sense of the vorticity dv_x/dz (clockwise as drawn, z up).
struct Rotation {
  double speed_rpm = 0;
  Point_mm center_mm{0, 0};
};
struct Translation {
  std::array<double, 2> velocity_mm_s{0, 0};
};
/// Shakes a wall along a straight line: displacement amplitude (sin(2 pi f t + phase) - sin(phase)), t from
/// the start of the stage.
struct Oscillation {
  std::array<double, 2> amplitude_mm{0, 0};
  double frequency_hz = 0;
  double phase_deg = 0;
};
/// The same in angle, about a point; positive clockwise as drawn.
struct Rocking {
  double amplitude_deg = 0;
  double frequency_hz = 0;
  double phase_deg = 0;
  Point_mm center_mm{0, 0};
};
/// The wall rests, its surface runs along itself, as a belt: segments from their first end to the other,
/// clockwise round other shapes.
struct Belt {
  double speed_mm_s = 0;
};
/// Several of one wall act one after the other, each on what those before it leave.
struct WallMotion {
  std::string wall;
  std::variant<Rotation, Translation, Oscillation, Rocking, ForceControl, PressureControl, StrainRate, Belt>
      motion;
};

/// Whether the motion is moved by a force or a pressure: one body more, its place a result.
bool is_driven(const WallMotion&);

inline constexpr int most_snapshots = 1'000'000;  ///< of a stage

/// A stretch of time with its own step, wall motions and number of snapshots (evenly spread, the last at its
/// end).
struct Stage {
  std::string name;
  std::optional<double> duration_s;
  std::optional<double> turns;  ///< of the first rotation among its motions; exactly one of the two is given
  double time_step_s = 0;
  std::vector<WallMotion> motions;
  int snapshots = 0;
  std::optional<std::vector<std::string>> opens = {};  ///< walls that are gone from its start on
  std::optional<StageGravity> gravity = {};            ///< stays until another stage changes it
  StageEffects effects = {};                           ///< in this stage alone
  std::optional<Until> until = {};
  std::optional<StageCell> cell = {};  ///< how a cell that is periodic in x and z moves
};

/// Seconds of a stage, from duration_s or from its turns; NaN for a stage that validate() refuses. One with
/// `until` may end before.
double duration_s(const Stage& stage);
/// The steps of a stage: the nearest number to its length over the step asked for, but none longer than that
/// by more than a hundredth. 0: it is shorter than half a step.
double steps_of(const Stage& stage);

}  // namespace drumlin::particles

#pragma once
// Walls: rigid shapes that move as told. Their poses are functions of time, never integrated, so that a drum
// turned a thousand times is still where its angle says.
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "particles/scene/scene.hpp"

namespace drumlin {

/// Rigid displacement p -> R(angle) p + offset; angle positive clockwise as drawn (the sense of spin).
struct Pose {
  double angle = 0;
  double x = 0, z = 0;
};
struct Point {
  double x = 0, z = 0;
};
Point moved(const Pose&, Point);
/// A pose with its sine and cosine, for many points.
struct Rigid {
  explicit Rigid(const Pose& pose);
  Point moved(Point) const;
  Point turned(Point) const;  ///< a direction: without the offset
  double cosine, sine, x, z;
};
/// The displacement that does `first`, then `second`.
Pose after(const Pose& second, const Pose& first);
Pose inverse(const Pose&);

/// Shapes in the pose of the moment.
struct Container {
  Point center;
  double radius = 0;
};
struct Segment {
  Point from, to;
};
struct FixedDisc {
  Point center;
  double radius = 0;
};
using Shape = std::variant<Container, Segment, FixedDisc>;

/// Motion of one wall within a stage.
struct Turning {
  double spin = 0;  ///< positive clockwise
  Point center;
};
struct Gliding {
  double v_x = 0, v_z = 0;
};
/// Displacement amplitude (sin(rate t + phase) - sin(phase)).
struct Shaking {
  Point amplitude;
  double rate = 0, phase = 0;
};
/// The same in angle, about `center`.
struct Swinging {
  double amplitude = 0, rate = 0, phase = 0;
  Point center;
};
/// Moved along `direction` by a force and by contacts; `position` and `velocity` are state.
struct Driven {
  Point direction;  ///< unit vector
  double force = 0, inverse_mass = 0;
  double glide_x = 0, glide_z = 0;  ///< velocity across
  double position = 0, velocity = 0;
};
using Motion = std::variant<std::monostate, Turning, Gliding, Shaking, Swinging, Driven>;
/// Displacement after `time` of a motion.
Pose displacement(const Motion&, double time);

/// What a driven wall has that no function of time tells.
struct DrivenState {
  double position = 0, velocity = 0;  ///< along its direction, position since the stage began
};

/// All walls of a scene. A shape's index is its place in `reference`; shapes of one name belong to one wall.
struct Walls {
  std::vector<std::string> names;  ///< one per wall
  std::vector<Shape> reference;    ///< as in the scene, each followed by the discs glued to it
  std::vector<int> wall_of_shape;
  std::vector<std::uint8_t> material_of_shape;  ///< empty when no law asks for it
  std::vector<Motion> motion;                   ///< one per wall, of the current stage
  std::vector<Pose> pose_at_start;              ///< one per wall, when the current stage began

  Pose pose(int wall, double time_in_stage) const;
  /// States of the walls that the current stage drives, in the order of the walls.
  std::vector<DrivenState> driven_states() const;
  void set_driven_states(const std::vector<DrivenState>& states);  ///< as many as driven_states() gives
  /// Shapes at a time of the current stage.
  std::vector<Shape> shapes_at(double time_in_stage) const;
};

Shape moved(const Rigid&, const Shape&);

/// Length of the line on which discs can be glued; 0 for a disc.
double wall_length_mm(const Wall& wall);
/// Centres of the discs glued to a wall, in mm: evenly along a container, or a segment with half a spacing
/// free at either end, so that a segment as long as the period closes on itself. Empty for a smooth wall.
std::vector<Point_mm> glued_centers_mm(const Wall& wall);

/// Dimensionless walls of a scene, at rest.
Walls walls_of(const Scene&, const Scales&);
/// Begins a stage: poses are carried over from `time_in_old_stage`, motions are replaced by those of `stage`.
/// A wall that the new stage drives starts with what velocity it has along the new direction, if it was
/// driven or glided.
void begin_stage(Walls&, const Stage& stage, const Scales&, double time_in_old_stage);

}  // namespace drumlin

#pragma once
// Walls: rigid shapes that move as told. Their poses are functions of time, never integrated, so that a drum
// turned a thousand times is still where its angle says; only walls that contacts push have a state.
#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace drumlin::particles {

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
  /// Unit directions in which another thin wall goes on from each end, where one does (join_ends); zero: a
  /// true end.
  Point beyond_from = {}, beyond_to = {};
};
struct FixedDisc {
  Point center;
  double radius = 0;
};
/// Half of a piece of a circle, solid on both sides, from the joint with its other half to the piece's end: a
/// disc touches a half at one point, and both ends of a piece at once if it is too large for it.
struct Arc {
  Point center;
  double radius = 0;
  Point joint;        ///< unit vector from the centre to the joint
  double turn = 0;    ///< angle from there to the end, positive anticlockwise
  Point beyond = {};  ///< as of a segment, at the end
};
/// What is left of the shapes of a wall that a stage has opened: nothing that grains could touch. They keep
/// their positions in lists, so that indices keep their meaning.
struct Opened {};
using Shape = std::variant<Container, Segment, FixedDisc, Opened, Arc>;
inline bool is_open(const Shape& shape) { return std::holds_alternative<Opened>(shape); }
/// Centre of a container or a disc, middle of a segment, joint of an arc; the origin for an opened one.
Point middle_of(const Shape&);
/// Least and greatest coordinates.
struct Reaches {
  double x_low, x_high, z_low, z_high;
};
/// Of a segment, a disc or an arc. A container has discs within it, an opened shape is nowhere: none.
std::optional<Reaches> reaches_of(const Shape&);
/// Bound on how far a point of a shape moves by a displacement; 0 for an opened one.
double largest_move(const Shape&, const Pose& displacement);

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
/// The distance from a reference along `direction` changes at a constant rate: distance exp(rate t).
struct Straining {
  Point direction;  ///< unit vector
  double distance = 0, rate = 0;
};
/// Moved along `direction` by a force and by contacts; how far and how fast is a DrivenState.
struct Driven {
  Point direction;  ///< unit vector
  double force = 0, inverse_mass = 0;
  double glide_x = 0, glide_z = 0;  ///< velocity across
  int state = 0;                    ///< its position among the states
  /// Shapes: the force is per length of the distance of their middles across the direction; -1: it is whole.
  std::array<int, 2> between = {-1, -1};
};
/// State of a driven wall along its direction: the one place where it is kept between steps.
struct DrivenState {
  double position = 0;  ///< since the stage began
  double velocity = 0;
};
/// The shape rests, its surface runs along itself, as that of a belt: on both sides of a segment from its
/// first end to the other, clockwise round other shapes.
struct Running {
  double speed = 0;
};
using Motion = std::variant<Turning, Gliding, Shaking, Swinging, Driven, Straining, Running>;
/// Displacement after `time` of a motion. `driven`: the states of all driven walls of the stage.
Pose displacement(const Motion&, double time, std::span<const DrivenState> driven = {});

/// Numbers of materials.
using MaterialSet = std::bitset<256>;

/// All walls of a scene. A shape's index is its position in `reference`; shapes of one name belong to one
/// wall.
struct Walls {
  std::vector<std::string> names;  ///< one per wall
  std::vector<Shape> reference;    ///< as in the scene, each followed by the discs glued to it
  std::vector<int> wall_of_shape;
  std::vector<std::uint8_t> material_of_shape;  ///< empty when no law asks for it
  std::vector<MaterialSet> acts_on;  ///< one per shape: of the grains that it meets; empty: each meets all
  /// One list per wall, of the current stage: each motion acts on what those before it leave.
  std::vector<std::vector<Motion>> motions;
  std::vector<Pose> pose_at_start;  ///< one per wall, when the current stage began
  std::vector<bool> open;           ///< one per wall, as far as the stages up to now opened any; else empty
  double period = 0;                ///< length of a periodic domain; 0: open

  // `driven`: the state of each wall that the current stage drives, in the order of the walls.
  Pose pose(int wall, double time_in_stage, std::span<const DrivenState> driven = {}) const;
  /// Shapes at a time of the current stage.
  std::vector<Shape> shapes_at(double time_in_stage, std::span<const DrivenState> driven = {}) const;
};

Shape moved(const Rigid&, const Shape&);
/// Tells segments and arcs whose ends meet of each other, so that discs pass the joint as if the wall were
/// one. `together`: shapes with the same number never move against each other.
void join_ends(std::span<Shape> shapes, std::span<const int> together);
/// The index of a wall's first shape.
int first_shape(const Walls&, int wall);
/// How contacts move a wall, if they do: always the last of its motions.
const Driven* driven_motion(const Walls&, std::size_t wall);

}  // namespace drumlin::particles

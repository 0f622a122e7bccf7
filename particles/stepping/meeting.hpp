#pragma once
// Where and when the surfaces of a pair meet within a step, on the paths that its bodies take without
// contacts.
#include <optional>
#include <span>

#include "particles/detection/candidate.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// Surfaces of a pair against each other: gap, and unit normal from j to i.
struct Surfaces {
  double gap = 0;
  Point normal;
};

/// The path of one side of a pair against the other, start + velocity t + acceleration t^2 / 2, from the
/// beginning of a step. Walls that are not discs move with the velocity of the point of them that was
/// nearest.
class PairPath {
 public:
  /// Of a pair as it was found. Grains start their paths at `step.free.shift` from their positions, with the
  /// velocities given; a wall that contacts push counts as one that moves with the velocity of the pair.
  PairPath(const StepInput& step, const Candidate& pair, const Point& v_i, const Point& v_j);

  /// Of two discs whose centres are `start` apart, their surfaces in touch at the distance `reach`.
  PairPath(const Point& start, const Point& velocity, double reach)
      : reach_(reach), start_(start), velocity_(velocity) {}
  /// Another beginning: i has been moved by `shift` against j.
  void move(const Point& shift) { start_ += shift; }
  /// Whether the surfaces of two discs part at a time.
  bool parts(double time) const { return dot(start_ + displacement(time), velocity(time)) >= 0; }

  Surfaces at(double time) const { return at_displacement(displacement(time)); }
  /// Somewhere else than on the path: so far from its beginning.
  Surfaces at_displacement(const Point& displacement) const;
  /// Velocity at a time.
  Point velocity(double time) const { return velocity_ + time * acceleration_; }
  /// Displacement up to a time.
  Point displacement(double time) const { return time * (velocity_ + time / 2 * acceleration_); }
  /// First time from `from` to `end` at which the surfaces meet and close; that itself where they touch then.
  std::optional<double> meeting(double from, double end) const;
  /// The time up to `end` at which bodies that meet do so, and others are nearest, on a straight path.
  double nearest(double end) const;

 private:
  std::optional<double> disc_meeting(double from, double end) const;

  const Shape* shape_ = nullptr;  // none: discs, or a point, at `reach_` from the origin
  double reach_ = 0;              // sum of the radii; of a shape, the grain's radius
  Point start_, velocity_, acceleration_;
};

/// Whether a grain that no impact has hit stays clear of a wall of which it is not far, told by its
/// normal and the curvature of containers alone. False of some that do.
bool stays_apart(const StepInput& step, const Candidate& pair);

/// The velocity of the surface of a container, whose centre has a velocity, turns with the normal, from that
/// of the pair to `now`; the pair takes both over.
void turn_wall_velocity(const Point& now, const Point& centre, Candidate& pair);

/// Gives pairs the gaps and normals with which the contact problem of a step takes them: of pairs that meet
/// within the step those of the position where they meet, of discs that pass each other those of where they
/// are nearest, since a plane through the surfaces as they are now would stop them; of hit pairs those
/// at the end of their paths. The gap is that along the normal, from where the paths begin: with any normal,
/// gap + (displacement within the step) . normal >= 0 excludes an overlap at the end. It is negative of
/// hit pairs alone, whose paths begin within each other. A wall that a grain does not reach on its path
/// stops nothing. `beside_grains`: of each grain, whether it has a pair with another grain; `shifted`:
/// whether its path begins elsewhere than it is.
void place_pairs(const StepInput& step, std::span<const char> beside_grains, std::span<const char> shifted,
                 std::span<Candidate> pairs);

}  // namespace drumlin::particles

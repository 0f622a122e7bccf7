#include "particles/effects/rotating_frame.hpp"

#include <numbers>

namespace drumlin::particles {
namespace {

/// The frame's displacement since time 0.
Pose pose_of(const TurningFrame& frame, double time) {
  return displacement(Turning{frame.spin, frame.center}, time);
}

/// Turns positions by `pose`, velocities by its angle.
void turn(const Pose& pose, Bodies& bodies) {
  const Rigid rigid(pose);
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const Point x = rigid.moved({bodies.x[b], bodies.z[b]});
    const Point v = rigid.turned({bodies.v_x[b], bodies.v_z[b]});
    bodies.x[b] = x.x, bodies.z[b] = x.z;
    bodies.v_x[b] = v.x, bodies.v_z[b] = v.z;
  }
}

/// Adds the velocity of a rigid rotation (spin (z - c_z), -spin (x - c_x)).
void add_rotation(double spin, const Point& center, Bodies& bodies) {
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    bodies.v_x[b] += spin * (bodies.z[b] - center.z);
    bodies.v_z[b] -= spin * (bodies.x[b] - center.x);
  }
  for (double& own : bodies.spin) own += spin;
}

}  // namespace

TurningFrame law_of(const RotatingFrame& key, const LawInput& in) {
  const Scales& scales = in.scales;
  const double unit = 1e-3 / scales.length_m;
  return TurningFrame{key.speed_rpm * 2 * std::numbers::pi / 60 * scales.time_s,
                      {key.center_mm[0] * unit, key.center_mm[1] * unit}};
}

void to_laboratory(const TurningFrame& frame, double time, Bodies& bodies) {
  turn(pose_of(frame, time), bodies);
  add_rotation(frame.spin, frame.center, bodies);
}

void from_laboratory(const TurningFrame& frame, double time, Bodies& bodies) {
  add_rotation(-frame.spin, frame.center, bodies);
  turn(inverse(pose_of(frame, time)), bodies);
}

WallStep in_laboratory(const TurningFrame& frame, double time, double time_step, const WallStep& walls) {
  const Pose before = pose_of(frame, time), after_step = pose_of(frame, time + time_step);
  const Rigid first(before), last(after_step);
  WallStep seen;
  for (const Shape& shape : walls.before) seen.before.push_back(moved(first, shape));
  for (const Shape& shape : walls.after) seen.after.push_back(moved(last, shape));
  seen.displacement = walls.displacement;
  for (ShapeStep& step : seen.displacement)
    step.set_displacement(after(after_step, after(step, inverse(before))));
  return seen;
}

Point direction_in_frame(const TurningFrame& frame, double time, Point direction) {
  return Rigid(inverse(pose_of(frame, time))).turned(direction);
}

}  // namespace drumlin::particles

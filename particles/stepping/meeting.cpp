#include "particles/stepping/meeting.hpp"

#include <algorithm>
#include <cmath>

#include "particles/detection/contact_list.hpp"
#include "particles/effects/driven_walls.hpp"

namespace drumlin::particles {
namespace {

/// The zero of a function between a time at which it is positive and one at which it is not (Illinois).
template <class Function>
double zero_between(double above, double f_above, double below, double f_below, Function f) {
  int side = 0;
  for (int k = 0; k < 80 && f_below < 0; ++k) {
    const double t = below - f_below * (below - above) / (f_below - f_above);
    if (!(t > std::min(above, below) && t < std::max(above, below))) break;
    const double value = f(t);
    if (value > 0) {
      above = t, f_above = value;
      if (side == 1) f_below /= 2;
      side = 1;
    } else {
      below = t, f_below = value;
      if (side == -1) f_above /= 2;
      side = -1;
    }
  }
  return below;
}

/// Of the surface of a container: turning about its centre moves none of it.
Point container_velocity(const StepInput& step, const Container& was, std::size_t shape) {
  const auto& is = std::get<Container>(step.walls.after[shape]);
  const Point moved = is.center - was.center;
  return {moved.x / step.time_step, moved.z / step.time_step};
}

}  // namespace

PairPath::PairPath(const StepInput& step, const Candidate& pair, const Point& v_i, const Point& v_j) {
  const Point of_i = shift(step.free, pair.i);
  velocity_ = v_i - v_j - wall_velocity(pair);
  const double radius = step.bodies.radius[pair.i];
  if (pair.j >= 0) {
    reach_ = radius + step.bodies.radius[pair.j];
    start_ = (reach_ + pair.gap) * normal(pair) + of_i - shift(step.free, pair.j);
    return;
  }
  acceleration_ = step.laws.gravity.value_or(Point{});
  const std::size_t s = -1 - pair.j;
  const Shape& shape = step.walls.before[s];
  if (const ShapeStep& moves = step.walls.displacement[s]; moves.surface != 0) {  // which moves no shape
    const Point touched = position(step.bodies, pair.i) - (radius + pair.gap) * normal(pair);
    const Point by = moved(static_cast<const Pose&>(moves), touched) - touched;
    velocity_ = v_i - Point{by.x / step.time_step, by.z / step.time_step};
  }
  if (const auto* disc = std::get_if<FixedDisc>(&shape)) {
    reach_ = radius + disc->radius;
    start_ = (reach_ + pair.gap) * normal(pair) + of_i;
    return;
  }
  shape_ = &shape;
  reach_ = radius;
  const Period& period = step.laws.period;
  double x = step.bodies.x[pair.i];
  if (!period.open()) x = middle_of(shape).x + period.nearest(x - middle_of(shape).x);
  start_ = Point{x, step.bodies.z[pair.i]} + of_i;
  if (const auto* was = std::get_if<Container>(&shape)) velocity_ = v_i - container_velocity(step, *was, s);
}

bool stays_apart(const StepInput& step, const Candidate& pair) {
  if (!(pair.gap > 0) || driven_wall_of(step.walls, pair) >= 0) return false;
  const double h = step.time_step;
  const std::size_t s = -1 - pair.j;
  const Shape& shape = step.walls.before[s];
  if (std::holds_alternative<Arc>(shape)) return false;
  const auto* container = std::get_if<Container>(&shape);
  const Point w = container ? container_velocity(step, *container, s) : wall_velocity(pair);
  const Point d = h * (0.5 * (velocity(step.bodies, pair.i) + velocity(step.free, pair.i)) - w);
  const double curvature = container ? 0.5 / (container->radius - step.bodies.radius[pair.i] - pair.gap) : 0;
  return curvature >= 0 && pair.gap + pair.n_x * d.x + pair.n_z * d.z - curvature * dot(d, d) >= 0;
}

Surfaces PairPath::at_displacement(const Point& d) const {
  const Point at = start_ + d;
  Surfaces s;
  Point point;
  if (shape_) {
    s.gap = gap_to_shape(*shape_, at.x, at.z, reach_, s.normal.x, s.normal.z, point, BesideNext::line);
    return s;
  }
  const double distance = std::sqrt(dot(at, at));
  return distance > 0 ? Surfaces{distance - reach_, {at.x / distance, at.z / distance}}
                      : Surfaces{-reach_, {0, 1}};
}

/// Discs that nothing accelerates against each other.
std::optional<double> PairPath::disc_meeting(double from, double end) const {
  const double along = dot(start_, velocity_), speed = dot(velocity_, velocity_);
  const double over = dot(start_, start_) - reach_ * reach_, root = along * along - speed * over;
  if (!(along + from * speed < 0 && root > 0)) return std::nullopt;
  const double time = std::max(from, over / (-along + std::sqrt(root)));
  if (time > end) return std::nullopt;
  return time;
}

std::optional<double> PairPath::meeting(double from, double end) const {
  if (!shape_ && is_zero(acceleration_)) return disc_meeting(from, end);
  double left = from;
  Surfaces first = at(left);
  const double u_n = dot(first.normal, velocity(left));
  if (u_n < 0 && first.gap <= 0) return left;
  if (u_n >= 0) {  // it may turn back
    const double a_n = dot(first.normal, acceleration_);
    if (!(a_n < 0) || !((left -= u_n / a_n) < end)) return std::nullopt;
    first = at(left);
    if (first.gap <= 0) return left;
  }
  double right = end;
  Surfaces last = at(right);
  if (last.gap > 0) {  // it may pass a disc or an end within the step
    const Point u = velocity(left), r = (reach_ + first.gap) * first.normal;
    right = left - dot(r, u) / std::max(dot(u, u), 1e-300);
    if (!(right > left && right < end)) return std::nullopt;
    last = at(right);
    if (last.gap > 0) return std::nullopt;
  }
  return zero_between(left, first.gap, right, last.gap, [this](double t) { return at(t).gap; });
}

double PairPath::nearest(double end) const {
  if (const auto time = disc_meeting(0, end)) return *time;
  const double speed = dot(velocity_, velocity_);
  return speed > 0 ? std::clamp(-dot(start_, velocity_) / speed, 0.0, end) : 0;
}

void turn_wall_velocity(const Point& now, const Point& centre, Candidate& pair) {
  const Point v = wall_velocity(pair) - centre;
  const double normal = normal_part(pair, v), tangential = tangential_part(pair, v);
  pair.wall_v_x = centre.x + normal * now.x + tangential * now.z;
  pair.wall_v_z = centre.z + normal * now.z - tangential * now.x;
  set_normal(pair, now);
}

namespace {

/// `centre`: velocity of a container. Takes the surfaces of a time on the path, and the gap of their plane at
/// the beginning of the step.
void place_at(const PairPath& path, double time, const Point* centre, Candidate& pair) {
  const Surfaces then = path.at(time);
  if (centre) turn_wall_velocity(then.normal, *centre, pair);
  set_normal(pair, then.normal);
  pair.gap = then.gap - dot(then.normal, path.displacement(time));
}

/// An overlap from before the step is no matter of velocities: the pair may keep it.
void keep_overlap(double gap_before, Candidate& pair) {
  if (pair.gap < 0 && gap_before < 0) pair.gap = std::min(0.0, pair.gap - gap_before);
}

/// Whether a grain touches a wall and goes on into it: nearly all grains at walls.
bool stays_in_contact(const StepInput& step, const Candidate& pair) {
  constexpr double rounded_gap = 1e-10;
  if (pair.gap > rounded_gap) return false;
  const Shape& shape = step.walls.before[-1 - pair.j];
  if (std::holds_alternative<FixedDisc>(shape)) return false;  // convex: it may fall away below the grain
  if (const auto* arc = std::get_if<Arc>(&shape))
    if (std::hypot(step.bodies.x[pair.i] - arc->center.x, step.bodies.z[pair.i] - arc->center.z) >
        arc->radius)
      return false;
  return normal_part(pair, velocity(step.free, pair.i) - wall_velocity(pair)) < 0;
}

/// `alone`: no other grain is near, so that the grain flies where the wall does not act (FreeMotion): further
/// away from a wall below it than its velocity at the end of the step tells.
void place_at_wall(const StepInput& step, bool alone, Candidate& pair) {
  const double h = step.time_step, gap_before = pair.gap;
  const bool shifted = !is_zero(shift(step.free, pair.i));
  if (!shifted && stays_in_contact(step, pair)) {
    pair.gap = 0;
    return;
  }
  if (!shifted && stays_apart(step, pair)) {
    const Point g = step.laws.gravity.value_or(Point{});
    if (alone) pair.gap -= std::min(0.0, h * h / 2 * normal_part(pair, g));
    return;
  }
  const PairPath path(step, pair, velocity(step.bodies, pair.i), {});
  const std::size_t s = -1 - pair.j;
  const auto* container = std::get_if<Container>(&step.walls.before[s]);
  const Point centre = container ? container_velocity(step, *container, s) : Point{};
  const Point u = path.velocity(h);
  const Surfaces end = path.at(h);
  const bool passes = end.gap >= 0 && driven_wall_of(step.walls, pair) < 0;
  if (shifted || pair.gap > 0 || normal_part(pair, u) >= 0)
    place_at(path, passes ? h : path.meeting(0, h).value_or(h), container ? &centre : nullptr, pair);
  if (passes && alone) {
    const double most = end.gap - h * normal_part(pair, u);
    pair.gap = std::max(pair.gap, shifted ? most : std::max(0.0, most));
  } else if (shifted) {
    keep_overlap(gap_before, pair);
  } else {
    pair.gap = std::max(0.0, pair.gap);
  }
}

void place_collided(const StepInput& step, Candidate& pair) {
  const double gap_before = pair.gap;
  const PairPath path(step, pair, velocity(step.bodies, pair.i), velocity(step.bodies, pair.j));
  place_at(path, step.time_step, nullptr, pair);
  keep_overlap(gap_before, pair);
}

}  // namespace

void place_pairs(const StepInput& step, std::span<const char> beside_grains, std::span<const char> shifted,
                 std::span<Candidate> pairs) {
  const double h = step.time_step;
  const Bodies& bodies = step.bodies;
  const auto& shift = step.free.shift;
  for (Candidate& pair : pairs) {
    if (pair.j < 0) {
      place_at_wall(step, !beside_grains[pair.i], pair);
    } else if ((shifted[pair.i] | shifted[pair.j]) != 0 &&
               (shift[pair.i].x != shift[pair.j].x || shift[pair.i].z != shift[pair.j].z)) {
      place_collided(step, pair);
    } else if (pair.gap <= 0) {
      pair.gap = 0;
    } else if (const Point v_i = velocity(bodies, pair.i), v_j = velocity(bodies, pair.j);
               pair.gap + h * normal_part(pair, v_i - v_j - wall_velocity(pair)) < 0) {
      const PairPath path(step, pair, v_i, v_j);
      place_at(path, path.nearest(h), nullptr, pair);
    }
  }
}

}  // namespace drumlin::particles

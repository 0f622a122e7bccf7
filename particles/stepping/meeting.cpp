#include "particles/stepping/meeting.hpp"

#include <algorithm>
#include <cmath>

#include "particles/detection/contact_list.hpp"
#include "particles/effects/driven_walls.hpp"

namespace drumlin::particles {
namespace {

double dot(const Point& a, const Point& b) { return a.x * b.x + a.z * b.z; }

PathShift shift_of(const StepInput& step, std::int32_t body) {
  return step.free.shift.empty() ? PathShift{} : step.free.shift[body];
}

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
  return {(is.center.x - was.center.x) / step.time_step, (is.center.z - was.center.z) / step.time_step};
}

}  // namespace

PairPath::PairPath(const StepInput& step, const Candidate& pair, const Point& v_i, const Point& v_j) {
  const Point of_i = shift_of(step, pair.i);
  velocity_ = {v_i.x - v_j.x - pair.wall_v_x, v_i.z - v_j.z - pair.wall_v_z};
  const double radius = step.bodies.radius[pair.i];
  if (pair.j >= 0) {
    const Point of_j = shift_of(step, pair.j);
    reach_ = radius + step.bodies.radius[pair.j];
    start_ = {pair.n_x * (reach_ + pair.gap) + of_i.x - of_j.x,
              pair.n_z * (reach_ + pair.gap) + of_i.z - of_j.z};
    return;
  }
  acceleration_ = step.laws.gravity.value_or(Point{});
  const std::size_t s = -1 - pair.j;
  const Shape& shape = step.walls.before[s];
  if (const ShapeStep& moves = step.walls.displacement[s]; moves.surface != 0) {  // which moves no shape
    const double off = radius + pair.gap;
    const Point touched{step.bodies.x[pair.i] - off * pair.n_x, step.bodies.z[pair.i] - off * pair.n_z};
    const Point then = moved(static_cast<const Pose&>(moves), touched);
    velocity_ = {v_i.x - (then.x - touched.x) / step.time_step,
                 v_i.z - (then.z - touched.z) / step.time_step};
  }
  if (const auto* disc = std::get_if<FixedDisc>(&shape)) {
    reach_ = radius + disc->radius;
    start_ = {pair.n_x * (reach_ + pair.gap) + of_i.x, pair.n_z * (reach_ + pair.gap) + of_i.z};
    return;
  }
  shape_ = &shape;
  reach_ = radius;
  const Period& period = step.laws.period;
  double x = step.bodies.x[pair.i];
  if (!period.open()) x = middle_of(shape).x + period.nearest(x - middle_of(shape).x);
  start_ = {x + of_i.x, step.bodies.z[pair.i] + of_i.z};
  if (const auto* was = std::get_if<Container>(&shape)) {
    const Point w = container_velocity(step, *was, s);
    velocity_ = {v_i.x - w.x, v_i.z - w.z};
  }
}

bool stays_apart(const StepInput& step, const Candidate& pair) {
  if (!(pair.gap > 0) || driven_wall_of(step.walls, pair) >= 0) return false;
  const double h = step.time_step;
  const std::size_t s = -1 - pair.j;
  const Shape& shape = step.walls.before[s];
  if (std::holds_alternative<Arc>(shape)) return false;
  const auto* container = std::get_if<Container>(&shape);
  const Point w = container ? container_velocity(step, *container, s) : Point{pair.wall_v_x, pair.wall_v_z};
  const double x = h * ((step.bodies.v_x[pair.i] + step.free.x[pair.i]) / 2 - w.x);
  const double z = h * ((step.bodies.v_z[pair.i] + step.free.z[pair.i]) / 2 - w.z);
  const double curvature = container ? 0.5 / (container->radius - step.bodies.radius[pair.i] - pair.gap) : 0;
  return curvature >= 0 && pair.gap + pair.n_x * x + pair.n_z * z - curvature * (x * x + z * z) >= 0;
}

Surfaces PairPath::at_displacement(const Point& d) const {
  const double x = start_.x + d.x, z = start_.z + d.z;
  Surfaces s;
  Point point;
  if (shape_) {
    s.gap = gap_to_shape(*shape_, x, z, reach_, s.n_x, s.n_z, point, BesideNext::line);
    return s;
  }
  const double distance = std::sqrt(x * x + z * z);
  return distance > 0 ? Surfaces{distance - reach_, x / distance, z / distance} : Surfaces{-reach_, 0, 1};
}

double PairPath::closing(const Surfaces& s, double time) const {
  const Point u = velocity(time);
  return s.n_x * u.x + s.n_z * u.z;
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
  if (!shape_ && acceleration_.x == 0 && acceleration_.z == 0) return disc_meeting(from, end);
  double left = from;
  Surfaces first = at(left);
  const double u_n = closing(first, left);
  if (u_n < 0 && first.gap <= 0) return left;
  if (u_n >= 0) {  // it may turn back
    const double a_n = first.n_x * acceleration_.x + first.n_z * acceleration_.z;
    if (!(a_n < 0) || !((left -= u_n / a_n) < end)) return std::nullopt;
    first = at(left);
    if (first.gap <= 0) return left;
  }
  double right = end;
  Surfaces last = at(right);
  if (last.gap > 0) {  // it may pass a disc or an end within the step
    const Point u = velocity(left), r{first.n_x * (reach_ + first.gap), first.n_z * (reach_ + first.gap)};
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

void turn_wall_velocity(const Surfaces& now, const Point& centre, Candidate& pair) {
  const double x = pair.wall_v_x - centre.x, z = pair.wall_v_z - centre.z;
  const double normal = pair.n_x * x + pair.n_z * z, tangential = pair.n_z * x - pair.n_x * z;
  pair.wall_v_x = centre.x + normal * now.n_x + tangential * now.n_z;
  pair.wall_v_z = centre.z + normal * now.n_z - tangential * now.n_x;
  pair.n_x = now.n_x, pair.n_z = now.n_z;
}

namespace {

/// `centre`: velocity of a container. Takes the surfaces of a time on the path, and the gap of their plane at
/// the beginning of the step.
void place_at(const PairPath& path, double time, const Point* centre, Candidate& pair) {
  const Surfaces then = path.at(time);
  const Point d = path.displacement(time);
  if (centre) turn_wall_velocity(then, *centre, pair);
  pair.n_x = then.n_x, pair.n_z = then.n_z;
  pair.gap = then.gap - (then.n_x * d.x + then.n_z * d.z);
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
  return pair.n_x * (step.free.x[pair.i] - pair.wall_v_x) + pair.n_z * (step.free.z[pair.i] - pair.wall_v_z) <
         0;
}

/// `alone`: no other grain is near, so that the grain flies where the wall does not act (FreeMotion): further
/// away from a wall below it than its velocity at the end of the step tells.
void place_at_wall(const StepInput& step, bool alone, Candidate& pair) {
  const double h = step.time_step, gap_before = pair.gap;
  const Point shift = shift_of(step, pair.i);
  const bool shifted = shift.x != 0 || shift.z != 0;
  if (!shifted && stays_in_contact(step, pair)) {
    pair.gap = 0;
    return;
  }
  if (!shifted && stays_apart(step, pair)) {
    const Point g = step.laws.gravity.value_or(Point{});
    if (alone) pair.gap -= std::min(0.0, h * h / 2 * (pair.n_x * g.x + pair.n_z * g.z));
    return;
  }
  const PairPath path(step, pair, {step.bodies.v_x[pair.i], step.bodies.v_z[pair.i]}, {});
  const std::size_t s = -1 - pair.j;
  const auto* container = std::get_if<Container>(&step.walls.before[s]);
  const Point centre = container ? container_velocity(step, *container, s) : Point{};
  const Point u = path.velocity(h);
  const Surfaces end = path.at(h);
  const bool passes = end.gap >= 0 && driven_wall_of(step.walls, pair) < 0;
  if (shifted || pair.gap > 0 || pair.n_x * u.x + pair.n_z * u.z >= 0)
    place_at(path, passes ? h : path.meeting(0, h).value_or(h), container ? &centre : nullptr, pair);
  if (passes && alone) {
    const double most = end.gap - h * (pair.n_x * u.x + pair.n_z * u.z);
    pair.gap = std::max(pair.gap, shifted ? most : std::max(0.0, most));
  } else if (shifted) {
    keep_overlap(gap_before, pair);
  } else {
    pair.gap = std::max(0.0, pair.gap);
  }
}

void place_collided(const StepInput& step, Candidate& pair) {
  const auto& v_x = step.bodies.v_x;
  const auto& v_z = step.bodies.v_z;
  const double gap_before = pair.gap;
  const PairPath path(step, pair, {v_x[pair.i], v_z[pair.i]}, {v_x[pair.j], v_z[pair.j]});
  place_at(path, step.time_step, nullptr, pair);
  keep_overlap(gap_before, pair);
}

}  // namespace

void place_pairs(const StepInput& step, std::span<const char> beside_grains, std::span<const char> shifted,
                 std::span<Candidate> pairs) {
  const double h = step.time_step;
  const auto& v_x = step.bodies.v_x;
  const auto& v_z = step.bodies.v_z;
  const auto& shift = step.free.shift;
  for (Candidate& pair : pairs) {
    if (pair.j < 0) {
      place_at_wall(step, !beside_grains[pair.i], pair);
    } else if ((shifted[pair.i] | shifted[pair.j]) != 0 &&
               (shift[pair.i].x != shift[pair.j].x || shift[pair.i].z != shift[pair.j].z)) {
      place_collided(step, pair);
    } else if (pair.gap <= 0) {
      pair.gap = 0;
    } else if (const Point u{v_x[pair.i] - v_x[pair.j] - pair.wall_v_x,
                             v_z[pair.i] - v_z[pair.j] - pair.wall_v_z};
               pair.gap + h * normal_part(pair, u) < 0) {
      const PairPath path(step, pair, {v_x[pair.i], v_z[pair.i]}, {v_x[pair.j], v_z[pair.j]});
      place_at(path, path.nearest(h), nullptr, pair);
    }
  }
}

}  // namespace drumlin::particles

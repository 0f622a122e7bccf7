#include "particles/detection/contact_list.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace drumlin {
namespace {

/// A disc that would move further than this (in d) within one step is searched for by hand: it must not widen
/// all cells.
constexpr double fast_displacement = 0.25;

double length(double x, double z) { return std::sqrt(x * x + z * z); }

/// Unit vector of (dx, dz), upwards for coincident points; returns the length.
double normal_of(double dx, double dz, double& n_x, double& n_z) {
  const double distance = length(dx, dz);
  n_x = distance > 0 ? dx / distance : 0;
  n_z = distance > 0 ? dz / distance : 1;
  return distance;
}

Point nearest_on_segment(const Segment& s, double x, double z) {
  const double ex = s.to.x - s.from.x, ez = s.to.z - s.from.z;
  const double along =
      std::clamp(((x - s.from.x) * ex + (z - s.from.z) * ez) / (ex * ex + ez * ez), 0.0, 1.0);
  return {s.from.x + along * ex, s.from.z + along * ez};
}

struct Box {
  double x_low, x_high, z_low, z_high;
};

/// Where the centres of discs near a shape can be, `reach` away from its surface; a container has discs
/// everywhere.
std::optional<Box> surroundings(const Shape& shape, double reach) {
  if (const auto* s = std::get_if<Segment>(&shape))
    return Box{std::min(s->from.x, s->to.x) - reach, std::max(s->from.x, s->to.x) + reach,
               std::min(s->from.z, s->to.z) - reach, std::max(s->from.z, s->to.z) + reach};
  if (const auto* d = std::get_if<FixedDisc>(&shape)) {
    const double r = d->radius + reach;
    return Box{d->center.x - r, d->center.x + r, d->center.z - r, d->center.z + r};
  }
  return std::nullopt;
}

/// The image of x that is nearest to the middle of a shape. A wall as long as the period meets every grain
/// once.
double image_near(const Shape& shape, double x, const Period& period) {
  if (period.open()) return x;
  double middle = 0;
  if (const auto* s = std::get_if<Segment>(&shape))
    middle = (s->from.x + s->to.x) / 2;
  else if (const auto* d = std::get_if<FixedDisc>(&shape))
    middle = d->center.x;
  else
    middle = std::get<Container>(shape).center.x;
  return middle + period.nearest(x - middle);
}

/// Bound on how far a point of a shape moves within a step.
double largest_move(const Shape& shape, const Pose& step) {
  const auto move_of = [&step](Point p) {
    const Point then = moved(step, p);
    return length(then.x - p.x, then.z - p.z);
  };
  if (const auto* s = std::get_if<Segment>(&shape)) return std::max(move_of(s->from), move_of(s->to));
  const auto [center, radius] = [&shape] {
    if (const auto* c = std::get_if<Container>(&shape)) return std::pair(c->center, c->radius);
    const auto& d = std::get<FixedDisc>(shape);
    return std::pair(d.center, d.radius);
  }();
  return move_of(center) + std::abs(step.angle) * radius;
}

}  // namespace

double gap_to_shape(const Shape& shape, double x, double z, double radius, double& n_x, double& n_z,
                    Point& point) {
  if (const auto* c = std::get_if<Container>(&shape)) {
    const double distance = normal_of(c->center.x - x, c->center.z - z, n_x, n_z);
    point = {c->center.x - c->radius * n_x, c->center.z - c->radius * n_z};
    return c->radius - radius - distance;
  }
  if (const auto* s = std::get_if<Segment>(&shape)) {
    point = nearest_on_segment(*s, x, z);
    return normal_of(x - point.x, z - point.z, n_x, n_z) - radius;
  }
  const auto& disc = std::get<FixedDisc>(shape);
  const double distance = normal_of(x - disc.center.x, z - disc.center.z, n_x, n_z);
  point = {disc.center.x + disc.radius * n_x, disc.center.z + disc.radius * n_z};
  return distance - radius - disc.radius;
}

double gap_now(const Candidate& pair, const Bodies& bodies, std::span<const Shape> shapes,
               const Period& period, double& n_x, double& n_z) {
  if (pair.j < 0) {
    Point point;
    const Shape& shape = shapes[-1 - pair.j];
    return gap_to_shape(shape, image_near(shape, bodies.x[pair.i], period), bodies.z[pair.i],
                        bodies.radius[pair.i], n_x, n_z, point);
  }
  return normal_of(period.nearest(bodies.x[pair.i] - bodies.x[pair.j]), bodies.z[pair.i] - bodies.z[pair.j],
                   n_x, n_z) -
         bodies.radius[pair.i] - bodies.radius[pair.j];
}

void ContactDetection::keep_if_near(std::int32_t i, std::int32_t j, const Bodies& bodies, const Velocities& v,
                                    const DetectionInput& input) {
  const double dx = input.period.nearest(bodies.x[i] - bodies.x[j]), dz = bodies.z[i] - bodies.z[j];
  const double touching = bodies.radius[i] + bodies.radius[j];
  const double dv_x = v.x[i] - v.x[j], dv_z = v.z[i] - v.z[j];
  const double reach = touching + range_;
  if (dx * dx + dz * dz > reach * reach) return;
  Candidate pair{i, j, 0, 0, 0, 0, 0};
  pair.gap = normal_of(dx, dz, pair.n_x, pair.n_z) - touching;
  note(pair, -(pair.n_x * dv_x + pair.n_z * dv_z), input);
}

void ContactDetection::note(const Candidate& pair, double approach, const DetectionInput& input) {
  const double reach = 2 * input.time_step * std::max(0.0, approach);
  if (pair.gap < input.margin + reach) {
    jolt_[pair.i] = std::max(jolt_[pair.i], reach);
    if (pair.j >= 0) jolt_[pair.j] = std::max(jolt_[pair.j], reach);
  }
  candidates_.push_back(pair);
  reach_.push_back(reach);
}

void ContactDetection::drop_far_pairs(const DetectionInput& input) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < candidates_.size(); ++p) {
    const Candidate& pair = candidates_[p];
    const double jolt = jolt_[pair.i] + (pair.j >= 0 ? jolt_[pair.j] : 0);
    if (pair.gap < input.margin + reach_[p] + jolt / 2) candidates_[kept++] = pair;
  }
  candidates_.resize(kept);
}

void ContactDetection::keep_if_near_wall(std::int32_t b, std::int32_t shape, double farthest,
                                         const Bodies& bodies, const Velocities& v,
                                         const DetectionInput& input) {
  Candidate pair{b, -1 - shape, 0, 0, 0, 0, 0};
  Point point;
  pair.gap = gap_to_shape(input.shapes[shape], image_near(input.shapes[shape], bodies.x[b], input.period),
                          bodies.z[b], bodies.radius[b], pair.n_x, pair.n_z, point);
  if (pair.gap > farthest) return;
  const Point then = moved(input.shape_steps[shape], point);
  pair.wall_v_x = (then.x - point.x) / input.time_step;
  pair.wall_v_z = (then.z - point.z) / input.time_step;
  note(pair, -(pair.n_x * (v.x[b] - pair.wall_v_x) + pair.n_z * (v.z[b] - pair.wall_v_z)), input);
}

void ContactDetection::push_on_fast_impacts(const Bodies& bodies, const Velocities& v,
                                            const DetectionInput& input, double looked_at, double largest) {
  if (fast_.empty()) return;
  const auto count = static_cast<std::int32_t>(bodies.count());
  for (std::int32_t i = 0; i < count; ++i) {
    if (jolt_[i] <= looked_at) continue;
    range_ = looked_at + jolt_[i];
    const double reach = largest + range_, x = input.period.first(bodies.x[i]), z = bodies.z[i];
    grid_.near(x - reach, x + reach, z - reach, z + reach, [&](std::int32_t b) {
      if (b != i) keep_if_near(std::min(b, i), std::max(b, i), bodies, v, input);
    });
  }
}

const std::vector<Candidate>& ContactDetection::find(const Bodies& bodies, std::span<const double> v_x,
                                                     std::span<const double> v_z,
                                                     const DetectionInput& input) {
  candidates_.clear();
  reach_.clear();
  jolt_.assign(bodies.count(), 0.0);
  const auto count = static_cast<std::int32_t>(bodies.count());
  if (count == 0) return candidates_;
  const Velocities v{v_x, v_z};
  double fastest = 0, slow = 0;
  fast_.clear();
  for (std::int32_t b = 0; b < count; ++b) {
    const double moves = input.time_step * length(v_x[b], v_z[b]);
    fastest = std::max(fastest, moves);
    if (moves > fast_displacement)
      fast_.push_back(b);
    else
      slow = std::max(slow, moves);
  }
  // Two discs that move m each close at most 2 m within the step; the rule above keeps twice that.
  const double largest = 2 * *std::max_element(bodies.radius.begin(), bodies.radius.end());
  range_ = input.margin + 4 * slow;
  grid_.sort(bodies, largest + range_, input.period);
  const auto visit_neighbours = [&](std::int32_t i, double reach, auto visit) {
    const double x = input.period.first(bodies.x[i]), z = bodies.z[i];
    grid_.near(x - reach, x + reach, z - reach, z + reach, visit);
  };
  for (std::int32_t i = 0; i < count; ++i)
    visit_neighbours(i, largest + range_, [&](std::int32_t j) {
      if (j > i) keep_if_near(i, j, bodies, v, input);
    });
  range_ = input.margin + 4 * fastest;
  for (const std::int32_t f : fast_)
    visit_neighbours(f, largest + range_, [&](std::int32_t b) {
      if (b != f) keep_if_near(std::min(b, f), std::max(b, f), bodies, v, input);
    });
  push_on_fast_impacts(bodies, v, input, input.margin + 4 * slow, largest);
  for (std::size_t s = 0; s < input.shapes.size(); ++s) {
    const double farthest =
        input.margin + 2 * (fastest + largest_move(input.shapes[s], input.shape_steps[s]));
    const auto near_shape = [&](std::int32_t b) {
      keep_if_near_wall(b, static_cast<std::int32_t>(s), farthest, bodies, v, input);
    };
    if (const auto box = surroundings(input.shapes[s], largest / 2 + farthest))
      grid_.near(box->x_low, box->x_high, box->z_low, box->z_high, near_shape);
    else
      for (std::int32_t b = 0; b < count; ++b) near_shape(b);
  }
  drop_far_pairs(input);
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
  if (!fast_.empty())
    candidates_.erase(
        std::unique(candidates_.begin(), candidates_.end(),
                    [](const Candidate& a, const Candidate& b) { return a.i == b.i && a.j == b.j; }),
        candidates_.end());
  return candidates_;
}

}  // namespace drumlin

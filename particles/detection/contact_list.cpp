#include "particles/detection/contact_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace drumlin::particles {
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

/// Appends the pairs within a range to a list; without a branch that a processor could guess wrongly.
class ContactDetection::Looking {
 public:
  Looking(std::vector<Pair>& list, const Period& period, double range)
      : list_(list), count_(list.size()), period_(period), range_(range) {}
  ~Looking() { list_.resize(count_); }
  void operator()(const NearGrain& a, const NearGrain& b) {
    if (count_ == list_.size()) list_.resize(2 * count_ + 1024);
    const double dx = period_.nearest(a.x - b.x), dz = a.z - b.z;
    const double reach = a.radius + b.radius + range_;
    list_[count_] = {&a, &b};
    count_ += dx * dx + dz * dz <= reach * reach;
  }

 private:
  std::vector<Pair>& list_;
  std::size_t count_;
  Period period_;
  double range_;
};

void ContactDetection::weigh(std::size_t from, const DetectionInput& input) {
  weighed_.resize(looked_at_.size());
  loops_.each(looked_at_.size() - from, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = from + begin; p < from + end; ++p) {
      const bool in_order = looked_at_[p].a->body < looked_at_[p].b->body;
      const NearGrain& a = in_order ? *looked_at_[p].a : *looked_at_[p].b;
      const NearGrain& b = in_order ? *looked_at_[p].b : *looked_at_[p].a;
      Weighed& w = weighed_[p];
      w.pair = {a.body, b.body, 0, 0, 0, 0, 0};
      w.pair.gap =
          normal_of(input.period.nearest(a.x - b.x), a.z - b.z, w.pair.n_x, w.pair.n_z) - a.radius - b.radius;
      const double approach = -(w.pair.n_x * (a.v_x - b.v_x) + w.pair.n_z * (a.v_z - b.v_z));
      w.reach = 2 * input.time_step * std::max(0.0, approach);
    }
  });
  for (const Weighed& w : std::span(weighed_).subspan(from)) {
    const double jolt = w.pair.gap < input.margin + w.reach ? w.reach : 0;
    jolt_[w.pair.i] = std::max(jolt_[w.pair.i], jolt);
    jolt_[w.pair.j] = std::max(jolt_[w.pair.j], jolt);
  }
}

void ContactDetection::keep_near_pairs(const DetectionInput& input) {
  candidates_.resize(weighed_.size());
  std::size_t kept = 0;
  for (const Weighed& w : weighed_) {
    const double jolt = jolt_[w.pair.i] + (w.pair.j >= 0 ? jolt_[w.pair.j] : 0);
    candidates_[kept] = w.pair;
    kept += w.pair.gap < input.margin + w.reach + jolt / 2;
  }
  candidates_.resize(kept);
}

void ContactDetection::look_at_wall(const NearGrain& grain, std::int32_t shape, double farthest,
                                    const DetectionInput& input) {
  Candidate pair{grain.body, -1 - shape, 0, 0, 0, 0, 0};
  Point point;
  pair.gap = gap_to_shape(input.shapes[shape], image_near(input.shapes[shape], grain.x, input.period),
                          grain.z, grain.radius, pair.n_x, pair.n_z, point);
  if (pair.gap > farthest) return;
  const Point then = moved(input.shape_steps[shape], point);
  pair.wall_v_x = (then.x - point.x) / input.time_step;
  pair.wall_v_z = (then.z - point.z) / input.time_step;
  const double approach = -(pair.n_x * (grain.v_x - pair.wall_v_x) + pair.n_z * (grain.v_z - pair.wall_v_z));
  const double reach = 2 * input.time_step * std::max(0.0, approach);
  if (pair.gap < input.margin + reach) jolt_[pair.i] = std::max(jolt_[pair.i], reach);
  weighed_.push_back({pair, reach});
}

void ContactDetection::find_near_walls(double fastest, double largest, const DetectionInput& input) {
  for (std::size_t s = 0; s < input.shapes.size(); ++s) {
    const double farthest =
        input.margin + 2 * (fastest + largest_move(input.shapes[s], input.shape_steps[s]));
    const auto near_shape = [&](const NearGrain& grain) {
      look_at_wall(grain, static_cast<std::int32_t>(s), farthest, input);
    };
    if (const auto box = surroundings(input.shapes[s], largest / 2 + farthest)) {
      grids_.near(box->x_low, box->x_high, box->z_low, box->z_high, near_shape);
    } else {
      const double everywhere = std::numeric_limits<double>::infinity();
      grids_.near(-everywhere, everywhere, -everywhere, everywhere, near_shape);
    }
  }
}

void ContactDetection::find_near_fast_grains(const Bodies& bodies, std::span<const double> v_x,
                                             std::span<const double> v_z, const DetectionInput& input,
                                             double looked_at, double fastest, double largest) {
  const auto look_around = [&](const NearGrain& grain, double range) {
    const double reach = largest + range;
    Looking look(looked_at_, input.period, range);
    grids_.near(grain.x - reach, grain.x + reach, grain.z - reach, grain.z + reach,
                [&](const NearGrain& other) {
                  if (other.body != grain.body) look(grain, other);
                });
  };
  const std::size_t slow_pairs = looked_at_.size();
  const double fast_range = input.margin + 4 * fastest;
  for (const NearGrain& grain : fast_) look_around(grain, fast_range);
  weigh(slow_pairs, input);
  // An impact pushes its grains on to others.
  const std::size_t pairs = looked_at_.size(), fast = fast_.size();
  for (std::size_t i = 0; i < bodies.count(); ++i)
    if (jolt_[i] > looked_at)
      fast_.push_back({input.period.first(bodies.x[i]), bodies.z[i], bodies.radius[i], v_x[i], v_z[i],
                       static_cast<std::int32_t>(i)});
  // Pairs refer to the entries of fast_, which may have moved.
  looked_at_.resize(slow_pairs);
  for (const NearGrain& grain : std::span(fast_).first(fast)) look_around(grain, fast_range);
  for (const NearGrain& grain : std::span(fast_).subspan(fast))
    look_around(grain, looked_at + jolt_[grain.body]);
  weigh(pairs, input);
}

std::vector<Candidate>& ContactDetection::find(const Bodies& bodies, std::span<const double> v_x,
                                               std::span<const double> v_z, const DetectionInput& input) {
  candidates_.clear();
  looked_at_.clear();
  fast_.clear();
  jolt_.assign(bodies.count(), 0.0);
  const auto count = static_cast<std::int32_t>(bodies.count());
  if (count == 0) return candidates_;
  double fastest = 0, slow = 0;
  for (std::int32_t b = 0; b < count; ++b) {
    const double moves = input.time_step * length(v_x[b], v_z[b]);
    fastest = std::max(fastest, moves);
    if (moves > fast_displacement)
      fast_.push_back({input.period.first(bodies.x[b]), bodies.z[b], bodies.radius[b], v_x[b], v_z[b], b});
    else
      slow = std::max(slow, moves);
  }
  const bool any_fast = !fast_.empty();
  const double largest = 2 * *std::max_element(bodies.radius.begin(), bodies.radius.end());
  // Two discs that move m each close at most 2 m within the step; the rule above keeps twice that.
  const double range = input.margin + 4 * slow;
  grids_.sort(bodies, v_x, v_z, range, input.period);
  {
    Looking look(looked_at_, input.period, range);
    grids_.each_pair([&look](const NearGrain& a, const NearGrain& b) { look(a, b); });
  }
  weigh(0, input);
  if (any_fast) find_near_fast_grains(bodies, v_x, v_z, input, range, fastest, largest);
  find_near_walls(fastest, largest, input);
  keep_near_pairs(input);
  if (any_fast) {  // a pair may have been found from both sides
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
    candidates_.erase(
        std::unique(candidates_.begin(), candidates_.end(),
                    [](const Candidate& a, const Candidate& b) { return a.i == b.i && a.j == b.j; }),
        candidates_.end());
  }
  return candidates_;
}

}  // namespace drumlin::particles

#include "particles/stepping/wall_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "particles/stepping/moving_arc.hpp"
#include "particles/stepping/wall_path.hpp"

namespace drumlin::particles {
namespace {

// Laid back from one wall a disc can stand beyond the next one of a corner.
constexpr int most_walls = 8;

/// A segment over a step, in the axes that it has at the beginning.
class MovingSegment {
 public:
  MovingSegment(const WallStep& walls, std::size_t shape)
      : was_(std::get<Segment>(walls.before[shape])),
        step_(walls.displacement[shape]),
        there_(step_),
        back_(inverse(step_)),
        e_(was_.to - was_.from),
        length_(std::hypot(e_.x, e_.z)),
        middle_(middle_of(was_).x) {}

  /// The path from `start` to `end` if it crosses the segment.
  std::optional<WallPath> crossing(Point start, Point end, const Period& period) const {
    return crossing_of_images(middle_, start, end, period,
                              [&](double image) { return crossing_of(start, end, image); });
  }

  /// The disc of a path laid onto the side that it came from.
  Point put_back(const WallPath& path, double radius) const {
    const Point place = there_.moved(point_at({path.to.along, std::copysign(radius, path.from.across)}));
    return {place.x - path.image, place.z};
  }

  /// A point that moves with the segment.
  Point carried(Point p) const { return there_.moved(p); }

  /// How far the segment moves across itself where a path begins.
  double move_across(const WallPath& path) const {
    const Point p = point_at(path.from);
    return std::abs(across(e_, there_.moved(p) - p)) / length_;
  }

  bool meets(std::size_t grain) const { return step_.meets(static_cast<std::int32_t>(grain)); }

 private:
  std::optional<WallPath> crossing_of(Point start, Point end, double image) const {
    WallPath path{place_of({start.x + image, start.z}), place_of(back_.moved({end.x + image, end.z})), image,
                  0};
    if (!(path.from.across * path.to.across < 0)) return std::nullopt;
    path.share = path.from.across / (path.from.across - path.to.across);
    const double along = path.from.along + (path.to.along - path.from.along) * path.share;
    if (along < -end_margin || along > 1 + end_margin) return std::nullopt;
    return path;
  }
  WallPosition place_of(Point p) const {
    const Point d = p - was_.from;
    return {dot(d, e_) / (length_ * length_), across(d, e_) / length_};
  }
  Point point_at(const WallPosition& at) const {
    return was_.from + at.along * e_ + at.across / length_ * Point{-e_.z, e_.x};
  }

  Segment was_;
  ShapeStep step_;
  Rigid there_, back_;
  Point e_;
  double length_, middle_;
};

/// A thin wall over a step.
using MovingWall = std::variant<MovingSegment, MovingArc>;

/// Of a disc that the wall meets.
std::optional<WallPath> crossing(const MovingWall& wall, std::size_t b, Point start, Point end,
                                 const Period& period) {
  return std::visit([&](const auto& w) { return w.meets(b) ? w.crossing(start, end, period) : std::nullopt; },
                    wall);
}

MovingWall moving_wall(const WallStep& walls, std::size_t shape) {
  if (std::holds_alternative<Segment>(walls.before[shape])) return MovingSegment(walls, shape);
  return MovingArc(walls, shape);
}

/// Where discs end a step that may have crossed a thin wall, if none has moved further than `furthest` along
/// an axis.
Reaches ends_of_paths(const WallStep& walls, std::size_t shape, const Period& period, double furthest) {
  const Reaches was = *reaches_of(walls.before[shape]), is = *reaches_of(walls.after[shape]);
  const ShapeStep& step = walls.displacement[shape];
  // Straight seen from a wall that turns is bent by at most a quarter of its angle on the relative path.
  const double bend =
      step.angle == 0 ? 0
                      : std::abs(step.angle) / 4 * (2 * furthest + largest_move(walls.before[shape], step));
  const double reach = furthest + bend, anywhere = std::numeric_limits<double>::infinity();
  return {period.open() ? std::min(was.x_low, is.x_low) - reach : -anywhere,
          period.open() ? std::max(was.x_high, is.x_high) + reach : anywhere,
          std::min(was.z_low, is.z_low) - reach, std::max(was.z_high, is.z_high) + reach};
}

/// The wall that a disc meets first on its path, with that path.
struct FirstCrossing {
  MovingWall wall;
  WallPath path;
};
std::optional<FirstCrossing> first_crossing(const WallStep& walls, std::span<const std::size_t> shapes,
                                            std::size_t b, Point start, Point end, const Period& period) {
  std::optional<FirstCrossing> first;
  for (const std::size_t shape : shapes) {
    const MovingWall wall = moving_wall(walls, shape);
    if (const auto path = crossing(wall, b, start, end, period))
      if (!first || path->share < first->path.share) first.emplace(FirstCrossing{wall, *path});
  }
  return first;
}

/// Lays disc b, whose centre stands outside of a container, back into it if it began the step inside and has
/// not moved further than the largest disc's radius: pressed out by a larger one, not flown out of a solve
/// that is worth nothing.
void put_inside(const Container& was, const Container& is, const Period& period, Point start, std::size_t b,
                double largest, Bodies& bodies, Crossings& crossings) {
  if (std::hypot(bodies.x[b] - start.x, bodies.z[b] - start.z) > largest ||
      std::hypot(period.nearest(start.x - was.center.x), start.z - was.center.z) > was.radius)
    return;
  const double x = period.nearest(bodies.x[b] - is.center.x), z = bodies.z[b] - is.center.z;
  const double distance = std::hypot(x, z), radius = bodies.radius[b];
  const double change = (is.radius - radius) / distance - 1;
  crossings.deepest = std::max(crossings.deepest, distance - is.radius + radius);
  bodies.x[b] += change * x, bodies.z[b] += change * z;
}

/// Some discs, of several pieces one after the other.
struct Discs {
  std::vector<std::size_t> list;
  void add(const Discs& more) { list.insert(list.end(), more.list.begin(), more.list.end()); }
};

/// Thin walls and discs that may have crossed them; how many boxes were looked at for it.
struct NearWalls {
  std::vector<std::pair<std::size_t, std::size_t>> list;
  std::int64_t looked_at = 0;
  void add(const NearWalls& more) {
    list.insert(list.end(), more.list.begin(), more.list.end());
    looked_at += more.looked_at;
  }
};

}  // namespace

void WallCrossings::begin(const Bodies& bodies, std::span<const Shape> shapes,
                          std::optional<double> largest) {
  largest_ = largest;
  thin_.clear(), containers_.clear();
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    if (std::holds_alternative<Segment>(shapes[s]) || std::holds_alternative<Arc>(shapes[s]))
      thin_.push_back(s);
    if (std::holds_alternative<Container>(shapes[s])) containers_.push_back(s);
  }
  if (thin_.empty() && containers_.empty()) return;
  x_.resize(bodies.count()), z_.resize(bodies.count());
  loops_.each(bodies.count(), [&](std::size_t first, std::size_t end) {
    std::copy(bodies.x.begin() + first, bodies.x.begin() + end, x_.begin() + first);
    std::copy(bodies.z.begin() + first, bodies.z.begin() + end, z_.begin() + first);
  });
}

Crossings WallCrossings::undo(const WallStep& walls, const Period& period, Bodies& bodies) {
  Crossings crossings;
  undo_at_containers(walls, period, bodies, crossings);
  if (thin_.empty()) return crossings;
  undo_at_thin_walls(walls, period, bodies, crossings);
  undo_at_containers(walls, period, bodies, crossings);
  return crossings;
}

void WallCrossings::undo_at_containers(const WallStep& walls, const Period& period, Bodies& bodies,
                                       Crossings& crossings) const {
  for (const std::size_t shape : containers_) {
    const auto& was = std::get<Container>(walls.before[shape]);
    const auto& is = std::get<Container>(walls.after[shape]);
    const auto outside = loops_.combined<Discs>(bodies.count(), [&](std::size_t begin, std::size_t end) {
      Discs some;
      const double *x = bodies.x.data(), *z = bodies.z.data();
      const double squared = is.radius * is.radius;
      for (std::size_t b = begin; b < end; ++b) {
        const double d_x = period.nearest(x[b] - is.center.x), d_z = z[b] - is.center.z;
        if (d_x * d_x + d_z * d_z > squared) some.list.push_back(b);
      }
      return some;
    });
    if (outside.list.empty()) continue;
    const double largest = largest_.value_or(*std::max_element(bodies.radius.begin(), bodies.radius.end()));
    for (const std::size_t b : outside.list)
      if (walls.displacement[shape].meets(static_cast<std::int32_t>(b)))
        put_inside(was, is, period, {x_[b], z_[b]}, b, largest, bodies, crossings);
  }
}

void WallCrossings::undo_at_thin_walls(const WallStep& walls, const Period& period, Bodies& bodies,
                                       Crossings& crossings) {
  furthest_ = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b)
    furthest_ = std::max({furthest_, std::abs(bodies.x[b] - x_[b]), std::abs(bodies.z[b] - z_[b])});
  boxes_.clear();
  for (const std::size_t shape : thin_) boxes_.push_back(ends_of_paths(walls, shape, period, furthest_));
  tree_.plant(boxes_);
  auto near = loops_.combined<NearWalls>(bodies.count(), [&](std::size_t begin, std::size_t end) {
    NearWalls some;
    for (std::size_t b = begin; b < end; ++b)
      some.looked_at += tree_.each_near(position(bodies, b), 0,
                                        [&](std::size_t k) { some.list.emplace_back(thin_[k], b); });
    return some;
  });
  looked_at_ = near.looked_at;
  std::sort(near.list.begin(), near.list.end());
  crossed_.clear();
  std::optional<MovingWall> wall;
  for (std::size_t k = 0; k < near.list.size(); ++k) {
    const auto [shape, b] = near.list[k];
    if (k == 0 || shape != near.list[k - 1].first) wall.emplace(moving_wall(walls, shape));
    if (crossing(*wall, b, {x_[b], z_[b]}, position(bodies, b), period)) crossed_.push_back(b);
  }
  std::sort(crossed_.begin(), crossed_.end());
  crossed_.erase(std::unique(crossed_.begin(), crossed_.end()), crossed_.end());
  for (const std::size_t b : crossed_) put_back(walls, period, b, bodies, crossings);
}

void WallCrossings::put_back(const WallStep& walls, const Period& period, std::size_t b, Bodies& bodies,
                             Crossings& crossings) const {
  const Point start{x_[b], z_[b]};
  const auto lose = [&](LostGrain::How how) {
    if (!crossings.lost) crossings.lost = LostGrain{static_cast<int>(b), bodies.x[b], bodies.z[b], how};
  };
  const double radius = bodies.radius[b];
  for (int attempt = 0;; ++attempt) {
    const Point end = position(bodies, b);
    // Laid back, it may be further from its start than any was: the path, and its bend, are longer.
    const double longer = std::max(std::abs(end.x - start.x), std::abs(end.z - start.z)) - furthest_;
    std::vector<std::size_t> shapes;
    tree_.each_near(end, 2 * std::max(0.0, longer), [&](std::size_t k) { shapes.push_back(thin_[k]); });
    std::sort(shapes.begin(), shapes.end());
    const auto first = first_crossing(walls, shapes, b, start, end, period);
    if (!first) return;
    const auto& [wall, path] = *first;
    crossings.deepest = std::max(crossings.deepest, radius + std::abs(path.to.across));
    const auto of_wall = [&wall = wall](auto act) { return std::visit(act, wall); };
    if (of_wall([&path = path](const auto& w) { return w.move_across(path); }) > radius)
      return lose(LostGrain::How::pushed_too_far);
    if (attempt > most_walls) return lose(LostGrain::How::went_through_wall);
    // Where walls leave no room for it, it keeps its position beside one of them.
    const Point place = of_wall([&, &path = path](const auto& w) {
      return attempt < most_walls ? w.put_back(path, radius) : w.carried(start);
    });
    bodies.x[b] = place.x, bodies.z[b] = place.z;
  }
}

}  // namespace drumlin::particles

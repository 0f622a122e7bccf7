#include "particles/detection/contact_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "particles/bodies/arc.hpp"
#include "particles/detection/open_gaps.hpp"

namespace drumlin::particles {
namespace {

double length(double x, double z) { return std::sqrt(x * x + z * z); }

/// An end of a thin wall, the unit direction from there along the wall, and that in which another goes on.
struct ThinEnd {
  Point place, along, beyond;
};

/// Gap and normal of a disc against a straight line through a point.
double gap_to_line(const Point& along, double dx, double dz, double radius, double& n_x, double& n_z) {
  const double across = along.x * dz - along.z * dx, side = std::copysign(1.0, across);
  n_x = -side * along.z, n_z = side * along.x;
  return std::abs(across) - radius;
}

/// Gap and normal of a disc whose centre is nearest to an end. Where its centre is beside the wall that goes
/// on, the end is no corner: within a concave joint, between the two walls, this wall counts as its line; at
/// a flat or convex one the other wall is nearer.
double gap_to_end(const ThinEnd& end, double x, double z, double radius, double& n_x, double& n_z,
                  BesideNext beside_next) {
  const double dx = x - end.place.x, dz = z - end.place.z;
  const double gap = normal_of(dx, dz, n_x, n_z) - radius;
  if (!(dx * end.beyond.x + dz * end.beyond.z > 0)) return gap;
  constexpr double flat = 1e-9;
  const double side = std::copysign(1.0, end.along.x * dz - end.along.z * dx);
  const bool concave = side * (end.along.x * end.beyond.z - end.along.z * end.beyond.x) > flat;
  if (concave && side * (dx * end.beyond.z - dz * end.beyond.x) > 0)
    return gap_to_line(end.along, dx, dz, radius, n_x, n_z);
  if (beside_next == BesideNext::infinite) return std::numeric_limits<double>::infinity();
  return gap_to_line(end.beyond, dx, dz, radius, n_x, n_z);
}

double gap_to_segment(const Segment& s, double x, double z, double radius, double& n_x, double& n_z,
                      Point& point, BesideNext beside_next) {
  const double ex = s.to.x - s.from.x, ez = s.to.z - s.from.z, squared = ex * ex + ez * ez;
  const double along = ((x - s.from.x) * ex + (z - s.from.z) * ez) / squared;
  if (along < 0 || along > 1) {
    const bool first = along < 0;
    point = first ? s.from : s.to;
    const double unit = (first ? 1 : -1) / std::sqrt(squared);
    return gap_to_end({point, {unit * ex, unit * ez}, first ? s.beyond_from : s.beyond_to}, x, z, radius, n_x,
                      n_z, beside_next);
  }
  point = {s.from.x + along * ex, s.from.z + along * ez};
  return normal_of(x - point.x, z - point.z, n_x, n_z) - radius;
}

/// Where the centres of discs near a shape can be, `reach` away from its surface; a container has discs
/// everywhere.
std::optional<Reaches> surroundings(const Shape& shape, double reach) {
  std::optional<Reaches> r = reaches_of(shape);
  if (r) r = {r->x_low - reach, r->x_high + reach, r->z_low - reach, r->z_high + reach};
  return r;
}

/// The image of x that is nearest to the middle of a shape. A wall as long as the period meets every grain
/// once.
double image_near(const Shape& shape, double x, const Period& period) {
  if (period.open()) return x;
  const double middle = middle_of(shape).x;
  return middle + period.nearest(x - middle);
}

/// What a search must know of all grains.
struct GrainMotion {
  double fastest = 0;  // displacement within the step
  double speeds = 0;   // bound on the relative speed of any two
  double largest = 0;  // diameter
  double smallest = 0;
};

/// Extremes of some grains.
struct MotionExtremes {
  static constexpr double most = std::numeric_limits<double>::infinity();
  double fastest = 0, largest = 0, smallest = most;  // squared speed, radii
  double x_low = most, x_high = -most, z_low = most, z_high = -most;

  void add(double v_x, double v_z, double radius) {
    fastest = std::max(fastest, v_x * v_x + v_z * v_z);
    x_low = std::min(x_low, v_x), x_high = std::max(x_high, v_x);
    z_low = std::min(z_low, v_z), z_high = std::max(z_high, v_z);
    largest = std::max(largest, radius), smallest = std::min(smallest, radius);
  }
  void add(const MotionExtremes& more) {
    fastest = std::max(fastest, more.fastest);
    x_low = std::min(x_low, more.x_low), x_high = std::max(x_high, more.x_high);
    z_low = std::min(z_low, more.z_low), z_high = std::max(z_high, more.z_high);
    largest = std::max(largest, more.largest), smallest = std::min(smallest, more.smallest);
  }
};

GrainMotion motion_of(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z,
                      const DetectionInput& input, const ParallelLoops& loops) {
  const auto all = loops.combined<MotionExtremes>(bodies.count(), [&](std::size_t begin, std::size_t end) {
    MotionExtremes some;
    for (std::size_t b = begin; b < end; ++b) some.add(v_x[b], v_z[b], bodies.radius[b]);
    return some;
  });
  const Period& cell = input.period;
  double images = 0;  // and one that images add
  if (cell.moves())
    images = std::abs(cell.rate_x) * 2 * cell.length +
             (std::abs(cell.rate_z) + std::abs(cell.shear)) * cell.length_z;
  return {input.time_step * std::sqrt(all.fastest),
          length(all.x_high - all.x_low, all.z_high - all.z_low) + images, 2 * all.largest, 2 * all.smallest};
}

// Of the smallest diameter: pairs within are listed, and within as much more if the list is to be used again.
// No wider, or grains have many more neighbours: the second shell of a dense packing begins at 0.73.
constexpr double widest = 0.25, thrown = 0.15;
// A list is made anew when a search had to measure more distances of other pairs than this, for each grain,
// or when a grain has moved further than this along x or z, in the smallest diameter.
constexpr double most_far = 1, farthest_drift = 1;
// After a list that could not be used again so many are made to be used once.
constexpr int lists_used_once = 30;

/// Gap up to which pairs are listed: all that any pair may close, but at most `widest`; pairs beyond are
/// found by their speeds. At least `thrown`: what contacts throw together is looked for in the list.
double listed_range(const GrainMotion& motion, const DetectionInput& input) {
  const double closing = 2 * input.time_step * motion.speeds;
  return input.margin + std::clamp(closing, thrown * motion.smallest, widest * motion.smallest);
}

/// Edge of the cells of the finest of the grids that list pairs up to a range.
double finest_cell(const GrainMotion& motion, double range) {
  const bool alike = 2 * motion.smallest > motion.largest;
  const double size = std::max(motion.smallest, std::min(range, motion.largest));
  const int level = alike ? 0 : std::ilogb(motion.largest / size);
  return motion.largest / std::exp2(level) + range;
}

}  // namespace

double gap_to_shape(const Shape& shape, double x, double z, double radius, double& n_x, double& n_z,
                    Point& point, BesideNext beside_next) {
  if (const auto* c = std::get_if<Container>(&shape)) {
    const double distance = normal_of(c->center.x - x, c->center.z - z, n_x, n_z);
    point = {c->center.x - c->radius * n_x, c->center.z - c->radius * n_z};
    return c->radius - radius - distance;
  }
  if (const auto* s = std::get_if<Segment>(&shape))
    return gap_to_segment(*s, x, z, radius, n_x, n_z, point, beside_next);
  if (const auto* a = std::get_if<Arc>(&shape)) {
    point = nearest_on(*a, {x, z});
    if (nearest_is_end(*a, {x, z}))
      return gap_to_end({point, tangent_at_end(*a), a->beyond}, x, z, radius, n_x, n_z, beside_next);
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
  const Point d =
      period.nearest(Point{bodies.x[pair.i] - bodies.x[pair.j], bodies.z[pair.i] - bodies.z[pair.j]});
  return normal_of(d.x, d.z, n_x, n_z) - bodies.radius[pair.i] - bodies.radius[pair.j];
}

namespace {

/// Whether a grain is so deep in a container that its wall is beyond `farthest`, by its square: no root.
bool deep_inside(const Shape& shape, const NearGrain& grain, double farthest) {
  const auto* container = std::get_if<Container>(&shape);
  if (container == nullptr) return false;
  const double within = (container->radius - grain.radius - farthest) * (1 - 1e-12);
  const double dx = grain.x - container->center.x, dz = grain.z - container->center.z;
  return within > 0 && dx * dx + dz * dz < within * within;
}

}  // namespace

void ContactDetection::weigh_at_wall(const NearGrain& grain, std::int32_t shape, double farthest,
                                     const DetectionInput& input) {
  Candidate pair{grain.body, -1 - shape, 0, 0, 0, 0, 0};
  Point point;
  pair.gap = gap_to_shape(input.shapes[shape], image_near(input.shapes[shape], grain.x, input.period),
                          grain.z, grain.radius, pair.n_x, pair.n_z, point);
  if (pair.gap > farthest || !input.shape_steps[shape].meets(grain.body)) return;
  const Point then = moved(input.shape_steps[shape], input.shapes[shape], point, {pair.n_x, pair.n_z});
  pair.wall_v_x = (then.x - point.x) / input.time_step;
  pair.wall_v_z = (then.z - point.z) / input.time_step;
  const double approach = -(pair.n_x * (grain.v_x - pair.wall_v_x) + pair.n_z * (grain.v_z - pair.wall_v_z));
  const double reach = 2 * input.time_step * std::max(0.0, approach);
  if (pair.gap < input.margin + reach) bounds_[pair.i] = std::max(bounds_[pair.i], reach);
  weighed_.push_back({pair, reach});
}

void ContactDetection::find_near_walls(double fastest, double largest, const DetectionInput& input) {
  for (std::size_t s = 0; s < input.shapes.size(); ++s) {
    if (is_open(input.shapes[s])) continue;
    const double farthest =
        input.margin + 2 * (fastest + largest_move(input.shapes[s], input.shape_steps[s]));
    const bool open = input.period.open();
    const auto near_shape = [&](const NearGrain& grain) {
      if (open && deep_inside(input.shapes[s], grain, farthest)) return;
      weigh_at_wall(grain, static_cast<std::int32_t>(s), farthest, input);
    };
    if (const auto box = surroundings(input.shapes[s], largest / 2 + farthest)) {
      grids_.near(box->x_low, box->x_high, box->z_low, box->z_high, near_shape);
    } else {
      const double everywhere = std::numeric_limits<double>::infinity();
      grids_.near(-everywhere, everywhere, -everywhere, everywhere, near_shape);
    }
  }
}

/// Makes the list of near pairs fit the state: the old one if it is good, else a new one.
void ContactDetection::list_pairs(const SearchedState& state, const PairRule& rule, double range,
                                  double smallest) {
  if (lists_.good && grids_.follow(state, farthest_drift * smallest, loops_)) {
    pairs_.weigh_again(state, rule);
    ++lists_.used_again;
    return;
  }
  if (lists_.skin > 0 && lists_.used_again == 0) lists_.once = lists_used_once;
  lists_.skin = lists_.once > 0 || !state.period.open() ? 0 : widest * smallest;
  lists_.once = std::max(0, lists_.once - 1);
  lists_.used_again = 0;
  grids_.sort(state, range + lists_.skin);
  pairs_.list(grids_, state, range + lists_.skin, rule);
}

std::span<const Candidate> ContactDetection::find(const Bodies& bodies, std::span<const double> v_x,
                                                  std::span<const double> v_z, const DetectionInput& input) {
  if (bodies.count() == 0) {
    candidates_.resize_uninitialized(0);
    return candidates();
  }
  weighed_.clear();
  bounds_.assign(bodies.count(), 0.0);
  const GrainMotion motion = motion_of(bodies, v_x, v_z, input, loops_);
  const PairRule rule{input.time_step, input.margin, motion.speeds, input.period};
  const double range = listed_range(motion, input);
  listed_within_ = input.margin + thrown * motion.smallest;
  cell_ = finest_cell(motion, range);
  list_pairs({bodies, v_x, v_z, input.period}, rule, range, motion.smallest);
  pairs_.find_closing(rule, bounds_);
  find_near_walls(motion.fastest, motion.largest, input);
  pairs_.find_by_bounds(rule, bounds_);
  pairs_.keep(rule, bounds_, weighed_, candidates_);
  lists_.good = lists_.skin > 0 &&
                static_cast<double>(pairs_.far_distances()) < most_far * static_cast<double>(bodies.count());
  if (input.period.moves()) add_image_velocities(bodies, input.period, candidates_);
  return candidates();
}

bool ContactDetection::is_local(std::span<const CollidedDisc> collided, double reach) const {
  const double cells = 2 * reach / cell_ + 2;  // that a disc's search reads, along x and z
  return static_cast<double>(collided.size()) * cells * cells < static_cast<double>(bounds_.size());
}

bool ContactDetection::find_around(std::span<const CollidedDisc> collided, const Bodies& bodies,
                                   std::span<const double> v_x, std::span<const double> v_z,
                                   const DetectionInput& input) {
  added_.clear(), found_.clear(), weighed_.clear();
  if (collided.empty()) return false;
  for (const CollidedDisc& disc : collided)
    bounds_[disc.grain] = std::max(bounds_[disc.grain], disc.displacement);
  const GrainMotion motion = motion_of(bodies, v_x, v_z, input, loops_);
  const double range = 2 * input.margin + 2 * input.time_step * motion.speeds +
                       1.5 * *std::max_element(bounds_.begin(), bounds_.end());
  if (!is_local(collided, range + motion.largest)) {
    const auto before = candidates();  // pairs that have met part now, and are far from each other still
    const std::vector<Candidate> found(before.begin(), before.end());
    find(bodies, v_x, v_z, input);
    found_ = found;
    insert_found();
    added_.clear();
    return true;
  }
  for (const CollidedDisc& disc : collided) add_around(disc, range, bodies, v_x, v_z, input);
  for (const WeighedPair& wall : weighed_)
    if (wall.pair.gap < input.margin + wall.reach + bounds_[wall.pair.i] / 2) found_.push_back(wall.pair);
  if (input.period.moves()) add_image_velocities(bodies, input.period, found_);
  return insert_found();
}

void ContactDetection::add_image_velocities(const Bodies& bodies, const Period& period,
                                            std::span<Candidate> pairs) {
  for (Candidate& pair : pairs) {
    if (pair.j < 0) continue;
    const Point whole{bodies.x[pair.i] - bodies.x[pair.j], bodies.z[pair.i] - bodies.z[pair.j]};
    const Point d = period.nearest(whole);
    const Point image = period.image_velocity({whole.x - d.x, whole.z - d.z});
    pair.wall_v_x = image.x, pair.wall_v_z = image.z;
  }
}

void ContactDetection::add_around(const CollidedDisc& disc, double range, const Bodies& bodies,
                                  std::span<const double> v_x, std::span<const double> v_z,
                                  const DetectionInput& input) {
  const std::int32_t i = disc.grain;
  const NearGrain a{bodies.x[i], bodies.z[i], bodies.radius[i], v_x[i], v_z[i], i};
  const double reach = range + a.radius + grids_.largest() / 2;
  grids_.near({a.x, a.z}, reach, [&](const NearGrain& other) {
    if (other.body == i) return;
    NearGrain b = other;
    b.v_x = v_x[b.body], b.v_z = v_z[b.body];
    const NearPair pair = near_pair(a, b, input.period, input.time_step);
    if (pair.gap < 2 * input.margin + pair.reach + disc.displacement / 2 + bounds_[b.body])
      found_.push_back({pair.i, pair.j, pair.gap, pair.n_x, pair.n_z, 0, 0});
  });
  const auto shapes = static_cast<std::int32_t>(input.shapes.size());
  for (std::int32_t s = 0; s < shapes; ++s)
    if (!is_open(input.shapes[s])) weigh_at_wall(a, s, std::numeric_limits<double>::infinity(), input);
}

/// Puts the pairs found in the order of (i, j) among the candidates, once each; returns whether any is new.
bool ContactDetection::insert_found() {
  const auto before = [](const Candidate& a, const Candidate& b) {
    return a.i != b.i ? a.i < b.i : a.j < b.j;
  };
  std::sort(found_.begin(), found_.end(), before);
  const auto same = [](const Candidate& a, const Candidate& b) { return a.i == b.i && a.j == b.j; };
  found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
  std::erase_if(found_, [&](const Candidate& pair) {
    return std::binary_search(candidates_.begin(), candidates_.end(), pair, before);
  });
  added_.resize(found_.size());
  open_gaps(candidates_, found_.size(), [&](std::size_t k, std::size_t end) {
    const auto place = std::lower_bound(candidates_.begin(), candidates_.begin() + end, found_[k], before);
    added_[k] = static_cast<std::int32_t>(place - candidates_.begin() + k);
    return added_[k];
  });
  for (std::size_t k = 0; k < found_.size(); ++k) candidates_[added_[k]] = found_[k];
  return !found_.empty();
}

}  // namespace drumlin::particles

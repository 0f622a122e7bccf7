#include "particles/stepping/wall_crossing.hpp"

#include <cmath>

namespace drumlin::particles {
namespace {

/// A point in the axes of a segment: distance along it from its beginning, in lengths, and across.
struct Place {
  double along = 0, across = 0;
};
Place place_at(const Segment& s, double x, double z) {
  const double e_x = s.to.x - s.from.x, e_z = s.to.z - s.from.z, length = std::hypot(e_x, e_z);
  const double d_x = x - s.from.x, d_z = z - s.from.z;
  return {(d_x * e_x + d_z * e_z) / (length * length), (e_x * d_z - e_z * d_x) / length};
}

}  // namespace

double undo_crossing(const Shape& before, const Shape& after, const Period& period, double time_step,
                     Bodies& bodies, std::size_t b) {
  const auto* was = std::get_if<Segment>(&before);
  if (!was) return 0;
  const auto& is = std::get<Segment>(after);
  const double middle = (is.from.x + is.to.x) / 2;
  const double x = middle + period.nearest(bodies.x[b] - middle), z = bodies.z[b];
  const Place from = place_at(*was, x - time_step * bodies.v_x[b], z - time_step * bodies.v_z[b]);
  const Place to = place_at(is, x, z);
  if (from.across * to.across >= 0) return 0;
  const double crossed = from.along + (to.along - from.along) * from.across / (from.across - to.across);
  if (crossed < 0 || crossed > 1) return 0;
  const double radius = bodies.radius[b], depth = radius + std::abs(to.across);
  const double e_x = is.to.x - is.from.x, e_z = is.to.z - is.from.z, length = std::hypot(e_x, e_z);
  const double back = std::copysign(depth, from.across);
  bodies.x[b] -= back * e_z / length;
  bodies.z[b] += back * e_x / length;
  return depth;
}

}  // namespace drumlin::particles

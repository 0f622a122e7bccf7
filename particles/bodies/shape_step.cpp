#include "particles/bodies/shape_step.hpp"

namespace drumlin::particles {
namespace {

/// Whether a surface runs along the tangent (n_z, -n_x), 1, or against it, -1.
double sense(const Shape& shape, Point touched, Point normal) {
  if (const auto* s = std::get_if<Segment>(&shape))
    return (s->to.x - s->from.x) * normal.z - (s->to.z - s->from.z) * normal.x < 0 ? -1 : 1;
  const auto* arc = std::get_if<Arc>(&shape);
  const Point center = arc ? arc->center : middle_of(shape);
  return (touched.x - center.x) * normal.x + (touched.z - center.z) * normal.z < 0 ? -1 : 1;
}

}  // namespace

Point moved(const ShapeStep& step, const Shape& shape, Point touched, Point normal) {
  const Point then = moved(static_cast<const Pose&>(step), touched);
  if (step.surface == 0) return then;
  const double along = sense(shape, touched, normal) * step.surface;
  return {then.x + along * normal.z, then.z - along * normal.x};
}

}  // namespace drumlin::particles

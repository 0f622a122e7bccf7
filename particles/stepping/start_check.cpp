#include "particles/stepping/start_check.hpp"

#include <algorithm>
#include <vector>

#include "particles/detection/contact_list.hpp"

namespace drumlin::particles {

StartOverlaps overlaps_at_start(const Bodies& bodies, std::span<const Shape> shapes,
                                std::span<const ShapeStep> still, const Period& period) {
  // At rest, so that nothing but positions decides.
  const std::vector<double> rest(bodies.count(), 0.0);
  ContactDetection detection;
  StartOverlaps overlaps;
  for (const Candidate& pair : detection.find(bodies, rest, rest, {shapes, still, 1, 0, period})) {
    double smaller = bodies.radius[pair.i];
    if (pair.j >= 0) smaller = std::min(smaller, bodies.radius[pair.j]);
    const double depth = -pair.gap / (2 * smaller);
    if (depth > noticed_at_start) ++overlaps.pairs;
    if (depth > overlaps.depth) overlaps = {overlaps.pairs, pair.i, pair.j, depth};
  }
  return overlaps;
}

}  // namespace drumlin::particles

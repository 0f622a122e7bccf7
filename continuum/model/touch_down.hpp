#pragma once
// What becomes of a free surface that rolls over its contacts, thins to a film, or reaches another wall.
#include "continuum/model/outline.hpp"

namespace drumlin::continuum {

struct LaidDown {
  std::vector<Outline> outlines;  ///< pieces
  double passed = 0;              ///< area cut off beyond openings
};

/// A contact goes on along its wall, round corners too, where the first free side makes less than the angle
/// with the dry wall, or lies behind it; it goes back where the first free point stands less than 2 % of the
/// size above the wet wall; both with the area kept nearly. A free point that has come to a dry wall takes
/// the contact with it, without air between. What has passed an open opening is cut off there;
/// where the outline crosses itself, it is cut in pieces (`pieces_of`). Call with_area() afterwards. Throws
/// NotConvergedError, with the place, where more air than `largest_bubble` would be closed.
LaidDown laid_down(const Outline& outline, const Region& region, double time, const SizeField& size,
                   double angle_deg = 45);

}  // namespace drumlin::continuum

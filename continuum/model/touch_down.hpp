#pragma once
// What becomes of a free surface that rolls over its contacts, thins to a film, or reaches another wall.
#include "continuum/model/outline.hpp"

namespace drumlin::continuum {

struct LaidDown {
  Outline outline;
  double passed = 0;  ///< area cut off beyond openings
};

/// A contact goes on along its wall, round corners too, where the first free side makes less than the angle
/// with the dry wall, or lies behind it; it goes back where the first free point stands less than 2 % of the
/// size above the wet wall; both with the area kept nearly. A free point that has come to a dry wall takes
/// the contact with it, without air between. What has passed an open opening is cut off there. Call
/// with_area() afterwards. Throws NotConvergedError, with the place, where the outline then still crosses
/// itself, or where the material has come to a wall with more air between it and its contacts than 16 size^2
/// and 5 % of its area: surfaces that break or merge are not followed.
LaidDown laid_down(const Outline& outline, const Region& region, double time, const SizeField& size,
                   double angle_deg = 45);

}  // namespace drumlin::continuum

#pragma once
// Undoes passages of discs through walls: where a solve has failed a small disc, pressed by one a thousand
// times as heavy, its centre can end a step beyond a segment, which would then push it on and out.
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/detection/cell_grid.hpp"

namespace drumlin::particles {

/// If the centre of disc b has gone through a segment within the step, between the segment's ends, lays it
/// onto the side that it came from. Velocities stay. Returns how deep the disc was in the wall; 0 if it did
/// not cross.
double undo_crossing(const Shape& before, const Shape& after, const Period& period, double time_step,
                     Bodies& bodies, std::size_t b);

}  // namespace drumlin::particles

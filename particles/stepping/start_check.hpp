#pragma once
// Whether grains stand where a run can begin: no two in one place, none inside a wall.
#include <cstdint>
#include <span>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/shape_step.hpp"
#include "particles/detection/cell_grid.hpp"

namespace drumlin::particles {

/// Overlaps of a start with one another and with walls, in diameters of the smaller disc of a pair.
struct StartOverlaps {
  int pairs = 0;              ///< overlapping by more than noticed_at_start
  std::int32_t i = 0, j = 0;  ///< the deepest pair; j < 0: wall shape -1 - j
  double depth = 0;           ///< of the deepest pair; 1 and more: a disc is inside another, or beyond a wall
};

/// About what the position projection takes away within one step; less goes unseen.
constexpr double noticed_at_start = 1e-3;
/// A tenth of a diameter takes the projection some fifty steps; deeper ones are errors of the list, and the
/// contact forces that press them apart mean nothing.
constexpr double most_at_start = 0.1;

/// Looks at all pairs of a start. `still`: of the shapes, at rest.
StartOverlaps overlaps_at_start(const Bodies& bodies, std::span<const Shape> shapes,
                                std::span<const ShapeStep> still, const Period& period);

}  // namespace drumlin::particles

#pragma once
// The path of a disc over a step as a thin wall sees it.
#include <optional>

#include "particles/bodies/period.hpp"
#include "particles/bodies/vectors.hpp"

namespace drumlin::particles {

// A path through the point at which two walls meet misses neither by rounding. In lengths of a segment, and
// rad.
inline constexpr double end_margin = 1e-9;

/// A point in the axes of a wall: along it (of a segment from its beginning, in lengths; of an arc the angle
/// from the joint), and across, its side by the sign.
struct WallPosition {
  double along = 0, across = 0;
};

/// The path of a disc's centre over the step, in the axes that the wall has at the beginning.
struct WallPath {
  WallPosition from, to;
  double image = 0;  ///< added to x: the image of the disc that the wall meets
  double share = 0;  ///< of the path, where it first crosses the wall
};

/// crossing_of(image) for the image of a disc that meets a wall, `middle` its position in x. In a periodic
/// domain two may: the nearest at the start and at the end.
template <class CrossingOf>
std::optional<WallPath> crossing_of_images(double middle, Point start, Point end, const Period& period,
                                           CrossingOf crossing_of) {
  const auto image_of = [&](double x) { return period.open() ? 0 : middle + period.nearest(x - middle) - x; };
  const double first = image_of(start.x), second = image_of(end.x);
  if (const std::optional<WallPath> path = crossing_of(first)) return path;
  return second != first ? crossing_of(second) : std::nullopt;
}

}  // namespace drumlin::particles

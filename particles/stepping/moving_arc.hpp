#pragma once
// An arc over a step: which paths cross it, and where discs that did are laid back.
#include <optional>

#include "particles/bodies/arc.hpp"
#include "particles/bodies/period.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/wall_path.hpp"

namespace drumlin::particles {

class MovingArc {
 public:
  MovingArc(const WallStep& walls, std::size_t shape);

  /// The path from `start` to `end` if it ends on the other side of the arc: if it crosses it an odd number
  /// of times.
  std::optional<WallPath> crossing(Point start, Point end, const Period& period) const;
  /// The disc of a path laid onto the side that it came from.
  Point put_back(const WallPath& path, double radius) const;
  /// A point that moves with the arc.
  Point carried(Point p) const { return there_.moved(p); }
  /// How far the arc moves across itself where a path begins.
  double move_across(const WallPath& path) const;

  bool meets(std::size_t grain) const { return step_.meets(static_cast<std::int32_t>(grain)); }

 private:
  std::optional<WallPath> crossing_of(Point start, Point end, double image) const;
  WallPosition place_of(Point p) const;

  Arc was_;
  ShapeStep step_;
  Rigid there_, back_;
  double middle_;
};

}  // namespace drumlin::particles

#pragma once
// An arc over a step: which ways cross it, and where discs that did are laid back.
#include <optional>

#include "particles/bodies/arc.hpp"
#include "particles/bodies/period.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/wall_way.hpp"

namespace drumlin::particles {

class MovingArc {
 public:
  MovingArc(const WallStep& walls, std::size_t shape);

  /// The way from `start` to `end` if it ends on the other side of the arc: if it crosses it an odd number of
  /// times.
  std::optional<Way> crossing(Point start, Point end, const Period& period) const;
  /// The disc of a way laid onto the side that it came from.
  Point laid_back(const Way& way, double radius) const;
  /// A point that moves with the arc.
  Point carried(Point p) const { return there_.moved(p); }
  /// How far the arc moves across itself where a way begins.
  double move_across(const Way& way) const;

  /// Where it is over the step.
  Reaches reaches() const;
  /// Bound on how far one of its points moves.
  double furthest() const { return largest_move(was_, step_); }
  double turns_by() const { return step_.angle; }
  bool meets(std::size_t grain) const { return step_.meets(static_cast<std::int32_t>(grain)); }

 private:
  std::optional<Way> crossing_of(Point start, Point end, double image) const;
  Place place_of(Point p) const;

  Arc was_, is_;
  ShapeStep step_;
  Rigid there_, back_;
  double middle_;
};

}  // namespace drumlin::particles

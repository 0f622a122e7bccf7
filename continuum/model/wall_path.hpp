#pragma once
// The way along the parts of a region on which a contact of the material goes on.
#include "continuum/model/part_line.hpp"

namespace drumlin::continuum {

/// On the line of a part, from one s to another: backwards if to < from; beyond the length once round a
/// circle.
struct PathPiece {
  int part = 0;
  PartLine line;
  double from = 0, to = 0;
  double sense() const { return to < from ? -1 : 1; }
  double length() const { return sense() * (to - from); }
  /// Unit vector of the way `along` it.
  Vec2 direction(double along) const;
  Vec2 at(double along) const { return line.at(from + sense() * along); }
};

/// From a point of a part on: where parts meet, to within 1e-6 d at the end of one of them, the way turns to
/// the one that lies farthest on the side of the material, onto openings first. It ends at the points of
/// `stops`, at the end of an open opening, and where no part goes on. `sense`: along the part or back;
/// `hand`: the material lies on the left of the way (1) or on its right (-1).
std::vector<PathPiece> path_from(const Region& region, double time, int part, Vec2 point, double sense,
                                 double hand, const std::vector<Vec2>& stops);

}  // namespace drumlin::continuum

#pragma once
// A cell that is periodic in x and z, as snapshots tell it: its period at one instant, and the path of a
// grain from one snapshot to the next, which may cross its borders.
#include <optional>

#include "particles/bodies/period.hpp"
#include "particles/bodies/snapshot.hpp"

namespace drumlin::particles {

/// The period of a snapshot with a cell; open without one.
Period period_of(const Snapshot&);

/// A grain at one instant, laboratory.
struct MovingPoint {
  Point at, velocity;
};
MovingPoint grain_of(const Snapshot&, std::size_t grain);
/// Its image in the first period.
MovingPoint first_image(const Period&, MovingPoint grain);

/// What is needed of a snapshot with a cell to follow its grains.
struct CellInstant {
  double time = 0;
  Period period;
  /// Grains stand in the cell, which they re-enter when they leave it. False where one stands outside: a cell
  /// at rest lets them go on.
  bool wrapped = false;
};
/// Nothing for a snapshot without a cell.
std::optional<CellInstant> cell_instant(const Snapshot&);

/// The motion of a cell and its grains between two snapshots.
class CellPath {
 public:
  CellPath(const CellInstant& before, const CellInstant& now);
  /// How a grain moved from `before` on, by `now` to the image that its velocities at both ends come nearest
  /// to.
  Point displacement(const MovingPoint& before, const MovingPoint& now) const;
  /// The cell half-way, with the origin of `now`.
  const Period& half_way() const { return half_way_; }
  /// What is added to the displacement of a grain for its image that half-way is displaced by `shift`.
  Point change(Point shift) const;

 private:
  double time_;
  bool wrapped_;
  Period now_, half_way_;
  double d_length_, d_height_, d_offset_;  // changes of the lattice vectors
};

}  // namespace drumlin::particles

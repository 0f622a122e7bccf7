#pragma once
// Stress, fabric and strain of one region of a run, snapshot by snapshot: how material responds that does not
// flow steadily (docs/formats/history.md).
#include <cstddef>
#include <optional>
#include <vector>

#include "coupling/core/results/plane_invariants.hpp"
#include "particles/bodies/cell_path.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/grain_bins.hpp"

namespace drumlin::particles {

/// Mean over a box, laboratory axes, at one instant, dimensionless.
struct RegionState {
  double time = 0;
  std::size_t grains = 0;   ///< with their centres in the box
  double nu = 0;            ///< area of these grains over that of the box
  double coordination = 0;  ///< loaded contacts per grain, those with walls included
  PlaneMatrix pressure;  ///< stress of contacts and of the motion, compression positive; NaN without contacts
  PlaneMatrix kinetic;   ///< the second part alone
  PlaneMatrix fabric;    ///< mean of n_a n_b over the contacts between grains: trace 1
  PlaneMatrix gradient;  ///< d v_a/d x_b since the snapshot before (xz: d_v_x_dz); NaN in the first one
  double strain = 0;     ///< shear strain since the first snapshot: sum of 2 |D| times the time between
};

/// The share of a straight line from (x, z) to (x + dx, z + dz) that lies in the box, 0 to 1.
double share_inside(const Rectangle& box, double x, double z, double dx, double dz);

/// The binning by one box (accumulate.hpp); of the images of a grain the one nearest to its middle, from
/// which places are counted. A box as wide as the period has no sides, one as high as the cell neither floor
/// nor top.
class BoxBinning {
 public:
  BoxBinning(const Rectangle& box, const Period& period);

  void each_part(const GrainSample<2>& grain, auto action) const {
    each_centre(grain,
                [&](std::size_t, double, const GrainSample<2>&) { action(std::size_t{0}, grain.area()); });
  }
  void each_centre(GrainSample<2> grain, auto action) const {
    const auto [at, velocity] =
        first_image(period_, {{grain.at[0], grain.at[1]}, {grain.velocity[0], grain.velocity[1]}});
    if (!open_.holds(at.x, at.z)) return;
    grain.at = place(at);
    grain.velocity = {velocity.x, velocity.z};
    action(std::size_t{0}, 1.0, grain);
  }
  void each_share(const HalfBranch<2>& branch, auto action) const {
    const Point at = period_.first({branch.at[0], branch.at[1]});
    action(std::size_t{0}, share_inside(open_, at.x, at.z, branch.toward[0], branch.toward[1]), branch);
  }
  /// Of the contacts of the grains with their centres in the box.
  void each_end(const HalfBranch<2>& branch, auto action) const {
    const Point at = period_.first({branch.at[0], branch.at[1]});
    if (open_.holds(at.x, at.z)) action(std::size_t{0}, 1.0, branch);
  }

  const Period& period() const { return period_; }
  bool holds(Point at) const { return open_.holds(at.x, at.z); }
  /// Counted from the middle of the box.
  Vector<2> place(Point at) const { return {at.x - middle_.x, at.z - middle_.z}; }

 private:
  Period period_;
  Rectangle open_;
  Point middle_;
};

/// Affine part of the motion from one snapshot to the next of the grains that are in the box half-way: the
/// matrix of the least squares fit of displacement over the place half-way, divided by the time. The place
/// half-way makes the symmetric part of a rigid turn, however large, nought to rounding. Nothing with fewer
/// than four grains, or when the snapshots have not the same number of them.
std::optional<PlaneMatrix> mean_gradient(const Rectangle& box, const Snapshot& before, const Snapshot& now);

/// One state after the other; the snapshot before is kept for the displacements.
class RegionHistory {
 public:
  explicit RegionHistory(const Rectangle& box) : box_(box) {}
  /// Throws InputError where the box is wider than the period, or higher than the cell.
  const RegionState& add(const Snapshot& snapshot);

 private:
  Rectangle box_;
  std::optional<Snapshot> before_;
  RegionState state_;
};

}  // namespace drumlin::particles

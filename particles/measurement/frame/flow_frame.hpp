#pragma once
// The frame in which everything is measured: x downslope along the surface, z its outward normal, and how its
// slope is found (docs/theory/measurement.md).
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "coupling/core/files/scratch_file.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/unit_cells.hpp"

namespace drumlin::particles {

/// Orthonormal axes in the laboratory; x turned clockwise into z by -90 degrees, as in the laboratory.
struct FlowFrame {
  double origin_x = 0, origin_z = 0;  ///< the drum's axis; without a container the grains' mean x and z = 0
  double x_axis_x = 1, x_axis_z = 0;  ///< unit vector along the surface
  /// Its axes turned clockwise.
  FlowFrame at_slope(double theta) const;
  /// The coordinates of a place, and the components of a vector.
  std::array<double, 2> place(double x, double z) const { return turned(x - origin_x, z - origin_z); }
  std::array<double, 2> turned(double v_x, double v_z) const {
    return {v_x * x_axis_x + v_z * x_axis_z, v_z * x_axis_x - v_x * x_axis_z};
  }
};

/// Frame with z against gravity (theta = 0), turned clockwise by theta. Gravity of zero counts as pointing to
/// -z.
FlowFrame frame_at_slope(double origin_x, double origin_z, double gravity_x, double gravity_z, double theta);

/// The same state seen in a vertical mirror. A drum that turns anticlockwise is measured so: the flow then
/// goes to +x.
Snapshot mirrored(Snapshot snapshot);

/// Angle of the centre of mass about the frame's origin from the direction of gravity (= -z of `upright`),
/// positive when the grains are carried up on the side that the surface descends from (-x).
double centre_of_mass_angle(const Snapshot& snapshot, const FlowFrame& upright);

/// Area covered by grains in square cells of side 1 d, summed over snapshots.
class CoverageMap {
 public:
  /// Cells over part of the frame.
  explicit CoverageMap(const Rectangle& over) : grid_(over), area_(grid_.cells(), 0.0) {}
  void add(const Snapshot& snapshot, const FlowFrame& frame);
  /// Batches put together, or one taken out again; all cover the same cells.
  friend void add_times(double factor, const CoverageMap& from, CoverageMap& to);
  double z_min() const { return grid_.z_min; }
  double z_max() const { return grid_.z_min + grid_.rows; }
  /// Mean volume fraction at a point, bilinear between cell centres; 0 outside.
  double volume_fraction(double x, double z) const;

 private:
  friend class CoverageBatches;
  void add_disc(double x, double z, double radius);

  UnitCells grid_;
  double snapshots_ = 0;
  std::vector<double> area_;
  std::vector<double> corners_;  ///< workspace of add_disc
};

/// Coverage of the batches of a run, one in memory and the others in a scratch file.
class CoverageBatches {
 public:
  /// `empty`: over the cells of all of them.
  CoverageBatches(const CoverageMap& empty, std::shared_ptr<ScratchFile> file);
  /// Batches in ascending order, from 0 on.
  void add(const Snapshot& snapshot, const FlowFrame& frame, std::size_t batch);
  std::size_t size() const { return stored_.size() + 1; }
  CoverageMap batch(std::size_t b) const;
  /// Of all batches.
  CoverageMap whole() const;

 private:
  struct Stored {
    std::uint64_t place;
    double snapshots;
  };
  CoverageMap empty_, newest_;
  std::shared_ptr<ScratchFile> file_;
  std::vector<Stored> stored_;
};

struct SlopeOptions {
  double isoline = 0.4;         ///< volume fraction of the line that stands for the surface
  double half_width = 20;       ///< d; cut to a quarter of the surface's chord in a small drum
  double container_radius = 0;  ///< 0: no container, no cut
};

/// Slope of the isoline of a map in the upright frame.
struct Slope {
  double theta = std::numeric_limits<double>::quiet_NaN();  ///< rad; NaN when no line is found
  double half_width = 0;                                    ///< of the range used, d
  double surface_z = 0;  ///< of the line at x = 0 in the frame at slope theta
};

/// Straight line through the isoline over |x| < half_width, both in the frame that has its slope: found by
/// iteration from `first_guess` (rad).
Slope isoline_slope(const CoverageMap& upright_map, double first_guess, const SlopeOptions& options);

}  // namespace drumlin::particles

#pragma once
// What a material that is carried along knows of a particle map: motion and stress in the laboratory,
// smoothed, at any point of the packing.
#include <complex>
#include <vector>

#include "coupling/core/results/field_map.hpp"

namespace drumlin::coupling {

/// A traceless symmetric tensor as xx + i xz: turned by a quarter turn in the space of such tensors it is
/// multiplied by i, and |.| is sqrt(T:T/2).
using Deviator = std::complex<double>;

struct PathFieldOptions {
  double smoothing = 2;          ///< d, standard deviation of the Gaussian over the nodes
  double least_nu = 0.6;         ///< of nodes that speak
  double wall_margin = 2.5;      ///< d, nodes nearer to the wall do not speak
  double surface_clearance = 1;  ///< d, paths keep this distance from the surface
};

/// Motion and stress at a point.
struct PathPoint {
  double u = 0, w = 0;  ///< velocity in the laboratory, the drum's turn included
  double spin = 0;      ///< W = (du/dz - dw/dx)/2, laboratory
  double p = 0;
  Deviator rate;        ///< D
  Deviator stress;      ///< s, traction-positive: s_xx = p - sigma_xx, s_xz = sigma_xz
  double dilation = 0;  ///< div v
};

/// Fields over the nodes of a map. The gradient is that of the displacements from snapshot to snapshot where
/// the map has them (the bed), else that of the velocities (the flow).
class PathFields {
 public:
  /// Needs nu, v_.., d_v_.., sigma_.. and the header's rotation, axis_depth, drum_radius (> 0: throws
  /// InputError without a drum, and where something is missing).
  explicit PathFields(const FieldMap& map, const PathFieldOptions& options = {});

  /// Bilinear between nodes; outside of the packing the nearest point inside of it, see inside().
  PathPoint at(double x, double z) const;
  /// The point itself, or the nearest one that is no closer than half a grain to the wall and not above the
  /// surface.
  void bring_inside(double& x, double& z) const;
  /// Whether node (column, row) speaks: its values are means of the map, not continued ones.
  bool speaks(std::size_t node) const { return speaks_[node]; }
  /// Share of the nodes that speak whose gradient is that of displacements.
  double share_from_displacements() const { return share_; }

  const MapGrid& grid() const { return grid_; }
  double axis() const { return axis_; }
  double radius() const { return radius_; }
  double rotation() const { return rotation_; }
  double surface(double x) const;  ///< z of the packing's upper edge

 private:
  void find_speaking(const FieldMap& map, const PathFieldOptions& options);
  void find_surface(const FieldMap& map, const PathFieldOptions& options);
  std::vector<double> smoothed(const std::vector<double>& values, double deviation) const;

  MapGrid grid_;
  double axis_ = 0, radius_ = 0, rotation_ = 0, share_ = 0;
  std::vector<bool> speaks_;
  std::vector<double> weight_;   // nu of nodes that speak, else 0
  std::vector<double> surface_;  // by column
  std::vector<PathPoint> points_;
};

}  // namespace drumlin::coupling

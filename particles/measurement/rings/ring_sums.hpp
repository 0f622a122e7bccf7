#pragma once
// Sums over rings about a point: what layers are to a slice. The tangent t points clockwise and takes the
// place of x, the radius r that of z, so that all sums of LayerSum keep their meaning and their signs.
#include <cstddef>
#include <vector>

#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// Ring l covers l thickness ... (l + 1) thickness about the origin of the frame, whose axes are those of the
/// laboratory.
struct RingGrid {
  FlowFrame frame;
  double thickness = 1;
  std::vector<double> area;  ///< of each ring, inside the container
  std::size_t rings() const { return area.size(); }
  double r_of(std::size_t ring) const { return (static_cast<double>(ring) + 0.5) * thickness; }
};

/// Rings out to `r_to`. container_radius > 0: of a container about the same centre, which cuts the last ring.
RingGrid ring_grid(double centre_x, double centre_z, double thickness, double r_to, double container_radius);

/// Area common to a disc of `radius` and a circle of radius `circle` whose centres are `distance` apart.
double disc_area_in_circle(double distance, double radius, double circle);

/// Adds one snapshot, seen in the grid's frame; `sums.layers` must have the grid's length. Velocities of
/// centres and forces are taken along the radius and the tangent at the place where they are; branches are
/// cut where they cross from ring to ring.
void add_snapshot(const RingGrid& grid, const FlowSnapshot& snapshot, LayerSums& sums);

}  // namespace drumlin::particles

#pragma once
// Each grain's share of the plane (docs/decisions.md): cells of the radical tessellation, closed at
// the container, across a period and at the free surface.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "particles/bodies/period.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/detection/cell_grid.hpp"
#include "particles/measurement/grains/convex_polygon.hpp"

namespace drumlin::particles {

/// d. A cell reaches no farther than this from the centre of a grain of diameter 1; from others to where a
/// tangent to the grain is as long as there. It closes cells at a free surface and must leave those within a
/// packing alone. Of a cell that is periodic in x and z, where nothing is free, no cell ends so.
inline constexpr double voronoi_reach = 1.5;

struct VoronoiCell {
  /// d^2. 0 for a grain that others leave no room (its centre deep in a larger disc; the second of two equal
  /// grains in one place); NaN for a grain that takes no part: its centre lies outside of the container, or
  /// its place or radius is no number.
  double area = 0;
  bool open = false;  ///< ends at the reach somewhere
};

/// The cells of one snapshot, each computed when it is asked for. The line that parts two grains has equal
/// tangents to both: it cuts no disc unless discs overlap. Straight walls are not known to a snapshot:
/// cells reach through them as at a free surface.
class VoronoiTessellation {
 public:
  explicit VoronoiTessellation(const Snapshot& snapshot, double reach = voronoi_reach);
  std::size_t count() const { return grains_.size(); }
  VoronoiCell cell(std::size_t grain);

 private:
  struct Neighbour {
    double x, z, distance_squared, offset;  ///< the cell keeps {(x, z) . p <= offset}
  };

  void cut_by_grid(std::size_t site, std::size_t grid);
  /// False when a neighbour leaves the site no room at all.
  bool gather(std::size_t site, const CellGrid& grid, double reach, double most_squared);

  Period period_;  ///< none within a container
  double container_radius_ = 0;
  double tangent_squared_ = 0;  ///< length of the tangents at which cells end, squared
  Bodies sites_;  ///< the grains that take part, from the container's axis or in the first period
  std::vector<std::int32_t> grains_;  ///< the site of each; -1: takes no part
  GrainGrids grids_;                  ///< of the sites
  std::vector<double> largest_;       ///< radius in each grid
  ConvexPolygon polygon_;
  std::vector<Neighbour> neighbours_;
};

/// All cells of a snapshot, in the order of its grains.
std::vector<VoronoiCell> voronoi_cells(const Snapshot& snapshot, double reach = voronoi_reach);

}  // namespace drumlin::particles

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

/// The line that parts two grains.
enum class Tessellation {
  radical,  ///< equal tangents to both discs: cuts no disc unless discs overlap
  ordinary  ///< equal distance from both centres: cuts the larger of two discs of unequal size that touch
};

struct VoronoiOptions {
  Tessellation tessellation = Tessellation::radical;
  /// d. A cell reaches no farther than this from the centre of a grain of diameter 1; from others to where a
  /// tangent to the grain is as long as there. It closes cells at a free surface and must leave those within
  /// a packing alone. Of a cell that is periodic in x and z, where nothing is free, no cell ends so.
  double reach = 1.5;
};

struct VoronoiCell {
  /// d^2. 0 for a grain that others leave no room (its centre deep in a larger disc; the second of two equal
  /// grains in one place); NaN for a grain that takes no part: its centre lies outside of the container, or
  /// its place or radius is no number.
  double area = 0;
  bool open = false;  ///< ends at the reach somewhere
};

/// The cells of one snapshot, each computed when it is asked for. Straight walls are not known to a snapshot:
/// cells reach through them as at a free surface.
class VoronoiTessellation {
 public:
  explicit VoronoiTessellation(const Snapshot& snapshot, const VoronoiOptions& options = {});
  std::size_t count() const { return grains_.size(); }
  VoronoiCell cell(std::size_t grain);

 private:
  /// What one grid of sites is to a search in it.
  struct Level {
    double largest_weight = 0, largest_diameter = 0;
  };
  struct Neighbour {
    double x, z, distance_squared, offset;  ///< the cell keeps {(x, z) . p <= offset}
  };

  double weight(double radius) const;
  void cut_by_level(std::size_t site, std::size_t level);
  /// False when a neighbour leaves the site no room at all.
  bool gather(std::size_t site, const CellGrid& grid, double reach, double most_squared);

  VoronoiOptions options_;
  Period period_;  ///< none within a container
  double container_radius_ = 0;
  double tangent_squared_ = 0;  ///< length of the tangents at which cells end, squared
  Bodies sites_;  ///< the grains that take part, from the container's axis or in the first period
  std::vector<std::int32_t> grains_;  ///< the site of each; -1: takes no part
  GrainGrids grids_;                  ///< of the sites
  std::vector<Level> levels_;         ///< of each grid
  ConvexPolygon polygon_;
  std::vector<Neighbour> neighbours_;
};

/// All cells of a snapshot, in the order of its grains.
std::vector<VoronoiCell> voronoi_cells(const Snapshot& snapshot, const VoronoiOptions& options = {});

}  // namespace drumlin::particles

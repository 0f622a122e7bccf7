#pragma once
// The window of an open scene that is measured: what its packing reaches, without the grains that flew far
// away.
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/disc_area.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {

/// Largest window that is measured, so that memory grows with the number of grains and not with the distance
/// of the farthest one. A window within it holds every grain.
struct WindowLimits {
  double area = 0;    ///< d^2: 16 per grain, at least 10,000
  double height = 0;  ///< d: 20 sqrt(grains), at least 1000
};
WindowLimits window_limits(std::size_t grains);
/// True if a window of this size is measured as it is. `period` > 0: its width.
bool fits(const WindowLimits& limits, const Rectangle& window, double period);

/// Area of discs in square cells of 4 d (of 4 d by the period in a periodic domain), summed over snapshots.
/// Holds at most 16 cells per grain and 10,000 more: beyond that the emptier half of them is forgotten.
class Occupancy {
 public:
  void add(const Snapshot& snapshot, const FlowFrame& frame);
  /// The box around the heaviest cluster of cells, side by side or corner to corner, whose mean coverage over
  /// all snapshots is 0.05 at least (below it no field of a map is drawn), one cell wider to each side;
  /// without such a cell around the median of the grains. Within `extent` and the limits.
  Rectangle window(const Rectangle& extent, const WindowLimits& limits) const;

 private:
  using Cell = std::pair<std::int64_t, std::int64_t>;
  struct Content {
    double area = 0;
    Rectangle reach = no_rectangle;  ///< of its discs
  };
  struct Cluster {
    double weight = 0;  ///< area of the grains, summed over the snapshots
    double centre_x = 0, centre_z = 0;
    Rectangle box;  ///< around its grains and those of the cells beside it
  };
  void forget_emptier_half();
  /// Of the cells with this mean area per area of the cell and more; weight 0 without any.
  Cluster heaviest_cluster(double least) const;
  Cluster cluster_of(const std::vector<Cell>& cells) const;
  Cluster middle_of_all(const Rectangle& extent) const;

  std::map<Cell, Content> cells_;  ///< in a fixed order: the same snapshots give the same window
  std::size_t snapshots_ = 0, most_cells_ = 0;
  double period_ = 0;
};

}  // namespace drumlin::particles

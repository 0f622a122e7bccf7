#pragma once
// The way from a point to the nodes of a map that its kernel reaches: one for all sums of coarse graining.
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/maps/coarse_graining.hpp"
#include "particles/measurement/maps/node_tiles.hpp"
#include "particles/measurement/maps/spline_kernel.hpp"

namespace drumlin::particles {

/// Nodes along one axis that a point reaches at most.
constexpr std::size_t most_nodes = static_cast<std::size_t>(4 * most_spacings_per_width) + 1;

/// Nodes along one axis that a point reaches, with the kernel there and its slope.
struct NodeReach {
  std::ptrdiff_t first = 0;
  std::size_t count = 0;
  std::array<double, most_nodes> weight, slope;
};

/// `place`: of the point, counted in spacings from the first node.
template <bool with_slope>
void find_reach(double place, double spacings_per_width, double width, NodeReach& reach) {
  const double radius = 2 * spacings_per_width;
  const double first = std::ceil(place - radius);
  reach.first = static_cast<std::ptrdiff_t>(first);
  reach.count = static_cast<std::size_t>(std::floor(place + radius) - first) + 1;
  const double scale = 1 / width, step = 1 / spacings_per_width, start = (first - place) * step;
  for (std::size_t k = 0; k < reach.count; ++k) {
    const double u = start + static_cast<double>(k) * step;
    reach.weight[k] = scale * spline(u);
    if constexpr (with_slope) reach.slope[k] = scale * scale * spline_slope(u);
  }
}

/// Puts points onto the nodes of one grid.
template <class Node>
class NodeCanvas {
 public:
  NodeCanvas(const CoarseGraining& graining, NodeTiles<Node>& nodes)
      : graining_(graining), grid_(graining.grid), nodes_(nodes) {}

  /// Calls action(node, phi) for every node that (x, z) reaches.
  template <class Action>
  void each_node(double x, double z, Action action) {
    find<false>(x, z);
    visit([&](Node& node, std::size_t column, std::size_t row) {
      action(node, x_.weight[column] * z_.weight[row]);
    });
  }
  /// action(node, phi, d phi/dx, d phi/dz), the derivatives with respect to the node.
  template <class Action>
  void each_node_with_slope(double x, double z, Action action) {
    find<true>(x, z);
    visit([&](Node& node, std::size_t column, std::size_t row) {
      action(node, x_.weight[column] * z_.weight[row], x_.slope[column] * z_.weight[row],
             x_.weight[column] * z_.slope[row]);
    });
  }

  /// Calls action(columns, rows, x, z) for each image of a point that reaches nodes, so many lengths and
  /// heights of the cell away; for the point itself alone without a cell.
  template <class Action>
  void each_image(const std::optional<FlowCell>& cell, double x, double z, Action action) const {
    if (!cell) {
      action(0.0, 0.0, x, z);
      return;
    }
    const double reach = 2 * graining_.width;
    const double lowest = grid_.z_first - reach, highest = grid_.z_of(grid_.rows - 1) + reach;
    const double left = grid_.x_first - reach, right = grid_.x_of(grid_.columns - 1) + reach;
    const double last_row = std::floor((highest - z) / cell->height);
    for (double row = std::ceil((lowest - z) / cell->height); row <= last_row; ++row) {
      const double row_x = x + row * cell->offset;
      const double last_column = std::floor((right - row_x) / cell->length);
      for (double column = std::ceil((left - row_x) / cell->length); column <= last_column; ++column)
        action(column, row, row_x + column * cell->length, z + row * cell->height);
    }
  }

 private:
  template <bool with_slope>
  void find(double x, double z) {
    find_reach<with_slope>((x - grid_.x_first) / grid_.spacing_x, graining_.width / grid_.spacing_x,
                           graining_.width, x_);
    find_reach<with_slope>((z - grid_.z_first) / grid_.spacing_z, graining_.width / grid_.spacing_z,
                           graining_.width, z_);
  }
  template <class Action>
  void visit(Action action) {
    const auto columns = static_cast<std::ptrdiff_t>(grid_.columns),
               rows = static_cast<std::ptrdiff_t>(grid_.rows);
    for (std::size_t k = 0; k < z_.count; ++k) {
      const std::ptrdiff_t row = z_.first + static_cast<std::ptrdiff_t>(k);
      if (row < 0 || row >= rows) continue;
      for (std::size_t c = 0; c < x_.count; ++c) {
        std::ptrdiff_t column = x_.first + static_cast<std::ptrdiff_t>(c);
        if (graining_.period > 0) {
          column = (column % columns + columns) % columns;
        } else if (column < 0 || column >= columns) {
          continue;
        }
        action(nodes_.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row)), c, k);
      }
    }
  }

  const CoarseGraining& graining_;
  const MapGrid& grid_;
  NodeTiles<Node>& nodes_;
  NodeReach x_, z_;
};

}  // namespace drumlin::particles

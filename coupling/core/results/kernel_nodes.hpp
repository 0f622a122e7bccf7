#pragma once
// The nodes of a grid that points reach by the kernel of coarse graining: of the grains of one side and the
// pieces of material of the other (docs/theory/coarse-graining.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "coupling/core/results/field_map.hpp"
#include "coupling/core/results/spline_kernel.hpp"

namespace drumlin {

/// Most spacings that a width may hold: the footprint of a point has a fixed size.
constexpr double most_spacings_per_width = 15;

/// Least volume fraction at which a node has more than its volume fraction: above the surface a few grains in
/// flight would stand for a field.
constexpr double least_map_nu = 0.05;

/// Columns at whole multiples of the spacing, rows halfway between them, at the middles of layers as thick as
/// the spacing. Throws InputError unless 1 <= width/spacing <= most_spacings_per_width: a wider spacing would
/// lose grains between nodes.
MapGrid grid_over(double x_from, double x_to, double z_from, double z_to, double spacing, double width);

struct MapPlace {
  std::size_t column, row;
};

/// The kernel of a node at a point, with its derivatives with respect to the node.
struct KernelWeight {
  double phi = 0, phi_x = 0, phi_z = 0;
};

/// Sums of phi times some moments at their points, and their slopes; phi is the kernel around the node. The
/// first moment is the weight of the means.
template <std::size_t N>
struct KernelSums {
  std::array<double, N> value{}, slope_x{}, slope_z{};

  void add(const KernelWeight& at, const std::array<double, N>& moments) {
    for (std::size_t k = 0; k < N; ++k) {
      value[k] += at.phi * moments[k];
      slope_x[k] += at.phi_x * moments[k], slope_z[k] += at.phi_z * moments[k];
    }
  }
  double mean(std::size_t k) const { return value[k] / value[0]; }
  /// Slope of the mean, each sum by the kernel's own slope.
  double slope(std::size_t k, const std::array<double, N>& slopes) const {
    return (slopes[k] - mean(k) * slopes[0]) / value[0];
  }
};

class KernelNodes {
 public:
  /// `grid` lives as long as this; 1 <= width/spacing <= most_spacings_per_width. period > 0: columns wrap
  /// around.
  KernelNodes(const MapGrid& grid, double width, double period = 0)
      : grid_(grid), width_(width), period_(period) {}

  /// action(node, KernelWeight) for every node that a point reaches.
  template <class Action>
  void each_node(double at_x, double at_z, Action action) const {
    const Reach x = reach<true>(0, at_x, at_x), z = reach<true>(1, at_z, at_z);
    visit(x, z, [&](MapPlace node, std::size_t c, std::size_t r) {
      action(node,
             KernelWeight{x.weight[c] * z.weight[r], x.slope[c] * z.weight[r], x.weight[c] * z.slope[r]});
    });
  }
  /// action(node, phi) for every node that one of two points reaches, phi the sum of both; they are at most
  /// `longest_piece` widths apart.
  template <class Action>
  void each_node_of_two(double x1, double z1, double x2, double z2, Action action) const {
    const Reach at_x1 = reach<false>(0, x1, x2), at_x2 = reach<false>(0, x2, x1);
    const Reach at_z1 = reach<false>(1, z1, z2), at_z2 = reach<false>(1, z2, z1);
    visit(at_x1, at_z1, [&](MapPlace node, std::size_t c, std::size_t r) {
      action(node, at_x1.weight[c] * at_z1.weight[r] + at_x2.weight[c] * at_z2.weight[r]);
    });
  }
  static constexpr double longest_piece = 0.6;

 private:
  /// Nodes along one axis that two points of a piece reach at most.
  static constexpr auto most_nodes =
      static_cast<std::size_t>((4 + longest_piece) * most_spacings_per_width) + 2;

  /// Nodes along one axis, with the kernel there around a point and its slope.
  struct Reach {
    std::ptrdiff_t first;
    std::size_t count;
    std::array<double, most_nodes> weight, slope;
  };
  /// The kernel around `at` at all nodes that it or `other` reaches; axis 0 is x.
  template <bool with_slope>
  Reach reach(int axis, double at, double other) const {
    const double from = axis == 0 ? grid_.x_first : grid_.z_first;
    const double spacing = axis == 0 ? grid_.spacing_x : grid_.spacing_z;
    const double step = spacing / width_, radius = 2 / step, place = (at - from) / spacing;
    const double beside = (other - from) / spacing;
    const double first = std::ceil(std::min(place, beside) - radius);
    Reach found;
    found.first = static_cast<std::ptrdiff_t>(first);
    found.count = static_cast<std::size_t>(std::floor(std::max(place, beside) + radius) - first) + 1;
    const double scale = 1 / width_, start = (first - place) * step;
    for (std::size_t k = 0; k < found.count; ++k) {
      const double u = start + static_cast<double>(k) * step;
      found.weight[k] = scale * spline(u);
      if constexpr (with_slope) found.slope[k] = scale * scale * spline_slope(u);
    }
    return found;
  }
  /// action(node, c, r) for the nodes of a rectangle that are in the grid; columns of a period wrap around.
  template <class Action>
  void visit(const Reach& x, const Reach& z, Action action) const {
    const auto columns = static_cast<std::ptrdiff_t>(grid_.columns),
               rows = static_cast<std::ptrdiff_t>(grid_.rows);
    for (std::size_t r = 0; r < z.count; ++r) {
      const std::ptrdiff_t row = z.first + static_cast<std::ptrdiff_t>(r);
      if (row < 0 || row >= rows) continue;
      for (std::size_t c = 0; c < x.count; ++c) {
        std::ptrdiff_t column = x.first + static_cast<std::ptrdiff_t>(c);
        if (period_ > 0) {
          column = (column % columns + columns) % columns;
        } else if (column < 0 || column >= columns) {
          continue;
        }
        action(MapPlace{static_cast<std::size_t>(column), static_cast<std::size_t>(row)}, c, r);
      }
    }
  }

  const MapGrid& grid_;
  double width_, period_;
};

}  // namespace drumlin

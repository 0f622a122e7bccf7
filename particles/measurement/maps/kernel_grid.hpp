#pragma once
// The binning by nodes of a map, with the kernel around each (frame/accumulate.hpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/images.hpp"
#include "particles/measurement/maps/coarse_graining.hpp"
#include "particles/measurement/maps/node_tiles.hpp"
#include "particles/measurement/maps/spline_kernel.hpp"

namespace drumlin::particles {

/// The kernel of a node at a point, with its derivatives with respect to the node.
struct KernelWeight {
  double phi = 0, phi_x = 0, phi_z = 0;
};

class KernelGrid {
 public:
  /// `graining` lives as long as this. Points of a `cell`, unless it is open, come with all of their images
  /// that reach nodes.
  KernelGrid(const CoarseGraining& graining, const Period& cell)
      : graining_(graining), grid_(graining.grid), cell_(cell) {}

  /// A grain and its images, which a moving cell makes faster.
  template <class Action>
  void each_centre(const GrainSample<2>& grain, Action action) const {
    each_image(grain.at, 0, [&](const Vector<2>& at) {
      GrainSample<2> seen = grain;
      seen.at = at;
      const Point faster = cell_.image_velocity({at[0] - grain.at[0], at[1] - grain.at[1]});
      for (Vector<2>* v : {&seen.velocity, &seen.laboratory_velocity})
        (*v)[0] += faster.x, (*v)[1] += faster.z;
      each_node(at, [&](MapPlace node, const KernelWeight& weight) { action(node, weight, seen); });
    });
  }
  /// The integral of the kernel along a half branch by two Gauss points in each of its pieces. Pieces up to
  /// 0.6 widths long keep its error below 1e-3 of the kernel's greatest value (test MapSums).
  template <class Action>
  void each_share(const HalfBranch<2>& branch, Action action) const;
  /// The contact's place; its normal has the length 1 there.
  template <class Action>
  void each_end(HalfBranch<2> branch, Action action) const {
    const double length = std::hypot(branch.toward[0], branch.toward[1]);
    branch.normal = {branch.toward[0] / length, branch.toward[1] / length};
    each_image(branch.point(1), 0, [&](const Vector<2>& at) {
      const Reach x = reach<false>(0, at[0], at[0]), z = reach<false>(1, at[1], at[1]);
      visit(x, z, [&](MapPlace node, std::size_t c, std::size_t r) {
        action(node, x.weight[c] * z.weight[r], branch);
      });
    });
  }

  /// Calls action(image) for each image of a point that, or what lies at most `beside` it, reaches nodes.
  template <class Action>
  void each_image(const Vector<2>& at, double beside, Action action) const {
    const double reach = 2 * graining_.width + beside;
    particles::each_image(cell_, at,
                          {grid_.x_first - reach, grid_.x_of(grid_.columns - 1) + reach,
                           grid_.z_first - reach, grid_.z_of(grid_.rows - 1) + reach},
                          action);
  }
  /// action(node, weight) for every node that a point reaches.
  template <class Action>
  void each_node(const Vector<2>& at, Action action) const {
    const Reach x = reach<true>(0, at[0], at[0]), z = reach<true>(1, at[1], at[1]);
    visit(x, z, [&](MapPlace node, std::size_t c, std::size_t r) {
      action(node,
             KernelWeight{x.weight[c] * z.weight[r], x.slope[c] * z.weight[r], x.weight[c] * z.slope[r]});
    });
  }

 private:
  static constexpr double longest_piece = 0.6;
  static constexpr double gauss_offset = 0.28867513459481288;  // sqrt(3)/6 from the middle of a piece of 1
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
    const double spacing = axis == 0 ? grid_.spacing_x : grid_.spacing_z, width = graining_.width;
    const double step = spacing / width, radius = 2 / step, place = (at - from) / spacing;
    const double beside = (other - from) / spacing;
    const double first = std::ceil(std::min(place, beside) - radius);
    Reach found;
    found.first = static_cast<std::ptrdiff_t>(first);
    found.count = static_cast<std::size_t>(std::floor(std::max(place, beside) + radius) - first) + 1;
    const double scale = 1 / width, start = (first - place) * step;
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
        if (graining_.period > 0) {
          column = (column % columns + columns) % columns;
        } else if (column < 0 || column >= columns) {
          continue;
        }
        action(MapPlace{static_cast<std::size_t>(column), static_cast<std::size_t>(row)}, c, r);
      }
    }
  }

  const CoarseGraining& graining_;
  const MapGrid& grid_;
  Period cell_;
};

template <class Action>
void KernelGrid::each_share(const HalfBranch<2>& branch, Action action) const {
  const double length = std::hypot(branch.toward[0], branch.toward[1]);
  const double pieces = std::max(1.0, std::ceil(length / (longest_piece * graining_.width)));
  const double share = 1 / (2 * pieces);
  for (double piece = 0; piece < pieces; ++piece) {
    const Vector<2> middle = branch.point((piece + 0.5) / pieces);
    const double off_x = gauss_offset / pieces * branch.toward[0],
                 off_z = gauss_offset / pieces * branch.toward[1];
    each_image(middle, longest_piece / 2 * graining_.width, [&](const Vector<2>& at) {
      const double x1 = at[0] - off_x, x2 = at[0] + off_x, z1 = at[1] - off_z, z2 = at[1] + off_z;
      const Reach at_x1 = reach<false>(0, x1, x2), at_x2 = reach<false>(0, x2, x1);
      const Reach at_z1 = reach<false>(1, z1, z2), at_z2 = reach<false>(1, z2, z1);
      visit(at_x1, at_z1, [&](MapPlace node, std::size_t c, std::size_t r) {
        const double phi = at_x1.weight[c] * at_z1.weight[r] + at_x2.weight[c] * at_z2.weight[r];
        action(node, share * phi, branch);
      });
    });
  }
}

}  // namespace drumlin::particles

#pragma once
// The binning by nodes of a map, with the kernel around each (frame/accumulate.hpp).
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "coupling/core/results/kernel_nodes.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/images.hpp"
#include "particles/measurement/maps/coarse_graining.hpp"

namespace drumlin::particles {

class KernelGrid {
 public:
  /// `graining` lives as long as this. Points of a `cell`, unless it is open, come with all of their images
  /// that reach nodes.
  KernelGrid(const CoarseGraining& graining, const Period& cell)
      : graining_(graining),
        grid_(graining.grid),
        nodes_(graining.grid, graining.width, graining.period),
        cell_(cell) {}

  /// A grain and its images, which a moving cell makes faster.
  template <int D, class Action>
  void each_centre(const GrainSample<D>& grain, Action action) const {
    each_image({grain.at[0], grain.at[1]}, 0, [&](const Vector<2>& at) {
      GrainSample<D> seen = grain;
      seen.at[0] = at[0], seen.at[1] = at[1];
      const Point faster = cell_.image_velocity({at[0] - grain.at[0], at[1] - grain.at[1]});
      for (Vector<D>* v : {&seen.velocity, &seen.laboratory_velocity})
        (*v)[0] += faster.x, (*v)[1] += faster.z;
      each_node(at, [&](MapPlace node, const KernelWeight& weight) { action(node, weight, seen); });
    });
  }
  /// The integral of the kernel along a half branch by two Gauss points in each of its pieces. Pieces up to
  /// 0.6 widths long keep its error below 1e-3 of the kernel's greatest value (test MapSums).
  template <int D, class Action>
  void each_share(const HalfBranch<D>& branch, Action action) const;
  /// The contact's place; its normal has the length 1 there.
  template <int D, class Action>
  void each_end(HalfBranch<D> branch, Action action) const {
    const double reach = branch.radius > 0 ? branch.radius : length<D>(branch.toward);
    for (int a = 0; a < D; ++a) branch.normal[a] = branch.toward[a] / reach;
    const Vector<D> contact = branch.point(1);
    each_image({contact[0], contact[1]}, 0, [&](const Vector<2>& at) {
      each_node(at, [&](MapPlace node, const KernelWeight& weight) { action(node, weight.phi, branch); });
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
    nodes_.each_node(at[0], at[1], action);
  }

 private:
  static constexpr double longest_piece = KernelNodes::longest_piece;
  static constexpr double gauss_offset = 0.28867513459481288;  // sqrt(3)/6 from the middle of a piece of 1

  const CoarseGraining& graining_;
  const MapGrid& grid_;
  KernelNodes nodes_;
  Period cell_;
};

template <int D, class Action>
void KernelGrid::each_share(const HalfBranch<D>& branch, Action action) const {
  const double length = std::hypot(branch.toward[0], branch.toward[1]);
  const double pieces = std::max(1.0, std::ceil(length / (longest_piece * graining_.width)));
  const double share = 1 / (2 * pieces);
  for (double piece = 0; piece < pieces; ++piece) {
    const Vector<D> middle = branch.point((piece + 0.5) / pieces);
    const double off_x = gauss_offset / pieces * branch.toward[0],
                 off_z = gauss_offset / pieces * branch.toward[1];
    each_image({middle[0], middle[1]}, longest_piece / 2 * graining_.width, [&](const Vector<2>& at) {
      nodes_.each_node_of_two(at[0] - off_x, at[1] - off_z, at[0] + off_x, at[1] + off_z,
                              [&](MapPlace node, double phi) { action(node, share * phi, branch); });
    });
  }
}

}  // namespace drumlin::particles

#pragma once
// Search for pairs that only their speed brings together within a step: a tree over cells of grains that
// bounds positions and velocities. A motion that neighbours have in common costs nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "particles/detection/cell_grid.hpp"
#include "particles/parallel/parallel_loops.hpp"

namespace drumlin::particles {

/// Bounds of some grains, in single precision and rounded outwards (bound_below, bound_above).
struct MotionBounds {
  float x_low = 0, x_high = 0, z_low = 0, z_high = 0;
  float v_x_low = 0, v_x_high = 0, v_z_low = 0, v_z_high = 0;
  float radius = 0;  ///< largest
  float bound = 0;   ///< largest, of MotionTree::set_bounds
  float moved_x_low = 0, moved_x_high = 0, moved_z_low = 0,
        moved_z_high = 0;  ///< since the grains were sorted
};

/// Bounds of a number in single precision. Beyond the range of that, and of no number, they are infinite.
inline float bound_above(double value) {
  const auto nearest = static_cast<float>(value);
  const float above = nearest + std::abs(nearest) * 0x1p-22F + std::numeric_limits<float>::min();
  return above == above ? above : std::numeric_limits<float>::infinity();
}
inline float bound_below(double value) { return -bound_above(-value); }

/// How far an image is from its original, and how fast it moves against it.
struct Image {
  Point shift, velocity;
  bool original() const { return shift.x == 0 && shift.z == 0; }
};

inline double difference(float a, float b) { return static_cast<double>(a) - static_cast<double>(b); }

/// Distance of the nearest positions of a and of an image of b.
inline double distance(const MotionBounds& a, const MotionBounds& b, const Image& image) {
  const auto& [x, z] = image.shift;
  const double dx = std::max({0.0, difference(a.x_low, b.x_high) - x, difference(b.x_low, a.x_high) + x});
  const double dz = std::max({0.0, difference(a.z_low, b.z_high) - z, difference(b.z_low, a.z_high) + z});
  return std::sqrt(dx * dx + dz * dz);
}

/// Bound on the relative speed of a grain of a and one of an image of b.
inline double relative_speed(const MotionBounds& a, const MotionBounds& b, const Image& image) {
  const auto& [x, z] = image.velocity;
  const double u_x = std::max(difference(a.v_x_high, b.v_x_low) - x, difference(b.v_x_high, a.v_x_low) + x),
               u_z = std::max(difference(a.v_z_high, b.v_z_low) - z, difference(b.v_z_high, a.v_z_low) + z);
  return std::sqrt(u_x * u_x + u_z * u_z);
}

/// Bound on how far a grain of a and one of b have moved against each other since they were sorted.
inline double relative_displacement(const MotionBounds& a, const MotionBounds& b) {
  const double x = std::max(difference(a.moved_x_high, b.moved_x_low),
                            difference(b.moved_x_high, a.moved_x_low)),
               z = std::max(difference(a.moved_z_high, b.moved_z_low),
                            difference(b.moved_z_high, a.moved_z_low));
  return std::sqrt(x * x + z * z);
}

inline MotionBounds united(const MotionBounds& a, const MotionBounds& b) {
  return {std::min(a.x_low, b.x_low),
          std::max(a.x_high, b.x_high),
          std::min(a.z_low, b.z_low),
          std::max(a.z_high, b.z_high),
          std::min(a.v_x_low, b.v_x_low),
          std::max(a.v_x_high, b.v_x_high),
          std::min(a.v_z_low, b.v_z_low),
          std::max(a.v_z_high, b.v_z_high),
          std::max(a.radius, b.radius),
          std::max(a.bound, b.bound),
          std::min(a.moved_x_low, b.moved_x_low),
          std::max(a.moved_x_high, b.moved_x_high),
          std::min(a.moved_z_low, b.moved_z_low),
          std::max(a.moved_z_high, b.moved_z_high)};
}

/// Which pairs to look for.
struct FarSearch {
  double time_step = 0;
  double margin = 0;
  double listed = 0;       ///< pairs that were closer than this when they were sorted are listed
  bool by_bounds = false;  ///< look for what bounds add; otherwise for what speeds bring together
};

/// A tree over each of the grids of a search, and what it bounds. Keeps pointers into the grids.
class MotionTree {
 public:
  void build(const GrainGrids& grids, const Period& period, const ParallelLoops& loops);
  /// Bounds the grains as they are now that the grids have followed them.
  void follow(const ParallelLoops& loops);
  std::size_t bytes() const {
    std::size_t sum =
        nodes_.capacity() * sizeof(Node) + (blocks_.capacity() + above_.capacity()) * sizeof(Block);
    sum +=
        (parts_.capacity() + next_parts_.capacity()) * sizeof(Part) + stacks_.capacity() * sizeof(stacks_[0]);
    for (const auto& stack : stacks_) sum += stack.capacity() * sizeof(Two);
    return sum;
  }
  /// Sets what each body may be pushed beyond its own motion; one entry per body.
  void set_bounds(std::span<const double> bounds, const ParallelLoops& loops);

  /// Cuts a search into parts, enough for some threads to share them about evenly; returns their number.
  std::size_t cut(const FarSearch& search);
  /// Of the search that was cut last. Calls `meet(p, a, b, same, image)` with the grains of two cells, which
  /// are one and the same if `same`, for all that can hold pairs with
  ///   gap < margin + 2 h |v_i - v_j|,  after bounds + (bound_i + bound_j) / 2,
  /// but for those that are known, b in an image of the domain. Each part p has one thread.
  template <class Meet>
  void far_pairs(const FarSearch& search, const ParallelLoops& loops, Meet meet) {
    loops.each_of(static_cast<int>(parts_.size()), [&](int p) {
      search_below(search, parts_[p], stacks_[p], [&, p](const auto&... found) { meet(p, found...); });
    });
  }

 private:
  /// Up to four children, or the grains of a cell.
  struct Node {
    MotionBounds bounds;
    std::array<std::int32_t, 4> child{-1, -1, -1, -1};
    const NearGrain* first = nullptr;  // of a leaf
    std::int32_t count = 0;
    bool leaf() const { return count > 0; }
    std::span<const NearGrain> grains() const { return {first, static_cast<std::size_t>(count)}; }
    float size() const { return bounds.x_high - bounds.x_low + bounds.z_high - bounds.z_low; }
  };
  /// A node and its position among the blocks of a level.
  struct Block {
    std::int32_t row, column, node;
  };
  struct Two {
    std::int32_t a, b;
  };
  /// Two nodes, the second in an image, below which one thread searches.
  struct Part {
    Two two;
    Image image;
  };

  Image image(int right, int up) const {
    const Point shift{right * period_.length + up * period_.offset, up * period_.length_z};
    return {shift, period_.image_velocity(shift)};
  }

  bool apart(const FarSearch& search, const Node& a, const Node& b, const Image& image) const {
    const double bounds =
        search.by_bounds ? (static_cast<double>(a.bounds.bound) + static_cast<double>(b.bounds.bound)) / 2
                         : 0;
    if (search.by_bounds && bounds == 0) return true;
    const double reach =
        search.margin + 2 * search.time_step * relative_speed(a.bounds, b.bounds, image) + bounds;
    return reach + relative_displacement(a.bounds, b.bounds) <= search.listed ||
           distance(a.bounds, b.bounds, image) - static_cast<double>(a.bounds.radius) -
                   static_cast<double>(b.bounds.radius) >
               reach;
  }

  /// `stack`: pairs of nodes that are still to do.
  template <class Meet>
  void search_below(const FarSearch& search, const Part& part, std::vector<Two>& stack, Meet meet) const {
    stack.assign(1, part.two);
    while (!stack.empty()) {
      const Two two = stack.back();
      stack.pop_back();
      const Node &a = nodes_[two.a], &b = nodes_[two.b];
      if (apart(search, a, b, part.image)) continue;
      if (a.leaf() && b.leaf())
        meet(a.grains(), b.grains(), is_one(part, two), part.image);
      else
        open(part, two, stack);
    }
  }
  static bool is_one(const Part& part, const Two& two) { return two.a == two.b && part.image.original(); }
  void add_roots();
  void open(const Part& part, const Two& two, std::vector<Two>& stack) const;
  void open_both(const Node& node, std::vector<Two>& stack) const;
  void open_one(const Two& two, bool first, std::vector<Two>& stack) const;

  std::int32_t tree_of(const CellGrid& grid, const ParallelLoops& loops);
  void raise(std::span<const Block> blocks, std::vector<Block>& above);

  Period period_;
  std::vector<Node> nodes_;  // children before their parents
  std::vector<std::int32_t> roots_;
  std::vector<Part> parts_, next_parts_;
  std::vector<std::vector<Two>> stacks_;  // of each part
  std::vector<Block> blocks_, above_;
};

}  // namespace drumlin::particles

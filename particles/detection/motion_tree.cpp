#include "particles/detection/motion_tree.hpp"

#include <algorithm>
#include <limits>

namespace drumlin::particles {
namespace {

/// Least and largest of some numbers, rounded outwards once at the end.
struct Range {
  double low, high;
  explicit Range(double value) : low(value), high(value) {}
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
};

MotionBounds bounds_of(std::span<const NearGrain> grains) {
  const NearGrain& one = grains[0];
  Range x(one.x), z(one.z), v_x(one.v_x), v_z(one.v_z);
  Range moved_x(one.x - one.sorted_x), moved_z(one.z - one.sorted_z), radius(one.radius);
  for (const NearGrain& g : grains.subspan(1)) {
    x.add(g.x), z.add(g.z), v_x.add(g.v_x), v_z.add(g.v_z);
    moved_x.add(g.x - g.sorted_x), moved_z.add(g.z - g.sorted_z), radius.add(g.radius);
  }
  return {bound_below(x.low),       bound_above(x.high),
          bound_below(z.low),       bound_above(z.high),
          bound_below(v_x.low),     bound_above(v_x.high),
          bound_below(v_z.low),     bound_above(v_z.high),
          bound_above(radius.high), 0,
          bound_below(moved_x.low), bound_above(moved_x.high),
          bound_below(moved_z.low), bound_above(moved_z.high)};
}

}  // namespace

void MotionTree::build(const GrainGrids& grids, const Period& period, const ParallelLoops& loops) {
  period_ = period;
  nodes_.clear();
  roots_.clear();
  for (const CellGrid& grid : grids.grids()) roots_.push_back(tree_of(grid, loops));
}

void MotionTree::follow(const ParallelLoops& loops) {
  loops.each(nodes_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (nodes_[n].leaf()) nodes_[n].bounds = bounds_of(nodes_[n].grains());
  });
  for (Node& node : nodes_) {
    if (node.leaf()) continue;
    node.bounds = nodes_[node.child[0]].bounds;
    for (std::size_t c = 1; c < node.child.size() && node.child[c] >= 0; ++c)
      node.bounds = united(node.bounds, nodes_[node.child[c]].bounds);
  }
}

std::int32_t MotionTree::tree_of(const CellGrid& grid, const ParallelLoops& loops) {
  const auto cells = grid.cells();
  const std::size_t first = nodes_.size();
  nodes_.reserve(first + grid.count() + grid.count() / 2);
  nodes_.resize(first + grid.count());
  blocks_.resize(grid.count());
  loops.each(grid.count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      blocks_[c] = {cells[c].row, cells[c].column, static_cast<std::int32_t>(first + c)};
      Node& leaf = nodes_[first + c];
      leaf.first = grid.grains().data() + cells[c].first;
      leaf.count = cells[c + 1].first - cells[c].first;
      leaf.bounds = bounds_of(leaf.grains());
    }
  });
  while (blocks_.size() > 1) {
    raise(blocks_, above_);
    blocks_.swap(above_);
  }
  return blocks_[0].node;
}

/// Blocks of two by two blocks; one that stands alone is its own parent.
void MotionTree::raise(std::span<const Block> blocks, std::vector<Block>& above) {
  constexpr auto none = std::numeric_limits<std::int32_t>::max();
  above.clear();
  for (std::size_t begin = 0; begin < blocks.size();) {
    const std::int32_t row = blocks[begin].row >> 1;
    std::size_t even = begin;
    while (even < blocks.size() && blocks[even].row == 2 * row) ++even;
    std::size_t end = even;
    while (end < blocks.size() && blocks[end].row == 2 * row + 1) ++end;
    for (std::size_t p = begin, q = even; p < even || q < end;) {
      const std::int32_t column =
          std::min(p < even ? blocks[p].column >> 1 : none, q < end ? blocks[q].column >> 1 : none);
      std::array<std::int32_t, 4> child{-1, -1, -1, -1};
      int children = 0;
      for (; p < even && blocks[p].column >> 1 == column; ++p) child[children++] = blocks[p].node;
      for (; q < end && blocks[q].column >> 1 == column; ++q) child[children++] = blocks[q].node;
      std::int32_t node = child[0];
      if (children > 1) {
        node = static_cast<std::int32_t>(nodes_.size());
        Node parent;
        parent.child = child;
        parent.bounds = nodes_[child[0]].bounds;
        for (int c = 1; c < children; ++c) parent.bounds = united(parent.bounds, nodes_[child[c]].bounds);
        nodes_.push_back(parent);
      }
      above.push_back({row, column, node});
    }
    begin = end;
  }
}

void MotionTree::set_bounds(std::span<const double> bounds, const ParallelLoops& loops) {
  loops.each(nodes_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      double largest = 0;
      for (const NearGrain& g : nodes_[n].grains()) largest = std::max(largest, bounds[g.body]);
      nodes_[n].bounds.bound = largest > 0 ? bound_above(largest) : 0;
    }
  });
  for (Node& node : nodes_)
    for (const std::int32_t c : node.child)
      if (c >= 0) node.bounds.bound = std::max(node.bounds.bound, nodes_[c].bounds.bound);
}

void MotionTree::add_roots() {
  parts_.clear();
  const auto add = [&](std::size_t a, std::size_t b, const Image& image) {
    parts_.push_back({{roots_[a], roots_[b]}, image});
  };
  for (std::size_t a = 0; a < roots_.size(); ++a)
    for (std::size_t b = a; b < roots_.size(); ++b) {
      add(a, b, {});
      if (period_.open()) continue;
      add(a, b, image(1, 0));
      if (a != b) add(a, b, image(-1, 0));
      if (period_.open_z()) continue;
      for (const int across : {-1, 0, 1}) {
        add(a, b, image(across, 1));
        if (a != b) add(a, b, image(across, -1));
      }
    }
}

std::size_t MotionTree::cut(const FarSearch& search) {
  constexpr std::size_t enough = 32;
  stacks_.resize(std::max<std::size_t>(stacks_.size(), 1));
  std::vector<Two>& below = stacks_[0];
  add_roots();
  for (bool opens = true; opens && parts_.size() < enough;) {
    opens = false;
    next_parts_.clear();
    for (const Part& part : parts_) {
      const Node &a = nodes_[part.two.a], &b = nodes_[part.two.b];
      if (apart(search, a, b, part.image)) continue;
      if (a.leaf() && b.leaf()) {
        next_parts_.push_back(part);
        continue;
      }
      opens = true;
      below.clear();
      open(part, part.two, below);
      for (const Two& two : below) next_parts_.push_back({two, part.image});
    }
    parts_.swap(next_parts_);
  }
  stacks_.resize(std::max(stacks_.size(), parts_.size()));
  return parts_.size();
}

void MotionTree::open(const Part& part, const Two& two, std::vector<Two>& stack) const {
  const Node &a = nodes_[two.a], &b = nodes_[two.b];
  if (is_one(part, two))
    open_both(a, stack);
  else
    open_one(two, b.leaf() || (!a.leaf() && a.size() > b.size()), stack);
}

void MotionTree::open_both(const Node& node, std::vector<Two>& stack) const {
  for (std::size_t p = 0; p < node.child.size() && node.child[p] >= 0; ++p)
    for (std::size_t q = p; q < node.child.size() && node.child[q] >= 0; ++q)
      stack.push_back({node.child[p], node.child[q]});
}

void MotionTree::open_one(const Two& two, bool first, std::vector<Two>& stack) const {
  const Node& opened = nodes_[first ? two.a : two.b];
  for (const std::int32_t c : opened.child)
    if (c >= 0) stack.push_back(first ? Two{c, two.b} : Two{two.a, c});
}

}  // namespace drumlin::particles
